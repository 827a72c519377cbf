"""Dialogs: modal screens with one question or one message."""
