"""Facilitation (III-B): observe, let the policy choose, persuade, act, and learn from the response.

`Facilitation` runs one game after another in any world, step by step, and tells what happened.
What happens is in the log before it is told.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias
from uuid import uuid4

from tangy_profiles.activity import Action, Activity
from tangy_profiles.beliefs import Beta
from tangy_profiles.state import ActivityState, Outcome, Response
from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import AWAITED
from tangy_tui.interaction.persuasion import Choice, Persuasion
from tangy_tui.learning.policy import Decision, Policy
from tangy_tui.world import World

BEGUN = "game begun"
STEP = "game step"
RESPONSE = "response"
ENDED = "game ended"

MOST_STEPS = 1_000
"""A game longer than this goes round in circles: all 75 numbers need about 120 steps."""


@dataclass(frozen=True, slots=True)
class GameBegun:
    """A game has begun."""

    game: str
    number: int
    state: ActivityState


@dataclass(frozen=True, slots=True)
class Acted:
    """One step of a game: what was observed, decided, done, and what came of it.

    `right` says whether the behaviour is the one that the activity expects there (None where it
    expects nothing) and whether the world could carry it out.
    """

    number: int
    state: ActivityState
    decision: Decision
    choice: Choice | None
    action: Action
    outcome: Outcome
    after: ActivityState
    speech: str
    image: str
    right: bool


@dataclass(frozen=True, slots=True)
class Learnt:
    """A person responded, and what is believed of them was updated."""

    response: Response
    belief: Beta


@dataclass(frozen=True, slots=True)
class GameEnded:
    """The game is over: played to its end, or stopped for a reason that a person can read."""

    game: str
    steps: int
    stopped: str | None


GameEvent: TypeAlias = GameBegun | Acted | Learnt | GameEnded


class Facilitation:
    """The running of games by a learnt policy. `begin` a game, then `step` until it is `over`."""

    def __init__(
        self,
        world: World,
        policy: Policy,
        persuasion: Persuasion,
        store: Store,
        *,
        names: Mapping[str, str],
        seed: int,
    ) -> None:
        self.world = world
        self.policy = policy
        self.persuasion = persuasion
        self.games = 0
        self.steps = 0
        self.over = True
        self._activity = world.activity
        self._store = store
        self._names = names
        self._seed = seed
        self._game = ""

    def begin(self) -> list[GameEvent]:
        """Begin the next game."""
        state = self.world.begin()
        self._game = uuid4().hex[:12]
        self.games += 1
        self.steps = 0
        self.over = False
        self._store.append(
            BEGUN,
            {
                "game": self._game,
                "number": self.games,
                "activity": self._activity.name,
                "policy": self.policy.digest,
                "seed": self._seed,
                "people": list(self.world.people),
            },
        )
        return [GameBegun(self._game, self.games, state)]

    def step(self) -> list[GameEvent]:
        """Do the next behaviour and return what happened.

        A situation that nobody demonstrated ends the game instead, with the reason: Tangy does
        not guess among people.
        """
        if self.over:
            return []
        state = self.world.observe()
        decision = self.policy.decide(state.situation)
        if not decision.sure:
            return [self._end(_why_not(self._activity, state, decision))]
        if self.steps >= MOST_STEPS:
            return [self._end(f"The game did not end within {MOST_STEPS} steps.")]
        with self._store.transaction():
            events = self._act(state, decision)
        return [self._learn(e) if isinstance(e, Response) else e for e in events]

    def _act(self, state: ActivityState, decision: Decision) -> list[GameEvent | Response]:
        activity = self._activity
        behaviour = activity.behaviours[decision.behaviour]
        target = state.attended if behaviour.attends else None
        choice = None
        if behaviour.persuades and target is not None:
            choice = self.persuasion.choose(target)
        action = activity.action(behaviour, target, choice.strategy if choice else None)
        outcome = self.world.execute(action)
        after = self.world.observe()
        self.steps += 1
        expected = activity.expected.get(state.situation, behaviour.name)
        name = self._names.get(target, target) if target is not None else ""
        events: list[GameEvent | Response] = [
            Acted(
                self.steps,
                state,
                decision,
                choice,
                action,
                outcome,
                after,
                activity.fill(action.speech, name, outcome.numbers),
                activity.fill(action.image, name, outcome.numbers),
                outcome.completed and expected == behaviour.name,
            )
        ]
        self._store.append(
            STEP,
            {
                "game": self._game,
                "behaviour": behaviour.name,
                "target": target,
                "strategy": action.strategy,
                "share": decision.share,
                "draws": choice and dict(choice.draws),
                "numbers": list(outcome.numbers),
                "completed": outcome.completed,
                "state": state.to_json(),
            },
        )
        if outcome.response is not None:
            self._log_response(outcome.response)
            events.append(outcome.response)
        elif choice is not None and outcome.completed:  # what they did may be known later
            body = {"game": self._game}
            self._store.append(AWAITED, body, person=choice.person, strategy=choice.strategy)
        if self.world.over:
            events.append(self._end(None))
        return events

    def _log_response(self, response: Response) -> None:
        self._store.append(
            RESPONSE,
            {"game": self._game, "followed": response.followed, "seconds": response.seconds},
            person=response.person,
            strategy=response.strategy,
            complied=response.complied,
        )

    def _learn(self, response: Response) -> Learnt:
        """Let the beliefs grow, now that the response is in the log."""
        return Learnt(response, self.persuasion.update(response))

    def _end(self, reason: str | None) -> GameEnded:
        self.over = True
        self._store.append(ENDED, {"game": self._game, "steps": self.steps, "stopped": reason})
        return GameEnded(self._game, self.steps, reason)


def _why_not(activity: Activity, state: ActivityState, decision: Decision) -> str:
    situation = activity.in_words(state.situation)
    if not decision.seen:
        return f"Nobody has shown Tangy what to do here yet: {situation}. Demonstrate it once."
    return (
        f"Tangy is not sure what to do here: {situation} ({decision.share:.0%} of the votes for "
        f"{decision.behaviour}). Demonstrate it again, or correct the demonstration that differs."
    )
