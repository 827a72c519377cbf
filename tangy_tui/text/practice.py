"""The results of speech practice as lines of at most 80 columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from string import ascii_lowercase
from typing import Any

from tangy_profiles.reading import plain
from tangy_tui.speech.practice import NOTHING, OUTCOMES, Practice

MOST_LISTED = 12  # files
NAME = 32  # columns
WIDTH = 80


def meaning_words(
    row: Mapping[str, Any], questions: Mapping[str, str], names: Mapping[str, str]
) -> str:
    """Explain a row of `tangy listen`.

    Args:
        row: see `tangy_tui.speech.transcription.listen`.
        questions: the words of the question about each behaviour.
        names: the name of each person.
    """
    choices = [
        questions.get(choice["behaviour"], choice["behaviour"])
        + (f" ({names.get(user, user)})" if user else "")
        for choice in row["choices"]
        for user in [choice["arguments"].get("user")]
    ]
    sure = f"{row['confidence']:.0%}"
    match row["tier"]:
        case "stop":
            return "stop, at once"
        case "sure":
            return f"{choices[0]}, {sure} sure"
        case "unsure":
            return f"perhaps {' or '.join(choices)}, {sure} sure"
        case _:
            return "not understood"


def practice_lines(practice: Practice) -> list[str]:
    """Format practice as lines: intents, totals, times, and the confusion matrix."""
    commands, others = len(practice.commands), len(practice.others)
    recordings = "1 recording" if commands + others == 1 else f"{commands + others} recordings"
    lines = [f"{recordings}: {commands} of a command, {others} of none.", ""]
    if commands:
        lines += [*_table(practice), ""]
    lines += [*_totals(practice), *_times(practice), "", *_matrix(practice)]
    return [*lines, *_left_out(practice)]


def _table(practice: Practice) -> Iterator[str]:
    yield f"{'':{NAME}}" + "".join(f"{outcome:>9}" for outcome in OUTCOMES)
    intents = practice.intents()
    for intent, counts in intents.items():
        yield _named(intent) + "".join(f"{counts[outcome]:9}" for outcome in OUTCOMES)
    if len(intents) > 1:
        sums = [sum(counts[outcome] for counts in intents.values()) for outcome in OUTCOMES]
        yield _named("all") + "".join(f"{number:9}" for number in sums)


def _totals(practice: Practice) -> Iterator[str]:
    commands, others = practice.commands, practice.others
    if commands:
        right = sum(row.outcome == "right" for row in commands)
        chosen = right + sum(row.outcome == "offered" for row in commands)
        wrong = sum(row.outcome == "wrong" for row in commands)
        yield f"Understood for sure:            {_part(right, len(commands))}"
        yield f"  or among the choices:         {_part(chosen, len(commands))}"
        yield f"Taken for something else:       {_part(wrong, len(commands))}"
    if others:
        sure, offered = practice.false_accepts()
        yield f"No command, but taken for one:  {_part(sure, len(others))}"
        yield f"  or offered as a choice:       {_part(offered, len(others))}"


def _times(practice: Practice) -> Iterator[str]:
    median, late, worst = (round(1000 * seconds) for seconds in practice.latencies())
    yield (f"Result after the sound: {median} ms (median), {late} ms (95 %), {worst} ms (worst).")
    sound = sum(row.seconds for row in practice.rows)
    if practice.cpu:
        yield f"A CPU second decodes {sound / practice.cpu:.1f} s of sound ({sound:.0f} s in all)."


def _matrix(practice: Practice) -> Iterator[str]:
    """Draw the confusion matrix of said and understood intents, without empty columns."""
    confusion = practice.confusion()
    heard = {name for row in confusion.values() for name in row}
    columns = [name for name in confusion if name in heard]
    columns += sorted(heard - {*confusion, NOTHING})
    key = dict(zip(columns, _keys(len(columns)), strict=True))
    if NOTHING in heard:
        columns.append(NOTHING)
        key[NOTHING] = "-"
    wide = 1 + max(2, *(len(str(n)) for row in confusion.values() for n in row.values()))
    yield "Said (rows), and what it was taken for first, sure or not (columns):"
    fit = (WIDTH - NAME) // wide
    for start in range(0, len(columns), fit):
        some = columns[start : start + fit]
        if start:
            yield "The same, further to the right:"
        yield f"{'':{NAME}}" + "".join(f"{key[name]:>{wide}}" for name in some)
        for said, counts in confusion.items():
            if start and not any(counts[name] for name in some):
                continue
            cells = "".join(f"{counts[name] or '.':>{wide}}" for name in some)
            yield f"{key.get(said, ''):>3} {_named(said, NAME - 4)}{cells}"
    for name in columns:
        if name not in confusion and name != NOTHING:
            yield f"{key[name]:>3} {name} (was never said)"


def _keys(number: int) -> list[str]:
    """Return short names for columns: a, b, ... z, aa, ab, ..."""
    letters = list(ascii_lowercase)
    return [*letters, *("".join(pair) for pair in product(letters, letters))][:number]


def _left_out(practice: Practice) -> Iterator[str]:
    if practice.unnamed:
        count = len(practice.unnamed)
        yield ""
        yield (
            "1 recording was left out: its name is no intent, and not none:"
            if count == 1
            else f"{count} recordings were left out: their names are no intent, and not none:"
        )
        yield from _some(practice.unnamed)
    if practice.cut_off:
        yield ""
        yield "These end before they say they do; what is there was heard:"
        yield from _some(practice.cut_off)
    if practice.left_out:
        yield ""
        yield "Left out:"
        yield from _some([f"{file} {why}" for file, why in practice.left_out])


def _some(names: Sequence[str]) -> Iterator[str]:
    yield from (_short(f"  {name}", WIDTH) for name in names[:MOST_LISTED])
    if len(names) > MOST_LISTED:
        yield f"  and {len(names) - MOST_LISTED} more"


def _named(name: str, width: int = NAME) -> str:
    return f"{_short(name, width - 1):{width}}"


def _short(text: str, most: int) -> str:
    """Cut the middle of a text that is too long for its column."""
    text = plain(text)
    if len(text) <= most:
        return text
    return f"{text[: most // 2 - 1]}...{text[-(most - most // 2 - 2) :]}"


def _part(number: int, of: int) -> str:
    return f"{number:4} of {of} ({100 * number / of:.0f} %)"
