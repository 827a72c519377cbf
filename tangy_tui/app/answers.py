"""Answers to Tangy's questions: staff verify the behaviour before Tangy carries it out.

Each question has its own verification.
"""

from __future__ import annotations

from typing import TypeAlias

from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.learning.verification import Asked, Offered, Reply, Say, Verification, Verifier
from tangy_tui.monitoring.supervision import Supervision

Spoken: TypeAlias = Verification | StaffNote
"""The reply to an answer before Tangy acts on it; the controller carries out a `Verified`."""


class AnswerCollector:
    """Collects and verifies staff's answer to the open question."""

    def __init__(self, supervision: Supervision) -> None:
        """Verify the answers to the questions of supervised games."""
        self._supervision = supervision
        self._verifier: Verifier | None = None
        self._question: Unsure | None = None

    @property
    def verifying(self) -> Asked | Offered | None:
        """The open verification, if a command waits for its Y."""
        verifier = self._of_question()
        return None if verifier is None else verifier.question

    @property
    def sayable(self) -> tuple[str, ...]:
        """The commands that can be carried out now, if Tangy asks for one."""
        verifier = self._of_question()
        return () if verifier is None else verifier.sayable()

    def say(self, said: Say) -> Spoken:
        """Take words as the answer to the open question."""
        verifier = self._of_question()
        return StaffNote("nothing asked") if verifier is None else verifier.say(said)

    def reply(self, reply: Reply) -> Spoken:
        """Answer the open verification."""
        verifier = self._of_question()
        if verifier is None or verifier.question is None:
            return StaffNote("nothing asked")
        return verifier.reply(reply)

    def _of_question(self) -> Verifier | None:
        """Return the verifier of the open question, None if Tangy asks nothing."""
        question = self._supervision.question
        if question is not self._question:
            self._question = question
            self._verifier = None if question is None else self._supervision.verifier()
        return self._verifier
