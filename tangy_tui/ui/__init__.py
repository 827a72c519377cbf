"""The user interface: everything that depends on Textual."""
