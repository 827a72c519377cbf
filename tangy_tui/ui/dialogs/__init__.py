"""Dialogs: one question or one message over a screen."""
