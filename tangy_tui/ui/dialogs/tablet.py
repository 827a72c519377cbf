"""Pairing a tablet as the chest screen: the address as text and as a QR code."""

from __future__ import annotations

from tangy_tui.text.tablet import TABLET_TITLE, tablet_lines
from tangy_tui.ui.dialogs.message import MessageDialog

QUIET = 2  # modules of light around the code


class TabletDialog(MessageDialog):
    """The address, the pairing code, and a QR code of the address."""

    DEFAULT_CSS = """
    TabletDialog #message { width: auto; min-width: 44; max-height: 100%; }
    """

    def __init__(self, address: str, code: str) -> None:
        super().__init__(
            "\n".join([*tablet_lines(address, code), *qr_lines(address)]), TABLET_TITLE
        )


def qr_lines(text: str) -> list[str]:
    """Draw a text as a QR code, with two modules in a cell; dark ones are blank."""
    import segno

    rows = [[not dark for dark in row] for row in segno.make(text, error="l").matrix]
    wide = len(rows[0]) + 2 * QUIET
    light = [True] * wide
    padded = [light] * QUIET + [[True] * QUIET + row + [True] * QUIET for row in rows]
    padded += [light] * QUIET
    if len(padded) % 2:
        padded.append(light)
    halves = {(True, True): "█", (True, False): "▀", (False, True): "▄", (False, False): " "}
    return [
        "".join(halves[pair] for pair in zip(upper, lower, strict=True))
        for upper, lower in zip(padded[::2], padded[1::2], strict=True)
    ]
