"""`tangy read-card`: which card is in a picture, and what is marked on it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.card_face import USUAL_SEED
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_tui.verbs.cards import DeckSeed
from tangy_tui.verbs.common import ActivityName, Json, print_json

if TYPE_CHECKING:
    from tangy_hw.perception.cards.reader import CardReader, CardReading
    from tangy_profiles.activity import Activity

METHODS = ("tags", "paper")


def read_card(
    files: Annotated[list[Path] | None, typer.Argument(help="Pictures of cards.")] = None,
    called: Annotated[
        str | None,
        typer.Option(help="What was called, as in 5,17,62: say how the person is doing."),
    ] = None,
    together: Annotated[
        bool, typer.Option("--together", help="All are frames of one card: make one reading.")
    ] = False,
    bench: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Count how well labelled pictures in DIR are read."),
    ] = None,
    method: Annotated[
        str, typer.Option(help="tags, or paper (grid lines, textures, red blobs) to compare.")
    ] = "tags",
    deck_seed: DeckSeed = USUAL_SEED,
    activity: ActivityName = "bingo",
    as_json: Json = False,
) -> None:
    """Read Tangy's printed cards in pictures.

    A cell that cannot be told is hidden, and never a guess. With --called the answer is how the
    person is doing; hidden cells matter only where they could change it.

    With --bench the truth is in DIR/labels.json, in the form in which --json prints: make it with
    `tangy read-card DIR/*.jpg --json > DIR/labels.json` and correct what is wrong in it. Or it is
    the "label" of the file that `tangy capture` wrote beside each picture.
    """
    from tangy_hw.perception.cards.labelled import count_labelled, labelled
    from tangy_hw.perception.cards.reader import CardReader
    from tangy_hw.perception.pictures import read_picture
    from tangy_profiles.activity import load_activity

    if bool(files) == (bench is not None):
        raise TangyError("Give pictures of cards, or a folder of them with --bench DIR.")
    loaded = load_activity(activity)
    numbers = None if called is None else _called(called, loaded)
    if method not in METHODS:
        raise TangyError(
            plain(f"--method {method[:40]!r} is not known; {nearest(method, METHODS)}")
        )
    reader = CardReader(loaded.deck, deck_seed)
    read = reader.read
    if method == "paper":
        from tangy_hw.perception.cards.paper import PaperReader

        read = PaperReader(loaded.deck, loaded.title, deck_seed).read
    if bench is not None:
        counted = count_labelled(labelled(bench, loaded.deck), read)
        if as_json:
            print_json(counted.document())
        else:
            print("\n".join(counted.lines()))
        return
    readings = [(str(path), read(read_picture(path))) for path in files or []]
    if together:
        readings = [(readings[0][0], reader.fuse([reading for _, reading in readings]))]
    listed = [_row(name, reading, reader, loaded, numbers) for name, reading in readings]
    if together:
        listed[0]["files"] = [str(path) for path in files or []]
    if as_json:
        print_json(listed)
        return
    for row, (_, reading) in zip(listed, readings, strict=True):
        print(plain(f"{row['file']}: {_told(row)}"))
        if reading.card is not None:
            for line in _drawn(reading, reader):
                print(f"  {line}")


def _called(text: str, activity: Activity) -> set[int]:
    """Understand the numbers that were called: 5,17 or B-5,I-17.

    Raises:
        TangyError: one of them is no number of the deck.
    """
    numbers: set[int] = set()
    for word in text.replace(",", " ").split():
        digits = word.rpartition("-")[2].lstrip("".join(c.letter for c in activity.deck.columns))
        number = int(digits) if digits.isascii() and digits.isdigit() and len(digits) < 6 else None
        if number not in activity.deck.numbers:
            low, high = activity.deck.numbers[0], activity.deck.numbers[-1]
            raise TangyError(
                plain(f"--called {word[:20]!r} is no number of the deck ({low} to {high}).")
            )
        numbers.add(number)
    return numbers


def _row(
    name: str,
    reading: CardReading,
    reader: CardReader,
    activity: Activity,
    called: set[int] | None,
) -> dict[str, Any]:
    row: dict[str, Any] = {"file": name, **reader.document(reading)}
    if called is not None:
        row["state"] = reader.state(reading, activity.user_states, called)
        row["label"] = next(s.label for s in activity.user_states if s.name == row["state"])
    return row


def _told(row: dict[str, Any]) -> str:
    """Say in words what was read."""
    if row["card"] is None:
        told = str(row["problem"])
    else:
        told = f"card {row['card']}, {len(row['marked'])} marked"
        if row["hidden"]:
            told += f", {len(row['hidden'])} not to be told"
        told += f", {min(row['confidence'], 0.999):.1%} sure"
    return f"{told}; {row['label']}" if "state" in row else told


def _drawn(reading: CardReading, reader: CardReader) -> list[str]:
    """Draw a card in letters: [12] is marked, ? cannot be told."""
    from tangy_profiles.card_face import numbers_of

    deck = reader.deck
    numbers = numbers_of(deck, reading.card or 1, reader.deck_seed)
    lines = []
    for row in range(deck.rows):
        cells = []
        for column in range(len(deck.columns)):
            cell = row * len(deck.columns) + column
            number = f"{numbers[cell]:>2}"
            if reading.hidden >> cell & 1:
                cells.append(f" {number}?")
            elif reading.marked >> cell & 1:
                cells.append(f"[{number}]")
            else:
                cells.append(f" {number} ")
        lines.append(" ".join(cells))
    return lines
