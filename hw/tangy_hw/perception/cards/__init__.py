"""Detects and identifies printed cards, and reads their marks."""
