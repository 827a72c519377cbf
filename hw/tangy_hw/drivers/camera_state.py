"""Derives the state of a camera from the measures and times of its frames."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from tangy_hw.drivers.camera_look import Look
from tangy_hw.rate_estimator import RateEstimator
from tangy_profiles.health import OK as WELL
from tangy_profiles.health import STALE, WARN, DeviceState, Fact, Reading

State = Literal[
    "OPENING", "OK", "DISCONNECTED", "FROZEN", "COVERED", "DARK", "BLURRED", "ENDED"
]  # fmt: skip
LONGEST = 3600.0  # s: maximum of this fact in robot profiles


@dataclass(frozen=True, slots=True)
class CameraLimits:
    """Thresholds of the camera states; times in s, measures as in `camera_look`.

    A flat image without sharp edges shows nothing: the lens is covered, by something dark or by a
    napkin. `dark`, `flat` and `frozen` are also thresholds of the fault rules; `blurred` was set by
    `tests/bench/cameras.py`. `clearly` is the hysteresis: the factor by which a measure must exceed
    its threshold to end the state.
    """

    gone: float = 1.5
    frozen: float = 1.0
    dark: float = 0.08
    flat: float = 0.03
    blurred: float = 0.19
    clearly: float = 1.15
    dark_for: float = 0.6
    blurred_for: float = 1.2
    well_for: float = 0.3


USUAL = CameraLimits()


@dataclass(frozen=True, slots=True)
class Sight:
    """State of a camera and the evidence for it; `why` is a sentence, "" in state OK.

    `age` is that of the newest frame and `unchanged` the time since its content first arrived, in
    s; `seconds` is the duration of the state. The measures are None before the first frame. `rate`
    is the frame rate per second, None if unknown.
    """

    state: State
    why: str
    seconds: float
    age: float
    unchanged: float
    brightness: float | None
    contrast: float | None
    sharpness: float | None
    rate: float | None = None

    def evidence(self) -> dict[str, float | None]:
        """Return the evidence (s, and ratios of full brightness), rounded for recordings."""
        found = {
            "age": self.age,
            "unchanged": self.unchanged,
            "brightness": self.brightness,
            "contrast": self.contrast,
            "sharpness": self.sharpness,
        }
        return {key: None if one is None else round(one, 3) for key, one in found.items()}

    def reading(self, device: str) -> Reading:
        """Return the camera's reading for the diagnosis."""
        facts: dict[str, Fact] = {}
        if self.brightness is not None and self.contrast is not None:
            facts["brightness"] = self.brightness
            facts["contrast"] = self.contrast
            facts["unchanged"] = min(self.unchanged, LONGEST)
        said: DeviceState = STALE if self.state in ("OPENING", "DISCONNECTED", "ENDED") else WARN
        state: DeviceState = WELL if self.state == "OK" else said
        return Reading(device, self.age, state, MappingProxyType(facts), self.rate)


class CameraWatch:
    """Collects observations of a camera, and derives its state at any time."""

    def __init__(
        self, now: float, limits: CameraLimits = USUAL, *, each: bool = False, interval: float = 0.0
    ) -> None:
        """Start to watch.

        Args:
            now: monotonic time in s, as all times here.
            limits: thresholds of the states.
            each: frames come on request: only their content counts, frame by frame.
            interval: time between two frames in s, if known.
        """
        self._limits = limits
        self._each = each
        self._gone = max(limits.gone, 2.5 * interval)
        self._began = now
        self._look: Look | None = None
        self._arrivals = RateEstimator()
        self._first_alike = now
        self._picture: State = "OK"  # state by the frames alone
        self._other_since: float | None = None  # since when they have indicated another state
        self._lost = ""
        self._over: str | None = None
        self._shown: State = "OPENING"
        self._since = now

    @property
    def over(self) -> bool:
        """Whether the stream has ended."""
        return self._over is not None

    def saw(self, look: Look) -> None:
        """Update with the measures of a frame."""
        last = self._look
        # Not every frame is measured, but every frame has a number.
        self._arrivals.count(look.stamp, 1 if last is None else max(1, look.seq - last.seq))
        other = last is None or last.fingerprint != look.fingerprint or self._each
        if other or self._lost or (last is not None and look.stamp - last.stamp > self._gone):
            self._first_alike = look.stamp  # not frozen while it was away
        self._look, self._lost = look, ""
        found = self._judge(look)
        if found == self._picture:
            self._other_since = None
            return
        if self._other_since is None or last is None:
            self._other_since = look.stamp
        if look.stamp - self._other_since >= self._hold(found):
            self._picture = found
            self._other_since = None

    def lost(self, why: str) -> None:
        """Record that the camera cannot be read, and why, in a few words."""
        self._lost = why

    def ended(self, why: str) -> None:
        """Record that the stream has ended for good, and why."""
        self._over = why

    def at(self, now: float) -> Sight:
        """Return the state at a time in s."""
        look = self._look
        age = now - (look.stamp if look is not None else self._began)
        unchanged = 0.0 if look is None else look.stamp - self._first_alike
        state, why = self._state(age, unchanged)
        if state != self._shown:
            self._shown, self._since = state, now
        return Sight(
            state,
            why,
            now - self._since,
            max(0.0, age),
            unchanged,
            look and look.brightness,
            look and look.contrast,
            look and look.sharpness,
            None if self._each else self._arrivals.rate(now),
        )

    def _hold(self, found: State) -> float:
        """Return for how many s frames must indicate a state before it is accepted."""
        if self._each:
            return 0.0
        if found == "OK":
            return self._limits.well_for
        return self._limits.blurred_for if found == "BLURRED" else self._limits.dark_for

    def _judge(self, look: Look) -> State:
        """Judge one frame, with hysteresis towards the previous state."""
        limits, was = self._limits, self._picture
        blurred = limits.blurred * (limits.clearly if was == "BLURRED" else 1.0)
        flat = limits.flat * (limits.clearly if was == "COVERED" else 1.0)
        dark = limits.dark * (limits.clearly if was == "DARK" else 1.0)
        unsharp = look.sharpness is None or look.sharpness < blurred
        if look.contrast < flat and unsharp:
            return "COVERED"
        if look.brightness < dark:
            return "DARK"
        return "BLURRED" if unsharp and look.sharpness is not None else "OK"

    def _state(self, age: float, unchanged: float) -> tuple[State, str]:
        if self._over is not None:
            return "ENDED", self._over
        if not self._each and age > self._gone:
            return "DISCONNECTED", f"No picture has come: {self._lost or 'it sends none'}."
        look = self._look
        if look is None:
            return "OPENING", "There was no picture yet."
        if self._picture == "COVERED":
            return "COVERED", "Nothing can be seen in the picture: does something cover the lens?"
        if unchanged >= self._limits.frozen:
            return "FROZEN", "The very same picture comes again and again."
        if self._picture == "DARK":
            return "DARK", "The picture is too dark: is there light in the room?"
        if self._picture == "BLURRED":
            return "BLURRED", "Nothing in the picture is sharp: is the lens clean, and in focus?"
        return "OK", ""
