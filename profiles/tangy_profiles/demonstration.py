"""A demonstration: the trajectory T = {b1, s1} -> {b2, s2} ... of one teacher (III-A-3-iv)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from tangy_profiles.state import ActivityState

Origin = Literal["shown", "again", "asked", "merged", "split"]
"""How a demonstration came about: shown in a game, shown again from a step of an earlier one,
answered when Tangy asked in a game, or made of others."""


@dataclass(frozen=True, slots=True)
class Step:
    """One behaviour-state pair, with the state that followed (from which effects are learnt).

    `completed` says whether the world could carry the behaviour out. `id` is the step's number in
    the log, which it keeps in every demonstration that it is copied into (0: not logged), and
    `teacher` who showed it there.
    """

    behaviour: str
    target: str | None
    state: ActivityState
    after: ActivityState
    completed: bool = True
    id: int = field(default=0, compare=False)
    teacher: str = field(default="", compare=False)

    def to_json(self) -> dict[str, Any]:
        """Return the step as the log keeps it."""
        return {
            "behaviour": self.behaviour,
            "target": self.target,
            "state": self.state.to_json(),
            "after": self.after.to_json(),
            "completed": self.completed,
        }

    @classmethod
    def from_json(cls, body: Mapping[str, Any], id: int = 0, teacher: str = "") -> Step:
        """Read a step that `to_json` wrote."""
        return cls(
            str(body["behaviour"]),
            body["target"],
            ActivityState.from_json(body["state"]),
            ActivityState.from_json(body["after"]),
            bool(body.get("completed", True)),
            id,
            teacher,
        )


@dataclass(frozen=True, slots=True)
class Demonstration:
    """What a teacher showed in one game: who, which activity and world, and the ordered steps.

    `seed`, `people` and `guided` make the simulated world again, so that a demonstration can be
    resumed; `of` names the demonstrations that it was made from.
    """

    id: str
    activity: str
    teacher: str
    seed: int
    people: tuple[str, ...]
    steps: tuple[Step, ...] = ()
    finished: bool = False
    origin: Origin = "shown"
    of: tuple[str, ...] = ()
    guided: bool = False

    @property
    def replayable(self) -> bool:
        """Whether its steps are those of one simulated game from its beginning."""
        return self.origin in ("shown", "again")

    def with_step(self, step: Step) -> Demonstration:
        """Return the demonstration with one more step."""
        return replace(self, steps=(*self.steps, step))

    def without_last(self) -> Demonstration:
        """Return the demonstration with its last step taken back."""
        return replace(self, steps=self.steps[:-1], finished=False)
