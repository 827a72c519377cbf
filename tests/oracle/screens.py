"""Scenes on a real terminal: keys are typed, and the readable text is recorded."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import monotonic

from tests.support.terminal import TANGY, Terminal

QUIET = 0.8
"""Seconds without a byte after which a screen counts as settled."""

LONGEST = 8.0
"""Seconds after which a screen that never settles is recorded as it is."""

_GUIDED = ["teach", "--guided", "--teacher", "scripted", "--seed", "1", "--plain"]
_TAUGHT = (_GUIDED, ["learn"])


@dataclass(frozen=True)
class Scene:
    """A program in a terminal of a size, and the keys that are typed there in turn.

    Each entry of `keys` is the text that must be on the screen first (or "" for a settled screen),
    and the keys that are typed then.
    """

    name: str
    words: list[str]
    keys: list[tuple[str, str]]
    size: tuple[int, int] = (80, 24)
    before: tuple[list[str], ...] = field(default=())


def show(scene: Scene, data: str) -> str:
    """Return the scene's text at first and after each entry of its keys."""
    columns, lines = scene.size
    terminal = Terminal(
        [TANGY, *scene.words, "--data", data],
        columns=columns,
        lines=lines,
        environment={"USER": "ada", "LOGNAME": "ada", "XDG_CACHE_HOME": f"{data}/cache"},
    )
    shown: list[str] = []
    try:
        for seen, keys in scene.keys:
            if seen:
                terminal.until(seen)
            _settle(terminal)
            shown.append(terminal.text)
            terminal.type(keys)
        _settle(terminal)
        shown.append(terminal.text)
    finally:
        terminal.end()
    rule = "\n" + "=" * columns + "\n"
    return rule.join(shown)


def _settle(terminal: Terminal) -> None:
    deadline = monotonic() + LONGEST
    while terminal.read(QUIET) and monotonic() < deadline:
        pass


SIZES = {"80x24": (80, 24), "120x40": (120, 40)}

F1, F4 = "\x1bOP", "\x1bOS"
_TEACH = [
    ("Who are you?", "\r"),
    ("skips the tour", "\x1b"),
    ("No steps yet", "greet everyone"),
    ("> greet everyone", "\r"),
    ("Did you say", "y"),
    ("Steps", "call number"),
    ("> call number", "\r"),
    ("Did you say", "n"),
    ("> call number", "\x1b"),
    ("", F4),
    ("", "\x1b"),
    ("", F1),
    ("", "\x1b"),
]
_HOME = [("Teach", "?"), ("", "\x1b")]
_PLAY = [("pause", "e"), ("plays again", "2"), *(("", key) for key in ("3", "4", "6", "1", "?"))]
_ROOMS = "iloeh"
"""Keys of the home screen's choices that show learnt data and run no game by the clock."""


def _scenes() -> list[Scene]:
    scenes = []
    for label, size in SIZES.items():
        scenes += [
            Scene(f"teach-{label}", ["teach", "--seed", "1"], _TEACH, size),
            Scene(f"home-{label}", [], _HOME, size, _TAUGHT),
            Scene(
                f"play-{label}",
                ["play", "--seed", "1", "--speed", "1000"],
                _PLAY,
                size,
                _TAUGHT,
            ),
        ]
        for key in _ROOMS:
            scenes.append(Scene(f"home-{key}-{label}", [], [("Teach", key)], size, _TAUGHT))
    return scenes


SCREENS = _scenes()
