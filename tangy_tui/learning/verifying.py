"""The verification of commands (III-A-1): nothing happens before "Did you say ...?" is answered.

The same door for whoever commands: a teacher who demonstrates, and one whom Tangy asks in a game.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.state import ActivityState
from tangy_tui.learning.commands import Command, Phrasebook
from tangy_tui.learning.speech import UNDERSTOOD

ANSWERS = {"y": True, "yes": True, "n": False, "no": False}
"""What is typed for an answer where lines are read."""
ANSWER_HELP = "Please answer Y to execute it, or N to give a new command."
ANSWER_MEANINGS = (
    ("y", "yes, execute it"),
    ("n", "no, do nothing; give a new command"),
    ("quit", "leave without executing it"),
)
NO_QUESTION = "There is no question open: give a command."


@dataclass(frozen=True, slots=True)
class Say:
    """A command in words, typed or heard; `confidence` is the decoder's (typed: 1)."""

    text: str
    confidence: float = 1.0


@dataclass(frozen=True, slots=True)
class Reply:
    """The answer to the question that is open: execute it, or not; or ask about another."""

    yes: bool
    alternative: int | None = None


@dataclass(frozen=True, slots=True)
class Asked:
    """The question that verifies a command; nothing happens before it is answered."""

    behaviour: str
    question: str
    heard: str
    confidence: float
    alternatives: tuple[str, ...]
    target: str | None


@dataclass(frozen=True, slots=True)
class NotUnderstood:
    """Words that match no behaviour, with the nearest phrases."""

    heard: str
    suggestions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Refused:
    """Something that cannot be done now, and why; `heard` goes back to the teacher."""

    reason: str
    heard: str = ""


@dataclass(frozen=True, slots=True)
class Rejected:
    """The question was answered with no; `heard` goes back to the teacher."""

    heard: str


@dataclass(frozen=True, slots=True)
class Verified:
    """The teacher said yes: this behaviour is to be executed, for this person."""

    behaviour: Behaviour
    target: str | None
    heard: str
    confidence: float


Verification: TypeAlias = Asked | NotUnderstood | Refused | Rejected | Verified


class Verifier:
    """Understands commands in the present state, asks about them, and takes the answer."""

    def __init__(
        self,
        activity: Activity,
        phrasebook: Phrasebook,
        observe: Callable[[], ActivityState],
        names: Mapping[str, str],
    ) -> None:
        """Make the door; `observe` gives the present state, `names` what people are called."""
        self.question: Asked | None = None
        self._activity = activity
        self._phrasebook = phrasebook
        self._observe = observe
        self._names = names

    def say(self, said: Say) -> Verification:
        """Understand a command, and ask about it."""
        self.question = None
        command = self._phrasebook.understand(said.text)
        if command is not None:
            command = replace(command, confidence=command.confidence * said.confidence)
        if command is None and said.confidence >= UNDERSTOOD:
            stranger = self._phrasebook.stranger(said.text)
            if stranger is not None:
                return Refused(self._nobody(stranger), said.text)
        if command is None or (said.confidence < 1 and command.confidence < UNDERSTOOD):
            return NotUnderstood(said.text, self._phrasebook.suggestions(said.text))
        return self._ask(command, command.behaviour)

    def reply(self, reply: Reply) -> Verification:
        """Take the answer to the open question."""
        question, self.question = self.question, None
        if question is None:
            return Refused("There is no question to answer: give a command first.")
        if reply.alternative is not None:
            if not 1 <= reply.alternative <= len(question.alternatives):
                self.question = question
                return Refused(f"There is no choice {reply.alternative}.")
            chosen = question.alternatives[reply.alternative - 1]
            command = Command(
                question.behaviour, {}, question.confidence, question.heard, question.alternatives
            )
            return self._ask(command, chosen)
        if not reply.yes:
            return Rejected(question.heard)
        behaviour = self._activity.behaviour(question.behaviour)
        return Verified(behaviour, question.target, question.heard, question.confidence)

    def _ask(self, command: Command, name: str) -> Verification:
        behaviour = self._activity.behaviour(name)
        target = command.arguments.get("user") if behaviour.attends else None
        if behaviour.attends and target is None:
            target = self._observe().attended
        reason = self._obstacle(behaviour, target)
        if reason is not None:
            return Refused(reason, command.heard)
        question = behaviour.question
        if target is not None:
            question = f"{question} ({self._name(target)})"
        others = tuple(other for other in command.alternatives if other != name)
        if command.confidence >= 1:
            others = ()  # a phrase typed letter by letter leaves no doubt
        if name != command.behaviour:
            others = (command.behaviour, *others)
        self.question = Asked(name, question, command.heard, command.confidence, others[:3], target)
        return self.question

    def _obstacle(self, behaviour: Behaviour, target: str | None) -> str | None:
        """Return why a behaviour for one person cannot be done now, or None."""
        if not behaviour.attends:
            return None
        goes = behaviour.effect == "go to user"
        if target is None:
            way = f" Say whom to go to, for example: {behaviour.phrases[0]} 1." if goes else ""
            return f"That cannot be done now: nobody asks for help.{way}"
        if not goes and self._observe().place != target:
            return f"Tangy is not with {self._name(target)} yet: it has to go there first."
        return None

    def _nobody(self, stranger: str) -> str:
        """Say that there is nobody of that name or number, and who there is."""
        *others, last = [self._name(person) for person in self._phrasebook.people]
        who = f"{', '.join(others)} and {last} take part" if others else f"{last} takes part"
        there = "There is no" if " " in stranger else "There is nobody called"
        return f"{there} {stranger}: {who}."

    def _name(self, person: str) -> str:
        return self._names.get(person, person)


def answer_help(alternatives: int) -> list[str]:
    """Say what can be answered to "Did you say ...?", a line each."""
    lines = [ANSWER_HELP, *(f"  {word}: {meaning}" for word, meaning in ANSWER_MEANINGS)]
    if alternatives:
        numbers = "1" if alternatives == 1 else f"1 to {alternatives}"
        lines.insert(3, f"  {numbers}: not that, but what stands beside the number")
    return lines
