"""The bench: one simulated room with a robot's devices and people, served over real wires.

Drivers of the hardware floor talk to it as to the devices themselves, so that they are exercised
and not bypassed. `world.py` is the room, `serving.py` its wires, `__main__.py` the process.
"""
