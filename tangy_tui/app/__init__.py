"""The application without a screen: wires profiles, store, worlds and robots together for games."""
