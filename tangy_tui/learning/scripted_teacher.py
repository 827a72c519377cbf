"""A scripted teacher that demonstrates the expected behaviours through a teaching session."""

from __future__ import annotations

from collections.abc import Iterator

from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.errors import TangyError
from tangy_profiles.state import EVERYBODY
from tangy_tui.learning.teaching_events import Next, TeachingEvent
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Reply, Say

SCRIPTED = "scripted"
"""The teacher's name in its demonstrations."""

MOST_STEPS = 2_000
"""Steps after which a demonstration is considered endless (real ones have about 62)."""


class ScriptedTeacher:
    """Says the phrase of the expected behaviour, and answers the question with yes."""

    def __init__(self, teaching: TeachingSession) -> None:
        self._teaching = teaching
        if not teaching.activity.expected:
            raise TangyError(
                f"{teaching.activity.title} does not say what is expected ([[expected]]), "
                "so nobody can demonstrate it by script."
            )
        self._phrases = {b.name: b.phrases[0] for b in teaching.activity.behaviours.values()}

    def command(self) -> Say | Reply | Next:
        """Return the teacher's next command.

        Raises:
            TangyError: the activity does not say what is expected here.
        """
        teaching = self._teaching
        if teaching.demonstration.finished:
            return Next()
        if teaching.question is not None:
            return Reply(yes=True)
        situation = teaching.world.observe().situation
        expected = teaching.activity.expected.get(situation)
        if expected is None:
            raise TangyError(f"Nothing is expected for {' / '.join(situation)}.")
        return Say(self._phrases[expected] + self._addressed(expected))

    def _addressed(self, expected: str) -> str:
        """Return the target in words, if it differs from the behaviour's default."""
        teaching, activity = self._teaching, self._teaching.activity
        state = teaching.world.observe()
        selector = activity.expected_selector(state.situation)
        if selector is None:
            return ""
        person = EVERYBODY if selector == "group" else dict(state.whom).get(selector, EVERYBODY)
        usual = first_addressee(activity.behaviours[expected], state) or EVERYBODY
        return "" if person == usual else f" to {teaching.name(person)}"

    def demonstrate(self) -> Iterator[TeachingEvent]:
        """Demonstrate until the game is over, yielding each event.

        Raises:
            TangyError: nothing is expected in a situation, or the game does not end.
        """
        for _ in range(2 * MOST_STEPS):
            if self._teaching.demonstration.finished:
                return
            yield from self._teaching.apply(self.command())
        raise TangyError(f"The game does not end: {MOST_STEPS} steps were demonstrated.")
