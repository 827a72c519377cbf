"""The real world: cameras, laser, base, arms, screen and voice of a robot."""

import logging

logging.getLogger(__name__).addHandler(logging.NullHandler())  # or it would go to stderr
