"""What the robot process is told before it begins: which robot, where, for whom, and by what."""

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
    """The beginning of the talk with the robot process, as JSON.

    Names of profiles are as `load_robot` and the like take them. `drivers` (device -> settings
    with their kind) and `cameras` (device -> source) go before those of the robot's profile.
    `requests` is a source of requests (see `perception.requests.sources`), `corners` the table's
    in its picture. `faces` are rows of features by person, of the kind `face_kind`. `pairing` is
    what tablets are known by (see `drivers.chest_pairing`); without one they pair anew.
    `courtesies` are what it says to those for whom it stands on its way (see `Courtesies`).
    `record` is a file for the scans of a drive by hand; without a map, the pose is the wheels'.
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

    def to_json(self) -> str:
        """Write it as a line."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, line: str | bytes) -> RobotSetup:
        """Read what `to_json` wrote.

        Raises:
            TangyError: it is no setup.
        """
        try:
            body: dict[str, Any] = json.loads(line)
            body["people"] = tuple(body["people"])
            body["corners"] = tuple((float(x), float(y)) for x, y in body.get("corners", ()))
            start = body.get("start")
            body["start"] = None if start is None else tuple(map(float, start))
            return cls(**body)
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            raise TangyError("The robot process was not told what robot it is.") from None
