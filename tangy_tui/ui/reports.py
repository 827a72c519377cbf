"""Tables and progress bars of the command line: policies, games, people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from textwrap import wrap
from typing import TypeVar

from rich import box
from rich.console import Console
from rich.progress import track
from rich.table import Table
from rich.text import Text

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beliefs, leading, probability_best
from tangy_profiles.reading import plain
from tangy_profiles.teaching_records import PolicyLearnt
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.comparison import SituationComparison
from tangy_tui.learning.coverage_proof import prove_coverage
from tangy_tui.learning.demonstration_rows import ListRow
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.library_entries import Library
from tangy_tui.learning.policy import Decision, Policy
from tangy_tui.text.activities import whom_words
from tangy_tui.text.activity_search import proof_words
from tangy_tui.text.endings import ENDED_EARLY
from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.people import COMPLIED
from tangy_tui.text.quality import quality_words
from tangy_tui.text.situations import agreement_words, conflict_lines
from tangy_tui.text.times import local_time
from tangy_tui.ui.printed_table import titled_table

T = TypeVar("T")


def progress(items: Iterable[T], what: str, *, quiet: bool) -> Iterator[T]:
    """Iterate with a progress bar on stderr, if stderr is a terminal."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield from items
    else:
        yield from track(items, description=what, console=console, transient=True)


COLUMN_GAP = 3  # characters between two columns
READABLE = 14
"""The width below which a column of longer cells is hard to read."""
NOTHING = ("", "\N{EN DASH}")


def print_rows(columns: Sequence[str], rows: Sequence[Sequence[str]], title: str = "") -> None:
    """Print a table, or a paragraph for each row if its columns do not fit; nothing without rows.

    Args:
        columns: the headings of the columns.
        rows: the cells of each row.
        title: the heading above.
    """
    if not rows:
        return
    console = Console(highlight=False)
    if title:
        console.print(Text(f"\n{title}"))
    if sum(map(_least_width, zip(columns, *rows, strict=True))) > console.width:
        for line in row_lines(columns, rows, console.width):
            console.print(Text(line))
        return
    table = Table(*columns, box=box.SIMPLE_HEAD, title_justify="left", show_edge=False)
    for row in rows:
        table.add_row(*(Text(plain(cell)) for cell in row))
    console.print(table)


def _least_width(cells: Sequence[str]) -> int:
    """Return the width that a column with these cells needs, in characters, with its gap."""
    words = (len(word) for cell in cells for word in cell.split())
    return max(*words, min(READABLE, max(map(len, cells))), 1) + COLUMN_GAP


