"""Teaching (III-A): a teacher's commands, each verified, become a trajectory.

Screens, the line mode, scripts and tests all drive a `TeachingSession`: a command goes in, events
come out. Every verified step is logged before its event is returned.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
    DemonstrationStepRedone,
    DemonstrationStepUndone,
)
from tangy_tui.language.commands import Learnt, Phrasebook
from tangy_tui.learning.announcements import Announcements
from tangy_tui.learning.command_log import CommandLog
from tangy_tui.learning.conflicts import DemonstratedStep
from tangy_tui.learning.editing import Editor, NotPossible, new_id
from tangy_tui.learning.game_replay import (
    MakeWorld,
    NotAsBefore,
    ReplayedGame,
    replay_game,
    shown_again,
    unfinished,
)
from tangy_tui.learning.library import read_library
from tangy_tui.learning.remarks import Remarks
from tangy_tui.learning.step_rules import StepRules
from tangy_tui.learning.teaching_events import (
    Again,
    Begun,
    Discard,
    Executed,
    Finish,
    Finished,
    Next,
    Redo,
    Remark,
    RemarkAnswer,
    SameWhatever,
    Settle,
    StepUndone,
    TeacherCommand,
    TeachingEvent,
    Undo,
)
from tangy_tui.learning.verification import (
    Asked,
    Offered,
    Refused,
    Reply,
    Say,
    Verification,
    Verified,
    Verifier,
)
from tangy_tui.world import World

NOTHING_SAID = "(nothing: there are no numbers to say)"


class TeachingSession:
    """One teacher's session: a series of demonstrations, each in its own simulated game."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[Person],
        store: Store,
        make_world: MakeWorld,
        *,
        teacher: str,
        seed: int,
        guided: bool = False,
        again: Again | None = None,
        learnt: Learnt | None = None,
    ) -> None:
        """Prepare a session; call `begin` to start it.

        Args:
            activity: the activity to teach.
            people: the participants.
            store: the log.
            make_world: makes the world of a demonstration.
            teacher: who demonstrates.
            seed: seed of the first new game; later games count up from it.
            guided: arrange new games so that each brings about every situation.
            again: begin by repeating a demonstration from some step on.
            learnt: see `Phrasebook`.
        """
        self.activity, self._learnt = activity, learnt
        self._store, self._make_world, self._seed = store, make_world, seed
        self.teach_as(teacher)
        self.phrasebook = self.phrasebook_for(people)
        self.demonstration: Demonstration
        self.world: World
        self.numbers: tuple[tuple[int, ...], ...] = ()
        """The numbers of each step (see `Outcome.numbers`)."""
        self.guided, self._first = guided, again
        self._verifier: Verifier
        self._undone: list[Step] = []
        self.rules = StepRules(activity, store)
        self._announcements, self._logged = Announcements(), False
        self._commands = CommandLog()
        self._people = {person.id: person for person in people}
        self._names = {person.id: person.name for person in people}

    def teach_as(self, teacher: str) -> None:
        """Change the teacher; call it before the session begins."""
        self.teacher, self._remarks = teacher, Remarks(self.activity, teacher, self._store)

    def phrasebook_for(self, people: Sequence[Person]) -> Phrasebook:
        """Build the phrasebook for the participants, with the teacher's own phrases."""
        return self._remarks.phrases.phrasebook(people, self._learnt)

    @property
    def people(self) -> tuple[str, ...]:
        """The ids of the participants of this demonstration."""
        return self.demonstration.people

    @property
    def question(self) -> Asked | Offered | None:
        """The open question, or None."""
        return self._verifier.question

    @property
    def sayable(self) -> tuple[str, ...]:
        """The commands that can be carried out now: what is due, then what was shown most."""
        if self.demonstration.finished:
            return ()
        situation = self.world.observe().situation
        return self._verifier.sayable(self._remarks.usual(situation), self.world)

    @property
    def remark(self) -> Remark | None:
        """The remark about the last step, while it can be answered."""
        return self._remarks.open

    def deferred(self) -> list[tuple[str, Remark]]:
        """Put the open remark off, and return the ones left open (see `Remarks.deferred`)."""
        self._remarks.put_off(self.demonstration.id)
        return self._remarks.deferred()

    def name(self, person: str) -> str:
        """Return a person's name, or the id if the name is unknown."""
        return self._names.get(person, person)

    def begin(self, *, resume: bool = True) -> list[TeachingEvent]:
        """Resume this teacher's unfinished demonstration, or begin a new one.

        An unfinished one is replayed. If its states then differ (the simulator has changed), it is
        left alone and a new one is begun.

        Raises:
            TangyError: the demonstration to repeat cannot be repeated.
        """
        if self._first is not None:
            return self.check()
        library = read_library(self._store, self.activity.name)
        if (entry := unfinished(library, self.teacher, guided=self.guided)) is None or not resume:
            return self._begin_new()
        kept = entry.demonstration
        if (replay := self._replay(kept)) is None:
            return [Refused("another simulator"), *self._begin_new()]
        self._enter(kept, replay)
        self._undone = list(entry.undone)
        self._logged = True
        self._seed = max(self._seed, kept.seed + 1)
        return [Begun(kept, resumed=True)]

    def check(self) -> list[TeachingEvent]:
        """Prepare the repetition of steps before a screen opens; raise TangyError if impossible."""
        return self._begin_again(self._first) if self._first is not None else []

    def apply(self, command: TeacherCommand) -> list[TeachingEvent]:
        """Carry out one command of the teacher and return the events."""
        with self._commands.carrying_out(command):
            events = self._heed(command)
            self._commands.followed(command, events)
        return events

    def _heed(self, command: TeacherCommand) -> list[TeachingEvent]:
        match command:
            case Say():
                self._remarks.put_off(self.demonstration.id)
                return self._say(command)
            case Settle(answer):
                return self._settle(answer)
            case Reply():
                return self._told(self._verifier.reply(command))
            case SameWhatever():
                return [self.rules.note(self.demonstration, command)]
            case Undo():
                return self._undo()
            case Redo():
                return self._redo()
            case Next():
                self._remarks.put_off(self.demonstration.id)
                if self.demonstration.finished:
                    return self._begin_new()
                return [Refused("not finished")]
            case Discard():
                return self._discard()
            case Finish():
                return self._finish()
            case Again(id, kept) if id == self.demonstration.id:
                return self._go_back(kept)
            case Again():
                try:
                    return self._begin_again(command)
                except TangyError as error:
                    return [Refused("not possible", about=str(error))]

    def _begin_new(self) -> list[TeachingEvent]:
        who, of = tuple(self._names), self.activity.name
        new = Demonstration(new_id(), of, self.teacher, self._seed, who, guided=self.guided)
        self._seed += 1
        self._enter(new, ReplayedGame(self._make_world(new), ()))
        self._logged = False
        return [Begun(new, resumed=False)]

    def _discard(self) -> list[TeachingEvent]:
        """Delete the current demonstration, and begin another."""
        if self._logged:
            Editor(self._store, self.activity).delete(self.demonstration.id)
            self._remarks.reread()
        return self._begin_new()

    def _finish(self) -> list[TeachingEvent]:
        """Mark the current demonstration as complete."""
        if self.demonstration.finished or not (self._logged and self.demonstration.steps):
            raise NotPossible("There is no unfinished game with steps that could be finished.")
        self._store.append(DemonstrationFinished(demonstration=self.demonstration.id))
        self.demonstration = replace(self.demonstration, finished=True)
        return [Finished(self.demonstration)]

    def _go_back(self, kept: int) -> list[TeachingEvent]:
        """Undo the last steps of the current demonstration in one transaction."""
        steps = len(self.demonstration.steps)
        if not 0 <= kept < steps:
            return [Refused("no step to show again", number=kept + 1)]
        before = (self.demonstration, ReplayedGame(self.world, self.numbers))
        undone, logged = self._undone, self._logged
        try:
            with self._store.transaction():
                return [event for _ in range(steps - kept) for event in self._undo()]
        except BaseException:  # the transaction was rolled back
            self._enter(*before)
            self._undone, self._logged = undone, logged
            raise

    def _begin_again(self, again: Again) -> list[TeachingEvent]:
        library = read_library(self._store, self.activity.name)
        new = shown_again(library, again, self.teacher)
        if (replay := self._replay(new)) is None:
            raise NotPossible("It was made with another simulator: show the whole game anew.")
        self._enter(new, replay)
        self._logged = False
        return [Begun(new, resumed=False)]

    def _enter(self, demonstration: Demonstration, led_to: ReplayedGame) -> None:
        """Continue a demonstration with its participants, in the world after it."""
        self.demonstration = demonstration
        self.world, self.numbers = led_to.world, led_to.numbers
        self._undone = []
        present = [self._people.get(id, Person(id, id)) for id in demonstration.people]
        self.phrasebook = self.phrasebook_for(present)
        self._verifier = Verifier(
            self.activity, self.phrasebook, lambda: self.world.observe(), self._names
        )

    def _say(self, said: Say) -> list[TeachingEvent]:
        if self.demonstration.finished:
            return [Refused("game over")]
        return self._told(self._remarks.phrases.followed(said, self._verifier.say(said)))

    def _told(self, verification: Verification) -> list[TeachingEvent]:
        if isinstance(verification, Verified):
            return self._execute(verification)
        return [verification]

    def _execute(self, verified: Verified) -> list[TeachingEvent]:
        behaviour = verified.behaviour

        def log(step: Step) -> Step:
            id, heard, sure = self.demonstration.id, verified.heard, verified.confidence
            shown = DemonstrationStep(demonstration=id, step=step, heard=heard, confidence=sure)
            return replace(step, id=self._store.append(shown))

        events = self._carry_out(behaviour, verified.target, log)
        self._undone = []
        if (remark := self.remark) is not None:
            events.insert(1, remark)
        return [*events, *self._announcements.news(self.world)]

    def _carry_out(
        self, behaviour: Behaviour, target: str | None, log: Callable[[Step], Step]
    ) -> list[TeachingEvent]:
        """Execute a behaviour and log the step; if logging fails, restore the world before it."""
        self._remarks.read()
        before = self.world.observe()
        action = self.activity.action(behaviour, target, None)
        outcome = self.world.execute(action)
        after = self.world.observe()
        finished = self.world.over
        try:
            with self._store.transaction():
                self._log_beginning()
                step = log(Step(behaviour.name, target, before, after, outcome.completed))
                if finished:
                    self._store.append(DemonstrationFinished(demonstration=self.demonstration.id))
        except BaseException:
            replay = self._replay(self.demonstration)
            self.world = self.world if replay is None else replay.world
            raise
        self._logged = True
        self.numbers = (*self.numbers, outcome.numbers)
        self.demonstration = replace(self.demonstration.with_step(step), finished=finished)
        speech, image = self.activity.words_of(action, outcome, self.name)
        number, speech = len(self.demonstration.steps), speech or NOTHING_SAID
        events: list[TeachingEvent] = [Executed(number, step, action, outcome, speech, image)]
        shown = DemonstratedStep(self.demonstration.id, self.teacher, number, step)
        self._remarks.notice(shown, outcome, over=finished)
        return [*events, Finished(self.demonstration)] if finished else events

    def _settle(self, answer: RemarkAnswer) -> list[TeachingEvent]:
        if answer == "undo" and self.remark is not None:
            return self._undo()
        settled = self._remarks.answer(answer, self.demonstration.id)
        if settled is not None and settled.answer == "keep":
            self._enter(self.demonstration, ReplayedGame(self.world, self.numbers))
        return [Refused("nothing to settle")] if settled is None else [settled]

    def _log_beginning(self) -> None:
        """Log the demonstration with its first step, so that no empty one is logged."""
        if not self._logged:
            kept = len(self.demonstration.steps)
            self._store.append(DemonstrationBegun.from_demonstration(self.demonstration, kept=kept))

    def _undo(self) -> list[TeachingEvent]:
        if not self.demonstration.steps:
            return [Refused("no step to undo")]
        if (rule := self.rules.take_back(self.demonstration)) is not None:
            return [rule]
        last, number = self.demonstration.steps[-1], len(self.demonstration.steps)
        shorter = self.demonstration.without_last()
        if (replay := self._replay(shorter)) is None:
            return [Refused("undo came out otherwise")]
        with self._store.transaction():
            self._log_beginning()
            self._store.append(DemonstrationStepUndone(demonstration=shorter.id, step=number))
            self._remarks.take_back(shorter.id, number, last)
        self._logged = True
        undone = [*self._undone, last]
        self._enter(shorter, replay)
        self._undone = undone
        return [StepUndone(number, last)]

    def _redo(self) -> list[TeachingEvent]:
        if not self._undone:
            return [Refused("no step to redo")]
        if self.question is not None:
            return [Refused("answer first")]
        step = self._undone[-1]
        behaviour = self.activity.behaviour(step.behaviour)

        def log(done: Step) -> Step:
            if done != step:
                raise NotAsBefore
            self._store.append(DemonstrationStepRedone(demonstration=self.demonstration.id))
            return step

        try:
            events = self._carry_out(behaviour, step.target, log)
        except NotAsBefore:
            return [Refused("redo came out otherwise")]
        self._undone.pop()
        if (remark := self._remarks.redone()) is not None:
            events.insert(1, remark)
        return events

    def _replay(self, demonstration: Demonstration) -> ReplayedGame | None:
        """Make the world after a demonstration; return None if its states differ."""
        return replay_game(self.activity, self._make_world, demonstration)
