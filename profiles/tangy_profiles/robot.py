"""A robot, read from TOML: joints with their limits, postures theta, speed, devices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from tangy_profiles.body import BodyProfile, read_body
from tangy_profiles.contacts import EXPERT, STAFF_ROLE, read_contact
from tangy_profiles.contacts import Contact as Contact
from tangy_profiles.defaults import SHIPPED, USUAL_ROBOT
from tangy_profiles.errors import ProfileError
from tangy_profiles.liveness import PAUSING, Liveness, read_liveness
from tangy_profiles.reading import Table, nearest, plain, read_toml

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity

LOOKS_AT = ("cards",)
"""Subjects of a camera that a profile can name."""


LINK = "link"
"""The device that stands for the connection between the program and the robot."""

FROZEN = "frozen"
"""The fact of the link for how many s the robot's program was frozen."""

PAUSES, LOST = "pauses", "lost"
"""The facts of the link about pauses: how often they occur, and the share of time lost."""

LINK_STALE_SECONDS = 0.25
LONGEST_SECONDS = 1e6

GAZES = ("card", "face")
"""Targets of the robot's gaze."""


OPTIONAL = ("body", "drivers", "expert", "faces", "gaze", "limbs", "liveness", "postures", "staff")
"""The tables that a robot's file may have."""


@dataclass(frozen=True)
class Limb:
    """A chain of joints that is posed together: joint names and limits in degrees."""

    name: str
    joints: tuple[str, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]


@dataclass(frozen=True)
class Measure:
    """A quantity that a device measures: its description for staff, and its values.

    They are words, a range of numbers, or else true and false.
    """

    says: str
    words: tuple[str, ...] = ()
    low: float | None = None
    high: float | None = None

    def wrong(self, value: str | float | bool) -> str:
        """Return why a value is invalid; "" if it is valid."""
        if self.words:
            return (
                ""
                if value in self.words
                else f"is none of its words; {nearest(str(value), self.words)}"
            )
        if self.low is None or self.high is None:
            return "" if isinstance(value, bool) else "must be true or false."
        if isinstance(value, str | bool) or not self.low <= value <= self.high:
            return f"must be a number from {self.low:g} to {self.high:g}."
        return ""


@dataclass(frozen=True)
class DeviceProfile:
    """A device of the robot: its data is stale after this many s; `facts` are its measurements.

    Data older than `fault_after` s is a fault; younger stale data makes the robot pause. Each fact
    has a description for staff and its possible values. `source` is the source of a camera's
    pictures: 0 or /dev/video0, http://..., rtsp://..., or a file or folder, which may be relative
    to the robot's file; "" if it is given elsewhere or this is no camera. `looks_at` is the subject
    of the pictures, one of `LOOKS_AT` or "".
    """

    name: str
    label: str
    stale_after: float
    facts: Mapping[str, Measure]
    source: str = ""
    looks_at: str = ""
    fault_after: float = 0.0

    @property
    def lost_after(self) -> float:
        """The age in s from which its data counts as lost."""
        return max(self.stale_after, self.fault_after)


@dataclass(frozen=True)
class Driver:
    """The driver of a device: its `kind`, and its own settings."""

    kind: str
    settings: Mapping[str, str | float | bool]


@dataclass(frozen=True)
class FaceModels:
    """The two ONNX files that detect and recognise faces, if a facility has its own."""

    finder: Path
    recogniser: Path


@dataclass(frozen=True, slots=True)
class MissingPosture:
    """A behaviour whose posture a robot, by its title, does not have; `near` names the nearest."""

    behaviour: str
    posture: str
    robot: str
    near: str

    def __str__(self) -> str:
        """Tell it, as in the messages about a file."""
        return (
            f"behaviours[{self.behaviour}].posture = {self.posture!r}: "
            f"{self.robot} has no such posture; {self.near}"
        )


