"""The layout of a printed card: its numbers and all positions.

Lengths are in mm from the top left corner of the card. Printing, pictures, the simulated camera and
the card reader all use this layout.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from random import Random

from tangy_profiles.cards import Deck
from tangy_profiles.errors import TangyError

WIDTH, HEIGHT = 148.0, 210.0  # A5
GRID, FEWEST = 130.0, 5  # the longer side of the grid, if it has at least this many cells
TAG = 26.0  # a corner tag of 6 x 6 modules, including its black border
LINE = 1.0  # thickness of the lines
MARGIN = 9.0  # left and right, within the printable area of any printer
TAGS_TOP, TAGS_BOTTOM = 5.0, 179.0
GRID_TOP = 44.5
LETTERS_ABOVE, LETTERS_HIGH = 5.75, 7.0  # letters: their middle above the grid, and their height
LAST_CARD = 249
"""Cards are numbered from 1; each has four of the thousand tags of its dictionary."""
USUAL_SEED = 1
"""The default deck, for printing and reading."""


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle in mm."""

    left: float
    top: float
    right: float
    bottom: float


@dataclass(frozen=True, slots=True)
class PrintedText:
    """A text centred on a point; `high` is the height of its capitals in mm."""

    text: str
    x: float
    y: float
    high: float


@dataclass(frozen=True)
class CardLayout:
    """The layout of the cards of a deck."""

    deck: Deck

    @cached_property
    def cell(self) -> float:
        """The side of a cell in mm."""
        return GRID / max(self.deck.rows, len(self.deck.columns), FEWEST)

    @cached_property
    def grid(self) -> Box:
        """The grid, between the centres of its outer lines."""
        width, height = self.cell * len(self.deck.columns), self.cell * self.deck.rows
        left, top = (WIDTH - width) / 2, GRID_TOP + (GRID - height) / 2
        return Box(left, top, left + width, top + height)

    @cached_property
    def number_high(self) -> float:
        """The height of a printed number in mm, limited by the longest number."""
        longest = max(len(str(number)) for number in self.deck.numbers)
        return 0.729 * min(0.6 * self.cell, 0.84 * self.cell / (0.696 * longest))

    def middle(self, cell: int) -> tuple[float, float]:
        """Return the middle of a cell; cells are counted row by row."""
        row, column = divmod(cell, len(self.deck.columns))
        return (
            self.grid.left + (column + 0.5) * self.cell,
            self.grid.top + (row + 0.5) * self.cell,
        )

    def lines(self) -> Iterator[Box]:
        """Yield the lines of the grid as black boxes."""
        half, grid = LINE / 2, self.grid
        for row in range(self.deck.rows + 1):
            y = grid.top + row * self.cell
            yield Box(grid.left - half, y - half, grid.right + half, y + half)
        for column in range(len(self.deck.columns) + 1):
            x = grid.left + column * self.cell
            yield Box(x - half, grid.top - half, x + half, grid.bottom + half)

    def words(self, card: int, seed: int, title: str) -> Iterator[PrintedText]:
        """Yield all texts on a card."""
        for column, told in enumerate(self.deck.columns):
            x = self.grid.left + (column + 0.5) * self.cell
            yield PrintedText(told.letter, x, self.grid.top - LETTERS_ABOVE, LETTERS_HIGH)
        for cell, number in enumerate(numbers_of(self.deck, card, seed)):
            free = self.deck.free >> cell & 1
            x, y = self.middle(cell)
            yield (
                PrintedText("FREE", x, y, self.cell / 5)
                if free
                else PrintedText(str(number), x, y, self.number_high)
            )
        middle = WIDTH / 2
        yield PrintedText(title, middle, TAGS_TOP + 5, 5.0)
        yield PrintedText(str(card), middle, TAGS_TOP + 19, 11.0)
        yield PrintedText(f"card {card}", middle, TAGS_BOTTOM + 9, 5.0)
        yield PrintedText(f"deck {seed}", middle, TAGS_BOTTOM + 18, 3.0)


TAGS = (
    Box(MARGIN, TAGS_TOP, MARGIN + TAG, TAGS_TOP + TAG),
    Box(WIDTH - MARGIN - TAG, TAGS_TOP, WIDTH - MARGIN, TAGS_TOP + TAG),
    Box(WIDTH - MARGIN - TAG, TAGS_BOTTOM, WIDTH - MARGIN, TAGS_BOTTOM + TAG),
    Box(MARGIN, TAGS_BOTTOM, MARGIN + TAG, TAGS_BOTTOM + TAG),
)
"""The corner tags, clockwise from the top left."""


def tag_ids(card: int) -> tuple[int, ...]:
    """Return the ids of a card's corner tags in the dictionary 4X4, clockwise from the top left."""
    return tuple(4 * card + corner for corner in range(len(TAGS)))


def numbers_of(deck: Deck, card: int, seed: int = USUAL_SEED) -> tuple[int, ...]:
    """Return the numbers of a card, row by row; they depend only on card and seed.

    Raises:
        TangyError: there is no card of this number.
    """
    if not 1 <= card <= LAST_CARD:
        raise TangyError(f"There is no card {card}: cards are numbered 1 to {LAST_CARD}.")
    return deck.deal(Random(f"tangy deck {seed} card {card}").random)


def rows_of(deck: Deck, card: int, seed: int = USUAL_SEED) -> list[list[int]]:
    """Return the numbers of a card as rows (see `numbers_of`)."""
    numbers, width = numbers_of(deck, card, seed), len(deck.columns)
    return [list(numbers[row * width : (row + 1) * width]) for row in range(deck.rows)]


def called_cells(deck: Deck, numbers: tuple[int, ...], called: set[int]) -> int:
    """Return the cells whose number was called, and the free cell, as a mask."""
    return deck.free | sum(1 << cell for cell, number in enumerate(numbers) if number in called)
