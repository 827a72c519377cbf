"""The themes: a calm dark one, a light one, and one in the terminal's own 16 colours.

Widgets draw with inks, which are named after their meaning rather than a colour. Every ink comes
with a word or a mark, so that nothing depends on colour alone.
"""

from __future__ import annotations

from textual.theme import BUILTIN_THEMES, Theme

INKS = (
    "text",
    "dim",  # less important
    "strong",  # a heading, a number to look at
    "robot",
    "person",
    "good",
    "warn",
    "bad",
    "floor",
    "table",
    "curve",
    "cursor",  # the row that a key acts on
    "now",  # the row in use at this moment
)
"""The styles of widgets; `.ink--*` in tangy.tcss defines their colours."""

INK_CLASSES = frozenset(f"ink--{name}" for name in INKS)

DARK = Theme(
    name="tangy-dark",
    dark=True,
    primary="#8ab4f8",
    secondary="#6c8ebf",
    accent="#ffc46b",
    warning="#ffd479",
    error="#ff8a80",
    success="#8fdc9a",
    foreground="#e8eaed",
    background="#11161d",
    surface="#171d26",
    panel="#1d2530",
    variables={
        "ink-dim": "#9aa5b4",
        "ink-floor": "#3b4757",
        "ink-table": "#c8a27a",
        "ink-person": "#9ecbff",
        "ink-line": "#4a5768",
        "ink-now": "#2b3f5c",
        "ink-cursor": "#24303f",
        "scrollbar": "#4a5768",
        "scrollbar-hover": "#6c8ebf",
        "scrollbar-active": "#8ab4f8",
        "scrollbar-background": "#1d2530",
        "scrollbar-background-hover": "#1d2530",
        "scrollbar-background-active": "#1d2530",
        "input-cursor-background": "#ffc46b",
        "input-cursor-foreground": "#11161d",
    },
)

LIGHT = Theme(
    name="tangy-light",
    dark=False,
    primary="#0b57b0",
    secondary="#3a6ea5",
    accent="#8a4b00",
    warning="#7a5200",
    error="#a8201a",
    success="#1a6b2f",
    foreground="#1b1f24",
    background="#fbfaf7",
    surface="#f3f1ec",
    panel="#e9e6df",
    variables={
        "ink-dim": "#545d68",
        "ink-floor": "#c9c4b8",
        "ink-table": "#7b5327",
        "ink-person": "#0b4a94",
        "ink-line": "#9b9587",
        "ink-now": "#cfe0f7",
        "ink-cursor": "#e2ded4",
        "scrollbar": "#9b9587",
        "scrollbar-hover": "#3a6ea5",
        "scrollbar-active": "#0b57b0",
        "scrollbar-background": "#e9e6df",
        "scrollbar-background-hover": "#e9e6df",
        "scrollbar-background-active": "#e9e6df",
        "input-cursor-background": "#8a4b00",
        "input-cursor-foreground": "#fbfaf7",
    },
)

ANSI = Theme(
    name="tangy-ansi",
    dark=True,
    ansi=True,
    primary="ansi_blue",
    secondary="ansi_cyan",
    accent="ansi_yellow",
    warning="ansi_yellow",
    error="ansi_red",
    success="ansi_green",
    foreground="ansi_default",
    background="ansi_default",
    surface="ansi_default",
    panel="ansi_default",
    boost="ansi_default",
    variables={
        **BUILTIN_THEMES["ansi-dark"].variables,
        "ink-dim": "ansi_default",
        "ink-floor": "ansi_default",
        "ink-table": "ansi_yellow",
        "ink-person": "ansi_cyan",
        "ink-line": "ansi_default",
        "ink-now": "ansi_default",
        "ink-cursor": "ansi_default",
        "input-cursor-background": "ansi_default",
        "input-cursor-foreground": "ansi_default",
        "border": "ansi_yellow",
        "border-blurred": "ansi_default",
    },
)

THEMES = (DARK, LIGHT, ANSI)

INK_DEFAULTS = DARK.variables
"""The inks in a theme that does not define them (Textual's own, from the palette)."""


def first_theme(chosen: str, *, ansi: bool) -> str:
    """Return the theme to begin with: the chosen one if it exists and the terminal can show it."""
    if ansi:
        return ANSI.name
    return chosen if chosen in {theme.name for theme in THEMES} else DARK.name
