"""`tangy read-card`: read the card in a picture, and its marks."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.card_face import USUAL_SEED
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_tui.text.cameras import TOGETHER
from tangy_tui.verbs.cards import DeckSeed
from tangy_tui.verbs.common import ActivityName, Json, print_json

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tangy_hw.perception.cards.reader import CardReader, CardReading
    from tangy_profiles.activity import Activity

READERS = ("tags", "paper")


def read_card(
    files: Annotated[
        list[Path] | None, typer.Argument(help="Pictures of cards, or folders of them.")
    ] = None,
    called: Annotated[
        str | None,
        typer.Option(help="The numbers called, as in 5,17,62: also say how the person is doing."),
    ] = None,
    together: Annotated[
        bool,
        typer.Option("--together", help="All pictures show one card: combine them."),
    ] = False,
    draw: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write each picture there, with its reading drawn on it."),
    ] = None,
    bench: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Score the readings of labelled pictures in DIR."),
    ] = None,
    method: Annotated[
        str, typer.Option(help="tags, or paper (grid lines, textures, red blobs) to compare.")
    ] = "tags",
    deck_seed: DeckSeed = USUAL_SEED,
    activity: ActivityName = DEFAULT_ACTIVITY,
    as_json: Json = False,
) -> None:
    """Read Tangy's printed cards in pictures.

    A cell that cannot be told is hidden, and never a guess; of several cards in a picture none is
    read. With --called the answer is how the person is doing; hidden cells matter only where they
    could change it. What a hand hides in one picture another may show: give several of the same
    card with --together.

    With --bench the truth is in DIR/labels.json, in the form in which --json prints: make it with
    `tangy read-card DIR/*.jpg --json > DIR/labels.json` and correct what is wrong in it. Or it is
    the "label" of the file that `tangy capture` wrote beside each picture.
    """
    from tangy_hw.perception.cards.labelled_set import count_labelled, labelled
    from tangy_hw.perception.cards.reader import CardReader
    from tangy_profiles.activity import load_activity

    if bool(files) == (bench is not None):
        raise TangyError("Give pictures of cards, or a folder of them with --bench DIR.")
    loaded = load_activity(activity)
    loaded.need_cards()
    numbers = None if called is None else _called(called, loaded)
    if method not in READERS:
        raise TangyError(
            plain(f"--method {method[:40]!r} is not known; {nearest(method, READERS)}")
        )
    if together and method != READERS[0]:
        raise TangyError(f"--together goes with --method {READERS[0]} alone.")
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
    files = _pictures(files or [])
    readings, refused = _readings(files, read, reader, draw)
    if together and readings:
        one = reader.fuse([reading for _, reading in readings])
        readings = [(" + ".join(name for name, _ in readings), one)]
        if as_json:
            readings = [(str(files[0]), one)]
    listed = [_row(name, reading, reader, loaded, numbers) for name, reading in readings]
    if as_json and listed:
        print_json(listed)
    elif listed:
        unseen = reader.state(reader.nothing(""), loaded.user_states, set())
        for row, (_, reading) in zip(listed, readings, strict=True):
            print(plain(f"{row['file']}: {_told(row, reading, unseen)}"))
            if reading.card is not None:
                print("\n".join(f"  {line}" for line in _drawn(reading, reader)))
        _explain([reading for _, reading in readings])
    if refused:
        raise typer.Exit(2)


def _pictures(paths: list[Path]) -> list[Path]:
    """Replace folders by the pictures in them, sorted by name.

    A folder without pictures stays, to be refused as no picture.

    Raises:
        TangyError: a folder cannot be opened.
    """
    from tangy_hw.perception.pictures import ENDINGS

    endings = {ending for several in ENDINGS.values() for ending in several}
    pictures: list[Path] = []
    for path in paths:
        if not path.is_dir():
            pictures.append(path)
            continue
        try:
            inside = sorted(one for one in path.iterdir() if one.suffix.lower() in endings)
        except OSError as error:
            raise TangyError(plain(f"{path}: cannot be opened ({error.strerror}).")) from None
        pictures += inside or [path]
    return pictures


def _readings(
    files: list[Path],
    read: Callable[[NDArray[Any]], CardReading],
    reader: CardReader,
    draw: Path | None,
) -> tuple[list[tuple[str, CardReading]], int]:
    """Read pictures; report and count those that cannot be opened."""
    from tangy_hw.perception.pictures import PictureError, read_picture

    readings: list[tuple[str, CardReading]] = []
    refused = 0
    for path in files:
        try:
            picture = read_picture(path, colours=True)
        except PictureError as error:
            print(f"tangy: {error}", file=sys.stderr)
            refused += 1
            continue
        reading = read(picture)
        readings.append((str(path), reading))
        if draw is not None:
            _draw(picture, reading, reader, path, draw)
    return readings, refused


def _draw(
    picture: NDArray[Any], reading: CardReading, reader: CardReader, path: Path, folder: Path
) -> None:
    """Write a picture with its reading drawn on it."""
    import cv2

    from tangy_hw.perception.cards.overlay import draw_reading

    there = folder / f"{path.stem}-read.png"
    drawn = cv2.imencode(".png", draw_reading(picture, reading, reader.deck))[1].tobytes()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        there.write_bytes(drawn)
    except OSError as error:
        raise TangyError(plain(f"{there}: cannot be written ({error.strerror}).")) from None


def _explain(readings: list[CardReading]) -> None:
    """Print a legend of the drawings, and how to combine several pictures of a card."""
    signs = []
    if any(reading.card is not None and reading.marked for reading in readings):
        signs.append("[ ] is marked")
    if any(reading.card is not None and reading.hidden for reading in readings):
        signs.append("? cannot be told")
    if signs:
        print(f"{', '.join(signs)}.")
    cards = [reading.card for reading in readings if reading.card is not None]
    if len(set(cards)) < len(cards) and any(reading.hidden for reading in readings):
        print(TOGETHER)


def _called(text: str, activity: Activity) -> set[int]:
    """Parse called numbers: 5,17 or B-5,I-17.

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


