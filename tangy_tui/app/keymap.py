"""The keymap: every action of any screen, with its keys and its typed word.

A key means the same on every screen. Key bindings, the line of keys at the foot, help and the
command palette all come from this table; `tangy_tui/text/keys.py` has the names of the actions.
Letters are keys only if no input line has the focus. Users may change keys in `settings.toml`.
"""

from __future__ import annotations

import string
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from tangy_profiles.reading import Table, nearest


@dataclass(frozen=True, slots=True)
class KeyAction:
    """An action and its keys.

    `keys` use Textual's names; the first one is shown while an input line takes letters. `word` is
    typed in a line or in the palette. A `fixed` action keeps its keys. An action `with_line` also
    works while the user types, so it takes no letter alone.
    """

    id: str
    keys: tuple[str, ...]
    word: str
    fixed: bool = False
    with_line: bool = False


def _line(id: str, keys: tuple[str, ...], word: str) -> KeyAction:
    return KeyAction(id, keys, word, with_line=True)


def _fixed(id: str, *keys: str, word: str = "") -> KeyAction:
    return KeyAction(id, keys, word, fixed=True)


ACTIONS: tuple[KeyAction, ...] = (
    # everywhere
    _line("stop", ("ctrl+x",), "stop"),
    _line("quit", ("ctrl+c", "ctrl+q"), "quit tangy"),
    _line("palette", ("ctrl+p",), "commands"),
    _line("help", ("f1", "question_mark"), "help"),
    _line("draw", ("ctrl+l",), "draw again"),
    _line("talk", ("ctrl+t", "t"), "talk"),
    _line("listen", ("f9",), "pause listening"),
    _line("name", ("ctrl+n",), "name"),
    KeyAction("messages", ("exclamation_mark",), "messages"),
    KeyAction("command", ("colon",), "command"),
    KeyAction("filter", ("slash",), "filter"),
    KeyAction("zoom", ("plus",), "enlarge"),
    KeyAction("picture", ("s",), "picture"),
    KeyAction("mouse", ("m",), "mouse"),
    KeyAction("voice", ("v",), "voice"),
    KeyAction("phrases", ("A",), "phrases"),
    # teaching and learning
    _line("undo", ("f2", "ctrl+z"), "undo"),
    _line("redo", ("f3", "ctrl+y"), "redo"),
    _line("why", ("f4", "w"), "why"),
    _line("learn", ("f5",), "learn"),
    _line("library", ("f6",), "library"),
    _line("next", ("f7", "g"), "next"),
    _line("guided", ("f8",), "guided"),
    _line("again", ("ctrl+r",), "again"),
    _line("rule", ("f10",), "rule"),
    _line("shown", ("ctrl+o",), "shown"),
    # games
    KeyAction("begin", ("B",), "begin"),
    KeyAction("inside", ("u",), "inside"),
    KeyAction("pause", ("p",), "pause"),
    KeyAction("step", ("full_stop",), "step"),
    KeyAction("faster", ("greater_than_sign",), "faster"),
    KeyAction("slower", ("less_than_sign",), "slower"),
    KeyAction("skip", ("E",), "skip"),
    KeyAction("inject", ("f",), "fault"),
    KeyAction("acknowledge", ("a",), "seen"),
    KeyAction("accept", ("r",), "all right"),
    KeyAction("expert", ("e",), "expert"),
    KeyAction("reached", ("R",), "reached"),
    KeyAction("autonomy", ("i",), "autonomy"),
    KeyAction("take_over", ("o",), "take over"),
    KeyAction("drive", ("d",), "drive"),
    KeyAction("call_again", ("c",), "call again"),
    KeyAction("ask_for", ("h",), "ask for"),
    KeyAction("claim", ("K",), "check a card"),
    KeyAction("presence", ("L",), "who is here"),
    KeyAction("whose_card", ("b",), "whose card"),
    KeyAction("tell", ("l",), "tell"),
    # lists
    KeyAction("put_away", ("x",), "put away"),
    KeyAction("mark", ("asterisk",), "mark"),
    KeyAction("merge", ("M",), "merge"),
    KeyAction("split", ("S",), "split"),
    KeyAction("differences", ("D",), "differences"),
    KeyAction("compare", ("C",), "compare"),
    KeyAction("another", ("O",), "another"),
    KeyAction("pronounce", ("N",), "pronounce"),
    _line("hear", ("ctrl+g", "H"), "hear"),
    KeyAction("feedback", ("F",), "feedback"),
    KeyAction("method", ("P",), "method"),
    KeyAction("join", ("J",), "add a person"),
    KeyAction("rename", ("T",), "rename"),
    KeyAction("world", ("W",), "games"),
    KeyAction("camera", ("V",), "camera"),
    KeyAction("printed_page", ("X",), "print"),
    # fixed
    _fixed("back", "escape", word="leave"),
    _fixed("open", "enter", word="open"),
    _fixed("up", "up", "k"),
    _fixed("down", "down", "j"),
    _fixed("left", "left"),
    _fixed("right", "right"),
    _fixed("panel", "tab"),
    _fixed("page", "pageup", "pagedown"),
    _fixed("ends", "home", "end"),
    _fixed("still", "space"),
    _fixed("yes", "y"),
    _fixed("no", "n"),
    _fixed("close", "q"),
    _fixed("number", *string.digits),
)

