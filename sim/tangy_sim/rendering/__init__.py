"""Rendering of cards as a camera sees them, and of faces."""
