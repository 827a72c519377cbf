"""Where the robot is and how it gets elsewhere: maps, localisation, planning and driving."""