BY_ID: Mapping[str, KeyAction] = {action.id: action for action in ACTIONS}

NAMED: Mapping[str, str] = {
    "?": "question_mark",
    ":": "colon",
    "/": "slash",
    "+": "plus",
    ".": "full_stop",
    ",": "comma",
    ";": "semicolon",
    "<": "less_than_sign",
    ">": "greater_than_sign",
    "*": "asterisk",
    "=": "equals_sign",
    "-": "minus",
    "_": "underscore",
    "!": "exclamation_mark",
    "&": "ampersand",
    "%": "percent_sign",
    "$": "dollar_sign",
    "#": "number_sign",
    "@": "at",
    "|": "vertical_line",
    "~": "tilde",
    "'": "apostrophe",
    '"': "quotation_mark",
    "(": "left_parenthesis",
    ")": "right_parenthesis",
}
"""Characters, and Textual's names of their keys."""

_SHOWN = {name: character for character, name in NAMED.items()} | {"escape": "esc"}

CONTROL = tuple(f"ctrl+{letter}" for letter in "bfgklnoprtuvwxyz")
"""Control keys that a terminal passes on; some belong to the input line."""

FUNCTION = tuple(f"f{number}" for number in range(1, 13))
OF_THE_LINE = frozenset({"ctrl+f", "ctrl+k", "ctrl+u", "ctrl+v", "ctrl+w"})
"""Keys that edit the input line."""

KNOWN: tuple[str, ...] = (*FUNCTION, *CONTROL, *string.ascii_letters, *NAMED, *NAMED.values())
"""Everything that may be written as a key."""

_PERMANENT = ("ctrl+x",)
"""Always stops the robot, whatever the settings: the key that screens and documents name."""


def shown(key: str) -> str:
    """Return how the screen writes a key: "^x", "f2", "?", "esc"."""
    return _SHOWN.get(key, key.replace("ctrl+", "^"))


def is_letter(key: str) -> bool:
    """Return whether an input line would take a key as a character."""
    return len(key) == 1 or (key in _SHOWN and key != "escape")


@dataclass(frozen=True, slots=True)
class Keymap:
    """The keys in use: those of the table, with the user's changes."""

    changed: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def keys(self, id: str) -> tuple[str, ...]:
        """Return the keys of an action."""
        return self.changed.get(id, BY_ID[id].keys)

    def action(self, key: str) -> str:
        """Return the action of a key, "" if it has none."""
        return next((a.id for a in ACTIONS if key in self.keys(a.id)), "")

    def shown(self, id: str, *, typing: bool = False) -> str:
        """Return the key to show for an action; `typing`: an input line takes the letters."""
        keys = self.keys(id)
        letters = [key for key in keys if is_letter(key)]
        if typing or not letters:
            return shown(next((key for key in keys if not is_letter(key)), keys[0]))
        return shown(letters[0])

    def overrides(self) -> dict[str, str]:
        """Return the user's changes in Textual's form."""
        return {id: ",".join(keys) for id, keys in self.changed.items()}


def read_keys(table: Table) -> Keymap:
    """Read the keys that a user has set: `undo = "f12"`, or several in a list.

    An action is named by its id or by its word.

    Raises:
        ProfileError: an action or a key is unknown, cannot be changed, or is used twice.
    """
    changeable = {action.id: action.id for action in ACTIONS if not action.fixed}
    changeable |= {BY_ID[id].word.replace(" ", "_"): id for id in tuple(changeable)}
    changed: dict[str, tuple[str, ...]] = {}
    for name in table:
        if name not in changeable:
            raise table.wrong(name, f"is no action; {nearest(name, changeable)}")
        id = changeable[name]
        keys = tuple(dict.fromkeys(_read(table, name, BY_ID[id])))
        if id == "stop":
            keys = tuple(dict.fromkeys((*_PERMANENT, *keys)))
        changed[id] = keys
    keymap = Keymap(changed)
    for id, keys in changed.items():
        for other in _clashes(keymap, id, keys):
            raise table.wrong(id, f"is the key of {other} already.")
    return keymap


def _read(table: Table, id: str, action: KeyAction) -> Iterator[str]:
    for written in table.texts(id):
        key = written.strip()
        key = key if len(key) == 1 else key.lower()
        if key not in KNOWN:
            raise table.wrong(id, f"{written!r} is no key; {nearest(key, KNOWN)}")
        if key in OF_THE_LINE:
            raise table.wrong(id, f"{key} edits the line you type in.")
        key = NAMED.get(key, key)
        if action.with_line and is_letter(key) and key not in action.keys:
            raise table.wrong(id, "works while you type: give it a function or control key.")
        yield key


def _clashes(keymap: Keymap, id: str, keys: Iterable[str]) -> Iterator[str]:
    """Yield the other actions that have one of some keys."""
    for action in ACTIONS:
        if action.id != id and not set(keys).isdisjoint(keymap.keys(action.id)):
            yield action.id
