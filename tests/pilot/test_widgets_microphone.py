"""The line of the microphone in all its states, in every width, and in ASCII."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import cell_len
from textual.app import ComposeResult

from tangy_tui.text.mic_check import trouble_words
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import to_ascii
from tangy_tui.ui.widgets.microphone_line import BAR, MicrophoneLine
from tests.support.gallery import HEARD, SampleEars

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


class Line(TangyScreen[None]):
    """A screen with the line alone."""

    def __init__(self, ears: SampleEars, expects: str = "") -> None:
        super().__init__()
        self.line = MicrophoneLine(ears, lambda: expects)

    def compose(self) -> ComposeResult:
        yield self.line


SAID = {
    "off": "○ t talk",
    "listening": "● listening ...",
    "speaking": "● hearing you ...",
    "thinking": "○ thinking ...",
    "shut": "○ shut while Tangy speaks",
    "over": "○ closed",
}


async def test_every_state_has_words_that_fit(run: Run) -> None:
    screen = Line(SampleEars("off"))
    async with run(screen) as pilot:
        for width in (60, 80, 120):
            await pilot.resize_terminal(width, 24)
            for ears in HEARD:
                screen.line.ears = ears
                screen.line.ticks = 0
                screen.line.look()
                screen.line.tick()
                await pilot.pause()
                text = screen.line.text
                assert cell_len(text) <= width - 2
                assert text.strip() in pilot.text()
                if ears.trouble:
                    assert trouble_words(ears.trouble)[:40] in text
                else:
                    assert text.startswith(SAID[ears.state])
                    assert ears.words in text
                plain = to_ascii(text)
                assert plain.isascii()
                assert plain.count("?") == text.count("?")


async def test_the_bar_length_follows_the_level(run: Run) -> None:
    ears = SampleEars("listening")
    screen = Line(ears)
    async with run(screen):
        for level, full in ((0.0, 0), (0.5, 6), (1.0, 12), (7.0, 12), (-1.0, 0)):
            ears.level = level
            screen.line.tick()
            assert screen.line.text.count("■") == full
            assert screen.line.text.count("·") == BAR - full


async def test_the_line_shows_the_last_of_many_words(run: Run) -> None:
    screen = Line(SampleEars("speaking", " ".join(f"word{n}" for n in range(40))))
    async with run(screen) as pilot:
        assert screen.line.text.endswith("word39")
        assert "…" in screen.line.text
        await pilot.resize_terminal(60, 20)
        await pilot.pause()
        assert screen.line.text.endswith("word39")


async def test_the_line_names_the_restricted_vocabulary(run: Run) -> None:
    screen = Line(SampleEars("listening"), "yes, no or stop")
    async with run(screen):
        assert "listening for yes, no or stop ..." in screen.line.text
        assert "ends it" not in screen.line.text


async def test_markup_in_decoded_words_is_shown_as_text(run: Run) -> None:
    screen = Line(SampleEars("speaking", "call \x1b[31m[/][@click=app.quit]"))
    async with run(screen) as pilot:
        assert "\x1b" not in screen.line.text
        assert "[/]" in pilot.text()


async def test_a_recording_has_no_level(run: Run) -> None:
    screen = Line(SampleEars("listening", level=0.5, live=False))
    async with run(screen):
        assert "■" not in screen.line.text
        assert screen.line.timer is not None
        assert not screen.line.timer._active.is_set()
