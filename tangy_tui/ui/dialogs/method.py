"""The persuasion method for one person: three settings, and a reset."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, TypeVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_profiles.persuading import PersuasionConfig, known_methods
from tangy_tui.text.people import method_name, method_title
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys

KeyT = TypeVar("KeyT")

PRIORS = {
    "uniform": "nothing, as in the paper",
    "people": "what worked with earlier people",
}
FORGETTING = {
    (1.0, "interaction"): "nothing, as in the paper",
    (0.98, "interaction"): "2% with each interaction",
    (0.9, "interaction"): "10% with each interaction",
    (0.99, "day"): "1% with each day",
    (0.97, "day"): "3% with each day",
}
"""The choices here; the command line takes any share."""


@dataclass(frozen=True, slots=True)
class MethodChoice:
    """The chosen method; None is the activity's own."""

    chosen: PersuasionConfig | None


class MethodDialog(Dialog[MethodChoice | None]):
    """Shows a person's method: 1, 2, 3 change a setting, 0 resets to the activity's, y accepts."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("1", "nothing", "Change a setting", key_display="1-3", id="number"),
        Binding("0", "nothing", "As the activity has it", id="number"),
        Binding("y", "nothing", "Use it"),
        Binding("n", "nothing", "Leave it as it was"),
    ]
    HELP = (
        "How a strategy is chosen, where beliefs begin, and how fast they fade for people who "
        "change. The counts stay whatever you choose, and {undo} on the people screen takes it "
        "back."
    )

    def __init__(
        self,
        name: str,
        current: PersuasionConfig,
        own: bool,
        default: PersuasionConfig,
        *,
        clock: Clock | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            name: the person's name.
            current: the present settings.
            own: whether they were chosen for this person alone.
            default: the activity's settings.
            clock: returns the time, in s.
        """
        super().__init__(None)
        self._whose = clean(name)
        self._default = default
        self._chosen = current
        self._own = own
        self._clock = clock
        self._keys = FreshKeys()

    def compose(self) -> ComposeResult:
        """Lay out the settings and the keys."""
        box = Static(self._content(), id="method", classes="box")
        box.border_title = Content(method_title(self._whose))
        yield box

    def on_mount(self) -> None:
        """Accept keys from now on."""
        self._keys.watch(self, self._clock)

    def on_key(self, event: events.Key) -> None:
        """Change a setting, accept the method, or cancel."""
        if not self._keys.take(event):
            return
        match event.key.lower():
            case "y":
                self.answer(MethodChoice(self._chosen if self._own else None))
            case "n" | "escape":
                self.answer(None)
            case "0":
                self._set(self._default, own=False)
            case "1":
                self._set(
                    replace(
                        self._chosen,
                        method=_next(dict.fromkeys(known_methods(), ""), self._chosen.method),
                    )
                )
            case "2":
                self._set(replace(self._chosen, prior=_next(PRIORS, self._chosen.prior)))
            case "3":
                now = (self._chosen.forgetting, self._chosen.forgetting_per)
                keep, per = _next(FORGETTING, now)
                self._set(replace(self._chosen, forgetting=keep, forgetting_per=per))

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    def _set(self, chosen: PersuasionConfig, *, own: bool = True) -> None:
        self._chosen, self._own = chosen, own
        self.query_one("#method", Static).update(self._content())

    def _content(self) -> Content:
        chosen = self._chosen
        fades = (chosen.forgetting, chosen.forgetting_per)
        other = f"{100 * (1 - chosen.forgetting):.3g}% with each {chosen.forgetting_per}"
        settings = (
            ("1", "choose by ", method_name(chosen.method)),
            ("2", "begin from", PRIORS[chosen.prior]),
            ("3", "forget    ", FORGETTING.get(fades, other)),
        )
        whose = "chosen for this person" if self._own else "as the activity sets"
        parts: list[str | tuple[str, str] | Content] = []
        for key, what, words in settings:
            parts += [(key, "$primary bold"), (f"  {what}  ", "$ink-dim"), f"{words}\n"]
        parts += [("\nIt is ", "$ink-dim"), whose, ".\n\n"]
        for key, words in (("Y", "use it"), ("0", "as the activity sets"), ("N", "leave it")):
            parts += [(key, "$primary bold"), f"  {words}", "" if key == "N" else "\n"]
        return Content.assemble(*parts)


def _next(known: dict[KeyT, str], now: KeyT) -> KeyT:
    """Return the choice after the present one; after an unlisted one, the first."""
    keys = list(known)
    return keys[(keys.index(now) + 1) % len(keys)] if now in known else keys[0]
