"""Simulation: people with cards, their requests and responses, and a robot among them."""

import logging

logging.getLogger(__name__).addHandler(logging.NullHandler())  # otherwise it would go to stderr