def _told(row: dict[str, Any], reading: CardReading, unseen: str) -> str:
    """Describe the reading; `unseen` is the state of a card that is not in view."""
    if len(reading.cards) > 1:
        return f"{reading.problem}; which one is meant cannot be told, so none is read"
    if row["card"] is None:
        told = reading.problem
    else:
        told = f"card {row['card']}, {len(row['marked'])} marked"
        if row["hidden"]:
            told += f", {len(row['hidden'])} not to be told"
        told += f", {min(row['confidence'], 0.999):.1%} sure"
    if "state" not in row:
        return told
    if row["card"] is not None and row["state"] == unseen:
        return f"{told}; how the person is doing hangs on what is not to be told"
    return f"{told}; {row['label']}"


def _drawn(reading: CardReading, reader: CardReader) -> list[str]:
    """Draw a card as text: [12] is marked, 12? is unknown."""
    from tangy_profiles.card_face import numbers_of

    deck = reader.deck
    numbers = numbers_of(deck, reading.card or 1, reader.deck_seed)
    columns = len(deck.columns)
    wide = max(len(str(number)) for number in deck.numbers)
    rule = "+".join("-" * (wide + 4) for _ in range(columns))
    lines = [" ".join(column.letter.center(wide + 4) for column in deck.columns), f"+{rule}+"]
    lines[0] = f" {lines[0]}"
    for row in range(deck.rows):
        cells = []
        for cell in range(row * columns, (row + 1) * columns):
            number = "free"[:wide] if deck.free >> cell & 1 else f"{numbers[cell]:>{wide}}"
            if reading.hidden >> cell & 1:
                cells.append(f"  {number}? ")
            elif reading.marked >> cell & 1:
                cells.append(f" [{number}] ")
            else:
                cells.append(f"  {number}  ")
        lines += [f"|{'|'.join(cells)}|", f"+{rule}+"]
    return lines
