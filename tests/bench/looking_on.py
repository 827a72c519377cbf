"""A second console beside a game: how late it sees events, how soon STOP acts, what it costs.

python -m tests.bench.looking_on --stops 20
"""

from __future__ import annotations

import argparse
import json
import re
import statistics
import subprocess
import tempfile
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from tangy_profiles.game_records import GameBeginning, GameStep
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store
from tangy_tui.app.watching import Guest
from tests.bench.kill_checks import share
from tests.bench.kills import TANGY, lines_of, taught_folder
from tests.support.terminal import Terminal

WATCHED_SECONDS = 60.0
STEP_DRAWN = re.compile(r"\d\d:\d\d:\d\d +(\d+)\. ")
"""A line of the screen that reports a step, with its number."""


def watched(folder: Path, seconds: float) -> list[float]:
    """Watch from another process; return the delay of each event (s) that occurred meanwhile."""
    watching = subprocess.Popen(  # noqa: S603
        [*TANGY, "watch", "--json", "--data", str(folder)], stdout=subprocess.PIPE
    )
    late: list[float] = []
    began, since = time.monotonic(), datetime.max.replace(tzinfo=UTC)
    for line in lines_of(watching):
        at, now = json.loads(line).get("at"), datetime.now(UTC)
        if at is not None and datetime.fromisoformat(at) > since:
            late.append((now - datetime.fromisoformat(at)).total_seconds())
        since = min(since, now)  # events from before are not late
        if time.monotonic() > began + seconds:
            break
    watching.terminate()
    watching.wait()
    return late


def seen(folder: Path, seconds: float, columns: int, lines: int) -> tuple[list[float], float, int]:
    """Watch by a screen in its own terminal, and leave.

    Returns the delay of each drawn step (s after it was logged), the screen's share of a processor
    once it was drawn, and the bytes that it wrote meanwhile.
    """
    terminal = Terminal((*TANGY, "watch", "--data", str(folder)), columns=columns, lines=lines)
    drawn: dict[int, datetime] = {}
    try:
        terminal.until(lambda text: bool(STEP_DRAWN.search(text)))
        busy, since, bytes_before = computed(terminal.process), time.monotonic(), len(terminal.raw)
        for number in STEP_DRAWN.findall(terminal.text):
            drawn.setdefault(int(number), datetime.min.replace(tzinfo=UTC))
        while time.monotonic() < since + seconds:
            if terminal.read(0.2):
                now = datetime.now(UTC)
                for number in STEP_DRAWN.findall(terminal.text):
                    drawn.setdefault(int(number), now)
        share_taken = (computed(terminal.process) - busy) / (time.monotonic() - since)
        written = len(terminal.raw) - bytes_before
    finally:
        terminal.end()
    with Store.open(folder, write=False) as store:
        begun = store.last(GameBeginning)
        assert begun is not None
        steps = [event.at for event in store.events(GameStep, after=begun.seq)]
    late = [
        (at - datetime.fromisoformat(steps[number - 1])).total_seconds()
        for number, at in drawn.items()
        if at.year > 1 and number <= len(steps)
    ]
    return late, share_taken, written


def stopped(folder: Path, stops: int) -> list[float]:
    """Stop repeatedly; return after how many s each stop was carried out and logged."""
    took = []
    guest = Guest(folder)
    for number in range(stops):
        asked = datetime.now(UTC)
        guest.stop(f"guest {number}")
        assert guest.answered()
        with Store.open(folder, write=False) as store:
            last = store.last(StaffAction)
        assert last is not None and last.record.by == f"guest {number}"
        took.append((datetime.fromisoformat(last.at) - asked).total_seconds())
        time.sleep(0.2)
    guest.close()
    return took


def computed(process: subprocess.Popen[bytes]) -> float:
    """Return a process's CPU seconds."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def figures(values: Sequence[float]) -> dict[str, object]:
    """Return n, median, p95 and the largest."""
    return {
        "n": len(values), "median": share(values, 50), "p95": share(values, 95),
        "max": round(max(values, default=0.0), 3),
    }  # fmt: skip


def main() -> None:
    """Run it, and print the figures as JSON."""
    options = argparse.ArgumentParser()
    options.add_argument("--stops", type=int, default=20)
    options.add_argument("--seconds", type=float, default=WATCHED_SECONDS)
    options.add_argument("--people", type=int, default=4)
    options.add_argument("--size", type=int, nargs=2, default=(160, 45), help="columns and lines")
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = taught_folder(Path(scratch) / "data")
        game = subprocess.Popen(  # noqa: S603
            [*TANGY, "play", "--plain", "--speed", "30", "--games", "9",
             "--users", str(given.people), "--data", str(folder)],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
        )  # fmt: skip
        guest = Guest(folder)
        while not (guest.look() and guest.view):
            time.sleep(0.1)
        guest.close()
        alone, since = computed(game), time.monotonic()
        time.sleep(given.seconds)
        alone = (computed(game) - alone) / (time.monotonic() - since)
        beside, since = computed(game), time.monotonic()
        late = watched(folder, given.seconds)
        beside = (computed(game) - beside) / (time.monotonic() - since)
        drawn, taken, written = seen(folder, given.seconds, *given.size)
        took = stopped(folder, given.stops)
        game.kill()
        game.wait()
    print(
        json.dumps(
            {
                "events_late_s": figures(late),
                "steps_drawn_late_s": figures(drawn),
                "screen_computing_share": round(taken, 3),
                "screen_bytes_per_s": round(written / given.seconds),
                "stop_s": figures(took),
                "computing_share": {"alone": round(alone, 3), "beside": round(beside, 3)},
                "mean_late_s": round(statistics.mean(late), 3) if late else None,
            },
            indent=2,
        )
    )


if __name__ == "__main__":
    main()
