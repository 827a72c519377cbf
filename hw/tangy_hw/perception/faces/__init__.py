"""Detects and identifies faces, with people's consent, and deletes their data on request."""
