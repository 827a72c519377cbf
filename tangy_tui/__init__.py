"""Tangy: people teach a social robot a group activity, and let it run that activity for them."""

import logging

__version__ = "0.6.0"

logging.getLogger(__name__).addHandler(logging.NullHandler())  # or it would go to stderr
