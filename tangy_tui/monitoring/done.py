"""A behaviour that was executed in a game, as read from its step in the log."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.memory import GameMemory
from tangy_profiles.game_records import GameStep
from tangy_profiles.state import ActivityState


@dataclass(frozen=True, slots=True)
class Done:
    """An executed behaviour: where, for whom, how, and whether as expected.

    `begun` and `over` are in s since the game began. `right`: the world carried it out, and the
    activity, if known, expects it in this situation or expects nothing. `said` is the speech, if
    the activity is known.
    """

    number: int
    begun: float
    over: float
    state: ActivityState
    after: ActivityState
    behaviour: str
    target: str | None
    strategy: str
    completed: bool
    right: bool
    teacher: str
    said: str
    draws: bool
    numbers: tuple[int, ...] = ()
    """The called number, or the numbers a person should mark or clear."""
    wins: bool = False
    """Whether it celebrates a winner, if the activity is known."""
    memory: GameMemory | None = None
    """The facts after it, in a live game of an activity by facts."""
    stopped: bool = False
    """Whether people stopped the robot before it was done."""
    ended: bool = False
    """Whether staff ended the game before it was done."""
    since: Mapping[str, float] = field(default_factory=dict)
    """When each person asked who asks after it, in s since the game began; not in old logs."""


def done_of(
    step: GameStep,
    number: int,
    times: tuple[float, float],
    activity: Activity | None,
    names: Mapping[str, str],
    before: int,
    *,
    stopped: bool,
) -> Done:
    """Read a behaviour from its step in the log.

    Args:
        step: the record.
        number: its number in the game, from 1.
        times: when it began and was over, in s since the game began.
        activity: the activity, if it is known.
        names: people's names, by id.
        before: how often the behaviour had been completed.
        stopped: whether people had stopped the robot when it was over.
    """
    name, target, strategy = step.behaviour, step.target, step.strategy or ""
    behaviour = activity.behaviours.get(name) if activity is not None else None
    expected = activity.expected.get(step.state.situation, name) if activity is not None else name
    said = ""
    if activity is not None and behaviour is not None:
        chosen = strategy or activity.plain_strategy
        speech = behaviour.speech.get(chosen, "")
        if isinstance(activity, DeclaredActivity):
            speech = activity.text_in_turn(name, chosen, before, personal=target is not None)
        numbers = tuple(n for n in step.numbers if n in activity.deck.numbers)
        said = activity.fill(speech, names.get(target or "", target or ""), numbers, aloud=True)
    return Done(
        number=number,
        begun=times[0],
        over=times[1],
        state=step.state,
        after=step.after or step.state,
        behaviour=name,
        target=target,
        strategy=strategy if behaviour is None or behaviour.persuades else "",
        completed=step.completed,
        right=step.completed and expected == name,
        teacher=step.teacher or "",
        said=said,
        draws=behaviour is not None and behaviour.calls,
        numbers=step.numbers,
        wins=behaviour is not None and bool(behaviour.needs) and step.completed,
        memory=step.memory,
        stopped=stopped and not step.completed,
        since=dict(zip(step.asking or (), step.since or (), strict=False)),
    )
