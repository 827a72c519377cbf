"""`tangy learn` and `tangy policy`: learn a policy, show it, or compare two."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_tui.text.follow_up import follow_up
from tangy_tui.text.learnt import changed_lines, grounds, learnt_lines, only_unfinished
from tangy_tui.text.policies import notice_words
from tangy_tui.verbs.common import (
    REGISTERED,
    ActivityName,
    Data,
    Json,
    Seed,
    print_json,
    print_line,
)
from tangy_tui.verbs.opening import open_workspace, say_notices

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tangy_profiles.demonstration import Demonstration
    from tangy_profiles.state import Situation
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policies import PolicyNotice
    from tangy_tui.learning.policy import Policy

MOST_SHOWN = 8
"""The most steps listed that support a decision."""


def learn(
    activity: ActivityName = "",
    forest: Annotated[str, typer.Option(help="exact, or paper for its bagging.")] = "exact",
    name: Annotated[str, typer.Option(help="A name for the policy.")] = "",
    unfinished: Annotated[
        bool, typer.Option("--unfinished", help="Learn from unfinished demonstrations too.")
    ] = False,
    teacher: Annotated[
        str | None, typer.Option(help="Learn from the demonstrations of one teacher only.")
    ] = None,
    seed: Annotated[int, typer.Option(help="The seed of the forest.")] = 0,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Learn a policy from the demonstrations.

    First settle where they disagree.
    """
    from dataclasses import replace

    from tangy_tui.console.conflicts import settle_conflicts
    from tangy_tui.console.inputs import line_reader
    from tangy_tui.learning.forest_cache import ForestCache
    from tangy_tui.learning.library import read_library
    from tangy_tui.learning.policies import (
        changes,
        check_name,
        keep_policy,
        last_policy,
        unused_name,
        without_strange_steps,
    )
    from tangy_tui.learning.policy import FORESTS, learn_policy
    from tangy_tui.text.documents import policy_document
    from tangy_tui.text.learnt import NOT_SHOWN

    if forest not in FORESTS:
        raise TangyError(f"--forest {plain(forest)}: {nearest(forest, FORESTS)}")
    check_name(name)
    with open_workspace(data, activity, REGISTERED) as workspace:
        if not as_json and sys.stdin.isatty() and sys.stdout.isatty():
            settle_conflicts(workspace, line_reader(None), print_line)
        library = read_library(workspace.store, workspace.activity.name)
        shown = library.demonstrations
        if teacher is not None:
            shown = _of_teacher(shown, teacher)
        used = [d for d in shown if d.finished or (unfinished and d.steps)]
        left_out = [d for d in shown if d.steps and d not in used]
        if left_out and not used:
            raise TangyError(only_unfinished(sum(len(d.steps) for d in left_out)))
        before = last_policy(workspace.store, workspace.activity.name)
        used, notices = without_strange_steps(workspace.activity, used)
        _say(workspace, notices)
        policy = learn_policy(
            workspace.activity,
            used,
            resolutions=library.resolutions,
            settings=replace(FORESTS[forest], seed=seed),
            name=plain(name)[:40],
            grow=ForestCache(workspace.store.folder).afresh,
        )
        policy = unused_name(workspace.store, policy)
        keep_policy(workspace.store, policy)
        steps = sum(len(d.steps) for d in used)
        changed = [] if before is None else changes(before, policy)
        if as_json:
            found = policy_document(workspace, policy)
            told = [[list(c.situation), c.before, c.after] for c in changed]
            more = {"steps": steps, "left_out": len(left_out), "changed": told}
            print_json({**found, **more})
        else:
            of, apart = workspace.activity, len(left_out)
            lines = learnt_lines(of, policy, steps, apart, NOT_SHOWN)
            if before is not None:
                lines += changed_lines(of, plain(before.name), changed)
            options = workspace.call_options
            for line in lines:
                print(follow_up(line, **options, unfinished=unfinished))


