"""A small picture in half-block characters, two pixels a cell; without colours, in grey shades."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region
from textual.strip import Strip

from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import draw
from tangy_tui.ui.widgets.wrapping import wrap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Cells = NDArray[Any]
    """An array of shape (rows, columns, 2, 3): upper and lower pixel, RGB."""

BLOCK = "▀"
SHADES = " .:-=+*#%@"
STEPS = 8  # of 256: similar colours are drawn alike, so that noise sends nothing
ALIKE = 14  # of 256: smaller changes of a pixel are not redrawn


class Pixels(Protocol):
    """A picture of BGR pixels, row by row."""

    @property
    def width(self) -> int:
        """Its width in pixels."""
        ...

    @property
    def height(self) -> int:
        """Its height in pixels."""
        ...

    @property
    def pixels(self) -> bytes:
        """Its BGR bytes."""
        ...


class BlockPicture(InkedWidget, can_focus=True):
    """Shows a picture made to `fit`, centred; redraws only the cells that changed."""

    HELP: ClassVar[str] = ""

    def __init__(self, title: str, help: str, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.border_title = title
        self.HELP = help  # type: ignore[misc] # one for each widget
        self._cells: Cells | None = None
        self._strips: dict[int, Strip] = {}
        self._sentence = ""

    @property
    def fit(self) -> tuple[int, int]:
        """The size of the largest picture that fits, in pixels: columns and rows."""
        width, height = self.content_size
        return max(1, width), max(1, 2 * height)

    @property
    def there(self) -> bool:
        """Whether a picture is shown."""
        return self._cells is not None

    def say(self, sentence: str) -> None:
        """Show a sentence instead of a picture."""
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
        """Redraw at the new size."""
        self._forget()

    def notify_style_update(self) -> None:
        """Redraw in the new colours."""
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
        """Return the number of empty columns and lines before the picture."""
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
    """Pack two rows of pixels into one line of cells; repeat the last row of an odd number."""
    import numpy as np

    pixels = np.frombuffer(picture.pixels, np.uint8)
    image = pixels.reshape(picture.height, picture.width, 3)[:, :, ::-1]
    if picture.height % 2:
        image = np.concatenate([image, image[-1:]])
    return image.reshape(-1, 2, picture.width, 3).transpose(0, 2, 1, 3).copy()


def _shades(row: Cells) -> str:
    """Draw a line of cells as characters, denser for brighter ones."""
    levels = (row.astype(float) @ (0.299, 0.587, 0.114)).mean(axis=1)
    return "".join(SHADES[int(level) * len(SHADES) // 256] for level in levels)


def _blocks(row: Cells) -> list[Segment]:
    """Draw a line of cells in colours; equal neighbours share a segment."""
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
    """Return the style of a cell: the upper pixel is the foreground, the lower the background."""
    return Style(
        color=Color.from_rgb(red, green, blue), bgcolor=Color.from_rgb(red_2, green_2, blue_2)
    )
