"""The console (line mode): teaching, games and drills for pipes, scripts and screen readers."""
