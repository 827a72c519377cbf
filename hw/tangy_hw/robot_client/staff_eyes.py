"""The eyes of a robot that has none for cards: staff are asked how the one beside it is.

Nobody is asked to move a card that no camera looks for. The robot waits beside the person until
staff have told.
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

LOOK_SECONDS = 0.5  # between two looks whether staff have told
NEEDED = {"wrong marks": False, "missing marks": True}
"""By checker: the states of which the numbers have to be told, and whether these were called."""


class ToldCard(NamedTuple):
    """How a card is, as staff tell: its user activity state, and the numbers it is about."""

    state: str
    numbers: tuple[int, ...] = ()


class StaffEyes:
    """Asks staff how cards are, and keeps what they told of the one beside the robot."""

    def __init__(self, activity: Activity, commands: Commands) -> None:
        """Take the activity, and how the robot waits."""
        self.asks = ""
        """Of whose card staff are to tell, "" while nothing is to be told."""
        self.answer: Callable[[str], ToldCard | None] = lambda person: self._told
        """Returns what staff said about a person's card; None: nothing yet."""
        self.asked_last = ""
        """Of whose card staff were asked last."""
        self.before: ToldCard | None = None
        """What was told of the same card before, in this visit."""
        self.began = 0.0
        """When staff were asked, in s of the robot's time."""
        self._activity = activity
        self._commands = commands
        self._called: Sequence[int] = ()
        self._told: ToldCard | None = None
        self._last: ToldCard | None = None

    def ask(self, person: str, called: Sequence[int]) -> str:
        """Ask staff for the state of a person's card, and wait for it.

        Args:
            person: at whose place the robot is.
            called: the numbers that were called.

        Raises:
            DeviceError: the waiting is broken off.
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
        """Forget the card that was beside the robot, which stands elsewhere now."""
        self.asked_last, self._last = "", None

    def tell(self, words: str) -> bool:
        """Take in what staff tell of the card that they are asked about; say if it is understood.

        Args:
            words: a state by its name or label; for marks that are wrong or missing with their
                numbers, as in "wrong marks B7, O70".
        """
        told = read_told(self._activity, words, self._called) if self.asks else None
        if told is not None:
            self._told = told
        return told is not None

    @property
    def sayable(self) -> list[str]:
        """What can be told now, an example for each state; none while nothing is asked."""
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
        """The state that was told last of the card beside the robot; None: nothing was told."""
        return None if self._last is None else self._last.state

    def asked_about(self, behaviour: Behaviour) -> tuple[int, ...] | None:
        """Return the numbers that a behaviour is to ask about; None: staff told of none."""
        told, checker = self._last, _corrected(behaviour)
        if told is None or checker != self._checker(told.state):
            return None
        return told.numbers or None

    def response(self, action: Action, person: str, sitting: str) -> Response:
        """Ask staff for the outcome of a request; return it as the person's response.

        Staff take time to look and to tell, which does not count against the person.

        Args:
            action: the request.
            person: at whose place the robot is.
            sitting: who sits there.

        Raises:
            DeviceError: the waiting is broken off.
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


def read_told(activity: Activity, words: str, called: Sequence[int]) -> ToldCard | None:
    """Parse words about a card; None if they lack the state or its numbers.

    Args:
        activity: whose states they are.
        words: a state by name or label, and numbers as the deck writes them.
        called: the numbers that were called: a mark is wrong on others, and missing on these.
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
            return ToldCard(state.name, numbers)
    return None


def told_card(
    activity: Activity, called: Sequence[int], numbers: Sequence[int], marked: int
) -> ToldCard:
    """Parse a report by a person who sees a card.

    Args:
        activity: whose states they are.
        called: the numbers that were called.
        numbers: those on the card, row by row.
        marked: the marked cells, as a mask.
    """
    cells = called_cells(activity.deck, tuple(numbers), set(called))
    state = judge(activity.card_states, activity.deck, marked, cells)
    checker = next(one.checker for one in activity.card_states if one.name == state)
    about = {"wrong marks": marked & ~cells, "missing marks": cells & ~marked}.get(checker, 0)
    return ToldCard(state, tuple(n for cell, n in enumerate(numbers) if about >> cell & 1))


def _numbers(activity: Activity, said: str) -> tuple[int, ...] | None:
    """Return the numbers that words name, None where a word is none."""
    deck = activity.deck
    labels = {re.sub(r"\W", "", deck.label(n).casefold()): n for n in deck.numbers}
    labels |= {str(number): number for number in deck.numbers}
    words = (re.sub(r"\W", "", word) for word in re.split(r"[\s,;]+|\band\b", said))
    found = [labels.get(word) for word in words if word]
    known = tuple(dict.fromkeys(number for number in found if number is not None))
    return known if len(known) == len(set(found)) else None


def _corrected(behaviour: Behaviour) -> str:
    """Return the checker of the state that a behaviour asks a person to mend, "" for none."""
    by_effect = {"clear wrong marks": "wrong marks", "set missing marks": "missing marks"}
    return by_effect.get(behaviour.effect, "")
