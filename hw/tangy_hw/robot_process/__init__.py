"""The robot process: it owns the devices, drives, speaks, shows, and stops by itself.

`tangy_hw.robot_client` starts it, and exchanges JSON lines with it over its pipes.
"""
