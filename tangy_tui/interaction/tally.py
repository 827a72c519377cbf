"""Totals over games: behaviours, the rows of Table II, interactions, beliefs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tangy_profiles.beliefs import Beliefs
from tangy_profiles.state import Situation
from tangy_tui.interaction.game_events import Acted, BeliefUpdated, GameEnded, Taught, Unsure


@dataclass(frozen=True, slots=True)
class TallyRow:
    """A row of Table II: a situation, its behaviour, how often, and the share of successes."""

    situation: Situation
    behaviour: str
    instances: int
    success: float

    def to_json(self) -> dict[str, object]:
        """Return the row for JSON; `success` is a share from 0 to 1."""
        return {
            "stage": self.situation.stage,
            "request": self.situation.request,
            "user_state": self.situation.user_state,
            "behaviour": self.behaviour,
            "instances": self.instances,
            "success": self.success,
        }


@dataclass
class Tally:
    """A running count over the events of games."""

    games: int = 0
    steps: int = 0
    interactions: int = 0
    answers: int = 0
    asked: int = 0
    """How often Tangy asked what to do."""
    stopped: list[tuple[int, str]] = field(default_factory=list)
    """The games that were stopped: their number, from 1, and the reason."""
    early: list[tuple[int, str, int]] = field(default_factory=list)
    """The games that ended early: their number, the behaviour that was due, the rounds left."""
    injected: list[dict[str, Any]] = field(default_factory=list)
    """The faults to inject: the game, the fault, and the step.

    `step` is None if the fault did not occur.
    """
    pauses: int = 0
    paused_seconds: float = 0.0
    """How often robots waited for late data, and for how long."""
    _done: Counter[tuple[Situation, str]] = field(default_factory=Counter)
    _right: Counter[tuple[Situation, str]] = field(default_factory=Counter)

    def add(self, events: Iterable[object]) -> None:
        """Count the events of games; ignore other events."""
        for event in events:
            match event:
                case Acted():
                    row = (event.state.situation, event.action.behaviour.name)
                    self.steps += 1
                    self._done[row] += 1
                    self._right[row] += event.right
                case BeliefUpdated():
                    self.interactions += 1
                case Taught():
                    self.answers += 1
                case GameEnded():
                    self.games += 1
                    self.pauses += event.pauses[0]
                    self.paused_seconds += event.pauses[1]
                    if event.stopped is not None:
                        self.stopped.append((self.games, event.stopped))
                    if event.due:
                        self.early.append((self.games, event.due, event.rounds_left))
                case Unsure():
                    self.asked += 1

    def add_injections(self, came: Iterable[tuple[int, str]], absent: Iterable[str]) -> None:
        """Add the injections of the latest game.

        Args:
            came: step and kind of each fault that occurred.
            absent: the injections that did not occur.
        """
        for step, kind in came:
            self.injected.append({"game": self.games, "fault": kind, "step": step})
        for words in absent:
            self.injected.append({"game": self.games, "fault": words, "step": None})

    @property
    def absent(self) -> dict[str, int]:
        """In how many games each injection did not occur."""
        return dict(Counter(one["fault"] for one in self.injected if one["step"] is None))

    @property
    def finished(self) -> int:
        """How many games were played to their end."""
        return self.games - len(self.stopped)

    def rows(self, order: Iterable[Situation]) -> list[TallyRow]:
        """Return the rows in the given order of situations, others last."""
        rank = {situation: place for place, situation in enumerate(order)}
        return [
            TallyRow(situation, behaviour, count, self._right[situation, behaviour] / count)
            for (situation, behaviour), count in sorted(
                self._done.items(), key=lambda item: (rank.get(item[0][0], len(rank)), item[0])
            )
        ]

    def to_json(
        self,
        order: Iterable[Situation],
        beliefs: Mapping[str, Beliefs],
        faults: Sequence[Mapping[str, Any]] | None = None,
    ) -> dict[str, Any]:
        """Return the document that `tangy play --json` prints.

        Args:
            order: the situations in the order of the rows.
            beliefs: each person's beliefs at the end.
            faults: the faults; by default the reasons for which games were stopped.
        """
        behaviours: Counter[str] = Counter()
        for (_, behaviour), count in self._done.items():
            behaviours[behaviour] += count
        visits = self.games * len(beliefs)
        early = [{"game": game, "due": due, "rounds_left": left} for game, due, left in self.early]
        reasons = [{"reason": reason} for _, reason in self.stopped]
        return {
            "games": self.games,
            "steps": self.steps,
            "behaviours": dict(behaviours.most_common()),
            "rows": [row.to_json() for row in self.rows(order)],
            "interactions_per_user_game": self.interactions / visits if visits else 0.0,
            "beliefs": {
                person: {strategy: [b.alpha, b.beta] for strategy, b in profile.items()}
                for person, profile in beliefs.items()
            },
            "faults": reasons if faults is None else faults,
            "finished": self.finished,
            "stopped": [{"game": game, "reason": reason} for game, reason in self.stopped],
            "asked": self.asked,
            "pauses": {"count": self.pauses, "seconds": round(self.paused_seconds, 2)},
            **({"ended_early": early} if early else {}),
        }
