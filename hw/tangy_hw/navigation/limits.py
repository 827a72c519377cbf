"""How a base may drive, whoever drives it."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from tangy_hw.device_protocols import STILL, Twist


@dataclass(frozen=True)
class MotionLimits:
    """How a base may drive: m/s, rad/s, m/s^2, rad/s^2, and metres.

    `radius` is the robot's own, `gap` what it always keeps free ahead. A laser sees legs: `torso`
    is how far a body reaches out over what is seen of it. Within `near` before a body it drives at
    no more than `careful`, and within `wary` of one, on any side, at no more than `gentle`.
    `unseen` is how fast it drives where its laser does not look, `turn_close` how fast it turns
    beside what is close.
    """

    speed: float = 0.5
    turn: float = 1.0
    gain: float = 0.5
    brake: float = 0.6
    spin_up: float = 2.0
    radius: float = 0.25
    gap: float = 0.12
    torso: float = 0.15
    near: float = 1.0
    careful: float = 0.15
    wary: float = 1.2
    gentle: float = 0.25
    unseen: float = 0.1
    turn_close: float = 0.4

    def clamped(self, twist: Twist) -> Twist:
        """Return a twist on the same arc that is no faster than it may be; no number is none.

        Whatever is not a finite number stands still.
        """
        forward, turn = twist
        if not (isfinite(forward) and isfinite(turn)):
            return STILL
        over = max(abs(forward) / self.speed, abs(turn) / self.turn)
        if over <= 1.0:
            return twist
        clamped = Twist(
            max(-self.speed, min(self.speed, forward / over)),
            max(-self.turn, min(self.turn, turn / over)),
        )
        return clamped if isfinite(over) else STILL
