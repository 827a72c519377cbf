"""The results of checking activities and fault rules, as tables on the command line."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby

from rich.console import Console
from rich.table import Table
from rich.text import Text

from tangy_profiles.activity import Activity
from tangy_profiles.reading import plain
from tangy_tui.language.activity_check import CheckedFile
from tangy_tui.language.phrase_list import PhraseList
from tangy_tui.monitoring.rules import Rules, looks_at
from tangy_tui.text.faults import recovery_words
from tangy_tui.text.numbers import counted
from tangy_tui.text.phrases import items
from tangy_tui.text.rules import UNRULED, UNSEEN, UNTRIED, together_words
from tangy_tui.ui.printed_table import titled_table


def print_activities(activities: Iterable[tuple[str, Activity]]) -> None:
    """Print the shipped activities, by their names on the command line."""
    table = titled_table(
        "Activities", "name", "title", "stages", "situations", "behaviours", "strategies"
    )
    for name, activity in activities:
        table.add_row(
            Text(plain(name)),
            Text(plain(activity.title)),
            str(len(activity.stages)),
            str(len(activity.situations)),
            str(len(activity.behaviours)),
            Text(plain(", ".join(activity.strategies))),
        )
    Console(highlight=False).print(table)


def print_checked(checked: CheckedFile, activity: Activity | None) -> None:
    """Print the results of checking an activity's file."""
    console = Console(highlight=False)
    console.soft_wrap = not console.is_terminal
    if activity is not None and not checked.mistakes:
        words = ", ".join(
            counted(number, noun)
            for number, noun in (
                (len(activity.stages), "stage"),
                (len(activity.situations), "situation"),
                (len(activity.behaviours), "behaviour"),
            )
        )
        console.print(_verdict(checked.file, not checked.warnings, words))
    for line in checked.warnings:
        console.print(Text(f"  hint: {line}", style="yellow"))
    for line in checked.notes:
        console.print(Text(f"  {line}"))


def print_rules(rules: Rules) -> None:
    """Print fault rules without mistakes, and the facts that no rule uses."""
    if rules.mistakes:
        return
    console = Console(highlight=False)
    table = titled_table(
        f"{rules.file}: {counted(len(rules.rules), 'fault rule')}, the first that matches counts",
        "", "fault", "recovery", "looks at",
    )  # fmt: skip
    for number, rule in enumerate(rules.rules, 1):
        name = Text(rule.code, style="bold red" if rule.critical else "")
        if rule.critical:
            name.append(" critical", style="red")
        keys = ", ".join(looks_at(rule)) or "what no other rule explains"
        table.add_row(str(number), name, Text(recovery_words(rule)), Text(keys))
    console.print(table)
    _print_left(console, UNSEEN, rules.unseen)
    _print_left(console, UNRULED, rules.unruled)
    _print_left(console, UNTRIED, rules.untried)
    for code, kinds in rules.together.items():
        console.print(Text(plain(together_words(kinds, code))))
    console.print(_verdict(rules.file, not rules.unruled, "no mistake"))


def print_phrases(listed: PhraseList) -> None:
    """Print the phrasebook as a page."""
    console = Console(highlight=False)
    console.print(Text(plain(f"{listed.title}: what can be said or typed"), style="bold"))
    for heading, of_it in groupby(items(listed), key=lambda item: item.heading):
        console.print(Text(f"\n{heading}", style="bold"))
        table = Table.grid(padding=(0, 2))
        table.add_column(min_width=20, max_width=24, overflow="fold")
        table.add_column(overflow="fold")
        for item in of_it:
            table.add_row(Text(plain(item.about)), Text("\n".join(map(plain, item.texts))))
        console.print(table)


def _print_left(console: Console, what: str, words: Sequence[str]) -> None:
    console.print(Text(f"{what}: {plain(', '.join(words)) or 'none'}."))


def _verdict(file: str, well: bool, words: str) -> Text:
    mark = Text("ok       " if well else "hints    ", style="green" if well else "yellow")
    return mark.append(plain(f"{file}: {words}"), style="")
