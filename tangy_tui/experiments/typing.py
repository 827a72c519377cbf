"""How long teaching a game takes: typed into the real program, in a terminal, in real time.

Somebody who types very fast and never errs teaches one game by chance: looks, types the shortest
command, waits until the question is on the screen, reads it, presses y, and sees that it is done.
Every one of these moments passes for real; the wall clock is what is measured. What to type is
known from the same simulated game, played along in this process.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_profiles.store import Store
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.experiments.classroom import about, activity_of
from tangy_tui.experiments.published import USERS
from tangy_tui.experiments.screen import Screen
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where
from tangy_tui.experiments.terminal import Terminal
from tangy_tui.text.questions import DID_YOU_SAY

UP, ENTER = "\x1b[A", "\r"
PROMPT = "> "
AGAIN = 1.0
"""Seconds after which somebody presses y again whose question is still there."""
MOST_AGAIN = 20

BEGINNING = 20
"""Characters of a question by which it is known on the screen, where the rest may be wrapped."""


@dataclass(frozen=True)
class Pace:
    """How fast somebody types: keys in a second, and seconds for looking and for reading.

    `look` is what passes from seeing a step done to the first key of the next command; `read` is
    what passes from seeing the question to the y.
    """

    keys: float
    look: float
    read: float


FASTEST = Pace(keys=10.0, look=0.3, read=0.3)
"""120 words a minute, and the reaction time of somebody who knows what is coming."""

ORDINARY = Pace(keys=4.0, look=1.5, read=1.0)
"""About 50 words a minute, and time to think; never typed, only worked out."""


def shortest(behaviour: Behaviour) -> str:
    """Return the shortest phrase that asks for a behaviour."""
    return min(behaviour.phrases, key=len)


def teach_by_typing(settings: Settings, case: Case) -> dict[str, Any]:
    """Teach one game through the real program: a case is (seed,).

    It takes minutes of real time, and its times are measured: it is the one piece of work that
    does not come out the same again.

    Returns:
        `seconds` in all, from starting the program to the end of the game on its screen; how many
        `steps` and `keys` there were, `human`, the seconds of the typist's pace in these, and
        `start`, the seconds until the program was ready.
    """
    activity = activity_of(settings["activity"])
    pace = Pace(**settings["pace"])
    with TemporaryDirectory(prefix="tangy-typing-") as folder:
        words = ["teach", "--activity", settings["activity"], "--users", str(USERS)]
        words += ["--seed", str(case[0]), "--teacher", "typist", "--data", folder]
        begun = monotonic()
        with Terminal(words) as terminal:
            typist = _Typist(terminal, activity, pace, case[0])
            terminal.until(_ready, "the line to type in")
            start = monotonic() - begun
            typist.teach(settings["steps"])
            seconds = monotonic() - begun
        kept = _kept_steps(Path(folder), activity)
    if kept != typist.done:
        raise TangyError("What was typed is not what the program kept: nothing was measured.")
    return {
        "seconds": seconds,
        "start": start,
        "steps": len(typist.done),
        "keys": typist.keys,
        "human": typist.keys / pace.keys + len(typist.done) * (pace.look + pace.read),
        "finished": typist.world.over,
    }


def _ready(screen: Screen) -> bool:
    """Whether the command line takes keys: its prompt stands at the bottom, and no question."""
    return any(line.startswith(PROMPT) for line in screen.lines[-3:]) and (
        DID_YOU_SAY not in screen.text
    )


def _kept_steps(folder: Path, activity: Activity) -> list[str]:
    from tangy_tui.learning.library import read_demonstrations

    with Store.open(folder, write=False) as store:
        shown = read_demonstrations(store, activity.name)
    return [step.behaviour for one in shown for step in one.steps]


class _Typist:
    """Types what the activity expects, at a pace, and plays the same game along."""

    def __init__(self, terminal: Terminal, activity: Activity, pace: Pace, seed: int) -> None:
        self._terminal = terminal
        self._activity = activity
        self._pace = pace
        people = load_people(USERS)
        self._names = {person.id: person.name for person in people}
        self.world = SimulatedWorld(
            activity, tuple(self._names), seed=seed, users=load_users().teaching()
        )
        self.done: list[str] = []
        self.keys = 0

    def teach(self, steps: int | None) -> None:
        """Teach to the end of the game, or so many steps."""
        while not self.world.over and (steps is None or len(self.done) < steps):
            self._step()

    def _step(self) -> None:
        activity, terminal = self._activity, self._terminal
        state = self.world.observe()
        behaviour = activity.behaviours[activity.expected[state.situation]]
        target = state.attended if behaviour.attends else None
        terminal.watch(self._pace.look)
        self._command(behaviour)
        asked = behaviour.question + (f" ({self._names[target]})" if target else "")
        begins = DID_YOU_SAY + asked[:BEGINNING]
        terminal.until(lambda screen: begins in screen.text, f"the question {begins!r}")
        terminal.watch(self._pace.read)
        self._press("y")
        for _ in range(MOST_AGAIN):
            if terminal.sees(lambda screen: DID_YOU_SAY not in screen.text, AGAIN):
                break
            self._press("y")  # it came too early: the program takes none in its first moment
        self.world.execute(activity.action(behaviour, target, None))
        self.done.append(behaviour.name)
        number = re.compile(rf"\bstep {len(self.done)}\b")
        over = self.world.over
        terminal.until(
            lambda screen: bool(number.search(screen.text)) and (over or _ready(screen)),
            f"step {len(self.done)}",
        )

    def _command(self, behaviour: Behaviour) -> None:
        """Type a command, or bring back the last one where it is the same."""
        if self.done and self.done[-1] == behaviour.name:
            self._press(UP)
        else:
            for key in shortest(behaviour):
                self._press(key)
        self._press(ENTER)

    def _press(self, key: str) -> None:
        self.keys += 1
        self._terminal.watch(1 / self._pace.keys)
        self._terminal.press(key)


def run(
    activity: str, seeds: Sequence[int], where: Where, *, steps: int | None = None
) -> dict[str, Any]:
    """Type games one after another on this machine, whatever else works elsewhere.

    Args:
        activity: what is played.
        seeds: of the games.
        where: where the work is kept and done.
        steps: leave each game after so many steps (None: whole games).
    """
    settings = {**about(activity), "pace": asdict(FASTEST), "steps": steps}
    here = Where(where.folder, 1, None, where.fresh, where.tell)
    sweep = Sweep("typing", teach_by_typing, settings, [(seed,) for seed in seeds])
    return _document(activity, sweep.run(here))


def _document(name: str, games: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    def mean(key: str) -> float:
        return float(sum(game[key] for game in games) / len(games))

    machine = mean("seconds") - mean("human")
    slow = mean("keys") / ORDINARY.keys + mean("steps") * (ORDINARY.look + ORDINARY.read)
    return {
        "minutes": mean("seconds") / 60,
        "machine_minutes": machine / 60,
        "start_seconds": mean("start"),
        "steps": mean("steps"),
        "keys": mean("keys"),
        "games": len(games),
        "pace": asdict(FASTEST),
        "ordinary": {**asdict(ORDINARY), "minutes": (machine + slow) / 60},
        "phrases": {b.name: shortest(b) for b in activity_of(name).behaviours.values()},
    }