@dataclass(frozen=True)
class Robot:
    """A robot's body: limbs, postures (joint angles in degrees by limb), speed in m/s, devices.

    `faces` are its face models; without them it uses those of OpenCV. `drivers` are the drivers of
    the real robot, by device name. `gaze` is the pose (angles in degrees by limb) to look at a
    `card` and at a `face`. `file` is the path of the profile. `expert` and `staff` are the contacts
    for faults that staff cannot fix, and for a halted robot. `liveness` limits late data, and
    `body` has size, dynamics and mountings. `undriven` are the devices of its file without a
    driver.
    """

    name: str
    title: str
    speed: float
    limbs: Mapping[str, Limb]
    postures: Mapping[str, Mapping[str, tuple[float, ...]]]
    devices: Mapping[str, DeviceProfile]
    faces: FaceModels | None = None
    file: Path = Path()
    drivers: Mapping[str, Driver] = field(default_factory=dict)
    gaze: Mapping[str, Mapping[str, tuple[float, ...]]] = field(default_factory=dict)
    expert: Contact | None = None
    liveness: Liveness = field(default_factory=Liveness)
    staff: Contact | None = None
    body: BodyProfile = field(default_factory=BodyProfile)
    undriven: tuple[DeviceProfile, ...] = ()

    def missing_posture(self, activity: Activity) -> MissingPosture | None:
        """Return the first posture of an activity that the robot does not have; None: it has all.

        Without limbs it needs none.
        """
        for behaviour in activity.behaviours.values():
            if self.limbs and behaviour.posture not in self.postures:
                near = nearest(behaviour.posture, self.postures)
                return MissingPosture(behaviour.name, behaviour.posture, self.title, near)
        return None

    def check(self, activity: Activity) -> None:
        """Check that the robot has every posture of an activity.

        Raises:
            ProfileError: names the behaviour and the nearest posture.
        """
        if (missing := self.missing_posture(activity)) is not None:
            raise ProfileError(f"{activity.source}: {missing}")


def shipped_robots() -> dict[str, Path]:
    """Return the files of the built-in robots, by name."""
    folder = SHIPPED / "robots"
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_robot(name: str = USUAL_ROBOT) -> Robot:
    """Load a robot by name, or by the path of its TOML file.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid word.
    """
    shipped = shipped_robots()
    if name not in shipped and not name.endswith(".toml"):
        if Path(name).is_file():
            raise ProfileError(
                plain(f"{name} is not a robot: the name of a robot's file ends in .toml.")
            )
        raise ProfileError(f"There is no robot {name!r}: {nearest(name, shipped)}")
    path = shipped.get(name) or Path(name)
    return read_robot(read_toml(path), path)


def read_robot(top: Table, path: Path) -> Robot:
    """Read a robot's profile; relative paths in it are relative to its file.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid word.
    """
    limbs: dict[str, Limb] = {}
    for entry in top.tables("limbs", optional=True):
        name_of_limb = entry.text("name")
        joints = entry.words("joints")
        low = entry.numbers("low", len(joints), -360, 360)
        high = entry.numbers("high", len(joints), -360, 360)
        if any(a > b for a, b in zip(low, high, strict=True)):
            raise entry.wrong("low", "must not be above `high`.")
        limbs[name_of_limb] = Limb(name_of_limb, joints, low, high)
        entry.close()
    postures: dict[str, Mapping[str, tuple[float, ...]]] = {}
    for posture, entry in top.table("postures", optional=not limbs).items():
        angles: dict[str, tuple[float, ...]] = {}
        for limb in limbs.values():
            angles[limb.name] = entry.numbers(limb.name, len(limb.joints), -360, 360)
            for joint, angle, low_end, high_end in zip(
                limb.joints, angles[limb.name], limb.low, limb.high, strict=True
            ):
                if not low_end <= angle <= high_end:
                    raise entry.wrong(
                        limb.name, f"{joint} must be from {low_end:g} to {high_end:g} degrees."
                    )
        entry.close()
        postures[posture] = MappingProxyType(angles)
    liveness = read_liveness(top)
    devices = _devices(top, liveness)
    robot = Robot(
        top.text("name"),
        top.text("title"),
        top.number("speed", 0.05, 3, unit="m/s"),
        MappingProxyType(limbs),
        MappingProxyType(postures),
        MappingProxyType(devices),
        _face_models(top, path.parent),
        path,
        MappingProxyType(_drivers(top, devices)),
        MappingProxyType(_gaze(top, limbs)),
        read_contact(top, EXPERT),
        liveness,
        read_contact(top, STAFF_ROLE),
        read_body(top, (name for name in devices if "camera" in name)),
    )
    top.close(also=OPTIONAL)
    return robot


