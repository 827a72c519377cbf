"""Execution monitoring (lower part of Fig. 1): detection, diagnosis, recovery."""
