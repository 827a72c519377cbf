"""Drivers: one module or folder for each kind, and their registry."""
