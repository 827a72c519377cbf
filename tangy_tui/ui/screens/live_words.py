"""What the live screen says of the robot, in sentences."""

from __future__ import annotations

LOOKS_ROUND = "Tangy does not know where it stands: it turns on the spot, then drives to the front."
WAS_FROZEN = (
    "The program in the robot was frozen for {:.0f} s. Tangy has given up what it was doing, and "
    "stands until you let it go on."
)
MAY_MOVE = "Tangy may move again."
