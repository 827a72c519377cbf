"""Games with typed lines that are read only while Tangy waits."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_tui.app.game_controller import GameController
from tangy_tui.console.staff import StaffLines
from tangy_tui.monitoring.supervision import Supervision


def nobody(wanted: str) -> str:
    """Find no person."""
    raise TangyError(f"There is nobody called {wanted!r}.")


def play_by_turns(
    supervision: Supervision,
    *lines: str,
    games: int = 1,
    name: Callable[[str], str] = str,
    teacher: str = "Ada",
    demonstrations: Callable[[], Sequence[Demonstration]] | None = None,
    scripted: bool = False,
) -> list[str]:
    """Play games in which these lines are typed; return the output."""
    written: list[str] = []
    typed = iter(lines)
    control = GameController(supervision, teacher)
    staff = StaffLines(
        control,
        name,
        nobody,
        lambda: next(typed, None),
        written.append,
        demonstrations=demonstrations,
    )
    staff.run_by_turns(games, scripted=scripted)
    return written
