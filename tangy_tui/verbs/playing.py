"""What the verbs that play games share: who answers, who clears, and by which policy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.verbs.common import print_json
from tangy_tui.verbs.opening import say_notices

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policy import Policy

PolicyName = Annotated[
    str,
    typer.Option("--policy", help="The policy to play by: a name or a digest; default the last."),
]
Teacher = Annotated[
    str | None,
    typer.Option("--teacher", help="Who answers where Tangy asks; 'scripted' knows the game."),
]
Expert = Annotated[
    str,
    typer.Option(
        "--expert", help="Who clears what halts Tangy; 'scripted' mends it. Default: you."
    ),
]
SCRIPTED = "scripted"
"""Who answers, or clears, by what the activity expects."""


def who_answers(teacher: str | None, expert: str) -> str:
    """Return who answers where Tangy asks.

    Raises:
        TangyError: there is no such expert.
    """
    from tangy_tui.app.workspace import teacher_name

    if expert not in ("", SCRIPTED):
        raise TangyError(plain(f"--expert {expert}: there is only 'scripted'."))
    return teacher_name(teacher)


def recall(workspace: Workspace, wanted: str, *, quiet: bool) -> Policy:
    """Return the policy to play by; say what is to be known before, also of the last game.

    Args:
        workspace: whose policy it is.
        wanted: its name or digest, "" for the last one.
        quiet: whether the last game is left out.

    Raises:
        TangyError: there is no such policy.
    """
    from tangy_tui.learning.policies import load_policy
    from tangy_tui.monitoring.games import uncleared

    learnt, notices = load_policy(workspace.store, workspace.activity, wanted)
    left = None if quiet else uncleared(workspace.store)
    if left is not None:
        last = f"The last game ended with a fault that nobody cleared: {left.name}."
        notices = [*notices, last]
    say_notices(notices)
    return learnt


INJECT_HELP = "help"
"""The word that lists the faults instead of bringing one about."""


def list_injections(as_json: bool) -> None:
    """Print the faults that can be brought about: each with what happens and when it shows."""
    from tangy_sim.worlds.injection import KINDS

    if as_json:
        print_json([{"fault": k.name, "what": k.words, "shows": k.shows} for k in KINDS.values()])
        return
    width = max(map(len, KINDS))
    for kind in KINDS.values():
        when = kind.shows if kind.shows == "at once" else f"while {kind.shows}"
        print(f"{kind.name:<{width}}  {kind.words} (shows {when})")
    print(f"\nAs in: --inject {next(iter(KINDS))}@12. After @ comes a step, after ~ a chance.")
