"""Bindings, and the line of keys at the foot, made from the keymap."""

from __future__ import annotations

from textual.binding import Binding, BindingType

from tangy_tui.app.keymap import BY_ID, Keymap, is_letter
from tangy_tui.text.keys import NAMES

DEFAULT = Keymap()

Key = tuple[str, str]
"""A key as it is shown, and a word on what it does."""


def keymap_of(app: object) -> Keymap:
    """Return the keys that count in Tangy's app; in any other app, those of the table."""
    keymap: Keymap = getattr(app, "keymap", DEFAULT)
    return keymap


def bind(
    id: str, action: str = "", *, name: str = "", show: bool = True, priority: bool = False
) -> list[BindingType]:
    """Bind the keys of an action of the keymap to an action of a screen.

    Keys that a line to type in would take are left to the line.

    Args:
        id: the action in the keymap.
        action: what Textual runs (default: the action of the same name).
        name: what it does here, where that can be said better.
        show: whether help and palette list it.
        priority: it works in dialogs and lines, too.
    """
    made: list[BindingType] = []
    for key in BY_ID[id].keys:
        made.append(
            Binding(
                key,
                action or id,
                name or NAMES[id].name,
                show=show,
                id=id,
                priority=not is_letter(key) and (priority or key in ("ctrl+z", "ctrl+y")),
            )
        )
    return made


def foot(app: object, *ids: str | Key, typing: bool = False) -> list[Key]:
    """Return the keys of actions with a word each; pairs are left as they are.

    "panel:next" gives the key of `panel` another word.
    """
    keymap, keys = keymap_of(app), list[Key]()
    for one in ids:
        if isinstance(one, tuple):
            keys.append(one)
            continue
        id, _, word = one.partition(":")
        keys.append((keymap.shown(id, typing=typing), word or NAMES[id].short))
    return keys
