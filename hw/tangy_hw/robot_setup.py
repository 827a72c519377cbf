"""First message to the robot process: the robot, its room, the people, and the drivers."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from tangy_profiles.card_face import USUAL_SEED
from tangy_profiles.errors import TangyError

Setting = str | float | bool


@dataclass(frozen=True)
class RobotSetup:
    """The first message to the robot process, as JSON.

    Profiles are named as `load_robot` and similar functions take them. `drivers` (device ->
    settings with their kind) and `cameras` (device -> source) override the robot's profile.
    `requests` is a source of requests (see `perception.requests.sources`), `corners` are the
    table's in its image. `faces` are the features by person, of the profile's models. `pairing`
    identifies tablets (see `drivers.chest_pairing`); without it they must pair again. `courtesies`
    are sentences for people whom the robot waits for (see `WaitExplanations`). `record` is a file
    for the scans of a manual drive; without a map, the pose is by odometry. `without` are devices
    that are not switched on, whatever the profile names.
    """

    robot: str
    activity: str
    people: tuple[str, ...]
    room: str = "common-room"
    deck_seed: int = USUAL_SEED
    drivers: Mapping[str, Mapping[str, Setting]] = field(default_factory=dict)
    cameras: Mapping[str, str] = field(default_factory=dict)
    requests: str = ""
    corners: tuple[tuple[float, float], ...] = ()
    start: tuple[float, float, float] | None = None
    stepped: bool = False
    seed: int = 1
    faces: Mapping[str, list[list[float]]] = field(default_factory=dict)
    map: str = ""
    log: str = ""
    pairing: Mapping[str, str] = field(default_factory=dict)
    courtesies: Mapping[str, str] = field(default_factory=dict)
    record: str = ""
    without: tuple[str, ...] = ()

    def to_json(self) -> str:
        """Return it as a JSON line."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, line: str | bytes) -> RobotSetup:
        """Read the output of `to_json`.

        Raises:
            TangyError: the line is not a setup.
        """
        try:
            body: dict[str, Any] = json.loads(line)
            body["people"] = tuple(body["people"])
            body["without"] = tuple(body.get("without", ()))
            body["corners"] = tuple((float(x), float(y)) for x, y in body.get("corners", ()))
            start = body.get("start")
            body["start"] = None if start is None else tuple(map(float, start))
            return cls(**body)
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            raise TangyError("The robot process was not told what robot it is.") from None
