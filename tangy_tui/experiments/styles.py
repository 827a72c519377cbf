"""Simulated teachers with different styles: phrases, order of visits, mistakes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.state import FRONT, ActivityState
from tangy_tui.experiments.classroom import Steps
from tangy_tui.learning.scripted_teacher import MOST_STEPS
from tangy_tui.learning.teaching_events import Executed, Undo
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, Reply, Say

Order = Callable[[Sequence[str], Sequence[str], str, Random], str]
"""Chooses the next person from those asking (first come first), the seats, the place, and rng."""


def first_come(asking: Sequence[str], seats: Sequence[str], place: str, rng: Random) -> str:
    """Go to the person who asked first."""
    return asking[0]


def last_come(asking: Sequence[str], seats: Sequence[str], place: str, rng: Random) -> str:
    """Go to the person who asked last."""
    return asking[-1]


def by_seat(asking: Sequence[str], seats: Sequence[str], place: str, rng: Random) -> str:
    """Go to the first seat along the table."""
    return min(asking, key=seats.index)


def nearest(asking: Sequence[str], seats: Sequence[str], place: str, rng: Random) -> str:
    """Go to the nearest seat; the front is opposite the middle of the table."""
    here = (len(seats) - 1) / 2 if place == FRONT else seats.index(place)
    return min(asking, key=lambda person: (abs(seats.index(person) - here), seats.index(person)))


def anybody(asking: Sequence[str], seats: Sequence[str], place: str, rng: Random) -> str:
    """Go to a random person."""
    return asking[int(rng.random() * len(asking))]


@dataclass(frozen=True)
class Style:
    """How one teacher teaches.

    `varied`: use all phrases of a behaviour, or else always the one at index `phrase`. `mistakes`:
    P(giving a wrong command) per step. Of these, the share `reads` is noticed in the question and
    answered with no; of the others, the share `mends` is undone after execution. The rest stay in
    the demonstration.
    """

    name: str
    order: Order
    mistakes: float
    reads: float
    mends: float
    phrase: int = 0
    varied: bool = False


STYLES = (
    Style("careful, in turn", first_come, 0.0, 1.0, 1.0),
    Style("many words, last come first", last_come, 0.01, 0.9, 1.0, varied=True),
    Style("along the table", by_seat, 0.02, 0.5, 0.5, phrase=1),
    Style("shortest way", nearest, 0.03, 0.5, 0.0, phrase=2),
    Style("hasty, anybody", anybody, 0.05, 0.3, 0.2, varied=True),
)
"""Five teachers, as in the paper, with no mistakes up to one in twenty steps."""


class StyledTeacher:
    """Demonstrates the expected behaviours in a style, with its mistakes."""

    def __init__(self, style: Style, teaching: TeachingSession, seed: int) -> None:
        self._style = style
        self._teaching = teaching
        self._rng = Random(f"{seed}/{style.name}")
        self.made = self.noticed = self.mended = 0
        """The numbers of wrong commands, of those answered with no, and of those undone."""

    def demonstrate(self) -> Steps:
        """Demonstrate to the end of the game, event by event."""
        for _ in range(MOST_STEPS):
            if self._teaching.demonstration.finished:
                return
            yield from self._step()

    def _step(self) -> Steps:
        teaching, rng, style = self._teaching, self._rng, self._style
        state = teaching.world.observe()
        right = teaching.activity.expected[state.situation]
        wrong = None
        if rng.random() < style.mistakes:
            others = [name for name in teaching.activity.behaviours if name != right]
            wrong = others[int(rng.random() * len(others))]
            self.made += 1
        command = self._words(teaching.activity.behaviours[wrong or right], state)
        events = teaching.apply(Say(command))
        yield from events
        if not isinstance(events[-1], Asked):
            return  # refused, so the mistake is noticed too
        if wrong is not None and rng.random() < style.reads:
            self.noticed += 1
            yield from teaching.apply(Reply(yes=False))
            return
        done = teaching.apply(Reply(yes=True))
        yield from done
        if wrong is not None and isinstance(done[0], Executed) and rng.random() < style.mends:
            self.mended += 1
            yield from teaching.apply(Undo())

    def _words(self, behaviour: Behaviour, state: ActivityState) -> str:
        phrases = behaviour.phrases
        at = int(self._rng.random() * len(phrases)) if self._style.varied else self._style.phrase
        phrase = phrases[at % len(phrases)]
        asking = self._teaching.world.scene().requests
        if behaviour.visits and asking:
            seats = self._teaching.people
            person = self._style.order(asking, seats, state.place, self._rng)
            phrase = f"{behaviour.phrases[0]} {seats.index(person) + 1}"
        return phrase
