"""Turns values into sentences for people, the same on screens, in the console and in reports."""
