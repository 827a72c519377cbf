"""`tangy play` and `tangy demo`: let Tangy run games, and see the whole story."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_tui.verbs.common import (
    ActivityName,
    Ascii,
    Data,
    Games,
    Json,
    Seed,
    Users,
    full_screen,
    open_house,
    print_json,
    say_notices,
)

if TYPE_CHECKING:
    from tangy_tui.house import House


def play(
    games: Games = 1,
    users: Users = 4,
    headless: Annotated[bool, typer.Option("--headless", help="Without a screen.")] = False,
    activity: ActivityName = "bingo",
    speed: Annotated[float, typer.Option(min=1, max=1000, help="Times life, 1 to 1000.")] = 10,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """Let Tangy facilitate games in simulation, by the policy it has learnt."""
    from tangy_tui.learning.policies import load_policy, need_policy

    with open_house(data, activity, users) as house:
        need_policy(house.store, house.activity)
        if not (headless or as_json) and full_screen():
            from tangy_tui.ui.program import run_playing

            raise typer.Exit(
                run_playing(house, games=games, speed=speed, seed=seed, ascii_only=ascii_only)
            )
        learnt, notices = load_policy(house.store, house.activity)
        say_notices(notices)
        facilitation = house.facilitation(learnt, seed)
        if headless or as_json:
            _play_headless(house, facilitation, games, as_json)
        else:
            from tangy_tui.game_lines import play_by_lines

            play_by_lines(facilitation, games, house.name, print)


def demo(
    seed: Annotated[int, typer.Option(help="Another seed, other games.")] = 1,
    data: Data = None,
    plain_lines: Annotated[bool, typer.Option("--plain", help="By lines.")] = False,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """See the whole story in a minute: three demonstrations, learning, one game."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory(prefix="tangy-demo-") as scratch, open_house(
        data or Path(scratch), "bingo", 4
    ) as house:  # fmt: skip
        if full_screen() and not (plain_lines or as_json):
            from tangy_tui.ui.program import run_demo

            status = run_demo(house, seed=seed, ascii_only=ascii_only)
            print("Teach it yourself: tangy teach. All you can do: tangy --help.")
            raise typer.Exit(status)
        from tangy_tui.story import tell

        tally = tell(house, seed, (lambda _: None) if as_json else print)
        if as_json:
            print_json(tally)


def _play_headless(house: House, facilitation: Any, games: int, as_json: bool) -> None:
    from tangy_tui.interaction.tally import Tally
    from tangy_tui.ui import reports

    tally = Tally()
    for _ in reports.progress(range(games), "Playing", quiet=as_json or games < 20):
        with house.store.transaction():  # one commit a game: .1 ms a step instead of 4
            tally.add(facilitation.begin())
            while not facilitation.over:
                tally.add(facilitation.step())
    beliefs = facilitation.persuasion.beliefs
    if as_json:
        print_json(tally.to_json(house.activity.situations, beliefs))
    else:
        reports.print_tally(house, tally, beliefs)
