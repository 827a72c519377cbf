"""The real world: cameras, laser, base, arms, screen and voice of a robot."""
