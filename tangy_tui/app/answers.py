"""Answers to Tangy's questions: words become a verified behaviour before it is carried out.

The verification belongs to the question: another question begins anew.
"""

from __future__ import annotations

from typing import TypeAlias

from tangy_tui.app.game_commands import StaffNote
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.learning.verification import Asked, Offered, Reply, Say, Verification, Verifier
from tangy_tui.monitoring.supervision import Supervision

Spoken: TypeAlias = Verification | StaffNote
"""What is said to an answer before it is acted upon; `Verified` is for the controller to do."""


class Answers:
    """The teacher's side of the question that is open."""

    def __init__(self, supervision: Supervision) -> None:
        """Take the answers to what supervised games ask."""
        self._supervision = supervision
        self._verifier: Verifier | None = None
        self._question: Unsure | None = None

    @property
    def verifying(self) -> Asked | Offered | None:
        """The verification that is open, where a command waits for its Y."""
        verifier = self._of_question()
        return None if verifier is None else verifier.question

    @property
    def sayable(self) -> tuple[str, ...]:
        """The commands that can be carried out now, where Tangy asks for one."""
        verifier = self._of_question()
        return () if verifier is None else verifier.sayable()

    def say(self, said: Say) -> Spoken:
        """Take words as the answer to what Tangy asks."""
        verifier = self._of_question()
        return StaffNote("nothing asked") if verifier is None else verifier.say(said)

    def reply(self, reply: Reply) -> Spoken:
        """Answer the verification."""
        verifier = self._of_question()
        if verifier is None or verifier.question is None:
            return StaffNote("nothing asked")
        return verifier.reply(reply)

    def _of_question(self) -> Verifier | None:
        """Return the verifier of the present question, None if nothing is asked."""
        question = self._supervision.question
        if question is not self._question:
            self._question = question
            self._verifier = None if question is None else self._supervision.verifier()
        return self._verifier
