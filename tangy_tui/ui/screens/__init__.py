"""Screens: each draws one part of the program, and takes its keys."""
