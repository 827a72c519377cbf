"""The actions available on a screen, as help and palette list them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from textual.dom import DOMNode
from textual.screen import Screen

from tangy_tui.app.keymap import BY_ID, Keymap
from tangy_tui.ui.keys import keymap_of

SILENT = frozenset({"number"})
"""Actions whose typed word is the key itself."""


@dataclass(frozen=True, slots=True)
class ListedAction:
    """An action: its name here, its key, its typed word, and the node that runs it."""

    name: str
    key: str
    word: str
    action: str
    node: DOMNode
    everywhere: bool


def listed(screen: Screen[Any]) -> list[ListedAction]:
    """List the actions of a screen and of its focused widget, each once.

    Actions with letter keys are listed even while an input line takes letters, without those keys:
    the palette runs them.
    """
    found: dict[tuple[str, str], ListedAction] = {}
    keymap, app = keymap_of(screen.app), screen.app
    typing = bool(screen.query("#command-input"))
    for node in _nodes(screen):
        for key, bindings in node._bindings.key_to_bindings.items():
            for binding in bindings:
                id = binding.id or ""
                if not (binding.show and binding.description) or (id, binding.description) in found:
                    continue
                state = app._check_action_state(binding.action, node)
                if state is False or not works(screen, binding.action):
                    continue
                given = (
                    binding.key_display
                    or _of_question(node, key)
                    or (
                        _shown(keymap, id, typing=typing)
                        if id in BY_ID and id not in SILENT
                        else app.get_key_display(binding)
                    )
                )
                word = "" if id in SILENT or id not in BY_ID else BY_ID[id].word
                found[id or key, binding.description] = ListedAction(
                    binding.description, given, word, binding.action, node, node is app
                )
    return list(found.values())


def _shown(keymap: Keymap, id: str, *, typing: bool) -> str:
    """Return the key of an action, "" if it is a letter that goes into an input line."""
    if typing and all(len(key) == 1 and key.isalnum() for key in keymap.keys(id)):
        return ""
    return keymap.shown(id, typing=typing)


def _of_question(node: DOMNode, key: str) -> str:
    """Return the key for yes to a question, which may be a digit; "" for any other key."""
    yes: str = getattr(node, "yes_key", "")
    return yes if key == "y" else ""


def _nodes(screen: Screen[Any]) -> Iterator[DOMNode]:
    """Yield the focused widget, its ancestors, the screen, and the application."""
    focused = screen.focused
    if focused is not None:
        yield from (node for node in focused.ancestors_with_self if node is not screen.app)
    else:
        yield screen
    if not screen.is_modal:
        yield screen.app


def works(screen: Screen[Any], action: str) -> bool:
    """Return whether a global key has an effect on a screen."""
    match action:
        case "command":
            return bool(screen.query("#command-input")) or hasattr(screen, "action_type")
        case "zoom":
            panel = screen.focused
            return screen.maximized is not None or (panel is not None and panel.allow_maximize)
        case "back":
            return len(screen.app.screen_stack) > 1
        case "phrases":
            return hasattr(screen.app, "action_phrases")
        case "filter":
            return hasattr(screen.focused, "begin_filter")
        case "listen" | "app.listen":
            return getattr(screen.app, "hearing", None) is not None
        case "talk":
            return bool(getattr(getattr(screen.app, "hearing", None), "by_key", False))
    return True
