"""How long teaching a game takes: typed into the real program, in a terminal, in real time.

A very fast typist without errors teaches one random game: look, type the shortest command, wait for
the question on the screen, read it, press y, and see that the step is done. Each of these pauses is
real, and wall-clock time is measured. The typist knows what to type from the same simulated game,
played in parallel in this process.
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
"""Time (s) after which the typist presses y again if the question is still there."""
MOST_AGAIN = 20

BEGINNING = 20
"""Characters of a question to look for on the screen, as the rest may be wrapped."""


@dataclass(frozen=True)
class Pace:
    """A typing speed: keys per second, and seconds for looking and for reading.

    `look` is the time from seeing a step done to the first key of the next command; `read` is the
    time from seeing the question to the y.
    """

    keys: float
    look: float
    read: float


FASTEST = Pace(keys=10.0, look=0.3, read=0.3)
"""120 words per minute, and the reaction time of an expert."""

ORDINARY = Pace(keys=4.0, look=1.5, read=1.0)
"""About 50 words per minute, with time to think; only used for estimates."""


def shortest(behaviour: Behaviour) -> str:
    """Return the shortest phrase of a behaviour."""
    return min(behaviour.phrases, key=len)


def teach_by_typing(settings: Settings, case: Case) -> dict[str, Any]:
    """Teach one game through the real program: a case is (seed,).

    It takes minutes of real time. It is the only piece of work that is not reproducible, because
    its times are measured.

    Returns:
        `seconds` from starting the program to the end of the game on its screen; the numbers of
        `steps` and `keys`; `human`, the seconds of these for typing, looking and reading; and
        `start`, the seconds until the program was ready.

    Raises:
        TangyError: the program did not keep what was typed.
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
    """Return whether the command line accepts keys: a prompt at the bottom, and no question."""
    return any(line.startswith(PROMPT) for line in screen.lines[-3:]) and (
        DID_YOU_SAY not in screen.text
    )


def _kept_steps(folder: Path, activity: Activity) -> list[str]:
    from tangy_tui.learning.library import read_demonstrations

    with Store.open(folder, write=False) as store:
        shown = read_demonstrations(store, activity.name)
    return [step.behaviour for one in shown for step in one.steps]


class _Typist:
    """Types the expected commands at a pace, and plays the same game in parallel."""

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
        """Teach to the end of the game, or this many steps."""
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
            self._press("y")  # pressed too early: the question ignores its first moment
        self.world.execute(activity.action(behaviour, target, None))
        self.done.append(behaviour.name)
        number = re.compile(rf"\bstep {len(self.done)}\b")
        over = self.world.over
        terminal.until(
            lambda screen: bool(number.search(screen.text)) and (over or _ready(screen)),
            f"step {len(self.done)}",
        )

    def _command(self, behaviour: Behaviour) -> None:
        """Type a command, or recall the last one if it is the same."""
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
    """Type games one after another, always on this machine.

    Args:
        activity: the activity.
        seeds: the seeds of the games.
        where: where results are stored.
        steps: end each game after this many steps (None: whole games).
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
