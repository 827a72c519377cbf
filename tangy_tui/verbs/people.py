"""`tangy people`: who takes part, what works with them, and corrections by staff."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import GameWorld, read_game_world
from tangy_profiles.persuading import known_methods
from tangy_profiles.reading import nearest, plain
from tangy_tui.text.names import (
    conflict_words,
    known_now,
    naming_lines,
    renamed,
    say_otherwise,
)
from tangy_tui.text.numbers import listed
from tangy_tui.verbs.common import (
    REGISTERED,
    ActivityName,
    Data,
    Json,
    Seed,
    Users,
    as_given,
    hand_on_options,
    print_json,
)
from tangy_tui.verbs.opening import open_workspace

if TYPE_CHECKING:
    from tangy_profiles.person import Person
    from tangy_profiles.persuading import PersuasionConfig
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.interaction.feedback import FeedbackEntry
    from tangy_tui.interaction.record import PersonSummary

app = typer.Typer(
    rich_markup_mode=None,
    help="Show who takes part, and what works with them. Without a command: list them.",
)

Who = Annotated[str, typer.Argument(metavar="PERSON", help="An id or a name.")]
WhoseGames = Annotated[
    str,
    typer.Option(
        "--world",
        help="Whose games count: simulated, bench or live; default: as in the last game.",
    ),
]
Strategy = Annotated[str, typer.Argument(help="A persuasive strategy of the activity.")]


@app.callback(invoke_without_command=True)
def people(
    context: typer.Context,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """List the people, where no verb is given."""
    if context.invoked_subcommand is None:
        people_list(activity, seed, data, users, as_json=as_json)
    else:
        hand_on_options(context)


@app.command("list")
def people_list(
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    world: WhoseGames = "",
    as_json: Json = False,
) -> None:
    """List the people, with how often each strategy has worked."""
    from tangy_tui.text.documents import person_document
    from tangy_tui.ui import people_report

    with open_workspace(data, activity, users, write=False) as workspace:
        records = workspace.records(world=_world(world))
        if as_json:
            print_json([person_document(record) for record in records])
        else:
            people_report.print_people(records)


@app.command("show")
def people_show(
    person: Who,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    world: WhoseGames = "",
    as_json: Json = False,
) -> None:
    """Show what works with a person, game by game."""
    from tangy_tui.ui import people_report

    with open_workspace(data, activity, users, write=False) as workspace:
        record = _record(workspace, workspace.find_person(person), _world(world))
        if not _printed(record, as_json):
            people_report.print_person(record)


@app.command("history")
def people_history(
    person: Who,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    world: WhoseGames = "",
    as_json: Json = False,
) -> None:
    """List what a person was asked to do.

    It goes game by game, with the numbers that `void` takes.
    """
    from tangy_tui.text.documents import entry_document
    from tangy_tui.ui import people_report

    with open_workspace(data, activity, users, write=False) as workspace:
        record = _record(workspace, workspace.find_person(person), _world(world))
        if as_json:
            print_json([entry_document(entry) for entry in record.history])
        else:
            people_report.print_history(record)


@app.command("void")
def people_void(
    person: Who,
    number: Annotated[
        int | None, typer.Argument(help="Its number in the history; without one, the last.")
    ] = None,
    why: Annotated[str, typer.Option(help="The reason, for the log.")] = "",
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    world: WhoseGames = "",
    as_json: Json = False,
) -> None:
    """Void a response ("that was not compliance")."""
    with _changing(data, activity, users, person, as_json, world) as (workspace, found):
        memory = workspace.memory(_world(world))
        entry = _numbered(memory.history(found.id), number, found)
        memory.feedback.void(found.id, entry.seq, plain(why))
        if not as_json:
            print(plain(f"Void: {_entry_words(entry)}."))


@app.command("feedback")
def people_feedback(
    person: Who,
    strategy: Strategy,
    complied: Annotated[str, typer.Argument(metavar="yes|no", help="Whether they complied.")],
    of: Annotated[
        int | None, typer.Option(help="The number in the history of the request it answers.")
    ] = None,
    seen: Annotated[
        bool, typer.Option("--seen", help="Staff asked the person: the log has no request.")
    ] = False,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    world: WhoseGames = "",
    as_json: Json = False,
) -> None:
    """Say later what a person did when asked."""
    with _changing(data, activity, users, person, as_json, world) as (workspace, found):
        memory = workspace.memory(_world(world))
        _known(strategy, workspace.activity.strategies, "strategy")
        _known(complied, ("yes", "no"), "answer")
        if seen and of is not None:
            raise TangyError("Choose one: --of for a request in the history, or --seen for none.")
        history = memory.history(found.id)
        request = None if seen else _awaiting(history, strategy, of, found)
        of_seq = None if request is None else request.seq
        given = memory.feedback.give(found.id, strategy, complied == "yes", of_seq)
        if not as_json:
            print(plain(f"Said: {_entry_words(given)}."))


@app.command("switch")
def people_switch(
    person: Who,
    strategy: Strategy,
    state: Annotated[str, typer.Argument(metavar="on|off")],
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Switch a strategy off for a person, or on again."""
    with _changing(data, activity, users, person, as_json) as (workspace, found):
        strategies = workspace.activity.strategies
        _known(strategy, strategies, "strategy")
        _known(state, ("on", "off"), "state")
        workspace.memory().feedback.switch(found.id, strategy, state == "on", strategies)


