"""Asks staff for the state of cards, for a robot without a camera that reads them.

Nobody is asked to move a card that no camera looks at. The robot waits beside the person until
staff have answered.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from tangy_hw.robot_client.commands import Commands
from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.card_face import called_cells
from tangy_profiles.cards import judge
from tangy_profiles.state import Response

LOOK_SECONDS = 0.5  # between two checks for an answer
NEEDED = {"wrong marks": False, "missing marks": True}
"""By checker: states whose report needs numbers, and whether these must have been called."""


class ReportedCard(NamedTuple):
    """A card as reported by staff: its user activity state, and the numbers concerned."""

    state: str
    numbers: tuple[int, ...] = ()


class StaffCardReports:
    """Asks staff for the state of cards, and keeps the report on the card beside the robot."""

    def __init__(self, activity: Activity, commands: Commands) -> None:
        """Set the activity, and the robot's commands."""
        self.asks = ""
        """Person whose card staff are to report, "" if none."""
        self.answer: Callable[[str], ReportedCard | None] = lambda person: self._told
        """Returns staff's report on a person's card; None: not yet."""
        self.asked_last = ""
        """Person whose card staff were asked about last."""
        self.before: ReportedCard | None = None
        """Previous report on the same card, in this visit."""
        self.began = 0.0
        """Time of the question, in s of the robot's clock."""
        self._activity = activity
        self._commands = commands
        self._called: Sequence[int] = ()
        self._told: ReportedCard | None = None
        self._last: ReportedCard | None = None

    def ask(self, person: str, called: Sequence[int]) -> str:
        """Ask staff for the state of a person's card, and wait for the answer.

        Args:
            person: the person beside the robot.
            called: the called numbers.

        Raises:
            DeviceError: the wait was aborted.
        """
        again = self.asked_last == person
        self.before, self.began = self._last if again else None, self._commands.link.time
        self._told, self._last, self._called = None, None, tuple(called)
        self.asks = self.asked_last = person
        try:
            while (told := self.answer(person)) is None:
                self._commands.wait(LOOK_SECONDS)
        finally:
            self.asks = ""
        self._last = told
        return told.state

    def leave(self) -> None:
        """Forget the card beside the robot, which has left."""
        self.asked_last, self._last = "", None

    def tell(self, words: str) -> bool:
        """Process a report by staff on the requested card; return whether it is understood.

        Args:
            words: a state by its name or label; wrong or missing marks with their numbers, as in
                "wrong marks B7, O70".
        """
        told = read_told(self._activity, words, self._called) if self.asks else None
        if told is not None:
            self._told = told
        return told is not None

    @property
    def sayable(self) -> list[str]:
        """Possible answers, with an example for each state; empty if nothing is asked."""
        if not self.asks:
            return []
        deck, called = self._activity.deck, set(self._called)
        examples = []
        for state in self._activity.card_states:
            wanted = NEEDED.get(state.checker)
            number = next((n for n in deck.numbers if (n in called) is wanted), None)
            if wanted is None or number is not None:
                label = f" {deck.label(number)}" if wanted is not None and number else ""
                examples.append(f"{state.label}{label}")
        return examples

    @property
    def state(self) -> str | None:
        """Last reported state of the card beside the robot; None: no report."""
        return None if self._last is None else self._last.state

    def asked_about(self, behaviour: Behaviour) -> tuple[int, ...] | None:
        """Return the numbers that a behaviour asks about; None if staff reported none."""
        told, checker = self._last, _corrected(behaviour)
        if told is None or checker != self._checker(told.state):
            return None
        return told.numbers or None

    def response(self, action: Action, person: str, sitting: str) -> Response:
        """Ask staff for the outcome of a request; return it as the person's response.

        The time that staff take does not count against the person.

        Args:
            action: the request.
            person: the place beside the robot.
            sitting: the person who sits there.

        Raises:
            DeviceError: the wait was aborted.
        """
        checker = _corrected(action.behaviour)
        self.ask(person, self._called)
        before, now = self.before, self._last
        same = now is not None and self._checker(now.state) == checker
        left = set(now.numbers) if same and now is not None else set[int]()
        done = before is None or not left.intersection(before.numbers)
        return Response(sitting, action.strategy, done, done, self._commands.link.time - self.began)

    def _checker(self, state: str) -> str:
        return next(s.checker for s in self._activity.card_states if s.name == state)


def read_told(activity: Activity, words: str, called: Sequence[int]) -> ReportedCard | None:
    """Parse words about a card; None if they lack the state or its numbers.

    Args:
        activity: the activity, with its card states.
        words: a state by name or label, and numbers as the deck writes them.
        called: the called numbers: marks are wrong on others, and missing on these.
    """
    said = " ".join(words.casefold().split())
    for state in activity.card_states:
        for name in sorted({state.name.casefold(), state.label.casefold()}, key=len, reverse=True):
            if said != name and not said.startswith(f"{name} "):
                continue
            numbers = _numbers(activity, said[len(name) :])
            wanted = NEEDED.get(state.checker)
            if numbers is None or (wanted is None) is bool(numbers):
                return None
            if any((number in called) is not wanted for number in numbers):
                return None
            return ReportedCard(state.name, numbers)
    return None


def reported_card(
    activity: Activity, called: Sequence[int], numbers: Sequence[int], marked: int
) -> ReportedCard:
    """Convert a report by a person who sees a card.

    Args:
        activity: the activity, with its card states.
        called: the called numbers.
        numbers: the numbers on the card, row by row.
        marked: mask of the marked cells.
    """
    cells = called_cells(activity.deck, tuple(numbers), set(called))
    state = judge(activity.card_states, activity.deck, marked, cells)
    checker = next(one.checker for one in activity.card_states if one.name == state)
    about = {"wrong marks": marked & ~cells, "missing marks": cells & ~marked}.get(checker, 0)
    return ReportedCard(state, tuple(n for cell, n in enumerate(numbers) if about >> cell & 1))


def _numbers(activity: Activity, said: str) -> tuple[int, ...] | None:
    """Return the numbers that words name, None if a word is not a number."""
    deck = activity.deck
    labels = {re.sub(r"\W", "", deck.label(n).casefold()): n for n in deck.numbers}
    labels |= {str(number): number for number in deck.numbers}
    words = (re.sub(r"\W", "", word) for word in re.split(r"[\s,;]+|\band\b", said))
    found = [labels.get(word) for word in words if word]
    known = tuple(dict.fromkeys(number for number in found if number is not None))
    return known if len(known) == len(set(found)) else None


def _corrected(behaviour: Behaviour) -> str:
    """Return the checker of the state that a behaviour asks a person to correct, "" for none."""
    if behaviour.clears_marks:
        return "wrong marks"
    return "missing marks" if behaviour.sets_marks else ""
