"""The robot process: it owns the devices, drives, speaks, shows, and stops on its own.

It is started by `tangy_hw.robot_client`, which speaks to it by JSON lines over its pipes.
"""
