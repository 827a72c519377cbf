"""The robot process: it holds the devices, drives, speaks, shows, and stops by itself.

It is started by `tangy_hw.robot_client`, which speaks to it by JSON lines over its pipes.
"""
