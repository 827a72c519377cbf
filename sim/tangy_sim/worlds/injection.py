"""Kinds of faults that can be injected into the simulated world, and their text form."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_sim.worlds.devices import READINGS, Symptom, dead, lasting, otherwise, silent

AT_ONCE = "at once"
DRIVING = "driving"
LOOKING = "looking"
ASKING = "asking"
CLOSING = "closing"
MOVING_ON = "moving on"
WAITING = "waiting"


@dataclass(frozen=True)
class FaultKind:
    """A kind of fault: what happens in the room, and when it can show.

    `shows`: at once, in a device's readings; or only while the robot is driving, looking at a card,
    asking a person for something, closing a request, moving the activity on, or while another
    person is waiting. `code` is the correct diagnosis.
    """

    name: str
    words: str
    code: str
    shows: str
    symptom: Symptom | None = None
    holds: bool = False
    """Whether it prevents driving."""
    blinds: bool = False
    """Whether it prevents seeing cards."""
    helped: bool = False
    """Whether people at the table can fix it."""
    stops: bool = False
    """Whether the robot stops by itself at once, in the middle of an action."""


_KINDS = (
    FaultKind("emergency-stop", "somebody presses the emergency stop", "emergency-stop", AT_ONCE,
         otherwise("stop_button", latched=True), holds=True, stops=True),
    FaultKind("link-lost", "nothing is heard from the robot", "link-lost", AT_ONCE,
         silent(*READINGS), holds=True, blinds=True, stops=True),
    FaultKind("laser-disconnected", "the laser scanner's cable comes off", "laser-disconnected",
         AT_ONCE, silent("laser"), holds=True, stops=True),
    FaultKind("laser-occluded", "a coat hangs over the laser scanner", "laser-occluded", AT_ONCE,
         otherwise("laser", near_share=0.85), holds=True, helped=True),
    FaultKind("camera-disconnected", "the head camera's cable comes off", "camera-disconnected",
         AT_ONCE, silent("camera"), blinds=True, stops=True),
    FaultKind("camera-occluded", "a scarf hangs over the head camera", "camera-occluded", AT_ONCE,
         otherwise("camera", brightness=0.03, contrast=0.01), blinds=True, helped=True),
    FaultKind("camera-frozen", "the head camera sends one picture for ever", "camera-frozen",
         AT_ONCE, lasting("camera", "unchanged"), blinds=True, stops=True),
    FaultKind("base-failed", "the wheels report nothing", "base-failed", AT_ONCE, silent("base"),
         holds=True, stops=True),
    FaultKind("stop-button-silent", "nothing is heard from the emergency stop",
         "stop-button-silent", AT_ONCE, silent("stop_button"), stops=True),
    FaultKind("navigation-failed", "the navigation program ends", "navigation-failed", AT_ONCE,
         dead("navigator"), holds=True, stops=True),
    FaultKind("base-stuck", "something is caught between the wheels", "base-stuck", DRIVING,
         otherwise("base", still=4.0), holds=True),
    FaultKind("wheels-slip", "a rug slides under the wheels", "wheels-slip", DRIVING,
         otherwise("base", slip=0.9), holds=True),
    FaultKind("path-blocked", "chairs block every way", "path-blocked", DRIVING,
         otherwise("navigator", path="none"), holds=True, helped=True),
    FaultKind("path-detour", "a chair stands in the shortest way", "path-detour", DRIVING,
         otherwise("navigator", path="replanned")),
    FaultKind("carried-off", "somebody pushes the robot elsewhere", "carried-off", AT_ONCE,
         otherwise("localisation", fit=0.55, spread=1.6), holds=True),
    FaultKind("card-out-of-sight", "a card is where the camera cannot see it", "card-out-of-sight",
         LOOKING, helped=True),
    FaultKind("requests-silent", "the request sensor sends nothing", "requests-silent", AT_ONCE,
         silent("requests")),
    FaultKind("request-stuck", "a sign stays up after its owner was helped", "request-stuck",
         CLOSING, helped=True),
    FaultKind("request-withdrawn", "somebody who waited asks no more", "request-withdrawn",
         WAITING),
    FaultKind("arm-failed", "a servo of an arm reports an error", "arm-failed", AT_ONCE,
         otherwise("arms", hardware_error=True)),
    FaultKind("voice-dead", "the voice ends", "voice-dead", AT_ONCE, dead("voice")),
    FaultKind("screen-dead", "the chest screen goes dark", "screen-dead", AT_ONCE, dead("screen")),
    FaultKind("never-complies", "a person says no to every request", "never-complies", ASKING),
    FaultKind("no-effect", "a behaviour comes to nothing, and no sensor says why", "unexplained",
         MOVING_ON),
)  # fmt: skip
KINDS: Mapping[str, FaultKind] = MappingProxyType({kind.name: kind for kind in _KINDS})
"""All kinds of faults, by name."""


def silencing(code: str, present: Iterable[str]) -> list[str]:
    """Return the present kinds that silence the device in which a diagnosis shows.

    An expert who repairs that device finds them, too. A lost link shows in every device; to
    restore it repairs none of them.
    """
    shows = {d for one in _KINDS if one.code == code and one.symptom for d in one.symptom(0.0)}
    if len(shows) != 1:
        return []
    silent = {kind.name: kind.symptom(0.0) for kind in _KINDS if kind.symptom is not None}
    return [
        name
        for name in present
        if (told := silent.get(name, {})).keys() <= shows
        and any(age is not None for age, _, _ in told.values())
    ]


IN_RECOVERY = "recovery"
"""Text form of "during the recovery from another fault"."""


@dataclass(frozen=True)
class Injection:
    """A pending fault: at a step of each game, at random in every step, or in recovery.

    Without any of these it starts as soon as it can show.
    """

    kind: FaultKind
    step: int | None = None
    chance: float | None = None
    in_recovery: bool = False

    def __str__(self) -> str:
        if self.in_recovery:
            return f"{self.kind.name}@{IN_RECOVERY}"
        if self.step is not None:
            return f"{self.kind.name}@{self.step}"
        return self.kind.name if self.chance is None else f"{self.kind.name}~{self.chance:g}"


def read_injection(text: str) -> Injection:
    """Parse `KIND`, `KIND@step`, `KIND~probability` or `KIND@recovery`.

    Raises:
        TangyError: the problem in one sentence, and the nearest kind.
    """
    for sign in "@~":
        name, found, when = text.partition(sign)
        if found:
            break
    name = name.strip().casefold()
    kind = KINDS.get(name)
    if kind is None:
        like = [other for other in KINDS if name and name in other]
        meant = f"choose one of: {', '.join(like)}." if like[1:] else nearest(name, like or KINDS)
        raise TangyError(plain(f"There is no fault {name!r}: {meant}"))
    when = when.strip()
    if not found:
        return Injection(kind)
    if sign == "@" and when == IN_RECOVERY:
        return Injection(kind, in_recovery=True)
    if sign == "@":
        if when.isascii() and when.isdecimal() and 1 <= int(when[:7]) <= 1_000_000:
            return Injection(kind, step=int(when))
        raise TangyError(
            plain(f"{text!r}: after @ comes a step from 1 on, or the word {IN_RECOVERY!r}.")
        )
    try:
        chance = float(when)
    except ValueError:
        chance = -1.0
    if not 0 < chance <= 1:
        raise TangyError(plain(f"{text!r}: after ~ comes a probability above 0 and up to 1."))
    return Injection(kind, chance=chance)
