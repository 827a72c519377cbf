"""Key bindings, and the line of keys at the foot, from the keymap."""

from __future__ import annotations

from textual.binding import Binding, BindingType

from tangy_tui.app.keymap import BY_ID, Keymap, is_letter
from tangy_tui.text.keys import NAMES

DEFAULT = Keymap()

Key = tuple[str, str]
"""A key as shown, and a word for its action."""


def keymap_of(app: object) -> Keymap:
    """Return the keymap of Tangy's application, or the default one for any other."""
    keymap: Keymap = getattr(app, "keymap", DEFAULT)
    return keymap


def bind(
    id: str, action: str = "", *, name: str = "", show: bool = True, priority: bool = False
) -> list[BindingType]:
    """Bind the keys of an action of the keymap to an action of a screen.

    An input line takes precedence for the keys that it uses.

    Args:
        id: the action in the keymap.
        action: the Textual action (default: the one with the same name).
        name: a name that describes it better here.
        show: whether help and palette list it.
        priority: whether it also works in dialogs and input lines.
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
    """Return the keys of actions with a word each; pairs are returned unchanged.

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
