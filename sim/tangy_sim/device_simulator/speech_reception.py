"""How people understand the robot's speech: the behaviour, its strategy, and its person.

They know the activity's sentences for each behaviour and persuasive strategy, and those with which
the robot asks for help after a fault. They do not react to anything else.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from string import Formatter

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.fault_file import load_faults
from tangy_profiles.person import Person
from tangy_profiles.robot import Robot
from tangy_profiles.room import SEAT
from tangy_sim.worlds.users import SimulatedUser

BEGINS, EACH = 1.0, 0.06  # s before the first word, and per letter


@dataclass(frozen=True)
class HeardLine:
    """A sentence that was understood.

    For a behaviour: its `strategy`, the person (an id, "" if none is named), and the numbers. For a
    request for help: the code of the `fault`, and the person it concerns.
    """

    behaviour: Behaviour | None = None
    strategy: str = ""
    person: str = ""
    numbers: tuple[int, ...] = ()
    fault: str = ""
    more: bool = False
    """Whether the screen shows more numbers than were said."""
    rows: tuple[int, ...] = ()
    """Possible rows of an activity's items."""
    turn: str = ""
    """The person whose turn it is now, if the sentence names them."""
    again: bool = False
    """Whether the person is asked to repeat their answer."""

    def cells(self, player: SimulatedUser) -> int:
        """Return a mask of the cells concerned; people read further numbers on the screen."""
        if self.more:
            return player.marked ^ player.called
        return sum(1 << player.cell[n] for n in self.numbers if n in player.cell)


@dataclass(frozen=True)
class _Pattern:
    pattern: re.Pattern[str]
    behaviour: Behaviour | None
    strategy: str
    fault: str


class SpeechReception:
    """Speech understanding of a group that plays an activity."""

    def __init__(
        self, activity: Activity, robot: Robot, people: Sequence[Person], seat: str = SEAT
    ) -> None:
        self._people = called(people, seat)
        deck = activity.deck
        self._numbers = {simplified(deck.label(number)): number for number in deck.numbers}
        label = "|".join(re.escape(one) for one in sorted(self._numbers, key=len, reverse=True))
        names = "|".join(re.escape(one) for one in sorted(self._people, key=len, reverse=True))
        more = _pattern(activity.rules.more_numbers, {"numbers": "", "count": r"(?P<more>\d+)"})
        slots = {
            "name": f"(?P<name>{names})",
            "call": f"(?P<call>{label})",
            "numbers": f"(?P<numbers>(?:{label})(?:, (?:{label}))*)(?:{more.pattern})?",
            "object": re.escape(simplified(activity.object)),
            "why": ".*",
        }
        self._patterns: list[_Pattern] = []
        for behaviour in activity.behaviours.values():
            for strategy, text in behaviour.speech.items():
                self._patterns.append(_Pattern(_pattern(text, slots), behaviour, strategy, ""))
        for rule in load_faults(robot).rules:
            for text in filter(None, (rule.aloud, rule.aloud_again)):
                self._patterns.append(_Pattern(_pattern(text, slots), None, "", rule.code))

    def hear(self, text: str) -> HeardLine | None:
        """Parse a sentence; return None if it is unknown."""
        plain = simplified(text)
        for one in self._patterns:
            found = one.pattern.fullmatch(plain)
            if found is None:
                continue
            groups = found.groupdict()
            said = groups.get("numbers") or groups.get("call") or ""
            return HeardLine(
                one.behaviour,
                one.strategy,
                self._people.get(groups.get("name") or "", ""),
                tuple(self._numbers[label] for label in said.split(", ") if label),
                one.fault,
                bool(groups.get("more")),
            )
        return None


def called(people: Sequence[Person], seat: str) -> dict[str, str]:
    """Return people's ids by their names and seats, as on screens."""
    seats = {f"{simplified(seat)} {number}": one.id for number, one in enumerate(people, 1)}
    return seats | {simplified(one.name): one.id for one in reversed(people)}


def speaking_seconds(text: str) -> float:
    """Return how many s the robot takes to speak a text."""
    return BEGINS + EACH * len(text)


def simplified(text: str) -> str:
    """Return a text in small letters with single spaces."""
    return " ".join(text.casefold().split())


def _pattern(template: str, slots: dict[str, str]) -> re.Pattern[str]:
    """Compile the pattern of a sentence with slots; repeated slots must have equal text."""
    parts: list[str] = []
    known: set[str] = set()
    for words, slot, _, _ in Formatter().parse(simplified(template)):
        parts.append(re.escape(words))
        if slot is None:
            continue
        parts.append(f"(?P={slot})" if slot in known and slots[slot][:3] == "(?P" else slots[slot])
        known.add(slot)
    return re.compile("".join(parts))
