"""Detecting the capabilities of the terminal."""

from __future__ import annotations

import io
import subprocess
import sys

import pytest

from tangy_tui.ui.terminal import TerminalKind, terminal_kind, too_small


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def kind(environ: dict[str, str], ascii: bool | None = None) -> TerminalKind:
    return terminal_kind(environ, stdin=Terminal(), stdout=Terminal(), ascii=ascii)


UTF8 = "en_GB.UTF-8"


@pytest.mark.parametrize(
    ("environ", "expected"),
    [
        ({"TERM": "xterm-256color", "LANG": UTF8}, TerminalKind()),
        ({"TERM": "tmux-256color", "LANG": "C.UTF-8"}, TerminalKind()),
        ({"TERM": "xterm", "COLORTERM": "truecolor", "LANG": UTF8}, TerminalKind()),
        ({"TERM": "xterm", "LANG": UTF8}, TerminalKind(ansi=True)),
        ({"TERM": "screen", "LANG": UTF8}, TerminalKind(ansi=True)),
        ({"TERM": "vt100", "LANG": UTF8}, TerminalKind(ansi=True)),
        ({"TERM": "linux", "LANG": UTF8}, TerminalKind(ansi=True, ascii=True)),
        ({"TERM": "xterm-256color", "LANG": UTF8, "NO_COLOR": "1"}, TerminalKind(ansi=True)),
        ({"TERM": "xterm-256color", "LANG": UTF8, "NO_COLOR": ""}, TerminalKind()),
        ({"TERM": "xterm-256color", "LANG": "C"}, TerminalKind(ascii=True)),
        ({"TERM": "xterm-256color"}, TerminalKind(ascii=True)),
        ({"TERM": "xterm-256color", "LANG": UTF8, "LC_ALL": "C"}, TerminalKind(ascii=True)),
        ({"TERM": "xterm-256color", "LANG": "de_DE.ISO-8859-1"}, TerminalKind(ascii=True)),
        ({"TERM": "xterm-256color", "LANG": "C", "LC_CTYPE": "C.utf8"}, TerminalKind()),
    ],
)
def test_the_environment_determines_the_kind_of_terminal(
    environ: dict[str, str], expected: TerminalKind
) -> None:
    assert kind(environ) == expected


def test_ascii_can_be_forced_and_refused() -> None:
    assert kind({"TERM": "xterm-256color", "LANG": UTF8}, True).ascii
    assert not kind({"TERM": "linux", "LANG": UTF8}, False).ascii


def test_an_unsuitable_terminal_gets_the_line_mode() -> None:
    dumb = kind({"TERM": "dumb", "LANG": UTF8})
    assert not dumb.full_screen
    assert "TERM=dumb" in dumb.reason
    piped = terminal_kind({"TERM": "xterm"}, stdin=io.StringIO(), stdout=Terminal())
    assert not piped.full_screen
    assert "not a terminal" in piped.reason
    closed = io.StringIO()
    closed.close()
    assert not terminal_kind({"TERM": "xterm"}, stdin=Terminal(), stdout=closed).full_screen


def test_the_sentence_for_a_small_window() -> None:
    assert too_small(60, 18) is None
    assert too_small(40, 10) == (
        "Tangy needs 60 x 18 characters; this window has 40 x 10. Make it larger: nothing is lost."
    )
    assert too_small(200, 17) is not None
    assert too_small(59, 50) is not None


def loaded(module: str) -> set[str]:
    """Return the top-level modules that a module's import loads."""
    code = f"import sys, {module}; print(*{{m.split('.')[0] for m in sys.modules}})"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603 - our own
    return set(done.stdout.split())


def test_detecting_the_terminal_loads_no_textual() -> None:
    assert not loaded("tangy_tui.ui.terminal") & {"textual", "rich"}


@pytest.mark.slow
@pytest.mark.parametrize("module", ["tangy_tui.ui.app", "tests.support.gallery"])
def test_the_screens_load_nothing_heavy(module: str) -> None:
    heavy = {"numpy", "sklearn", "cv2", "scipy", "pocketsphinx", "skimage", "joblib"}
    assert not loaded(module) & heavy
