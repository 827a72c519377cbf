"""Pages for the web browser: what reports are made of, and the report of a session."""
