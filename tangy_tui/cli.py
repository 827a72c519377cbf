"""The command line: the one place where worlds, store and screens are put together.

Every verb prints one JSON document with `--json`. The exit status is 0 when done, 2 for bad input
(with one sentence on stderr), and 1 for anything else.
"""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui import __version__

if TYPE_CHECKING:
    from tangy_tui.house import House
    from tangy_tui.learning.demonstrating import Teaching
    from tangy_tui.learning.ears import Ears

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Teach a social robot a group activity, and let it run that activity for you.",
)
people_app = typer.Typer(rich_markup_mode=None, help="Who takes part, and what works with them.")
app.add_typer(people_app, name="people")

Json = Annotated[bool, typer.Option("--json", help="Print one JSON document, nothing else.")]
Seed = Annotated[int | None, typer.Option(help="Repeat the same simulated games.")]
Data = Annotated[Path | None, typer.Option(help="The data folder, instead of your own.")]
ActivityName = Annotated[str, typer.Option("--activity", help="A shipped activity, or its TOML.")]
Users = Annotated[int, typer.Option(help="How many people take part, 1 to 8.")]
Ascii = Annotated[bool, typer.Option("--ascii", help="Draw with plain ASCII characters only.")]
Games = Annotated[int, typer.Option(min=1, help="How many games.")]


