"""What Tangy knows: activities, robots, rooms and people, and the store of what happened."""
