"""Verification of commands (III-A-1): nothing happens before "Did you say ...?" is answered.

It is used for demonstrations, and when Tangy asks a teacher during a game.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

from tangy_profiles.declared.fitting import fitting
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.state import EVERYBODY, FRONT, ActivityState
from tangy_tui.language.commands import MOST_ALTERNATIVES, Command, Phrasebook
from tangy_tui.language.words import clean

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.behaviour import Behaviour

FEWEST_LETTERS = 3
"""Typed letters from which the beginning of a phrase is enough."""

RefusalKind: TypeAlias = Literal[
    "no question",
    "no such choice",
    "say which",
    "nobody asks",
    "request ended",
    "nobody to do it for",
    "not with them",
    "no such person",
    "not finished",
    "another simulator",
    "no step to show again",
    "game over",
    "nothing to settle",
    "no step to undo",
    "undo came out otherwise",
    "no step to redo",
    "answer first",
    "redo came out otherwise",
    "not possible",
]
"""Why something cannot be done now; `not possible` carries the message of an error."""


@dataclass(frozen=True, slots=True)
class Say:
    """A command in words.

    For spoken words, `commands` are the possible meanings, likeliest first, and `sure` is whether
    to ask about the first one directly. Typed words are understood later (`commands` is None).
    """

    text: str
    confidence: float = 1.0
    commands: tuple[Command, ...] | None = None
    sure: bool = True


@dataclass(frozen=True, slots=True)
class StopCommand:
    """Someone told the robot to stop: it stops at once, without a question."""

    text: str


@dataclass(frozen=True, slots=True)
class Reply:
    """The answer to the open question: yes or no, or the number of an alternative."""

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
    others: tuple[str, ...] = ()
    """The questions for the alternatives."""
    typed: bool = False


@dataclass(frozen=True, slots=True)
class Offered:
    """The candidate meanings of uncertain words: choose one, or none."""

    heard: str
    confidence: float
    alternatives: tuple[str, ...]
    questions: tuple[str, ...]
    typed: bool = False


@dataclass(frozen=True, slots=True)
class NotUnderstood:
    """Words that match no behaviour, with the nearest phrases."""

    heard: str
    suggestions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Refused:
    """A behaviour that cannot be carried out now, and why; `heard` is shown to the teacher.

    Args:
        why: the reason.
        heard: the words of the command.
        about: a person's name, an unknown name, a phrase to say, or an error message.
        number: the number of a choice or a step.
        people: the names of all participants.
    """

    why: RefusalKind
    heard: str = ""
    about: str = ""
    number: int = 0
    people: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Rejected:
    """The question was answered with no; `heard` is shown to the teacher."""

    heard: str


@dataclass(frozen=True, slots=True)
class Verified:
    """The teacher confirmed this behaviour, for this person."""

    behaviour: Behaviour
    target: str | None
    heard: str
    confidence: float


Verification: TypeAlias = Asked | Offered | NotUnderstood | Refused | Rejected | Verified


class Verifier:
    """Understands commands in the current state, asks about them, and takes the answer."""

    def __init__(
        self,
        activity: Activity,
        phrasebook: Phrasebook,
        observe: Callable[[], ActivityState],
        names: Mapping[str, str],
    ) -> None:
        """Verify commands; `observe` gives the current state, `names` maps ids to names."""
        self.question: Asked | Offered | None = None
        self._activity = activity
        self._phrasebook = phrasebook
        self._observe = observe
        self._names = names
        self._others: tuple[Command, ...] = ()
        self._typed = False

    def say(self, said: Say) -> Verification:
        """Understand a command, and ask about it."""
        self.question, self._typed = None, said.commands is None
        if said.commands is None:
            command = self._typed_command(said.text)
            commands = () if command is None else (command, *self._alternatives(command))
        else:
            commands = said.commands
        if not commands:
            stranger = self._phrasebook.stranger(said.text)
            if stranger is not None:
                people = tuple(self._name(person) for person in self._phrasebook.people)
                return Refused("no such person", said.text, stranger, people=people)
            heard = said.commands is not None  # speech that is not understood gets no suggestions
            return NotUnderstood(
                said.text, () if heard else self._phrasebook.suggestions(said.text)
            )
        if not said.sure:
            return self._offer(said, commands)
        return self._ask(commands[0], commands[1:])

    def _typed_command(self, text: str) -> Command | None:
        """Understand typed words; the first letters of one act's phrases are enough."""
        command = self._phrasebook.understand(text)
        if command is not None and command.confidence >= 1:
            return command
        return self._completed(text) or command

    def _completed(self, text: str) -> Command | None:
        """Return the command that first letters can only mean, or None.

        If they fit one behaviour for several people, they mean the phrase that names nobody.
        """
        if len(text.strip()) < FEWEST_LETTERS:
            return None
        found = [self._phrasebook.understand(one) for one in self._phrasebook.complete(text)]
        known = [one for one in found if one is not None]
        if len({one.behaviour for one in known}) != 1:
            return None
        meant = [one for one in known if not one.arguments] or known
        if len({one.arguments.get("user") for one in meant}) != 1:
            return None
        return replace(meant[0], heard=clean(text))

    def sayable(self, usual: Sequence[str] = (), world: object = None) -> tuple[str, ...]:
        """Return a phrase for each behaviour that can be done now, best first.

        The expected behaviour comes first, because it is due, then the `usual` ones. In a `world`
        with a game declared by facts, the best-fitting behaviours follow; in other worlds, the
        behaviours for one person if the robot is beside one, otherwise those for the group.
        """
        state, activity = self._observe(), self._activity
        expected = activity.expected.get(state.situation)
        beside = state.place != FRONT
        rest = sorted(activity.behaviours, key=lambda name: self._attends(name) is not beside)
        if isinstance(game := getattr(world, "game", None), DeclaredGame):
            rest = fitting(game)
        order = dict.fromkeys((*([expected] if expected else ()), *usual, *rest))
        phrases: list[str] = []
        for name in order:
            behaviour = self._activity.behaviours.get(name)
            if behaviour is None:
                continue
            target = self._usual(behaviour) if behaviour.attends else None
            if self._obstacle(behaviour, target) is None:
                phrases.append(behaviour.phrases[0])
        return tuple(phrases)

    def _attends(self, behaviour: str) -> bool:
        return self._activity.behaviour(behaviour).attends

    def reply(self, reply: Reply) -> Verification:
        """Apply the answer to the open question."""
        question, self.question = self.question, None
        if question is None:
            return Refused("no question")
        if reply.alternative is not None:
            if not 1 <= reply.alternative <= len(question.alternatives):
                self.question = question
                return Refused("no such choice", number=reply.alternative)
            chosen = self._others[reply.alternative - 1]
            rest = tuple(other for other in self._others if other != chosen)
            if isinstance(question, Asked):
                rest = (self._asked, *rest)
            return self._ask(chosen, rest)
        if not reply.yes:
            return Rejected(question.heard)
        if isinstance(question, Offered):
            self.question = question
            return Refused("say which")
        behaviour = self._activity.behaviour(question.behaviour)
        return Verified(behaviour, question.target, question.heard, question.confidence)

    def _alternatives(self, command: Command) -> tuple[Command, ...]:
        """Return the other behaviours that typed words may mean."""
        if command.confidence >= 1:
            return ()  # an exact phrase is unambiguous
        return tuple(
            Command(name, {}, command.confidence, command.heard, ())
            for name in command.alternatives
        )

    def _ask(self, command: Command, others: tuple[Command, ...]) -> Verification:
        behaviour = self._activity.behaviour(command.behaviour)
        target = self._target(command)
        if (obstacle := self._obstacle(behaviour, target)) is not None:
            return replace(obstacle, heard=command.heard)
        self._asked, self._others = command, others[:MOST_ALTERNATIVES]
        names = tuple(other.behaviour for other in self._others)
        self.question = Asked(
            command.behaviour,
            self._words(command),
            command.heard,
            command.confidence,
            names,
            target,
            tuple(map(self._words, self._others)),
            self._typed,
        )
        return self.question

    def _offer(self, said: Say, commands: tuple[Command, ...]) -> Offered:
        self._others = commands[:MOST_ALTERNATIVES]
        self.question = Offered(
            said.text,
            said.confidence,
            tuple(command.behaviour for command in self._others),
            tuple(map(self._words, self._others)),
            self._typed,
        )
        return self.question

    def _target(self, command: Command) -> str | None:
        """Return the person that a command addresses, or None."""
        behaviour = self._activity.behaviour(command.behaviour)
        if not behaviour.attends:
            return None
        named = command.arguments.get("user")
        if named == EVERYBODY:
            return None
        return named or self._usual(behaviour)

    def _usual(self, behaviour: Behaviour) -> str | None:
        """Return the default addressee of a behaviour."""
        state = self._observe()
        return first_addressee(behaviour, state) if behaviour.to else state.attended

    def _words(self, command: Command) -> str:
        """Return the question about a command: the words of its behaviour, and the person."""
        target = self._target(command)
        question = self._activity.behaviour(command.behaviour).question
        return question if target is None else f"{question} ({self._name(target)})"

    def _obstacle(self, behaviour: Behaviour, target: str | None) -> Refused | None:
        """Return why a behaviour cannot be done now, or None."""
        if not behaviour.attends:
            return None
        goes = behaviour.visits
        nobody: RefusalKind = "nobody asks"
        if behaviour.to:
            if target is not None or EVERYBODY in behaviour.to:
                return None
            nobody = "nobody to do it for"
        ended = self._observe().closed
        if target is None and ended and not goes and not behaviour.to:
            return Refused("request ended", about=self._name(ended))
        if target is None:
            return Refused(nobody, about=f"{behaviour.phrases[0]} 1" if goes else "")
        if not goes and self._observe().place != target:
            return Refused("not with them", about=self._name(target))
        return None

    def _name(self, person: str) -> str:
        return self._names.get(person, person)
