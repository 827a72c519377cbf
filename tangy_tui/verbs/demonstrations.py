"""`tangy demonstrations`: list and edit demonstrations, and settle their conflicts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text import conflicts as text
from tangy_tui.text.follow_up import follow_up
from tangy_tui.verbs.common import REGISTERED, ActivityName, Data, Json, Seed, print_json
from tangy_tui.verbs.opening import open_workspace

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.conflicts import Conflict
    from tangy_tui.learning.editing import Editor
    from tangy_tui.learning.library_entries import Edit

app = typer.Typer(
    rich_markup_mode=None, help="List and edit demonstrations, and settle their conflicts."
)

One = Annotated[str, typer.Argument(metavar="N", help="Its number in the list, or its id.")]
Unfinished = Annotated[
    bool, typer.Option("--unfinished", help="Include unfinished demonstrations.")
]
Some = Annotated[list[str], typer.Argument(metavar="N...", help="Numbers in the list, or ids.")]


@app.command("list")
def list_them(
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """List the demonstrations and their problems."""
    from tangy_tui.learning.demonstration_rows import list_rows
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.demonstrations import NONE_YET, row_document
    from tangy_tui.ui import reports

    with open_workspace(data, activity, REGISTERED, write=False) as workspace:
        rows = list_rows(workspace.activity, read_library(workspace.store, workspace.activity.name))
        if as_json:
            print_json([row_document(row) for row in rows])
        else:
            used = [row for row in rows if row.state != "undone"]
            reports.print_demonstrations(used, follow_up(NONE_YET, **workspace.call_options))


@app.command()
def show(
    demonstration: One,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show one demonstration, step by step."""
    from tangy_tui.learning.conflicts import called_wrong
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.documents import demonstration_document
    from tangy_tui.text.situations import step_words

    with open_workspace(data, activity, 8, write=False) as workspace:
        library = read_library(workspace.store, workspace.activity.name)
        entry = library.find(demonstration)
        shown = entry.demonstration
        if as_json:
            print_json({**demonstration_document(shown), "state": entry.hidden or "in use"})
            return
        print(plain(f"{library.name(shown.id)} ({shown.id}) by {shown.teacher}:"))
        for number, step in enumerate(shown.steps, 1):
            wrong = called_wrong(library.resolutions, step)
            failed = "" if step.completed else " (could not be done)"
            note = " (a teacher called it wrong)" if wrong else failed
            print(
                plain(f"{number:4}. {step_words(workspace.activity, step, workspace.name)}{note}")
            )


