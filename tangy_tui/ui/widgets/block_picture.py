"""A small picture drawn in blocks, two pixels a cell; or in shades, where there are no colours."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region
from textual.strip import Strip

from tangy_tui.ui.widgets.inks import Inked
from tangy_tui.ui.widgets.rows import draw
from tangy_tui.ui.widgets.wrapping import wrap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Cells = NDArray[Any]
    """Rows, columns, upper and lower pixel, red-green-blue."""

BLOCK = "▀"
SHADES = " .:-=+*#%@"
STEPS = 8  # of 256: colours that are nearer are drawn alike, so that noise costs nothing
ALIKE = 14  # of 256: by so much a pixel changes before it is drawn anew


class Pixels(Protocol):
    """A picture, blue, green and red, row by row."""

    @property
    def width(self) -> int:
        """Its columns."""
        ...

    @property
    def height(self) -> int:
        """Its rows."""
        ...

    @property
    def pixels(self) -> bytes:
        """Its bytes."""
        ...


class BlockPicture(Inked, can_focus=True):
    """Shows a picture that was made to `fit`, in the middle; only cells that changed are drawn."""

    HELP: ClassVar[str] = ""

    def __init__(self, title: str, help: str, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.border_title = title
        self.HELP = help  # type: ignore[misc] # of each its own
        self._cells: Cells | None = None
        self._strips: dict[int, Strip] = {}
        self._sentence = ""

    @property
    def fit(self) -> tuple[int, int]:
        """The pixels that there is room for: columns and rows."""
        width, height = self.content_size
        return max(1, width), max(1, 2 * height)

    @property
    def there(self) -> bool:
        """Whether there is a picture."""
        return self._cells is not None

    def say(self, sentence: str) -> None:
        """Show a sentence in place of a picture."""
        if self._cells is not None or sentence != self._sentence:
            self._cells, self._sentence = None, sentence
            self._forget()

    def show(self, picture: Pixels) -> None:
        """Show a picture."""
        import numpy as np

        new = _cells(picture)
        old = self._cells
        if old is None or old.shape != new.shape:
            self._cells = new
            self._forget()
            return
        far = np.abs(new.astype(np.int16) - old).max(axis=(2, 3)) >= ALIKE
        if not far.any():
            return
        old[far] = new[far]
        left, top = self._offset(old)
        regions: list[Region] = []
        for row in np.flatnonzero(far.any(axis=1)):
            columns = np.flatnonzero(far[row])
            first, last = int(columns[0]), int(columns[-1])
            self._strips.pop(int(row) + top, None)
            regions.append(Region(left + first, int(row) + top, last - first + 1, 1))
        self.refresh(*regions)

    def on_resize(self, event: events.Resize) -> None:
        """Draw anew."""
        self._forget()

    def notify_style_update(self) -> None:
        """Draw in the new colours."""
        super().notify_style_update()
        self._strips.clear()

    def render_line(self, y: int) -> Strip:
        """Draw one line."""
        if y not in self._strips:
            self._strips[y] = self._strip(y)
        return self._strips[y]

    def _forget(self) -> None:
        self._strips.clear()
        self.refresh()

    def _offset(self, cells: Cells) -> tuple[int, int]:
        """Return how many columns and lines are free before the picture."""
        width, height = self.content_size
        return max(0, (width - cells.shape[1]) // 2), max(0, (height - cells.shape[0]) // 2)

    def _strip(self, y: int) -> Strip:
        width, height = self.content_size
        cells = self._cells
        if cells is None:
            lines = wrap(self._sentence, max(1, width))
            n = y - max(0, (height - len(lines)) // 2)
            text = lines[n] if 0 <= n < len(lines) else ""
            return draw(self, ((text.center(width), "dim"),), width)
        left, top = self._offset(cells)
        blank = self.ink("blank")
        if not 0 <= y - top < len(cells):
            return Strip.blank(width, blank)
        row = cells[y - top]
        kind: Any = getattr(self.app, "kind", None)
        if self.app.native_ansi_color or (kind is not None and kind.ascii):
            shades = Segment(_shades(row), self.ink("text"))
            strip = Strip([Segment(" " * left, blank), shades])
        else:
            strip = Strip([Segment(" " * left, blank), *_blocks(row)])
        return strip.adjust_cell_length(width, blank)


def _cells(picture: Pixels) -> Cells:
    """Put two rows of pixels on one line; a row that is left over at the end is doubled."""
    import numpy as np

    pixels = np.frombuffer(picture.pixels, np.uint8)
    image = pixels.reshape(picture.height, picture.width, 3)[:, :, ::-1]
    if picture.height % 2:
        image = np.concatenate([image, image[-1:]])
    return image.reshape(-1, 2, picture.width, 3).transpose(0, 2, 1, 3).copy()


def _shades(row: Cells) -> str:
    """Draw a line of cells in characters, the brighter the denser."""
    levels = (row.astype(float) @ (0.299, 0.587, 0.114)).mean(axis=1)
    return "".join(SHADES[int(level) * len(SHADES) // 256] for level in levels)


def _blocks(row: Cells) -> list[Segment]:
    """Draw a line of cells in colours; cells side by side that are alike in one piece."""
    steps = row // STEPS * STEPS + STEPS // 2
    segments: list[Segment] = []
    last, count = (), 0
    for cell in steps.reshape(len(row), 6).tolist():
        here = tuple(cell)
        if here == last:
            count += 1
            continue
        if count:
            segments.append(Segment(BLOCK * count, _style(*last)))
        last, count = here, 1
    segments.append(Segment(BLOCK * count, _style(*last)))
    return segments


@lru_cache(8192)
def _style(red: int, green: int, blue: int, red_2: int, green_2: int, blue_2: int) -> Style:
    """Return the style of a cell: the upper pixel is written, the lower one its background."""
    return Style(
        color=Color.from_rgb(red, green, blue), bgcolor=Color.from_rgb(red_2, green_2, blue_2)
    )
