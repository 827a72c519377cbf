"""Maps, localisation, path planning and driving."""
