"""Speech identification (III-A-1): from sound to words, and from words to a behaviour."""
