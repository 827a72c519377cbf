"""Games with real devices: what opens the robot or its bench, and what is made of it."""