def policy(
    activity: ActivityName = "",
    name: Annotated[
        str, typer.Option(help="A policy by its name or digest, or last~1; default the last.")
    ] = "last",
    compare: Annotated[
        tuple[str, str] | None,
        typer.Option(help="Two policies (name, digest, last~1) or teachers, row by row."),
    ] = None,
    why: Annotated[
        str | None, typer.Option(help="Explain a situation: its number in the table, or words.")
    ] = None,
    list_all: Annotated[bool, typer.Option("--list", help="List all learnt policies.")] = False,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Show the policy, explain it, or compare two.

    It lists every situation, and what Tangy does in it.
    """
    with open_workspace(data, activity, REGISTERED, write=False) as workspace:
        if list_all:
            _list_policies(workspace, as_json)
        elif compare is not None:
            _compare(workspace, *compare, as_json)
        elif why is not None:
            _why(workspace, name, why, as_json)
        else:
            _show(workspace, name, as_json)


# ------------------------------------------------------------------------------------ learning


def _of_teacher(shown: list[Demonstration], teacher: str) -> list[Demonstration]:
    teachers = dict.fromkeys(d.teacher for d in shown)
    if teacher not in teachers:
        raise TangyError(plain(f"--teacher {teacher}: {nearest(teacher, teachers)}"))
    return [d for d in shown if d.teacher == teacher]


# ------------------------------------------------------------------------------------- showing


def _say(workspace: Workspace, notices: Sequence[PolicyNotice]) -> None:
    options = workspace.call_options
    say_notices([follow_up(words, **options) for words in notice_words(notices)])


def _find(workspace: Workspace, name: str) -> Policy:
    from tangy_tui.learning.comparison import find_policy
    from tangy_tui.learning.policies import need_policy

    need_policy(workspace.store, workspace.activity)
    found, notices = find_policy(workspace.store, workspace.activity, name)
    _say(workspace, notices)
    return found


def _show(workspace: Workspace, name: str, as_json: bool) -> None:
    from tangy_tui.learning.library import effects_of, read_library
    from tangy_tui.text.documents import policy_document
    from tangy_tui.ui import reports

    learnt = _find(workspace, name)
    if as_json:
        print_json(policy_document(workspace, learnt))
        return
    library = read_library(workspace.store, workspace.activity.name)
    effects = effects_of(workspace.store, workspace.activity, learnt)
    reports.print_policy(workspace.activity, learnt, effects, library)


def _list_policies(workspace: Workspace, as_json: bool) -> None:
    from tangy_tui.learning.policies import stored_policies
    from tangy_tui.ui import reports

    kept = stored_policies(workspace.store, workspace.activity.name)
    if as_json:
        told = ("name", "at", "digest", "demonstrations", "versions")
        print_json([{key: getattr(one, key) for key in told} for one in kept])
    else:
        reports.print_policies(kept)


def _compare(workspace: Workspace, a: str, b: str, as_json: bool) -> None:
    from tangy_tui.learning.comparison import compare, find_policy
    from tangy_tui.text.documents import comparison_document
    from tangy_tui.ui import reports

    first, notices = find_policy(workspace.store, workspace.activity, a)
    second, more = find_policy(workspace.store, workspace.activity, b)
    _say(workspace, [*notices, *more])
    rows = compare(workspace.activity, first, second)
    if as_json:
        print_json(comparison_document(workspace, first, second, rows))
    else:
        reports.print_comparison(workspace.activity, first, second, rows)


def _why(workspace: Workspace, name: str, wanted: str, as_json: bool) -> None:
    from tangy_tui.learning.explanation import explain
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.decisions import shown_words, why_words
    from tangy_tui.text.documents import why_document

    policy = _find(workspace, name)
    library = read_library(workspace.store, workspace.activity.name)
    situation = _situation(workspace, wanted)
    shown = [entry.demonstration for entry in library.entries.values()]
    why = explain(policy, shown, situation)
    if as_json:
        print_json(why_document(workspace, why))
        return
    for sentence in why_words(workspace.activity, why):
        print(sentence)
    for title, steps in grounds(why):
        if steps:
            print(f"{title}:")
            for step in steps[:MOST_SHOWN]:
                print(plain(f"  {shown_words(workspace.activity, step, library.name)}"))
            if len(steps) > MOST_SHOWN:
                print(f"  and {len(steps) - MOST_SHOWN} more (--json has them all)")


def _situation(workspace: Workspace, wanted: str) -> Situation:
    """Return the situation with a number, with these parts, or with these words."""
    activity = workspace.activity
    situations = list(activity.situations)
    if wanted.isdecimal() and 1 <= int(wanted) <= len(situations):
        return situations[int(wanted) - 1]
    names = {activity.in_words(s).casefold(): s for s in situations}
    names |= {" / ".join(s).casefold(): s for s in situations}
    names |= {"/".join(s).casefold(): s for s in situations}
    names |= {activity.not_yet(s).casefold(): s for s in situations}
    simple = " ".join(wanted.casefold().split())
    if simple in names:
        return names[simple]
    within = list(dict.fromkeys(s for words, s in names.items() if simple and simple in words))
    if len(within) == 1:
        return within[0]
    if within:
        several = "; ".join(activity.in_words(s) for s in within)
        raise TangyError(plain(f"{wanted!r} fits several situations: {several}."))
    known = [activity.in_words(s) for s in situations]
    raise TangyError(plain(f"There is no situation {wanted!r}: {nearest(wanted, known)}"))
