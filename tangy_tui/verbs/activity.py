"""`tangy activity`: list activities, check their files, and write new ones."""

from __future__ import annotations

import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.activity_parts import GAME, VISIT
from tangy_profiles.defaults import DEFAULT_ACTIVITY, TO_BEGIN_WITH
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.given_file import lines_of
from tangy_profiles.reading import plain
from tangy_tui.text.remarks import no_own_phrase
from tangy_tui.verbs.common import (
    REGISTERED,
    ActivityName,
    Data,
    Json,
    Seed,
    Users,
    hand_on_options,
    print_json,
    print_line,
)
from tangy_tui.verbs.opening import open_workspace

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.robot import Robot
    from tangy_tui.language.activity_check import CheckedFile

app = typer.Typer(
    rich_markup_mode=None,
    help="List activities, check their files, write new ones. Without a command: list them.",
)

SHOWN = 4  # people with whom phrases are tried: most behaviours can be aimed at a person


@app.callback(invoke_without_command=True)
def activities(context: typer.Context, as_json: Json = False) -> None:
    """List the activities, where no verb is given."""
    if context.invoked_subcommand is None:
        activity_list(as_json=as_json)
    else:
        hand_on_options(context)


@app.command("list")
def activity_list(data: Data = None, as_json: Json = False) -> None:
    """List the activities of Tangy and of other packages."""
    from tangy_profiles.activity import known_activities, load_activity, shipped_activities
    from tangy_profiles.errors import ProfileError

    shipped = shipped_activities()
    found = []
    for name in sorted(known_activities()):
        try:
            found.append((name, load_activity(name)))
        except ProfileError:
            if name in shipped:
                raise  # an activity of another package; `tangy doctor` tells its mistake
    if as_json:
        print_json([_activity_document(name, activity) for name, activity in found])
        return
    from tangy_tui.ui.check_report import print_activities

    print_activities(found)


