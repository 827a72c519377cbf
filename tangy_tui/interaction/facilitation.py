"""Facilitation (III-B): observe, decide by the policy, persuade, act, and learn from the response.

`Facilitation` runs games in any world, step by step, and logs each event before reporting it.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias
from uuid import uuid4

from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.declared.whom import Addressee, addressee
from tangy_profiles.demonstration import Step
from tangy_profiles.game_records import ChangeKind, GameBeginning, GameEnding, GameResumed
from tangy_profiles.past_game import PastGame
from tangy_profiles.person import Person
from tangy_profiles.state import ActivityState, Outcome
from tangy_profiles.store import Store
from tangy_tui.interaction.changes import GameChanges
from tangy_tui.interaction.game_events import (
    Acted,
    BeliefUpdated,
    DoneOnce,
    GameBegun,
    GameEnded,
    GameEvent,
    ResumedGame,
    Taught,
    Unsure,
)
from tangy_tui.interaction.game_log import GameLog
from tangy_tui.interaction.observation import Observation, refused
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.interaction.reading_error import learnt_error
from tangy_tui.interaction.uncertainty import remedy_for, which_of, why_not
from tangy_tui.language.commands import Learnt, Phrasebook
from tangy_tui.learning.early_ends import due_instead
from tangy_tui.learning.online_learning import OnlineLearning
from tangy_tui.learning.policy import Decision, Policy
from tangy_tui.learning.teaching_session import NOTHING_SAID
from tangy_tui.learning.verification import Verifier
from tangy_tui.world import World

_LOG = logging.getLogger(__name__)

NOT_DONE = "(it could not be carried out)"
CUT_SHORT = "(Tangy stopped for a moment: this program was too slow; Tangy tries again)"
OBSOLETE = "(Tangy looked at the card again: this is no longer needed)"
MOST_STEPS = 1_000
"""Steps after which a game is considered endless: calling all 75 numbers takes about 120."""


Permits: TypeAlias = Callable[[Decision, str | None], bool]
"""Returns whether a decision may be carried out, for this target."""

Contradicts: TypeAlias = Callable[[Action, ActivityState, Outcome, ActivityState], bool]
"""Returns whether the state after an action differs from the expected one."""


class Facilitation:
    """Runs games by a learnt policy: `begin` a game, then `step` until it is `over`."""

    def __init__(
        self,
        world: World,
        policy: Policy,
        persuasion: Persuasion,
        store: Store,
        *,
        names: Mapping[str, str],
        people: Sequence[Person] = (),
        seed: int,
        room: str = "",
        answers: OnlineLearning | None = None,
        learnt: Learnt | None = None,
    ) -> None:
        """Prepare to run games.

        Args:
            world: the world in which the games are played.
            policy: the policy that decides.
            persuasion: the beliefs about people, and the choice of strategies.
            store: the log.
            names: people's names, by id.
            people: details of these people: how their names are pronounced, and their seats.
            seed: seed of the random generators.
            room: the name of the room; "" chooses it by the number of people.
            answers: learns from the answers of a teacher who is present; without it, a situation in
                which Tangy is not sure ends the game.
            learnt: see `Phrasebook`.
        """
        self.world = world
        self.policy = policy
        self.persuasion = persuasion
        self.room = room
        self.games = 0
        self.steps = 0
        self.over = True
        self.question: Unsure | None = None
        """The open question; nothing happens before it is answered or the game is given up."""
        self.looked_over = False
        """Whether a supervisor checks the last behaviour and then ends the game (`finish`)."""
        self.permits: Permits = lambda decision, target: True
        """Called at each step before acting; if it returns False, nothing is done."""
        self.contradicts: Contradicts = lambda action, state, outcome, after: False
        """Called after an action to decide whether to look again; set by a supervisor."""
        error = learnt_error(store, world.activity.name, world.played_in)
        self.observation = Observation(world, error)
        """Observes the state, with second looks."""
        self.changes = GameChanges(world, store)
        self.log = GameLog(world, store)
        """Logs the steps, and measures the time played."""
        self._answers = answers
        self._learnt = learnt
        self._activity = world.activity
        self._store = store
        self._names = names
        self._people = {person.id: person for person in people}
        self._seed = seed
        self._game = ""
        self._refused: str | None = None
        """The person who refused a request during the current visit."""
        self._said: tuple[str, str, str] | None = None
        """The last person, behaviour and strategy of this visit."""
        self._last: Acted | None = None

    def begin(self) -> list[GameEvent]:
        """Begin the next game."""
        state = self.world.begin()
        self.log.begin()
        self._enter(uuid4().hex[:12], self.games + 1, 0, state)
        self._store.append(
            GameBeginning(
                game=self._game,
                number=self.games,
                activity=self._activity.name,
                file=self._activity.file,
                policy=self.policy.digest,
                seed=self._seed,
                people=tuple(self.world.people),
                world=self.world.played_in,
                room=self.room,
                asks_in_visit=self._activity.asking.visit,
                asks_in_game=self._activity.asking.game,
                **self.changes.logged,
            )
        )
        return [GameBegun(self._game, self.games, state)]

    def resume(self, past: PastGame, by: str) -> list[GameEvent]:
        """Continue an interrupted game.

        Raises:
            NotResumable: the world cannot restore the state of the game.
        """
        self.changes.resume(past)
        state, game = self.world.resume(past), past.beginning
        self.log.resume(past)
        self._enter(game.game, game.number, len(past.steps), state)
        self._store.append(GameResumed(game=self._game, steps=self.steps, by=by))
        places = {person: place for place, person in enumerate(game.people)}
        joined = [
            self.change("joined", person=person, place=places[person], by=by)
            for person in past.newcomers
        ]
        late = [self.change(c.what, person=c.person, by=c.by) for c in past.unmade]
        return [ResumedGame(self._game, self.games, self.steps, state), *joined, *late]

    def _enter(self, game: str, number: int, steps: int, state: ActivityState) -> None:
        """Set the current game and step."""
        self.observation.begin(state)
        self._game, self.games, self.steps = game, number, steps
        self.over = False
        self.question = self._refused = self._said = self._last = None

    def step(self) -> list[GameEvent]:
        """Carry out the next behaviour and return the events.

        In a situation that was not demonstrated, or about which demonstrations disagree, Tangy does
        not guess. It asks a teacher (see `answer`), or ends the game if nobody can be asked.
        """
        if self.over or self.question is not None:
            return []
        if changed := self.changes.due(self._game, self.steps):
            over = changed[-1].what == "nobody won"
            return [*changed, self._end(None)] if over else [*changed]
        state = self.look()
        decision = self.policy.decide(state.situation)
        if self.steps >= MOST_STEPS:
            return [self._end(f"The game did not end within {MOST_STEPS} steps.")]
        if not decision.sure:
            reason, remedy = why_not(self._activity, state, decision), remedy_for(decision)
            if self._answers is None:
                return [self._end(f"{reason} {remedy}")]
            self.question = Unsure(state, decision, reason, remedy)
            return [self.question]
        behaviour = self._activity.behaviours[decision.behaviour]
        target = state.attended if behaviour.attends else None
        if behaviour.to:
            found = addressee(self.policy.whom, behaviour, state)
            target = found.person
            if not found.sure:
                return [self._ask_whom(state, decision, found)]
        if not self.permits(decision, target):
            return []
        acted = self._act(state, decision, behaviour, target)
        with self._store.transaction():
            ended = self._log(acted, "")
        return self._told(acted, ended)

    def _ask_whom(self, state: ActivityState, decision: Decision, found: Addressee) -> GameEvent:
        """Ask whom a behaviour is for; end the game if nobody can be asked."""
        reason = which_of(decision.behaviour, found.others, self._names)
        if self._answers is None:
            return self._end(reason)
        self.question = Unsure(state, decision, reason, remedy_for(decision))
        return self.question

    def change(self, what: ChangeKind, **about: Any) -> GameEvent:
        """Make a change in the game besides its behaviours."""
        return self.changes.make(self._game, self.steps, what, **about)

    def look(self) -> ActivityState:
        """Observe the state before a behaviour."""
        return self.observation.before(lambda seen: not self.policy.decide(seen.situation).sure)

    @property
    def asks(self) -> bool:
        """Whether there is a teacher to ask."""
        return self._answers is not None

    @property
    def game(self) -> str:
        """The id of the current game, or of the last one."""
        return self._game

    def ask(self, reason: str, remedy: str, fault: str) -> list[GameEvent]:
        """Ask a teacher about a fault, even if the policy is sure."""
        if self.over or self.question is not None or self._answers is None:
            return []
        state = self.world.observe()
        decision = self.policy.decide(state.situation)
        self.question = Unsure(state, decision, reason, remedy, fault)
        return [self.question]

    def refused(self, person: str | None) -> None:
        """Record that a person refused a request outside the behaviours."""
        self._refused = person

    def withdraw(self) -> None:
        """Withdraw the question, because nothing is left to answer."""
        self.question = None

    def finish(self) -> list[GameEvent]:
        """End a game that is over in the world, after its last behaviour was checked."""
        return [self._end(None)] if self.world.over and not self.over else []

    def stop(self, reason: str) -> list[GameEvent]:
        """End a game that cannot go on; `reason` is for people."""
        if self.over:
            return []
        self.question = None
        return [self._end(reason)]

    def verifier(self) -> Verifier:
        """Make the verifier of a teacher's answers."""
        named = {id: Person(id, self._names.get(id, id)) for id in self.world.people} | self._people
        people = [named[id] for id in self.world.people]
        phrasebook = Phrasebook(self._activity, people, self._learnt)
        return Verifier(self._activity, phrasebook, self.world.observe, self._names)

    def answer(self, behaviour: Behaviour, target: str | None, teacher: str) -> list[GameEvent]:
        """Carry out a teacher's answer, learn from it, and continue with the new policy.

        An answer about a fault is carried out once and not learnt, if the policy is sure of another
        behaviour in that situation.

        If logging fails, the exception leaves log, policy and beliefs unchanged, and the next
        `step` observes the game again.
        """
        if self.question is None or self._answers is None:
            return []
        question, self.question = self.question, None
        state, decision = question.state, question.decision
        if question.fault and decision.sure and behaviour.name != decision.behaviour:
            acted = self._act(state, decision, behaviour, target)
            with self._store.transaction():
                ended = self._log(acted, teacher)
            first, *rest = self._told(acted, ended)
            return [first, DoneOnce(teacher, decision.behaviour), *rest]
        acted = self._act(state, decision, behaviour, target)
        with self._store.transaction():
            ended = self._log(acted, teacher)
            response = acted.outcome.response
            # The effect of a behaviour that the person did not follow is not to be expected.
            did = acted.outcome.completed and (response is None or response.followed)
            shown = Step(behaviour.name, target, state, acted.after, completed=did)
            lesson = self._answers.learn(
                self.policy, shown, teacher=teacher, seed=self._seed, people=self.world.people
            )
        self.policy = lesson.policy
        first, *rest = self._told(acted, ended)
        return [first, Taught(teacher, lesson), *rest]

    def give_up(self) -> list[GameEvent]:
        """End a game because nobody answers its question."""
        if self.question is None:
            return []
        question, self.question = self.question, None
        return [self._end(f"{question.reason} {question.remedy}")]

    def leave(self, *, ends: bool = False) -> list[GameEvent]:
        """End a running game because its viewer leaves, or because staff end it (`ends`)."""
        return self.stop("Staff ended it." if ends else "It was left before its end.")

    def _told(self, acted: Acted, ended: GameEnded | None) -> list[GameEvent]:
        """Return the events of a logged step, and update the posteriors by its response."""
        events: list[GameEvent] = [acted]
        response = acted.outcome.response
        if response is not None:
            events.append(BeliefUpdated(response, self.persuasion.update(response)))
        if ended is not None:
            events.append(ended)
        return events

    def _act(
        self,
        state: ActivityState,
        decision: Decision,
        behaviour: Behaviour,
        target: str | None,
    ) -> Acted:
        """Carry out a behaviour; no lock on the log is held, as it takes time in a real world."""
        activity = self._activity
        choice = None
        if behaviour.persuades and target is not None:
            without = (activity.pressing if self._refused == target else ()) + self.changes.left_out
            same = self._said is not None and self._said[:2] == (target, behaviour.name)
            again = self._said[2] if same and self._said is not None else None
            choice = self.persuasion.choose(self.world.who(target), without, again=again)
            self._said = (target, behaviour.name, choice.strategy)
        action = activity.action(behaviour, target, choice.strategy if choice else None)
        _LOG.info("%s for %s begins", behaviour.name, target or "everybody")
        outcome = self.world.execute(action)
        after = self.observation.after(lambda seen: self.contradicts(action, state, outcome, seen))
        self.steps += 1
        _LOG.info(
            "step %d: %s for %s, %s, %.1f s",
            *(self.steps, behaviour.name, target or "everybody"),
            *("done" if outcome.completed else "not done", outcome.seconds),
        )
        if state.place != after.place:
            self._refused = self._said = None
        elif refused(behaviour, state, outcome, after):
            self._refused = target
        expected = activity.expected.get(state.situation, behaviour.name)
        undone = CUT_SHORT if outcome.cut_short else OBSOLETE if outcome.obsolete else NOT_DONE
        speech, image = activity.words_of(
            action, outcome, lambda person: self._names.get(person, person)
        )
        return Acted(
            self.steps,
            state,
            decision,
            choice,
            action,
            outcome,
            after,
            speech or (NOTHING_SAID if outcome.completed else undone),
            image,
            outcome.completed and expected == behaviour.name,
        )

    def _log(self, acted: Acted, teacher: str) -> GameEnded | None:
        """Log a step and the response; return the end of the game, if it is over."""
        self.log.step(self._game, acted, teacher)
        self._last = acted
        return self._end(None) if self.world.over and not self.looked_over else None

    def _end(self, reason: str | None) -> GameEnded:
        self.over = True
        due, left = ("", 0) if reason or self._last is None else self._early(self._last)
        count, seconds = self.world.pauses
        ending = GameEnding(
            game=self._game, steps=self.steps, stopped=reason, pauses=count, paused_seconds=seconds,
            looks=self.observation.counted.looks, looks_wrong=self.observation.counted.wrong,
            due=due, rounds_left=left,
        )  # fmt: skip
        self._store.append(ending)
        return GameEnded(self._game, self.steps, reason, (count, seconds), due, left)

    def _early(self, last: Acted) -> tuple[str, int]:
        """Return the behaviour that was due instead of the last one, and the rounds left."""
        due = due_instead(self._activity, last.state.situation, last.action.behaviour.name)
        return due, last.outcome.rounds_left