@app.command()
def delete(
    demonstrations: Some,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Put demonstrations away; `restore` brings them back.

    Tangy does not learn from them meanwhile.
    """
    _change(data, activity, as_json, lambda editor: editor.delete(*demonstrations))


@app.command()
def restore(
    demonstrations: Some,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Restore deleted demonstrations."""
    _change(data, activity, as_json, lambda editor: editor.restore(*demonstrations))


@app.command()
def merge(
    demonstrations: Some,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Merge several demonstrations into one, in the given order."""
    _change(data, activity, as_json, lambda editor: editor.merge(*demonstrations))


@app.command()
def split(
    demonstration: One,
    step: Annotated[int, typer.Argument(help="The first part ends with this step.")],
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Split a demonstration in two after a step."""
    _change(data, activity, as_json, lambda editor: editor.split(demonstration, step))


@app.command()
def undo(
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Take back the last of these changes."""
    _change(data, activity, as_json, lambda editor: editor.undo(), "Taken back: ")


@app.command()
def redo(
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Redo the change that you took back last."""
    _change(data, activity, as_json, lambda editor: editor.redo(), "Done again: ")


@app.command()
def conflicts(
    unfinished: Unfinished = False,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show where demonstrations disagree, side by side."""
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.documents import conflict_document
    from tangy_tui.text.situations import conflict_lines

    with open_workspace(data, activity, REGISTERED, write=False) as workspace:
        library = read_library(workspace.store, workspace.activity.name)
        found = library.all_conflicts if unfinished else library.conflicts
        if as_json:
            print_json([conflict_document(workspace, c) for c in found])
            return
        for number, conflict in enumerate(found, 1):
            first, *rest = conflict_lines(workspace.activity, library, conflict)
            print(f"Conflict {number}. {first}")
            for line in rest:
                print(line)
        options = workspace.call_options
        if found:
            print(follow_up(text.SETTLE_ONE, **options, unfinished=unfinished))
        else:
            print(plain(text.all_agree(workspace.activity.title)))


@app.command()
def resolve(
    conflict: Annotated[
        str, typer.Argument(metavar="N", help="The conflict's number, or its situation in words.")
    ],
    right: Annotated[
        list[str] | None, typer.Option(help="The answer that is right; may be repeated.")
    ] = None,
    instead: Annotated[
        str | None, typer.Option(help="The right behaviour, if nobody showed it.")
    ] = None,
    both: Annotated[bool, typer.Option("--both", help="All answers are right.")] = False,
    unfinished: Unfinished = False,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Say which answer is right in a situation.

    Tangy does not learn from the others.
    """

    def settle(editor: Editor) -> Edit:
        library = editor.library
        found = library.all_conflicts if unfinished else library.conflicts
        chosen = _chosen(found, conflict, editor.activity)
        if [bool(right), both, instead is not None].count(True) != 1:
            raise TangyError("Say which answer is right: --right ANSWER, or --both.")
        if instead is not None:
            return editor.resolve(chosen, editor.activity.behaviour_named(instead))
        answers = [editor.activity.behaviour_named(answer) for answer in right or ()]
        for answer in answers:
            if answer not in chosen.answers:
                shown = " or ".join(map(editor.activity.behaviour_words, chosen.answers))
                raise TangyError(
                    plain(
                        f"Nobody answered {answer!r}: choose {shown}, or say --instead "
                        "BEHAVIOUR if neither is right."
                    )
                )
        return editor.resolve(chosen, *(chosen.answers if both else answers))

    _change(data, activity, as_json, settle)


def _chosen(found: list[Conflict], wanted: str, activity: Activity) -> Conflict:
    """Return a conflict by its number, or by the words of its situation."""
    if wanted.isdecimal() and 1 <= int(wanted) <= len(found):
        return found[int(wanted) - 1]
    simple = " ".join(wanted.casefold().split())

    def words(conflict: Conflict) -> str:
        situation = conflict.situation
        return f"{activity.in_words(situation)} {' / '.join(situation)}".casefold()

    named = [conflict for conflict in found if simple and simple in words(conflict)]
    if len(named) == 1:
        return named[0]
    there = "there is 1" if len(found) == 1 else f"there are {len(found)}"
    raise TangyError(plain(f"There is no conflict {wanted!r}: {there}."))


def _change(
    data: Path | None,
    activity: str,
    as_json: bool,
    change: Callable[[Editor], Edit],
    before: str = "",
) -> None:
    """Change the library, and print what changed."""
    from tangy_tui.learning.editing import Editor

    with open_workspace(data, activity, REGISTERED) as workspace:
        editor = Editor(workspace.store, workspace.activity)
        edit = change(editor)
        if as_json:
            print_json(_edit_document(edit))
            return
        print(plain(f"{before}{_edit_words(workspace, editor, edit)}"))
        if not before:
            print(follow_up(text.UNDO_TAKES_BACK, **workspace.call_options))
        if edit.done.what == "resolve":
            left = len(editor.library.conflicts)
            print(follow_up(text.conflicts_left(left), **workspace.call_options))


def _edit_document(edit: Edit) -> dict[str, Any]:
    from tangy_profiles.codec import encode

    return {"edit": edit.seq, "at": edit.at, **encode(edit.done)}


def _edit_words(workspace: Workspace, editor: Editor, edit: Edit) -> str:
    from tangy_tui.text.situations import edit_words

    return edit_words(workspace.activity, editor.library, edit)


@app.command()
def accepted(
    take_back: Annotated[
        int | None, typer.Option(metavar="N", help="Take back the one of this number.")
    ] = None,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """List the surprises that a teacher accepted.

    --take-back makes one a surprise again.
    """
    from tangy_tui.monitoring.accepted import read_accepted
    from tangy_tui.monitoring.accepted import take_back as take_it_back
    from tangy_tui.monitoring.evidence import mismatch_words
    from tangy_tui.text.times import local_time

    with open_workspace(data, activity, REGISTERED, write=take_back is not None) as workspace:
        name = workspace.activity.name
        if take_back is not None:
            take_it_back(workspace.store, name, take_back)
        there = read_accepted(workspace.store, name)
        label = workspace.activity.behaviour_words
        words = [
            "; ".join(mismatch_words(found, label) for found in one.mismatches) for one in there
        ]
        if as_json:
            print_json(
                [
                    {"number": n, "at": one.at, "by": one.by, "what": what}
                    for n, (one, what) in enumerate(zip(there, words, strict=True), 1)
                ]
            )
            return
        if take_back is not None:
            print(text.FAULT_AGAIN)
        for n, (one, what) in enumerate(zip(there, words, strict=True), 1):
            print(plain(f"{n}. {local_time(one.at)}, {one.by}: {what}"))
        if not there:
            print(text.NOTHING_ACCEPTED)