@app.command("check")
def activity_check(
    files: Annotated[
        list[str] | None,
        typer.Argument(metavar="[FILE_OR_NAME...]", help="Default: all shipped activities."),
    ] = None,
    faults: Annotated[
        list[Path] | None, typer.Option("--faults", metavar="FILE", help="A file of fault rules.")
    ] = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Check activities and fault rules.

    Every mistake is one line, with the nearest valid word.

    A file that holds `faults` is read as fault rules. The exit status is 2 if there is a mistake.
    """
    from tangy_profiles.activity import shipped_activities
    from tangy_profiles.robot import load_robot
    from tangy_tui.monitoring.rules import check_rules

    robot = load_robot()
    names, books = [], list[Path | None](faults or [])
    for file in files or []:
        path = Path(file)
        if _holds_faults(file):
            books.append(path)
        else:
            names.append(file)
    if not names and not books:
        names, books = list(shipped_activities()), [None]
    checked = [checked_file(name, robot) for name in names]
    rules = [check_rules(robot, path) for path in books]
    mistakes = [line for one, _ in checked for line in one.mistakes]
    mistakes += [line for one in rules for line in one.mistakes]
    if as_json:
        told: list[dict[str, Any]] = [_checked_document(one, a) for one, a in checked]
        print_json({"ok": not mistakes, "files": told + [one.to_json() for one in rules]})
    else:
        from tangy_tui.ui import check_report

        for one, activity in checked:
            check_report.print_checked(one, activity)
        for book in rules:
            check_report.print_rules(book)
        for line in mistakes:
            for part in line.split("\n"):
                print_line(plain(part), to=sys.stderr)
    if mistakes:
        raise typer.Exit(2)


@app.command("show")
def activity_show(
    activity: Annotated[str, typer.Argument(help="An activity, or its TOML.")],
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show an activity: its stages, facts and behaviours."""
    from tangy_profiles.activity import load_activity
    from tangy_profiles.declared.activity import DeclaredActivity
    from tangy_tui.text.activities import activity_lines

    loaded = load_activity(activity)
    if as_json:
        print_json(_activity_document(loaded.name, loaded))
    elif isinstance(loaded, DeclaredActivity):
        for line in activity_lines(loaded):
            print(plain(line))
    else:
        from tangy_tui.ui.check_report import print_activities

        print_activities([(loaded.name, loaded)])


@app.command("try")
def activity_try(
    activity: Annotated[str, typer.Argument(help="An activity, or its TOML.")],
    users: Users = TO_BEGIN_WITH,
    seed: Seed = 1,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Play a game as the activity's file expects it.

    It prints the game step by step.
    """
    from tangy_profiles.activity import load_activity
    from tangy_tui.app.trying import tried_game
    from tangy_tui.text.activities import TRIED, people_did, tried_lines

    steps = []
    for step in tried_game(load_activity(activity), users, seed or 1):
        if as_json:
            steps.append(asdict(step))
            continue
        for line in (*tried_lines(step), people_did(step.doing, step.silent)):
            if line:
                print_line(plain(line))
    print_json({"steps": steps, "finished": True}) if as_json else print(TRIED)


@app.command("use")
def activity_use(
    activity: Annotated[str, typer.Argument(help="An activity, or its TOML.")],
    data: Data = None,
) -> None:
    """Teach and play this activity by default."""
    from tangy_profiles.activity import load_activity
    from tangy_tui.app.chosen_activity import choose_activity
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.text.activities import chosen_words

    print(plain(chosen_words(load_activity(choose_activity(data_folder(data), activity)).title)))


@app.command("phrases")
def activity_phrases(
    activity: Annotated[
        str, typer.Argument(help="A shipped activity, or its TOML.")
    ] = DEFAULT_ACTIVITY,
    forget: Annotated[
        str | None, typer.Option(metavar="PHRASE", help="Remove a phrase of your own.")
    ] = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Show what you can say, and how it is pronounced."""
    from tangy_tui.language.phrase_list import list_phrases
    from tangy_tui.learning.own_phrases import forget_phrase, own_phrases, personal_activity

    with open_workspace(data, activity, users, write=forget is not None) as workspace:
        whose = (workspace.store, workspace.activity.name, workspace.teacher)
        if forget is not None and not forget_phrase(*whose, forget):
            raise TangyError(plain(no_own_phrase(forget, workspace.teacher)))
        own = own_phrases(*whose)
        listed = list_phrases(personal_activity(workspace.activity, own), workspace.people, own)
    if as_json:
        print_json(listed.to_json())
    else:
        from tangy_tui.ui.check_report import print_phrases

        print_phrases(listed)


@app.command("hear")
def activity_hear(
    text: Annotated[
        str, typer.Argument(metavar="WORDS_OR_PHONES", help="Words, or the phones in capitals.")
    ],
    sink: Annotated[
        str, typer.Option(help="What plays it: auto, the name of a program, or null.")
    ] = "auto",
    activity: ActivityName = DEFAULT_ACTIVITY,
    as_json: Json = False,
) -> None:
    """Say words or ARPAbet phones, as Tangy hears them.

    It prints the phones.
    """
    import asyncio

    from tangy_profiles.activity import load_activity
    from tangy_tui.app.aloud import hear
    from tangy_tui.language.lexicon import phones_of

    phones = phones_of(text, load_activity(activity))
    if not as_json:
        print(phones)
    asyncio.run(hear(phones, sink=sink))
    if as_json:
        print_json({"text": text, "phones": phones})


def _holds_faults(file: str) -> bool:
    """Return whether a file holds fault rules; a file that cannot be read is reported later."""
    from tangy_profiles.reading import read_toml

    if not file.endswith(".toml"):
        return False
    try:
        return "faults" in read_toml(Path(file))
    except ProfileError:
        return False


def checked_file(name: str, robot: Robot) -> tuple[CheckedFile, Activity | None]:
    """Check the file of an activity; return the activity, too, if it can be read."""
    from tangy_profiles.activity import load_activity
    from tangy_profiles.declared.activity import DeclaredActivity
    from tangy_profiles.declared.checking import findings
    from tangy_profiles.declared.source import MistakesError
    from tangy_profiles.person import load_people
    from tangy_profiles.room import load_room
    from tangy_tui.language.activity_check import CheckedFile, check_activity
    from tangy_tui.text.activities import separator_notes, table_lines, uneven_notes, without_words
    from tangy_tui.text.activity_search import dead_end_lines, finding_words, search_lines

    try:
        activity = load_activity(name)
    except MistakesError as error:
        return CheckedFile(plain(Path(name).name), error.lines), None
    except ProfileError as error:
        return CheckedFile(plain(Path(name).name), (str(error),)), None
    people = load_room().placed(load_people(SHOWN))
    checked = check_activity(activity, robot, people, lines_in_file(name, activity))
    if checked.mistakes:  # the search can take long: mend these first
        return checked, activity
    if isinstance(activity, DeclaredActivity):
        found = findings(activity)
        flaws, mistakes = list[str](), list[str]()
        for one in found.flaws:
            lines = (finding_words(activity.source, one), *dead_end_lines(activity, one))
            told = "\n    ".join(map(plain, lines))
            mistakes.append(told) if one.endless else flaws.append(told)
        searched = search_lines(found, teams=bool(activity.teams))
        notes = map(plain, (*separator_notes(activity), *uneven_notes(activity), *searched))
        warnings = (
            *map(plain, table_lines(activity)),
            *checked.warnings,
            *flaws,
            *map(plain, without_words(activity)),
        )
        checked = replace(checked, mistakes=tuple(mistakes), warnings=warnings, notes=tuple(notes))
    return checked, activity


def lines_in_file(name: str, activity: Activity) -> dict[str, int]:
    """Return the lines of the behaviours in the file of an activity; none if it is no file."""
    from tangy_profiles.toml_lines import line_of

    path = Path(name)
    if not path.is_file():
        return {}
    text = lines_of(path.read_bytes())
    found = {one: line_of(text, ("behaviours", one)) for one in activity.behaviours}
    return {one: line for one, line in found.items() if line is not None}


def _activity_document(name: str, activity: Activity) -> dict[str, Any]:
    return {
        "name": name,
        "title": activity.title,
        "file": activity.source,
        "stages": list(activity.stages),
        "situations": [list(situation) for situation in activity.situations],
        "behaviours": list(activity.behaviours),
        "strategies": list(activity.strategies),
    }


def _asking_document(activity: Activity) -> dict[str, int]:
    return {VISIT: activity.asking.visit, GAME: activity.asking.game}


def _checked_document(checked: CheckedFile, activity: Activity | None) -> dict[str, Any]:
    told = {} if activity is None else _activity_document(activity.name, activity)
    return {
        **told,
        "file": checked.file,
        "kind": "activity",
        **({} if activity is None else _asking_document(activity)),
        "mistakes": list(checked.mistakes),
        "warnings": list(checked.warnings),
        "notes": list(checked.notes),
    }
