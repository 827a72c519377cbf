"""Lines that staff type in a game in words of their own: `python -m tests.bench.staff_lines`.

A line is right if it is read as what was wanted, offered if a similar command that does it is
suggested, wrong if it is read as something else (or only something else is suggested), and
otherwise nothing. `--all` prints each line that is not right, but those of the held set.
"""

from __future__ import annotations

import sys
import tomllib
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import command_reader
from tangy_tui.app.game_commands import CallAgain, ChangePace, GoesAway, Pause, StopRobot
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.app.typed_line import Several, Typed, read_typed

LINES = Path(__file__).with_suffix(".toml")
BINGO = load_activity("bingo")
NAMES = ("Ada", "Otto")
READ: dict[str, tuple[object, ...]] = {
    "where": (Perform("why"),),
    "todo": (Perform("why"),),
    "slower": (ChangePace(-1),),
    "faster": (ChangePace(1),),
    "left": (GoesAway("ada"), GoesAway("otto")),
    "left_two": (Several((GoesAway("ada"), GoesAway("otto"))),),
    "new_game": (Perform("next"),),
    "fall": (StopRobot(),),
    "pause": (Pause(),),
    "repeat": (CallAgain(),),
}
"""What lines may be read as, besides a question about the topic of the same name."""
OFFERED = {
    "slower": ("slower",),
    "faster": ("faster",),
    "left": ("left Ada", "left Otto"),
    "left_two": ("left Ada and Otto",),
    "new_game": ("next game",),
    "fall": ("stop", "pause"),
    "pause": ("pause",),
    "repeat": ("call again",),
    "louder": ("call again",),
    "come_here": ("take over",),
    "end": ("end",),
    "where": ("why",),
}


def find(wanted: str) -> str:
    """Return the id of a person by name."""
    if wanted.casefold() not in ("ada", "otto"):
        raise TangyError(f"There is nobody called {wanted!r}.")
    return wanted.casefold()


def read(line: str) -> Typed | None:
    """Read a line as the screen does."""
    try:
        return read_typed(line, command_reader(BINGO, find), find, lambda action: True, BINGO.rules)
    except TangyError:
        return None


def result_of(wish: str, line: str) -> str:
    """Return what becomes of a line with which somebody wants something."""
    said = read(line)
    if said is not None:
        asked = getattr(said, "topic", "").replace(" ", "_")
        return "right" if asked == wish or said in READ.get(wish, ()) else "wrong"
    near = nearest_commands(line, NAMES, BINGO.rules)
    if not near:
        return "nothing"
    return "offered" if {*near} & {*OFFERED.get(wish, ())} else "wrong"


def counts_of(name: str, tell: Callable[[str], None] = lambda line: None) -> Counter[str]:
    """Return how many lines of a set are right, offered, nothing or wrong."""
    results = Counter[str]()
    for wish, lines in tomllib.loads(LINES.read_text())[name].items():
        for line in lines:
            became = result_of(wish, line)
            results[became] += 1
            if became != "right":
                near = nearest_commands(line, NAMES, BINGO.rules)
                tell(f"  {became}: {wish}: {line!r} -> {read(line) or near}")
    return results


def main() -> None:
    """Print a table."""
    for name in ("from_staff", "development", "held"):
        show = print if "--all" in sys.argv and name != "held" else lambda line: None
        counts = counts_of(name, show)
        each = ", ".join(f"{one} {counts[one]}" for one in ("right", "offered", "nothing", "wrong"))
        print(f"{name}: {counts.total()} lines: {each}")


if __name__ == "__main__":
    main()
