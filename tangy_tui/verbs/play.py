"""`tangy play` and `tangy demo`: let Tangy run games, and see the whole story."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.reading import plain
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
    print_line,
    say_notices,
)

if TYPE_CHECKING:
    from tangy_tui.house import House
    from tangy_tui.learning.asking import Lesson


def play(
    games: Games = 1,
    users: Users = 4,
    headless: Annotated[bool, typer.Option("--headless", help="Without a screen.")] = False,
    activity: ActivityName = "bingo",
    policy: Annotated[
        str, typer.Option(help="The policy to play by: a name or a digest; default the last.")
    ] = "",
    teacher: Annotated[
        str | None, typer.Option(help="Who answers where Tangy asks; 'scripted' knows the game.")
    ] = None,
    speed: Annotated[float, typer.Option(min=1, max=1000, help="Times life, 1 to 1000.")] = 10,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """Let Tangy facilitate games in simulation, by the policy it has learnt.

    Where nobody has shown it what to do, it asks a teacher, and goes on with the answer. Without
    one (--headless or --json) the game stops there.
    """
    from tangy_tui.house import teacher_name
    from tangy_tui.learning.policies import load_policy, need_policy

    who = plain(teacher or teacher_name())[:40]
    with open_house(data, activity, users) as house:
        need_policy(house.store, house.activity, policy)
        if not (headless or as_json) and full_screen():
            from tangy_tui.ui.run import run_playing

            raise typer.Exit(
                run_playing(
                    house,
                    games=games,
                    speed=speed,
                    seed=seed,
                    policy=policy,
                    teacher=who,
                    ascii_only=ascii_only,
                )
            )
        learnt, notices = load_policy(house.store, house.activity, policy)
        say_notices(notices)
        by_lines = not (headless or as_json)
        scripted = who == "scripted"
        facilitation = house.facilitation(learnt, seed, asks=by_lines or scripted)
        if not by_lines:
            _play_headless(house, facilitation, games, as_json)
            return
        from tangy_tui.game_lines import play_by_lines
        from tangy_tui.inputs import line_reader
        from tangy_tui.learning.library import read_library

        read = None if scripted else line_reader(None)
        play_by_lines(
            facilitation,
            games,
            house.name,
            print_line,
            read,
            who,
            demonstrations=lambda: [
                entry.demonstration
                for entry in read_library(house.store, house.activity.name).entries.values()
            ],
        )


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
            from tangy_tui.ui.run import run_demo

            status = run_demo(house, seed=seed, ascii_only=ascii_only)
            print("Teach it yourself: tangy teach. All you can do: tangy --help.")
            raise typer.Exit(status)
        from tangy_tui.story import tell

        tally = tell(house, seed, (lambda _: None) if as_json else print)
        if as_json:
            print_json(tally)


def _play_headless(house: House, facilitation: Any, games: int, as_json: bool) -> None:
    from tangy_tui.documents import lesson_document
    from tangy_tui.interaction.facilitation import Taught
    from tangy_tui.interaction.scripted_answers import answer_by_script
    from tangy_tui.interaction.tally import Tally
    from tangy_tui.ui import reports
    from tangy_tui.wording import lesson_words

    tally = Tally()
    lessons: list[Lesson] = []
    for _ in reports.progress(range(games), "Playing", quiet=as_json or games < 20):
        with house.store.transaction():  # one commit a game: .1 ms a step instead of 4
            tally.add(facilitation.begin())
            while not facilitation.over:
                tally.add(facilitation.step())
                if facilitation.question is not None:
                    answered = answer_by_script(facilitation)
                    tally.add(answered)
                    lessons += [event.lesson for event in answered if isinstance(event, Taught)]
    beliefs = facilitation.persuasion.beliefs
    if as_json:
        told = {"answers": [lesson_document(house, one) for one in lessons]} if lessons else {}
        print_json({**tally.to_json(house.activity.situations, beliefs), **told})
    else:
        for lesson in lessons:
            print(lesson_words(house.activity, lesson))
        reports.print_tally(house, tally, beliefs)
