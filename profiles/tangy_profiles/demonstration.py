"""A demonstration: the trajectory T = {b1, s1} -> {b2, s2} ... of one teacher (III-A-3-iv)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from tangy_profiles.state import ActivityState


@dataclass(frozen=True, slots=True)
class Step:
    """One behaviour-state pair, with the state that followed (from which effects are learnt)."""

    behaviour: str
    target: str | None
    state: ActivityState
    after: ActivityState

    def to_json(self) -> dict[str, Any]:
        """Return the step as the log keeps it."""
        return {
            "behaviour": self.behaviour,
            "target": self.target,
            "state": self.state.to_json(),
            "after": self.after.to_json(),
        }

    @classmethod
    def from_json(cls, body: Mapping[str, Any]) -> Step:
        """Read a step that `to_json` wrote."""
        return cls(
            str(body["behaviour"]),
            body["target"],
            ActivityState.from_json(body["state"]),
            ActivityState.from_json(body["after"]),
        )


@dataclass(frozen=True, slots=True)
class Demonstration:
    """What a teacher showed in one game: who, which activity and world, and the ordered steps.

    `seed` and `people` make the simulated world again, so that a demonstration can be resumed.
    """

    id: str
    activity: str
    teacher: str
    seed: int
    people: tuple[str, ...]
    steps: tuple[Step, ...] = ()
    finished: bool = False

    def with_step(self, step: Step) -> Demonstration:
        """Return the demonstration with one more step."""
        return replace(self, steps=(*self.steps, step))

    def without_last(self) -> Demonstration:
        """Return the demonstration with its last step taken back."""
        return replace(self, steps=self.steps[:-1], finished=False)
