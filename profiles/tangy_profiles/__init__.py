"""What Tangy knows: activities, robots, rooms and people, and the store of what happened."""

import logging

logging.getLogger(__name__).addHandler(logging.NullHandler())  # or it would go to stderr
