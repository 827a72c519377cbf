"""Tangy's data: activities, robots, rooms and people, and the log of events."""

import logging

logging.getLogger(__name__).addHandler(logging.NullHandler())  # else warnings go to stderr
