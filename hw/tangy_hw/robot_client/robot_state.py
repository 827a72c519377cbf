"""How the robot is, as a beat of the robot process tells it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tangy_hw.device_protocols import Pose
from tangy_profiles.health import ERROR, Health, Reading, device_state

NOWHERE = Pose(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class RobotState:
    """What the robot said of itself last; `time` is its own, in s, and so is `since` of a request.

    `asks` are (seat, since); `hazard` says why it stands still, `stopped` who stopped it, and
    `failed` what has failed of its control, for which only another robot process helps. `frozen` is
    for how many s its control stood still, until staff have seen to that; `held` is what it does
    about who drives it by hand: "" as told, "slow", or "stands". `waits` says which data is late,
    while it stands for that; `pauses` is how often it has, and for how many s. `lets` is for whom
    it stands on its way: "walking" for somebody who passes, "standing" for somebody in the way.
    `answered` are the keys of the calls that were answered at the chest screen.
    """

    number: int = 0
    time: float = 0.0
    health: Health = ()
    pose: Pose = NOWHERE
    going: str = ""
    path: tuple[tuple[float, float], ...] = ()
    particles: tuple[tuple[float, float], ...] = ()
    obstacles: tuple[tuple[float, float], ...] = ()
    asks: tuple[tuple[int, float], ...] = ()
    hazard: str = ""
    stopped: str = ""
    failed: str = ""
    frozen: float = 0.0
    held: str = ""
    waits: str = ""
    pauses: tuple[int, float] = (0, 0.0)
    lets: str = ""
    answered: tuple[str, ...] = ()

    @classmethod
    def from_json(cls, body: dict[str, Any]) -> RobotState:
        """Read what a beat of the robot process tells."""
        return cls(
            body["number"],
            body["time"],
            tuple(_reading(*told) for told in body["health"]),
            Pose(*body["pose"]),
            body["going"],
            tuple((x, y) for x, y in body["path"]),
            tuple((x, y) for x, y in body["particles"]),
            tuple((x, y) for x, y in body["obstacles"]),
            tuple((int(seat), since) for seat, since in body["asks"]),
            body["hazard"],
            body["stopped"],
            body["failed"],
            body["frozen"],
            body["held"],
            body["waits"],
            (body["pauses"][0], body["pauses"][1]),
            body["lets"],
            tuple(map(str, body["answered"])),
        )


def _reading(device: str, age: float, state: str, *more: Any) -> Reading:
    """Return a reading as it was told; of a state that there is not nothing good is known."""
    return Reading(device, age, device_state(state) or ERROR, *more)
