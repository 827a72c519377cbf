"""Demonstrating (III-A): a teacher's commands, each verified, become a trajectory.

`Teaching` is the session that screens, lines, scripts and tests all drive alike: a command goes
in, events come out. Every verified step is in the log before its event is returned.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias
from uuid import uuid4

from tangy_profiles.activity import Action, Activity, Behaviour
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.person import Person
from tangy_profiles.state import Outcome
from tangy_profiles.store import Store
from tangy_tui.learning.commands import Command, Phrasebook
from tangy_tui.learning.library import BEGUN, FINISHED, STEP, UNDONE, read_demonstrations
from tangy_tui.learning.speech import UNDERSTOOD
from tangy_tui.world import World

MakeWorld: TypeAlias = Callable[[int, Sequence[str]], World]
"""Make the world of a demonstration from its seed and people, ready at its first state."""


# ------------------------------------------------------------------- what a teacher can do


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
class Undo:
    """Take the last step back."""


@dataclass(frozen=True, slots=True)
class Next:
    """Begin another demonstration after a finished one."""


TeacherCommand: TypeAlias = Say | Reply | Undo | Next


# ---------------------------------------------------------------------------- what follows


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
class Executed:
    """A verified behaviour was carried out and is step `number` of the trajectory (from 1)."""

    number: int
    step: Step
    action: Action
    outcome: Outcome
    speech: str
    image: str


@dataclass(frozen=True, slots=True)
class StepUndone:
    """Step `number` was taken back; the world is as it was before it."""

    number: int
    step: Step


@dataclass(frozen=True, slots=True)
class Begun:
    """A demonstration was begun, or taken up again with the steps it had."""

    demonstration: Demonstration
    resumed: bool


@dataclass(frozen=True, slots=True)
class Finished:
    """The game is over and the demonstration complete."""

    demonstration: Demonstration


TeachingEvent: TypeAlias = (
    Asked | NotUnderstood | Refused | Rejected | Executed | StepUndone | Begun | Finished
)


class Teaching:
    """One teacher's session: demonstrations one after another, each in its own simulated game."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[Person],
        store: Store,
        make_world: MakeWorld,
        *,
        teacher: str,
        seed: int,
    ) -> None:
        self.activity = activity
        self.phrasebook = Phrasebook(activity, people)
        self.teacher = teacher
        self.demonstration: Demonstration
        self.world: World
        self.question: Asked | None = None
        self._names = {person.id: person.name for person in people}
        self._store = store
        self._make_world = make_world
        self._seed = seed
        self._logged = False

    @property
    def people(self) -> tuple[str, ...]:
        """The ids of those who take part in the present demonstration."""
        return self.demonstration.people

    def name(self, person: str) -> str:
        """Return a person's name, or the id of somebody who has none here."""
        return self._names.get(person, person)

    def begin(self, *, resume: bool = True) -> list[TeachingEvent]:
        """Take up this teacher's unfinished demonstration, or begin a new one.

        An unfinished one is replayed in a world of the same seed. If that does not lead to the
        states that were logged (the simulator has changed since), it stays as it is in the log,
        and a new one is begun.
        """
        if resume:
            for kept in reversed(read_demonstrations(self._store, self.activity.name)):
                if kept.teacher == self.teacher and not kept.finished:
                    world = self._replay(kept)
                    if world is not None:
                        self._enter(kept, world)
                        self._logged = True
                        self._seed = max(self._seed, kept.seed + 1)
                        return [Begun(kept, resumed=True)]
                    return [
                        Refused(
                            "The unfinished demonstration was made with another simulator; "
                            "it is kept, and a new one begins."
                        ),
                        *self._begin_new(),
                    ]
        return self._begin_new()

    def apply(self, command: TeacherCommand) -> list[TeachingEvent]:
        """Carry out one command of the teacher and return what followed."""
        match command:
            case Say(text, confidence):
                return self._say(text, confidence)
            case Reply(yes, alternative):
                return self._reply(yes, alternative)
            case Undo():
                return self._undo()
            case Next():
                if self.demonstration.finished:
                    return self._begin_new()
                return [Refused("This demonstration is not finished yet.")]

    def _begin_new(self) -> list[TeachingEvent]:
        people = tuple(self._names)
        new = Demonstration(uuid4().hex[:12], self.activity.name, self.teacher, self._seed, people)
        self._seed += 1
        self._enter(new, self._make_world(new.seed, people))
        self._logged = False
        return [Begun(new, resumed=False)]

    def _enter(self, demonstration: Demonstration, world: World) -> None:
        """Go on with a demonstration, among those who take part, in a world that it led to."""
        self.demonstration = demonstration
        self.world = world
        self.question = None
        present = [Person(id, self.name(id)) for id in demonstration.people]
        self.phrasebook = Phrasebook(self.activity, present)

    def _say(self, text: str, confidence: float) -> list[TeachingEvent]:
        if self.demonstration.finished:
            return [Refused("This game is over. Begin the next demonstration, or undo a step.")]
        command = self.phrasebook.understand(text)
        if command is not None:
            command = replace(command, confidence=command.confidence * confidence)
        if command is None or (confidence < 1 and command.confidence < UNDERSTOOD):
            self.question = None
            return [NotUnderstood(text, self.phrasebook.suggestions(text))]
        return self._ask(command, command.behaviour)

    def _ask(self, command: Command, name: str) -> list[TeachingEvent]:
        behaviour = self.activity.behaviour(name)
        target = command.arguments.get("user") if behaviour.attends else None
        if behaviour.attends and target is None:
            target = self.world.observe().attended
        reason = self._obstacle(behaviour, target)
        if reason is not None:
            self.question = None
            return [Refused(reason, command.heard)]
        question = behaviour.question
        if target is not None:
            question = f"{question} ({self.name(target)})"
        others = tuple(other for other in command.alternatives if other != name)
        if command.confidence >= 1:
            others = ()  # a phrase typed letter by letter leaves no doubt
        if name != command.behaviour:
            others = (command.behaviour, *others)
        self.question = Asked(name, question, command.heard, command.confidence, others[:3], target)
        return [self.question]

    def _obstacle(self, behaviour: Behaviour, target: str | None) -> str | None:
        """Return why a behaviour for one person cannot be done now, or None."""
        if not behaviour.attends:
            return None
        goes = behaviour.effect == "go to user"
        if target is None:
            way = f" Say whom to go to, for example: {behaviour.phrases[0]} 1." if goes else ""
            return f"Nobody asks for help.{way}"
        if not goes and self.world.observe().place != target:
            return f"Tangy is not with {self.name(target)} yet: it has to go there first."
        return None

    def _reply(self, yes: bool, alternative: int | None) -> list[TeachingEvent]:
        question, self.question = self.question, None
        if question is None:
            return [Refused("There is no question to answer: give a command first.")]
        if alternative is not None:
            if not 1 <= alternative <= len(question.alternatives):
                self.question = question
                return [Refused(f"There is no choice {alternative}.")]
            chosen = question.alternatives[alternative - 1]
            command = Command(
                question.behaviour,
                {},
                question.confidence,
                question.heard,
                question.alternatives,
            )
            return self._ask(command, chosen)
        if not yes:
            return [Rejected(question.heard)]
        return self._execute(question)

    def _execute(self, question: Asked) -> list[TeachingEvent]:
        behaviour = self.activity.behaviour(question.behaviour)
        before = self.world.observe()
        action = self.activity.action(behaviour, question.target, None)
        outcome = self.world.execute(action)
        step = Step(behaviour.name, question.target, before, self.world.observe())
        finished = self.world.over
        try:
            with self._store.transaction():
                self._log_beginning()
                self._store.append(STEP, {"demonstration": self.demonstration.id, **step.to_json()})
                if finished:
                    self._store.append(FINISHED, {"demonstration": self.demonstration.id})
        except BaseException:  # what is not in the log has not happened
            self.world = self._replay(self.demonstration) or self.world
            raise
        self._logged = True
        self.demonstration = replace(self.demonstration.with_step(step), finished=finished)
        name = self.name(question.target) if question.target else ""
        events: list[TeachingEvent] = [
            Executed(
                len(self.demonstration.steps),
                step,
                action,
                outcome,
                self.activity.fill(action.speech, name, outcome.numbers),
                self.activity.fill(action.image, name, outcome.numbers),
            )
        ]
        if finished:
            events.append(Finished(self.demonstration))
        return events

    def _log_beginning(self) -> None:
        """Log the demonstration with its first step, so that looking in leaves no empty one."""
        if not self._logged:
            self._store.append(
                BEGUN,
                {
                    "demonstration": self.demonstration.id,
                    "activity": self.activity.name,
                    "teacher": self.teacher,
                    "seed": self.demonstration.seed,
                    "people": list(self.demonstration.people),
                },
            )

    def _undo(self) -> list[TeachingEvent]:
        if not self.demonstration.steps:
            return [Refused("There is no step to undo.")]
        last = self.demonstration.steps[-1]
        number = len(self.demonstration.steps)
        shorter = self.demonstration.without_last()
        world = self._replay(shorter)
        if world is None:
            return [Refused("This step cannot be undone: the simulator has changed since.")]
        self._store.append(UNDONE, {"demonstration": shorter.id, "step": number})
        self._enter(shorter, world)
        return [StepUndone(number, last)]

    def _replay(self, demonstration: Demonstration) -> World | None:
        """Make the world that a demonstration led to; None if its states come out differently."""
        world = self._make_world(demonstration.seed, demonstration.people)
        for step in demonstration.steps:
            behaviour = self.activity.behaviours.get(step.behaviour)
            if behaviour is None or world.observe() != step.state:
                return None
            world.execute(self.activity.action(behaviour, step.target, None))
            if world.observe() != step.after:
                return None
        return world
