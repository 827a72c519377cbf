"""Pictures that are drawn: cards as a camera sees them, and faces."""