def _face_models(top: Table, folder: Path) -> FaceModels | None:
    """Read the paths of the face models, which may be relative to the robot's file."""
    if "faces" not in top:
        return None
    entry = top.table("faces")
    models = FaceModels(folder / entry.text("finder"), folder / entry.text("recogniser"))
    entry.close()
    return models


def _devices(top: Table, liveness: Liveness) -> dict[str, DeviceProfile]:
    devices: dict[str, DeviceProfile] = {}
    for entry in top.tables("devices"):
        name = entry.text("name")
        if name in devices:
            raise entry.wrong("name", "was used before: every device has its own.")
        facts = entry.table("facts", optional=True)
        stale_after = entry.number("stale_after", 0.05, 60, unit="s")
        devices[name] = DeviceProfile(
            name,
            entry.text("label"),
            stale_after,
            MappingProxyType({fact: _measure(facts, fact) for fact in facts}),
            entry.text("source", ""),
            entry.choice("looks_at", LOOKS_AT, ""),
            entry.number("fault_after", stale_after, 600, max(stale_after, liveness.fault_after)),
        )
        facts.close()
        entry.close()
    return _with_link(devices, liveness)


def _with_link(
    devices: Mapping[str, DeviceProfile], liveness: Liveness
) -> dict[str, DeviceProfile]:
    """Return the devices with the link, which every robot has even if its file omits it."""
    link = devices.get(LINK) or DeviceProfile(
        LINK, "link to the robot", LINK_STALE_SECONDS, {}, fault_after=liveness.fault_after
    )
    facts = {
        FROZEN: Measure(
            "seconds for which the robot's own program stood still", low=0.0, high=LONGEST_SECONDS
        ),
        PAUSES: Measure("how often the robot had to wait for data", PAUSING),
        LOST: Measure("share of the last minute spent waiting for data", low=0.0, high=1.0),
        **link.facts,
    }
    known = {LINK: replace(link, facts=MappingProxyType(facts))}
    return {**devices, **known} if LINK in devices else {**known, **devices}


def _drivers(top: Table, devices: Mapping[str, DeviceProfile]) -> dict[str, Driver]:
    """Read the drivers; their kinds and settings are checked by the drivers."""
    drivers: dict[str, Driver] = {}
    table = top.table("drivers", optional=True)
    for name, entry in table.items():
        if name not in devices:
            entry_for = f"add a [[devices]] entry named {name!r}"
            problem = f"is no device of this robot: {entry_for}; {nearest(name, devices)}"
            raise table.wrong(name, problem)
        settings = {key: entry.word_or_number(key) for key in entry if key != "kind"}
        drivers[name] = Driver(entry.text("kind"), MappingProxyType(settings))
    return drivers


def _gaze(top: Table, limbs: Mapping[str, Limb]) -> dict[str, Mapping[str, tuple[float, ...]]]:
    """Read the poses for looking at a card and at a face, if there are any."""
    gaze: dict[str, Mapping[str, tuple[float, ...]]] = {}
    table = top.table("gaze", optional=True)
    for name in GAZES:
        if name in table:
            entry = table.table(name)
            gaze[name] = MappingProxyType(
                {
                    limb: entry.numbers(limb, len(limbs[limb].joints), -360, 360)
                    for limb in entry
                    if limb in limbs
                }
            )
            entry.close(also=limbs)
    table.close(also=GAZES)
    return gaze


def _measure(facts: Table, name: str) -> Measure:
    entry = facts.table(name)
    says, words = entry.text("says"), entry.words("words", default=())
    low = entry.number("low", default=0) if "high" in entry else None
    high = entry.number("high") if "high" in entry else None
    entry.close(also=("low", "high"))
    return Measure(says, words, low, high)
