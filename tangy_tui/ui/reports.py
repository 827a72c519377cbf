"""Tables and progress bars of the command line: policy, tally of games, people."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar

from rich import box
from rich.console import Console
from rich.progress import track
from rich.table import Table
from rich.text import Text

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beliefs, leading, probability_best
from tangy_tui.house import House
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Policy
from tangy_tui.wording import counted

T = TypeVar("T")


def progress(items: Iterable[T], what: str, *, quiet: bool) -> Iterator[T]:
    """Go through items with a progress bar on stderr, where somebody can see it."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield from items
    else:
        yield from track(items, description=what, console=console, transient=True)


def print_policy(activity: Activity, policy: Policy, effects: Effects) -> None:
    """Print the decision for every situation, and the learnt effects of every behaviour."""
    console = Console(highlight=False)
    exact = "as expected everywhere" if policy.exact(activity) else "not as expected everywhere"
    table = _table(
        f"Policy {policy.name} ({counted(len(policy.demonstrations), 'demonstration')}, {exact})",
        "situation", "behaviour", "votes", "shown",
    )  # fmt: skip
    for situation in activity.situations:
        decision = policy.decide(situation)
        table.add_row(
            activity.in_words(situation),
            Text(decision.behaviour, style="" if decision.sure else "bold red"),
            f"{decision.share:.2f}",
            str(decision.seen) if decision.seen else Text("never", style="bold red"),
        )
    console.print(table)
    table = _table("What follows", "behaviour", "what was seen afterwards")
    for behaviour in activity.behaviours:
        variables = effects.values.get(behaviour)
        if variables is None:
            table.add_row(behaviour, Text("never demonstrated", style="bold red"))
            continue
        table.add_row(
            behaviour,
            "\n".join(f"{v}: {' or '.join(sorted(seen))}" for v, seen in variables.items()),
        )
    console.print(table)


def print_tally(house: House, tally: Tally, beliefs: Mapping[str, Beliefs]) -> None:
    """Print the rows of Table II for the games that were played, and the beliefs after them."""
    console = Console(highlight=False)
    table = _table(
        f"{counted(tally.games, 'game')}, {counted(tally.steps, 'behaviour')}",
        "situation", "behaviour", "instances", "success",
    )  # fmt: skip
    for row in tally.rows(house.activity.situations):
        table.add_row(
            house.activity.in_words(row.situation),
            row.behaviour,
            str(row.instances),
            f"{row.success:.1%}",
        )
    console.print(table)
    console.print(_people_table(house, beliefs))
    reasons = sorted(set(tally.stopped))
    for reason in reasons:
        stopped = counted(tally.stopped.count(reason), "game")
        console.print(Text(f"{stopped} stopped: {reason}"))


def _people_table(house: House, beliefs: Mapping[str, Beliefs]) -> Table:
    strategies = tuple(house.activity.strategies)
    table = _table("Complied, of times tried (P(best))", "person", *strategies)
    for person, profile in beliefs.items():
        best = probability_best(profile)
        leads = leading(best)
        table.add_row(
            Text(house.name(person)),
            *(
                Text(
                    f"{profile[s].alpha - 1:.0f}/{profile[s].trials} ({best[s]:.2f})"
                    + (" *" if s == leads and profile[s].trials else ""),
                )
                for s in strategies
            ),
        )
    return table


def _table(title: str, *columns: str) -> Table:
    table = Table(title=Text(title), box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for column in columns:
        table.add_column(column, overflow="fold")
    return table
