"""The robot's state, from a heartbeat of the robot process."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tangy_hw.device_protocols import Pose
from tangy_profiles.health import ERROR, Health, Reading, device_state

NOWHERE = Pose(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class RobotState:
    """Latest state of the robot; `time` is its own, in s, and so is `since` of a request.

    `asks` are (seat, since), `shows` the answer signs: (seat, letter, since, probability);
    `hazard` is why it stands still, `stopped` why it was stopped, and `failed` a failure of its
    control that only a new robot process fixes. `frozen` is for how many s its control was
    frozen, until staff acknowledge it; `held` is the result of the last manual command: ""
    executed, "slow", "stands" or "overridden". `waits` names the late data that it waits for;
    `pauses` is the number of such waits, and their total s. `yields_to` says for what it
    waits: a person "walking" past or "standing" in the way, or probably an "object". `answered`
    are the keys of calls answered at the chest screen.
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
    shows: tuple[tuple[int, str, float, float], ...] = ()
    hazard: str = ""
    stopped: str = ""
    failed: str = ""
    frozen: float = 0.0
    held: str = ""
    waits: str = ""
    pauses: tuple[int, float] = (0, 0.0)
    yields_to: str = ""
    answered: tuple[str, ...] = ()

    @classmethod
    def from_json(cls, body: dict[str, Any]) -> RobotState:
        """Read a heartbeat of the robot process."""
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
            tuple((int(seat), str(letter), *more) for seat, letter, *more in body["shows"]),
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
    """Return a reading; an unknown state counts as an error."""
    return Reading(device, age, device_state(state) or ERROR, *more)
