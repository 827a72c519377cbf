"""The real robot: cameras, laser, base, arms, screen and voice."""

import logging

logging.getLogger(__name__).addHandler(logging.NullHandler())  # otherwise it would go to stderr
