"""HTML pages: building blocks of reports, and the report of a session."""
