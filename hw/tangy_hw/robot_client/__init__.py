"""The program's side of the robot: starts the robot process, sends it requests, and is its world.

It loads no numpy, so that screens start quickly.
"""