@app.callback(invoke_without_command=True)
def program(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Say the version.")] = False,
    data: Data = None,
    ascii_only: Ascii = False,
) -> None:
    """Open the program, where no verb is given."""
    if version:
        print(f"tangy {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        if not _full_screen():
            from tangy_tui.ui.terminal import terminal_kind

            print(f"No screens here ({terminal_kind().reason}): try `tangy teach --plain`.\n")
            print(context.get_help())
            return
        from tangy_tui.ui.program import run_program

        with _house(data, "bingo", 4) as house:
            raise typer.Exit(run_program(house, ascii_only=ascii_only))


@app.command()
def teach(
    activity: ActivityName = "bingo",
    script: Annotated[Path | None, typer.Option(help="Take the lines from a file.")] = None,
    mic: Annotated[
        str | None, typer.Option(help="Listen to FILE.wav, - (standard input) or arecord.")
    ] = None,
    plain_lines: Annotated[
        bool, typer.Option("--plain", help="By lines, for any terminal.")
    ] = False,
    teacher: Annotated[
        str | None, typer.Option(help="Whose demonstration it is; 'scripted' for the built-in one.")
    ] = None,
    games: Games = 1,
    speed: Annotated[
        float | None,
        typer.Option(min=0.1, max=1000, help="Watch the scripted teacher, x times life."),
    ] = None,
    users: Users = 4,
    new: Annotated[bool, typer.Option("--new", help="Leave an unfinished game as it is.")] = False,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """Demonstrate an activity: say or type what Tangy should do, and confirm with Y."""
    from tangy_tui.house import teacher_name

    who = plain(teacher or teacher_name())[:40]
    from tangy_tui.inputs import keys_from_terminal

    sound = keys_from_terminal(script) if mic == "-" else 0
    with _house(data, activity, users) as house:
        teaching = house.teaching(who, seed)
        ears = _ears(mic, teaching, sound, house)
        if who == "scripted" and (speed is None or not _full_screen()):
            _teach_by_script(teaching, games, as_json)
        elif not (plain_lines or script or as_json) and _full_screen():
            from tangy_tui.ui.program import run_teaching

            status = run_teaching(
                house, teaching, ears=ears, resume=not new, games=games, speed=speed,
                ascii_only=ascii_only,
            )  # fmt: skip
            raise typer.Exit(status)
        else:
            _teach_by_lines(teaching, script, ears, as_json, resume=not new)


@app.command()
def learn(
    activity: ActivityName = "bingo",
    forest: Annotated[str, typer.Option(help="exact, or paper for its bagging.")] = "exact",
    name: Annotated[str, typer.Option(help="What to call the policy.")] = "",
    unfinished: Annotated[
        bool, typer.Option("--unfinished", help="Learn from unfinished demonstrations too.")
    ] = False,
    seed: Annotated[int, typer.Option(help="The seed of the forest.")] = 0,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Learn a policy from the demonstrations."""
    from dataclasses import replace

    from tangy_profiles.reading import nearest
    from tangy_tui.documents import policy_document
    from tangy_tui.learning.library import keep_policy, read_demonstrations
    from tangy_tui.learning.policy import FORESTS, learn_policy
    from tangy_tui.wording import counted

    if forest not in FORESTS:
        raise TangyError(f"--forest {plain(forest)}: {nearest(forest, FORESTS)}")
    with _house(data, activity, 4) as house:
        shown = read_demonstrations(house.store, house.activity.name)
        used = [d for d in shown if d.finished or (unfinished and d.steps)]
        left_out = sum(1 for d in shown if d.steps and d not in used)
        policy = learn_policy(
            house.activity,
            used,
            settings=replace(FORESTS[forest], seed=seed),
            name=plain(name)[:40],
        )
        keep_policy(house.store, policy)
        seen = [s for s in house.activity.situations if policy.decide(s).seen]
        if as_json:
            _print_json(
                {
                    **policy_document(house, policy),
                    "steps": sum(len(d.steps) for d in used),
                    "left_out": left_out,
                }
            )
            return
        steps = sum(len(d.steps) for d in used)
        print(
            f"Learnt {policy.name!r} from {counted(len(used), 'demonstration')} ({steps} steps): "
            f"{len(seen)} of {len(house.activity.situations)} situations were shown."
        )
        for situation in house.activity.situations:
            if situation not in seen:
                print(f"  not shown yet: {house.activity.in_words(situation)}")
        if left_out:
            print(
                f"{counted(left_out, 'unfinished demonstration')} left out; "
                "--unfinished learns from them too."
            )


@app.command()
def policy(
    activity: ActivityName = "bingo",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show what was learnt: every situation, what Tangy does there, and what follows."""
    from tangy_tui.documents import policy_document
    from tangy_tui.learning.library import effects_of, load_policy
    from tangy_tui.ui import reports

    with _house(data, activity, 4, write=False) as house:
        learnt, notices = load_policy(house.store, house.activity)
        _say_notices(notices)
        if as_json:
            _print_json(policy_document(house, learnt))
        else:
            effects = effects_of(house.store, house.activity, learnt)
            reports.print_policy(house.activity, learnt, effects)


@app.command()
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
    from tangy_tui.learning.library import load_policy, need_policy

    with _house(data, activity, users) as house:
        need_policy(house.store, house.activity)
        if not (headless or as_json) and _full_screen():
            from tangy_tui.ui.program import run_playing

            raise typer.Exit(
                run_playing(house, games=games, speed=speed, seed=seed, ascii_only=ascii_only)
            )
        learnt, notices = load_policy(house.store, house.activity)
        _say_notices(notices)
        facilitation = house.facilitation(learnt, seed)
        if headless or as_json:
            _play_headless(house, facilitation, games, as_json)
        else:
            from tangy_tui.lines import play_by_lines

            play_by_lines(facilitation, games, house.name, print)


@app.command()
def demo(
    seed: Annotated[int, typer.Option(help="Another seed, other games.")] = 1,
    data: Data = None,
    plain_lines: Annotated[bool, typer.Option("--plain", help="By lines.")] = False,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """See the whole story in a minute: three demonstrations, learning, one game."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory(prefix="tangy-demo-") as scratch, _house(
        data or Path(scratch), "bingo", 4
    ) as house:  # fmt: skip
        if _full_screen() and not (plain_lines or as_json):
            from tangy_tui.ui.program import run_demo

            status = run_demo(house, seed=seed, ascii_only=ascii_only)
            print("Teach it yourself: tangy teach. All you can do: tangy --help.")
            raise typer.Exit(status)
        from tangy_tui.story import tell

        tally = tell(house, seed, (lambda _: None) if as_json else print)
        if as_json:
            _print_json(tally)


@app.command()
def listen(
    files: Annotated[list[Path], typer.Argument(help="WAV files with one spoken command each.")],
    activity: ActivityName = "bingo",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Hear spoken commands in WAV files, and say what was understood."""
    from tangy_profiles.activity import load_activity
    from tangy_profiles.person import load_people
    from tangy_tui.learning import speech
    from tangy_tui.learning.commands import Phrasebook

    heard = speech.listen(files, Phrasebook(load_activity(activity), load_people(4)))
    if as_json:
        _print_json(heard)
        return
    for one in heard:
        meaning = one["behaviour"] or "not understood"
        print(plain(f"{one['file']}: {one['heard']!r} -> {meaning} ({one['confidence']:.0%})"))


@people_app.command("list")
def people_list(
    seed: Seed = None, data: Data = None, users: Users = 4, as_json: Json = False
) -> None:
    """List the people, with how often each strategy has worked."""
    from tangy_tui.documents import person_document
    from tangy_tui.ui import reports

    with _house(data, "bingo", users, write=False) as house:
        if as_json:
            _print_json([person_document(house, person) for person in house.people])
        else:
            reports.print_people(house)


@people_app.command("show")
def people_show(
    person: Annotated[str, typer.Argument(help="An id or a name.")],
    seed: Seed = None,
    data: Data = None,
    users: Users = 4,
    as_json: Json = False,
) -> None:
    """Show one person: every strategy with counts, mean and P(best)."""
    from tangy_tui.documents import person_document
    from tangy_tui.ui import reports

    with _house(data, "bingo", users, write=False) as house:
        found = house.find_person(person)
        if as_json:
            _print_json(person_document(house, found))
        else:
            reports.print_person(house, found)


@people_app.command("rename")
def people_rename(
    person: Annotated[str, typer.Argument(help="An id or a name.")],
    name: Annotated[str, typer.Argument(help="The new name.")],
    seed: Seed = None,
    data: Data = None,
    users: Users = 4,
    as_json: Json = False,
) -> None:
    """Give a person another name; what Tangy has learnt of them stays."""
    with _house(data, "bingo", users) as house:
        found = house.find_person(person)
        house.rename(found, name)
        if as_json:
            _print_json({"id": found.id, "name": name})
        else:
            print(f"{found.id} is now called {plain(name)}.")


@app.command()
def doctor(seed: Seed = None, data: Data = None, as_json: Json = False) -> None:
    """Say what of this machine works: terminal, store, speech, voice, microphone."""
    from tangy_tui.doctor import examine
    from tangy_tui.house import data_folder

    findings = examine(data_folder(data))
    if as_json:
        _print_json([{"part": f.part, "ok": f.ok, "text": f.text} for f in findings])
        return
    for finding in findings:
        print(f"{'ok     ' if finding.ok else 'missing'}  {finding.part}: {finding.text}")


# ------------------------------------------------------------------------------------ parts


@contextmanager
def _house(data: Path | None, activity: str, users: int, *, write: bool = True) -> Iterator[House]:
    from tangy_tui.house import House, data_folder

    house = House(data_folder(data), activity=activity, users=users, write=write)
    try:
        _say_notices(house.store.notices)
        yield house
    finally:
        house.close()


def _full_screen() -> bool:
    from tangy_tui.ui.terminal import terminal_kind

    return terminal_kind().full_screen


def _teach_by_script(teaching: Teaching, games: int, as_json: bool) -> None:
    from tangy_tui.documents import demonstration_document
    from tangy_tui.learning.demonstrating import Finished, Next
    from tangy_tui.learning.scripted_teacher import ScriptedTeacher

    scripted = ScriptedTeacher(teaching)
    teaching.begin()
    done = []
    for number in range(games):
        if number:
            teaching.apply(Next())
        for event in scripted.demonstrate():
            if isinstance(event, Finished):
                done.append(event.demonstration)
                shown = {step.state.situation for d in done for step in d.steps}
                if not as_json:
                    print(
                        f"Demonstration {number + 1} (game {event.demonstration.seed}): "
                        f"{len(event.demonstration.steps)} steps; "
                        f"{len(shown)} of {len(teaching.activity.situations)} situations "
                        "shown so far."
                    )
    if as_json:
        _print_json({"demonstrations": [demonstration_document(d) for d in done]})


def _teach_by_lines(
    teaching: Teaching, script: Path | None, ears: Ears | None, as_json: bool, *, resume: bool
) -> None:
    from tangy_tui.documents import demonstration_document
    from tangy_tui.inputs import line_reader
    from tangy_tui.lines import TeachingLines

    write: Callable[[str], None] = (lambda _: None) if as_json else _print_line
    lines = TeachingLines(teaching, line_reader(script), write, ears, scripted=script is not None)
    asyncio.run(lines.run(resume=resume))
    if as_json:
        _print_json({"demonstrations": [demonstration_document(teaching.demonstration)]})


def _ears(mic: str | None, teaching: Teaching, sound: int, house: House) -> Ears | None:
    if mic is None:
        return None
    from tangy_tui.learning.ears import Ears

    return Ears(mic, teaching.phrasebook, stdin=sound, log=house.store.folder / "speech.log")


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
        _print_json(tally.to_json(house.activity.situations, beliefs))
    else:
        reports.print_tally(house, tally, beliefs)


def _say_notices(notices: list[str]) -> None:
    for notice in notices:
        print(f"tangy: {plain(notice)}", file=sys.stderr)


def _print_line(line: str) -> None:
    print(line, flush=True)


def _print_json(document: Any) -> None:
    print(json.dumps(document, ensure_ascii=False, indent=2))


def main() -> None:
    """Run the command line and exit with its status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without UTF-8 still gets its line
    try:
        status = app(standalone_mode=False)
    except TangyError as error:
        print(f"tangy: {error}", file=sys.stderr)
        status = 2
    except BrokenPipeError:
        sys.stderr.close()  # whoever read our output has had enough
        status = 1
    except KeyboardInterrupt:
        status = 130
    except (typer.Abort, typer.Exit) as stop:
        status = getattr(stop, "exit_code", 130)
    except Exception as error:
        # Typer carries its own copy of Click, whose usage errors have no public base class.
        if not hasattr(error, "format_message"):
            raise
        print(f"tangy: {plain(error.format_message())}", file=sys.stderr)
        status = 2
    sys.exit(status if isinstance(status, int) else 0)
