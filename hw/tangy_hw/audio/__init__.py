"""Sound: sources that are heard, players, voices, and WAV files."""
