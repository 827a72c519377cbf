"""Reads a folder of labelled card images, and measures the accuracy of the card reader."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.reader import CardReading
from tangy_hw.perception.pictures import read_picture
from tangy_profiles.cards import Deck
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import read_given_text
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from numpy.typing import NDArray

LABELS = "labels.json"
LARGEST_JSON = 20_000_000  # bytes: a hundred thousand images


@dataclass(frozen=True)
class CardLabel:
    """Ground truth of an image; cells in `hidden` cannot be decided."""

    path: Path
    card: int | None
    marked: int
    hidden: int


@dataclass
class ReadingCounts:
    """Counts of correct and wrong readings of labelled images."""

    pictures: int = 0
    with_card: int = 0
    read: int = 0
    whole: int = 0
    wrong_cards: int = 0
    wrong_cells: int = 0
    seen_cells: int = 0
    not_told: int = 0
    mistakes: list[dict[str, Any]] = field(default_factory=list)

    def document(self) -> dict[str, Any]:
        """Return it as JSON."""
        return dict(vars(self))

    def lines(self) -> list[str]:
        """Return it as a table, with a list of wrong readings."""
        rows = [
            ("cards read", self.read, self.with_card),
            ("read with all cells in sight", self.whole, self.with_card),
            ("wrong cards", self.wrong_cards, self.pictures),
            ("cells read wrongly", self.wrong_cells, self.seen_cells),
            ("cells in sight, but not told", self.not_told, self.seen_cells),
        ]
        told = [f"{self.pictures} pictures, {self.with_card} of them with a card"]
        told += [
            f"  {what:<30}{many:>7} of {of:>7}{many / max(1, of):>9.1%}" for what, many, of in rows
        ]
        if self.mistakes:
            told.append("Read wrongly:")
        return told + [plain(f"  {m['file']}: {m['what']}") for m in self.mistakes]


def labelled(folder: Path, deck: Deck) -> list[CardLabel]:
    """Read the labels of the images in a folder.

    They are in its labels.json, a list in the form that the reader prints; or, as recorded by
    `tangy capture`, in the `label` of the JSON file beside each image: a reading, or true if `seen`
    is correct. Unlabelled images are skipped.

    Raises:
        TangyError: there are no labels, or one is invalid.
    """
    path = folder / LABELS
    name = plain(str(path))
    if path.is_file():
        told = _json(path)
        if not isinstance(told, list) or not told:
            raise TangyError(f"{name}: must be a list with an entry for each picture.")
        return [
            _label(entry, folder, deck, f"{name}: entry {place + 1}")
            for place, entry in enumerate(told)
        ]
    labels = []
    for beside in sorted(folder.glob("*.json")):
        told = _json(beside)
        if not isinstance(told, dict):
            raise TangyError(
                f"{plain(str(beside))}: must be what `tangy capture` writes, an object."
            )
        label = told.get("label")
        if label is None:
            continue
        seen = told.get("seen") if label is True else label
        entry = {**seen, "file": told.get("file")} if isinstance(seen, dict) else None
        labels.append(_label(entry, folder, deck, f"{plain(str(beside))}: its label"))
    if not labels:
        raise TangyError(
            f"{plain(str(folder))}: holds no {LABELS}, and no JSON file beside a picture has a "
            "`label`: nothing says what is in the pictures."
        )
    return labels


def _json(path: Path) -> Any:
    name = plain(str(path))
    text = read_given_text(path, LARGEST_JSON)
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        raise TangyError(f"{name}: is not JSON.") from None


def _label(entry: Any, folder: Path, deck: Deck, where: str) -> CardLabel:
    try:
        card = entry["card"]
        if card is not None and (isinstance(card, bool) or not isinstance(card, int)):
            raise TypeError
        marked, hidden = (_mask(entry.get(key, []), deck) for key in ("marked", "hidden"))
        file = folder / Path(str(entry["file"])).name
        return CardLabel(file, card, marked, hidden & ~deck.free)
    except (KeyError, TypeError, ValueError, AttributeError):
        raise TangyError(
            f"{where} needs `file`, `card` (a number or null) and `marked` "
            "(a list of [row, column] from 0)."
        ) from None


def _mask(places: Any, deck: Deck) -> int:
    columns = len(deck.columns)
    mask = deck.free
    for row, column in places:
        if not (0 <= row < deck.rows and 0 <= column < columns):
            raise ValueError
        mask |= 1 << (row * columns + column)
    return mask


def count_labelled(
    labels: list[CardLabel], read: Callable[[NDArray[Any]], CardReading]
) -> ReadingCounts:
    """Read each image (BGR) and compare it with its label.

    Raises:
        PictureError: an image cannot be read.
    """
    counted = ReadingCounts()
    for label in labels:
        reading = read(read_picture(label.path))
        counted.pictures += 1
        counted.with_card += label.card is not None
        if reading.card is not None and reading.card != label.card:
            counted.wrong_cards += 1
            right = "none" if label.card is None else f"card {label.card}"
            what = f"read as card {reading.card}, is {right}"
            counted.mistakes.append({"file": label.path.name, "what": what})
            continue
        cells = len(reading.cells)
        seen = ~label.hidden & ((1 << cells) - 1)
        if label.card is not None:
            counted.seen_cells += seen.bit_count()
        if reading.card is None:
            counted.not_told += seen.bit_count() if label.card is not None else 0
            continue
        told = seen & ~reading.hidden
        wrong = (reading.marked ^ label.marked) & told
        counted.read += 1
        counted.whole += not wrong and told == seen
        counted.wrong_cells += wrong.bit_count()
        counted.not_told += (seen & ~told).bit_count()
        if wrong:
            what = f"{wrong.bit_count()} cells read wrongly"
            counted.mistakes.append({"file": label.path.name, "what": what})
    return counted
