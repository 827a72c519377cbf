"""Reads the card in an image: its number, its marked cells, and the undecided ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.card_detection import Sighting, find_cards
from tangy_hw.perception.cards.classifier import HIDDEN, MARKED, UNMARKED, load_classifier
from tangy_hw.perception.cards.features import CellFeatures, features_of
from tangy_hw.perception.cards.likeness import unlike_others
from tangy_hw.perception.cards.rectification import flatten
from tangy_profiles.card_face import USUAL_SEED, CardLayout, called_cells, numbers_of
from tangy_profiles.cards import CardState, Deck, judge_partly

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[Any]
    Real = NDArray[Any]

WIDEST = 1920  # pixels; larger images are scaled down first
TRIES = 4  # sightings to try, the most certain first
LEGIBLE = 0.6  # correlation from which a number counts as legible
AGREE, FEWEST_AGREE = 0.6, 4  # share and minimum of legible numbers that must match the card's
COVERED = 0.7  # share of surely marked cells of a card with few bare numbers
CLEARLY = 0.8  # correlation of a bare number: chips reach .7, bare numbers .9
BY_CHANCE = 1e-6  # or enough matches that another deck's card would hardly have
NO_TAGS = "no card in sight"
TOO_LITTLE = "too little of the card in sight"
OTHER_NUMBERS = "not a card of this deck"
UNCERTAIN = 1 / 3
HAND = 0.5  # probability of hidden from which a hand is on the card
MAYBE_HAND = 0.1  # probability of hidden from which a hand may be on the card
CERTAIN_UNMARKED = 0.99  # minimum for a state, given that the cell is visible
CERTAIN_MARKED = 0.965, 0.996  # for marked cells: without a hand, with a possible hand
FADED = 0.6  # of the card's usual contrast: a bare number has more


@dataclass(frozen=True)
class CardReading:
    """A reading of a card: its number (None if unreadable) and its cells.

    Masks have the bits of `Deck`'s cells. `cells` are probabilities that a cell is marked;
    `confidence` is that of the least certain decided cell; `problem` says why there is no card.
    `cards` are the numbers of all cards in sight, legible or not, with copies; if there are
    several, none is read, because it is unclear which one is meant.
    """

    card: int | None
    marked: int
    hidden: int
    confidence: float
    cells: tuple[float, ...]
    problem: str = ""
    parts: tuple[tuple[float, float, float], ...] = ()
    corners: tuple[tuple[float, float], ...] = ()
    cards: tuple[int, ...] = ()


def cards_in(readings: Sequence[CardReading]) -> tuple[int, ...]:
    """Return the numbers of all cards in sight in any of several frames."""
    most = max((reading.cards for reading in readings), key=len, default=())
    more = {card for reading in readings for card in reading.cards}.difference(most)
    return tuple(sorted((*most, *more)))


def several_words(cards: Sequence[int]) -> str:
    """Return a phrase that says which cards are in sight."""
    if len(set(cards)) == 1:
        return f"{_count(len(cards))} copies of card {cards[0]} in sight"
    *first, last = sorted(set(cards))
    return f"{_count(len(cards))} cards in sight: {', '.join(map(str, first))} and {last}"


def _count(number: int) -> str:
    words = ("no", "one", "two", "three", "four")
    return words[number] if number < len(words) else str(number)


def _reconsidered(parts: Real, measured: CellFeatures, across: int) -> Real:
    """Make cells uncertain: unmarked ones with a pale number, and marks unlike the others.

    Objects on a number reduce its contrast, however clear or pale they are; light does not.
    """
    import numpy as np

    parts = parts.copy()
    unmarked = parts[:, UNMARKED] >= parts[:, MARKED]
    parts[unmarked & (measured.compared("middle of usual") < FADED)] = UNCERTAIN
    tells, hand = load_classifier().tells, _has_hand(parts)
    told = np.array([tells(part, hand) for part in parts])
    parts[unlike_others(measured, parts, told, across)] = UNCERTAIN
    return parts


def _has_hand(parts: Real) -> bool:
    return bool(parts[:, HIDDEN].max() >= HAND)


class CardReader:
    """Reads cards of one deck."""

    def __init__(self, deck: Deck, deck_seed: int = USUAL_SEED) -> None:
        self.deck = deck
        self.deck_seed = deck_seed
        self.face = CardLayout(deck)

    def read(self, picture: Picture) -> CardReading:
        """Read the card in an image (BGR); none if there are several."""
        import cv2
        import numpy as np

        larger = max(picture.shape[:2]) / WIDEST
        if larger > 1:
            size = round(picture.shape[1] / larger), round(picture.shape[0] / larger)
            smaller = cv2.resize(picture, size, interpolation=cv2.INTER_AREA).astype(np.uint8)
            reading = self._read(smaller)
            if reading.problem != NO_TAGS:
                return reading
        return self._read(picture)

    def _read(self, picture: Picture) -> CardReading:
        import cv2

        grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype("uint8")
        sightings = find_cards(grey)
        there = tuple(sorted(seen.card for seen in sightings if seen.sure))
        if len(there) > 1:
            return self.several(there)
        problem = NO_TAGS
        for seen in sightings[:TRIES]:
            reading = self._read_card(picture, seen)
            if reading.card is not None:
                there = there if seen.sure else (*there, reading.card)
                return reading if len(there) == 1 else self.several(there)
            if seen.sure:  # otherwise it may not be a tag
                problem = reading.problem
        return self.nothing(problem, there)

    def nothing(self, problem: str, cards: Sequence[int] = ()) -> CardReading:
        """Return an empty reading, with these cards in sight."""
        cells = self.deck.rows * len(self.deck.columns)
        return CardReading(
            None,
            self.deck.free,
            ((1 << cells) - 1) & ~self.deck.free,
            0.0,
            (0.5,) * cells,
            problem,
            ((UNCERTAIN,) * 3,) * cells,
            cards=tuple(cards),
        )

    def several(self, cards: Sequence[int]) -> CardReading:
        """Return the reading of several cards in sight, none of them read."""
        return self.nothing(several_words(cards), sorted(cards))

    def _read_card(self, picture: Picture, seen: Sighting) -> CardReading:
        import numpy as np

        from tangy_hw.perception.cards.card_detection import project

        flat = flatten(picture, seen, self.face, self.deck_seed)
        if flat is None:
            return self.nothing(TOO_LITTLE)
        numbers = numbers_of(self.deck, seen.card, self.deck_seed)
        measured = features_of(flat, self.face, numbers)
        read = measured.read
        legible = read[:, :2].max(1) >= LEGIBLE
        own = int((legible & (read[:, 0] >= read[:, 1])).sum())
        across = len(self.deck.columns)
        parts = load_classifier().probabilities(measured.rows, measured.beside, across)
        parts = _reconsidered(parts, measured, across)
        agreed = self.agree(own, int(legible.sum()))
        if not agreed and not (seen.sure and self.covered(parts, read)):
            few = int(legible.sum()) < FEWEST_AGREE
            return self.nothing(TOO_LITTLE if few else OTHER_NUMBERS)
        grid = self.face.grid
        ends = [
            (grid.left, grid.top),
            (grid.right, grid.top),
            (grid.right, grid.bottom),
            (grid.left, grid.bottom),
        ]
        corners = project(flat.plane, np.array(ends))
        return self.told(seen.card, parts, tuple((float(x), float(y)) for x, y in corners))

    def agree(self, own: int, legible: int) -> bool:
        """Return whether enough of the legible numbers match the card."""
        if own < FEWEST_AGREE:
            return False
        if own >= AGREE * legible:  # chips may look like other numbers
            return True
        chance = max(1 / (column.high - column.low + 1) for column in self.deck.columns)
        by_chance = sum(
            comb(legible, same) * chance**same * (1 - chance) ** (legible - same)
            for same in range(own, legible + 1)
        )
        return by_chance < BY_CHANCE

    def covered(self, parts: Real, read: Real) -> bool:
        """Return whether marks cover so many numbers that too few are legible.

        Only the tags identify the card then, and no number of another card may be bare.

        Args:
            parts: class probabilities of each cell (cells, 3).
            read: correlations of each cell with the card's own number and any other (cells, >= 2).
        """
        other = (read[:, 1] > read[:, 0]) & (read[:, 1] >= CLEARLY)
        tells, hand = load_classifier().tells, _has_hand(parts)
        cells = [cell for cell in range(len(parts)) if not self.deck.free >> cell & 1]
        marks = sum(part[MARKED] > part[UNMARKED] and tells(part, hand) for part in parts[cells])
        return not other.any() and marks >= COVERED * len(cells)

    def told(
        self, card: int, parts: Real, corners: tuple[tuple[float, float], ...] = ()
    ) -> CardReading:
        """Decide the cells from their probabilities, and return the reading."""
        classifier = load_classifier()
        hand = _has_hand(parts)
        marked = hidden = 0
        confidence = 1.0
        for cell, part in enumerate(parts):
            if self.deck.free >> cell & 1:
                marked |= 1 << cell
                continue
            best = float(max(part[UNMARKED], part[MARKED]))
            if not classifier.tells(part, hand):
                hidden |= 1 << cell
                continue
            confidence = min(confidence, best)
            marked |= int(part[MARKED] > part[UNMARKED]) << cell
        return CardReading(
            card,
            marked,
            hidden,
            confidence,
            tuple(
                1.0 if self.deck.free >> cell & 1 else float(part[MARKED] + part[HIDDEN] / 2)
                for cell, part in enumerate(parts)
            ),
            "",
            tuple((float(a), float(b), float(c)) for a, b, c in parts),
            corners,
            (card,),
        )

    def fuse(self, readings: Sequence[CardReading]) -> CardReading:
        """Fuse readings of the same card into one; if they show different cards, read none."""
        import numpy as np

        there = cards_in(readings)
        if len(there) > 1:
            return self.several(there)
        told = [reading for reading in readings if reading.card is not None]
        if len(readings) == 1 or not told:
            return readings[-1] if readings else self.nothing(NO_TAGS)
        parts = np.array([reading.parts for reading in told], float)
        odds = np.log(np.clip(parts, 1e-6, 1)[..., MARKED] / np.clip(parts, 1e-6, 1)[..., UNMARKED])
        seen = 1 - parts[..., HIDDEN]
        # Errors of frames from one camera are correlated, so evidence is discounted by a square
        # root.
        total = (odds * seen).sum(0) / np.maximum(seen.sum(0), 1) ** 0.5
        hidden = np.prod(parts[..., HIDDEN], 0) ** (1 / len(parts) ** 0.5)
        marked = (1 - hidden) / (1 + np.exp(-total))
        fused = np.stack([1 - hidden - marked, marked, hidden], 1).astype(np.float32)
        return self.told(there[0], fused, readings[-1].corners)

    def state(self, reading: CardReading, states: Sequence[CardState], called: set[int]) -> str:
        """Return the user activity state of a card; the unread one if uncertain.

        A state requires more certainty than a single cell, because one wrong cell makes it wrong.
        """
        unread = next(state.name for state in states if state.checker == "unread")
        if reading.card is None:
            return unread
        numbers = numbers_of(self.deck, reading.card, self.deck_seed)
        cells = called_cells(self.deck, numbers, called)
        unknown = reading.hidden | self._doubted(reading)
        return judge_partly(states, self.deck, reading.marked, unknown, cells)

    def _doubted(self, reading: CardReading) -> int:
        """Return a mask of the cells that are too uncertain for a state."""
        hand = any(part[HIDDEN] >= MAYBE_HAND for part in reading.parts)
        doubted = 0
        for cell, (unmarked, marked, _) in enumerate(reading.parts):
            if marked > unmarked:
                unsure = marked < CERTAIN_MARKED[hand]
            else:
                unsure = unmarked < CERTAIN_UNMARKED * (unmarked + marked)
            doubted |= int(unsure) << cell
        return doubted & ~self.deck.free

    def document(self, reading: CardReading) -> dict[str, Any]:
        """Return a reading as JSON."""
        columns = len(self.deck.columns)

        def places(mask: int) -> list[list[int]]:
            return [
                list(divmod(cell, columns))
                for cell in range(self.deck.rows * columns)
                if mask >> cell & 1
            ]

        cells = [round(part, 4) for part in reading.cells]
        return {
            "card": reading.card,
            "marked": places(reading.marked) if reading.card is not None else [],
            "hidden": places(reading.hidden),
            "confidence": round(reading.confidence, 4),
            "cells": [cells[row * columns : (row + 1) * columns] for row in range(self.deck.rows)],
            "cards": list(reading.cards),
            "problem": reading.problem,
        }
