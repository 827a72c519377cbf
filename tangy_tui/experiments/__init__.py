"""Repetition of the paper's experiments, and comparison with its results."""
