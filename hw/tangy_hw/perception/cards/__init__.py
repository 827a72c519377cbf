"""Printed cards: where they are, which they are, what is marked on them."""
