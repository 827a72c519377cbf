"""Records of people on the command line: the list, one person, and the history game by game."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.text import Text

from tangy_profiles.reading import plain
from tangy_tui.interaction.record import PersonSummary
from tangy_tui.text.people import (
    BEST,
    COMPLIED,
    HISTORY,
    NO_HISTORY,
    SETTLED,
    STAR,
    drift_lines,
    entry_words,
    method_words,
    prior_words,
    sentence,
    tally,
)
from tangy_tui.text.times import on_day
from tangy_tui.ui.printed_table import titled_table


def print_people(records: Sequence[PersonSummary]) -> None:
    """Print everybody with their counts for each strategy, and a sentence about what works."""
    console = Console(highlight=False)
    strategies = tuple(records[0].beliefs)
    title = f"{COMPLIED}, in {records[0].world} games"
    table = titled_table(title, "person", *strategies)
    for record in records:
        cells = (_short(record, strategy) for strategy in strategies)
        table.add_row(Text(plain(record.person.name)), *cells)
    console.print(table)
    _print_legend(console, STAR)
    for record in records:
        console.print(Text(f"{record.person.id}: {plain(sentence(record))}"))


def print_person(record: PersonSummary) -> None:
    """Print one person in detail."""
    console = Console(highlight=False)
    table = titled_table(
        f"{plain(record.person.name)} ({record.person.id}), in {record.world} games",
        "way of asking", "did it", "average", "90% interval", "chance to be best", "",
    )  # fmt: skip
    for strategy, belief in record.beliefs.items():
        low, high = belief.interval()
        table.add_row(
            strategy,
            tally(belief),
            f"{belief.mean:.2f}",
            f"{low:.2f} to {high:.2f}",
            f"{record.best[strategy]:.2f}",
            _mark(record, strategy),
        )
    console.print(table)
    _print_legend(console, SETTLED)
    for line in (sentence(record), *drift_lines(record)):
        console.print(Text(plain(line)))
    console.print(Text(f"Method: {method_words(record)}; it {prior_words(record.known.prior)}."))
    print_history(record)


def print_history(record: PersonSummary) -> None:
    """Print the requests to a person, game by game."""
    console = Console(highlight=False)
    table = titled_table(HISTORY, "no.", "when", "strategy", "what came of it")
    for game in record.games:
        where = "game of" if game.id is not None else "outside of a game,"
        table.add_row("", Text(f"{where} {on_day(game.begun)}", style="bold"), "", "")
        for entry in game.entries:
            style = "" if entry.counts else "dim"
            words = plain(entry_words(entry))
            row = (str(entry.number), on_day(entry.at), entry.strategy, words)
            table.add_row(*(Text(cell, style=style) for cell in row))
    console.print(table if record.games else Text(NO_HISTORY))


def _short(record: PersonSummary, strategy: str) -> Text:
    """Format a strategy in one cell; a star marks a unique highest P(best)."""
    belief = record.beliefs[strategy]
    star = " *" if strategy == record.leading and belief.trials else ""
    off = " off" if strategy in record.known.off else ""
    share = f"({record.best[strategy]:.2f})"
    return Text(f"{belief.complied}/{belief.trials} {share}{star}{off}")


def _mark(record: PersonSummary, strategy: str) -> str:
    if strategy in record.known.off:
        return "switched off"
    return "settled" if strategy == record.settled else ""


def _print_legend(console: Console, mark: str) -> None:
    console.print(Text(BEST + mark, style="dim"))
