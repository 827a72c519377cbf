"""Simulated worlds: the room, its people, its faults, and guidance for teachers."""
