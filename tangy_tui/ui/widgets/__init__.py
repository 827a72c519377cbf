"""Widgets: each draws values; none knows of a screen or a dialog."""
