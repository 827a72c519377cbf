"""Widgets: each draws values, and depends on no screen or dialog."""
