"""The bench: a simulated room whose robot devices speak the real protocols.

Drivers in `tangy_hw` talk to it as to real devices, so they are tested rather than bypassed.
`world.py` is the room, `device_servers.py` serves the protocols, and `__main__.py` is the process.
"""