def row_lines(columns: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> Iterator[str]:
    """Write each row as a paragraph of lines up to a width: its first cell, and then the others.

    Empty cells are left out.
    """
    for row in rows:
        yield plain(row[0])
        told = [
            f"{column}: {plain(cell)}"
            for column, cell in zip(columns[1:], row[1:], strict=True)
            if cell not in NOTHING
        ]
        yield from wrap("; ".join(told), width, initial_indent="  ", subsequent_indent="  ")


"""As many as a search of all games has."""


def print_policy(activity: Activity, policy: Policy, effects: Effects, library: Library) -> None:
    """Print the decision for every situation, the learnt effects, and warnings."""
    console = Console(highlight=False)
    exact = agreement_words(activity, policy)
    table = titled_table(
        f"Policy {policy.name} ({counted(len(policy.demonstrations), 'demonstration')}, {exact}; "
        f"digest {policy.digest[:8]})",
        "", "situation", "behaviour", "votes", "shown",
    )  # fmt: skip
    for number, situation in enumerate(activity.situations, 1):
        decision = policy.decide(situation)
        also = [b for b in decision.right if b != decision.behaviour]
        table.add_row(
            str(number),
            activity.in_words(situation),
            Text(_does(activity, decision, also), style="" if decision.sure else "bold red"),
            f"{decision.share:.2f}" if decision.seen else "",
            str(decision.seen) if decision.seen else Text("never", style="bold red"),
        )
    console.print(table)
    for situation in activity.situations:
        if not policy.decide(situation).seen:
            console.print(Text(f"Not shown: {activity.not_yet(situation)}."))
    for conflict in library.conflicts:
        for line in conflict_lines(activity, library, conflict):
            console.print(Text(line))
    for line in whom_words(activity, policy):
        console.print(Text(line))
    found = prove_coverage(activity, policy)
    for line in () if found is None else proof_words(activity, found):
        console.print(Text(line))
    table = titled_table("What follows", "behaviour", "what was seen afterwards")
    for behaviour in activity.behaviours:
        words, variables = activity.behaviour_words(behaviour), effects.values.get(behaviour)
        if variables is None:
            table.add_row(words, Text("never demonstrated", style="bold red"))
            continue
        table.add_row(
            words,
            "\n".join(f"{v}: {' or '.join(sorted(seen))}" for v, seen in variables.items()),
        )
    console.print(table)


def print_policies(kept: Sequence[PolicyLearnt]) -> None:
    """Print the learnt policies, the latest last."""
    table = titled_table("Policies", "name", "learnt", "demonstrations", "digest")
    for one in kept:
        count = str(len(one.demonstrations))
        table.add_row(Text(plain(one.name)), local_time(one.at), count, one.digest[:8])
    Console(highlight=False).print(table)


def print_demonstrations(rows: Sequence[ListRow], none: str) -> None:
    """Print the demonstrations, one row each, with their notes; if there are none, tell so."""
    console = Console(highlight=False)
    if not rows:
        console.print(Text(none), soft_wrap=True)
        return
    table = titled_table(
        "Demonstrations", "", "teacher", "date", "steps", "shown", "state", "notes"
    )
    for row in rows:
        style = "" if row.state == "in use" else "dim"
        notes = Text("; ".join(quality_words(row.notes)))
        table.add_row(
            str(row.number), Text(plain(row.teacher)), local_time(row.at), str(row.steps),
            f"{row.seen}/{row.situations}", row.state, notes, style=style,
        )  # fmt: skip
    console.print(table)


def print_comparison(
    activity: Activity, a: Policy, b: Policy, rows: Sequence[SituationComparison]
) -> None:
    """Print two policies side by side, and mark the rows that differ."""
    console = Console(highlight=False)
    table = titled_table("", "", "situation", plain(a.name), plain(b.name))
    for row in rows:
        style = "" if row.same else "bold red"
        mark = Text("" if row.same else "!", style=style)
        answers = (Text(_does(activity, decision), style=style) for decision in (row.a, row.b))
        table.add_row(mark, activity.in_words(row.situation), *answers)
    console.print(table)
    different = sum(not row.same for row in rows)
    console.print(f"{different} of {counted(len(rows), 'row')} differ.")


def _does(activity: Activity, decision: Decision, also: Sequence[str] = ()) -> str:
    if decision.sure:
        return listed(map(activity.behaviour_words, [decision.behaviour, *also]), "or")
    why = "contested" if decision.contested else "never shown" if not decision.seen else "unsure"
    return f"asks ({why})"


def print_tally(workspace: Workspace, tally: Tally, beliefs: Mapping[str, Beliefs]) -> None:
    """Print the rows of Table II for the played games, and the posteriors after them."""
    console = Console(highlight=False)
    table = titled_table(
        f"{counted(tally.games, 'game')}, {counted(tally.steps, 'behaviour')}",
        "situation", "behaviour", "instances", "success",
    )  # fmt: skip
    for row in tally.rows(workspace.activity.situations):
        table.add_row(
            workspace.activity.in_words(row.situation),
            workspace.activity.behaviour_words(row.behaviour),
            str(row.instances),
            f"{row.success:.1%}",
        )
    console.print(table)
    console.print(_people_table(workspace, beliefs))
    for reason, times in sorted(Counter(reason for _, reason in tally.stopped).items()):
        console.print(Text(f"{counted(times, 'game')} stopped: {reason}"))
    for due, times in sorted(Counter(due for _, due, _ in tally.early).items()):
        console.print(Text(f"{counted(times, 'game')} {ENDED_EARLY.format(due=due)}"))


def _people_table(workspace: Workspace, beliefs: Mapping[str, Beliefs]) -> Table:
    strategies = tuple(workspace.activity.strategies)
    table = titled_table(COMPLIED, "person", *strategies)
    for person, profile in beliefs.items():
        best = probability_best(profile)
        leads = leading(best)
        table.add_row(
            Text(workspace.name(person)),
            *(
                Text(
                    f"{profile[s].complied}/{profile[s].trials} ({best[s]:.2f})"
                    + (" *" if s == leads and profile[s].trials else ""),
                )
                for s in strategies
            ),
        )
    return table
