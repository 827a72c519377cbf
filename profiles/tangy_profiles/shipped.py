"""The folder of the files that ship with Tangy: activities, robots, rooms, people and faults."""

from __future__ import annotations

from pathlib import Path

SHIPPED = Path(__file__).parent
"""Without `importlib.resources`, whose import takes 2% of the start-up time."""