@app.command("method")
def people_method(
    person: Who,
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="WORDS...",
            help=f"{listed(known_methods(), 'or')}; uniform or people (where beliefs begin); a "
            "share that is kept, such as 0.98, with each interaction or day (1: all is kept). "
            "Options you leave out stay as they are. Or: default.",
        ),
    ],
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Choose how Tangy persuades one person.

    Options you leave out stay as they are. Only `default` returns to what the activity sets.
    """
    from tangy_profiles.persuading import DEFAULT

    with _changing(data, activity, users, person, as_json) as (workspace, found):
        memory = workspace.memory()
        chosen = None if words == [DEFAULT] else _changed(memory.recall(found.id).chosen, words)
        memory.feedback.choose_method(found.id, chosen)


@app.command("undo")
def people_undo(
    person: Who,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Undo the last void, feedback, switch or method.

    Again, and it undoes the one before. A new name is not undone: rename the person again.
    """
    from tangy_tui.text.people import change_words

    with _changing(data, activity, users, person, as_json) as (workspace, found):
        change = workspace.memory().feedback.undo(found.id)
        if not as_json:
            print(plain(f"Taken back: {change_words(change)}."))


@app.command("rename")
def people_rename(
    person: Who,
    name: Annotated[str, typer.Argument(help="The new name.")],
    seed: Seed = None,
    data: Data = None,
    users: Users = REGISTERED,
    as_json: Json = False,
) -> None:
    """Rename a person; Tangy keeps what it has learnt."""
    from tangy_tui.language.name_conflicts import find_clash
    from tangy_tui.language.name_pronunciation import how_said

    with open_workspace(data, DEFAULT_ACTIVITY, users) as workspace:
        found = workspace.find_person(person)
        workspace.rename(found, name)
        named = workspace.find_person(found.id)
        clash = find_clash(workspace.activity, workspace.people, named)
        if as_json:
            like = None if clash is None else clash.like
            named_so = {"id": named.id, "name": name, **how_said(named).to_json()}
            print_json({**named_so, "sounds_like": like})
            return
        print(renamed(named.id, plain(name)))
        verb = f"tangy people pronounce {named.id}{as_given(data, users)}"
        lines = naming_lines(how_said(named), verb)
        if clash is not None:
            lines = [conflict_words(clash), say_otherwise(f'{verb} "R OW Z AH"')]
        for line in lines:
            print(plain(line))


@contextmanager
def _changing(
    data: Path | None, activity: str, users: int, person: str, as_json: bool, world: str = ""
) -> Iterator[tuple[Workspace, Person]]:
    """Open the workspace for a change to a person; afterwards, print what is now known of them."""
    from tangy_tui.text.people import method_words, sentence

    with open_workspace(data, activity, users) as workspace:
        found = workspace.find_person(person)
        yield workspace, found
        record = _record(workspace, found, _world(world))
        if not _printed(record, as_json):
            print(plain(known_now(sentence(record), record.world)))
            off = sorted(record.known.off)
            print(plain(f"Method: {method_words(record)}.") + _off_words(off))


def _changed(chosen: PersuasionConfig, words: list[str]) -> PersuasionConfig:
    """Change only the settings of a method that the words mention."""
    from dataclasses import replace

    from tangy_profiles.persuading import PERIODS, PRIORS, known_methods, spoken_persuading

    spoken = spoken_persuading(words)  # refuses unknown words
    known = dict.fromkeys(known_methods(), "method") | dict.fromkeys(PRIORS, "prior")
    known |= dict.fromkeys(PERIODS, "forgetting_per")
    said = {known.get(word.casefold(), "forgetting") for word in words}
    return replace(chosen, **{key: getattr(spoken, key) for key in said})


def _entry_words(entry: FeedbackEntry) -> str:
    """Name a line of a history: number, strategy, time, and response."""
    from tangy_tui.text.people import entry_words
    from tangy_tui.text.times import on_day

    return f"number {entry.number}, {entry.strategy}, {on_day(entry.at)}, {entry_words(entry)}"


def _off_words(off: list[str]) -> str:
    return plain(f" Switched off: {', '.join(off)}.") if off else ""


def _record(workspace: Workspace, person: Person, world: GameWorld | None) -> PersonSummary:
    (record,) = workspace.records(person, world=world)
    return record


def _world(word: str) -> GameWorld | None:
    """Return the wanted world; None: that of the last game."""
    return read_game_world(word) if word else None


def _printed(record: PersonSummary, as_json: bool) -> bool:
    from tangy_tui.text.documents import person_document

    if as_json:
        print_json(person_document(record))
    return as_json


def _known(word: str, words: Iterable[str], what: str) -> None:
    """Refuse an unknown word, suggesting the nearest one."""
    if word not in words:
        raise TangyError(plain(f"There is no {what} {word!r}: {nearest(word, words)}"))


def _numbered(history: list[FeedbackEntry], number: int | None, person: Person) -> FeedbackEntry:
    """Return the history entry with a number; without one, the last that counts."""
    counting = [entry for entry in history if entry.counts]
    if number is None and counting:
        return counting[-1]
    for entry in history:
        if entry.number == number:
            return entry
    if number is None:
        raise TangyError(plain(f"{person.name} has no response that counts."))
    most = f"1 to {len(history)}" if history else "none yet"
    raise TangyError(plain(f"{person.name} has no response number {number}: there are {most}."))


def _awaiting(
    history: list[FeedbackEntry], strategy: str, of: int | None, person: Person
) -> FeedbackEntry:
    """Return the request that late feedback answers: the numbered one, or the last open one."""
    if of is not None:
        return _numbered(history, of, person)
    waiting = [entry for entry in history if entry.open and entry.strategy == strategy]
    if not waiting:
        raise TangyError(
            plain(
                f"No request to {person.name} with {strategy} waits for an answer: void a wrong "
                f"answer first, or add --seen if staff asked themselves."
            )
        )
    return waiting[-1]
