"""How people understand the robot's speech in an activity declared by facts.

They know its sentences, and the rows of its items: a question identifies its row.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.model import Items
from tangy_profiles.declared.vocabulary import SLOT
from tangy_profiles.defaults import ASK_AGAIN
from tangy_profiles.person import Person
from tangy_profiles.room import SEAT
from tangy_sim.device_simulator.speech_reception import HeardLine, called, simplified


class _Sentence(NamedTuple):
    pattern: re.Pattern[str]
    columns: tuple[str, ...]
    """Columns of the items in it, in order, with repetitions."""
    letters: int
    """Number of letters outside slots."""
    behaviour: Behaviour
    strategy: str


class DeclaredReception:
    """Speech understanding of a group that plays such an activity."""

    def __init__(
        self, activity: DeclaredActivity, people: Sequence[Person], seat: str = SEAT
    ) -> None:
        self._items: Items = activity.declaration.items
        self._people = called(people, seat)
        names = "|".join(re.escape(one) for one in sorted(self._people, key=len, reverse=True))
        cells = {column: _cells(self._items, column) for column in self._items.columns}
        sentences = [
            _sentence(text, names, cells, activity.behaviours[name], strategy)
            for name, one in activity.declaration.behaviours.items()
            for strategy, texts in one.says.items()
            for text in texts
        ]
        self._again = [
            re.compile(
                re.escape(simplified(text)).replace(re.escape("{name}"), f"(?P<name>{names})")
            )
            for text in ASK_AGAIN
        ]
        self._hints = [
            _sentence(text, names, cells, activity.behaviours[name], "")
            for name, one in activity.declaration.behaviours.items()
            for text in one.again
        ]
        self._sentences = sorted(sentences, key=lambda one: -one.letters)

    def hear(self, text: str) -> HeardLine | None:
        """Parse a sentence; return None if it is unknown."""
        plain = simplified(text)
        for one in self._sentences:
            found = one.pattern.fullmatch(plain)
            if found is None:
                continue
            rows = self._rows(one.columns, found.groupdict())
            if one.columns and not rows:
                continue
            person, turn = (
                self._people.get(found.groupdict().get(slot) or "", "") for slot in ("name", "turn")
            )
            return HeardLine(one.behaviour, one.strategy, person, rows=tuple(rows), turn=turn)
        asked = next((found for one in self._again if (found := one.fullmatch(plain))), None)
        asked = asked or next(
            (found for one in self._hints if (found := one.pattern.fullmatch(plain))), None
        )
        if asked is None:
            return None
        return HeardLine(
            person=self._people.get(asked.groupdict().get("name") or "", ""), again=True
        )

    def _rows(self, columns: tuple[str, ...], said: Mapping[str, str]) -> list[int]:
        """Return the rows of the items whose columns match the spoken texts."""
        return [
            row
            for row in range(len(self._items.rows) if columns else 0)
            if all(
                simplified(self._items.value(row, column).split("|")[0]) == said[f"s{place}"]
                for place, column in enumerate(columns)
            )
        ]


def _cells(items: Items, column: str) -> str:
    """Return a pattern of the texts of a column, the longest first."""
    said = {simplified(items.value(row, column).split("|")[0]) for row in range(len(items.rows))}
    return "|".join(re.escape(one) for one in sorted(said, key=len, reverse=True) if one)


def _sentence(
    text: str, names: str, cells: Mapping[str, str], behaviour: Behaviour, strategy: str
) -> _Sentence:
    pattern, used, letters, begin, named = "", list[str](), 0, 0, set[str]()
    plain = simplified(text)
    for slot in SLOT.finditer(plain):
        between = plain[begin : slot.start()]
        pattern += re.escape(between)
        letters, begin = letters + len(between), slot.end()
        name = next((one for one in cells if one.casefold() == slot[1]), "")
        if slot[1] in ("name", "turn"):
            pattern += f"(?P={slot[1]})" if slot[1] in named else f"(?P<{slot[1]}>{names})"
            named.add(slot[1])
        elif name:
            pattern += f"(?P<s{len(used)}>{cells[name]})"
            used.append(name)
        else:
            pattern += ".+?"
    pattern += re.escape(plain[begin:])
    return _Sentence(
        re.compile(pattern), tuple(used), letters + len(plain) - begin, behaviour, strategy
    )
