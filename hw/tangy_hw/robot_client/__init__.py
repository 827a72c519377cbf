"""The program's side of the robot: it starts the robot process, asks it, and is its world.

It loads no numpy, so that a screen need not wait for it.
"""
