"""Screens: each shows one part of the application, and handles its keys."""
