"""Tangy: people teach a social robot a group activity, and let it run that activity for them."""

__version__ = "0.6.0"
