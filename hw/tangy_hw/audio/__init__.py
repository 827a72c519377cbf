"""Audio: sources, players, speech synthesis, and WAV files."""
