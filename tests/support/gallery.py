"""A gallery for developers: every widget and dialog on one screen, with demanding data.

`python -m tests.support.gallery [--ascii] [--ansi] [--light] [--people N]`
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical

from tangy_hw.audio.meter import SoundTrouble
from tangy_profiles.activity import load_activity
from tangy_profiles.beliefs import Beta
from tangy_profiles.person import load_people
from tangy_profiles.room import load_room
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT
from tangy_tui.ui.app import TangyApp, run_app
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.question import Answer, ChoicesDialog, QuestionDialog
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.themes import LIGHT
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.microphone_line import MicrophoneLine
from tangy_tui.ui.widgets.policy_table import PolicyRow, PolicyTable
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript

NARROW_OR_WIDE = [(0, "-narrow"), (120, "-wide")]


@dataclass
class SampleEars:
    """A microphone in one of its possible states."""

    state: str
    words: str = ""
    trouble: SoundTrouble | None = None
    level: float = 0.0
    live: bool = True
    hands_free: bool = False
    records: bool = False

    @property
    def meter(self) -> SampleEars:
        """The meter of the level."""
        return self


HEARD = (
    SampleEars("off"),
    SampleEars("listening", level=0.2),
    SampleEars("speaking", "call the next", level=0.7),
    SampleEars("speaking", "call the next", level=0.7, records=True),
    SampleEars("thinking", "call the next number"),
    SampleEars("shut"),
    SampleEars("listening", trouble=SoundTrouble("no sound", 2)),
    SampleEars("over"),
)


class GalleryScreen(TangyScreen[None]):
    """All of it at once; 80 columns show room, steps and command bar."""

    TITLE = "Gallery"
    HELP = (
        "Every widget with sample data. g lets the robot walk, d opens the question, c offers "
        "choices, t shows the next state of the microphone."
    )
    AUTO_FOCUS = "#command-input"
    CSS = """
    GalleryScreen #upper { height: 3fr; }
    GalleryScreen #lower { height: 2fr; }
    GalleryScreen #room { width: 3fr; }
    GalleryScreen #transcript { width: 3fr; }
    GalleryScreen #posteriors, GalleryScreen #policy, GalleryScreen #log { width: 2fr; }
    GalleryScreen.-narrow #posteriors, GalleryScreen.-narrow #log, GalleryScreen.-narrow #policy {
        display: none;
    }
    """
    HORIZONTAL_BREAKPOINTS = NARROW_OR_WIDE
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("g", "go", "Let the robot walk"),
        Binding("d", "ask", "Ask the question"),
        Binding("c", "offer", "Offer choices"),
        Binding("t", "listen", "The next state of the microphone"),
        Binding("y", "confirm", "Ask for a yes"),
        Binding("w", "tell", "Show a message"),
    ]

    def __init__(self, people: int = 4) -> None:
        super().__init__()
        self.activity = load_activity("bingo")
        self.people = load_people(people)
        self.places = [*(p.id for p in self.people), FRONT]
        self.room_view = RoomView(load_room(), self.people, label=self.activity.deck.label)
        self.transcript = Transcript(id="transcript")
        self.posteriors = Posteriors()
        self.policy = PolicyTable()
        self.log_view = LogView(id="log")
        self.bar = CommandBar(self._complete)
        self.heard = 0

    def compose(self) -> ComposeResult:
        """Lay out the panels."""
        yield StatusLine(Status("gallery", "OK", "help", 3, 12))
        with Vertical():
            with Horizontal(id="upper"):
                yield self.room_view
                yield self.posteriors
            with Horizontal(id="lower"):
                yield self.transcript
                yield self.policy
                yield self.log_view
        yield MicrophoneLine(HEARD[0])
        yield self.bar
        for panel in (self.room_view, self.posteriors, self.transcript, self.policy, self.log_view):
            panel.add_class("panel")

    def on_mount(self) -> None:
        """Fill the panels."""
        ids = [p.id for p in self.people]
        sample = ("marks B7", "asks for help", "watches", "moves the card")
        doing = {id: sample[n % 4] for n, id in enumerate(ids)}
        asking = tuple(ids[1::3])
        self.room_view.show(Scene(FRONT, asking, doing, (7, 22, 31, 50, 61, 3, 18), None))
        self.room_view.say("The number is I 18. I repeat: I 18.")
        for n in range(14):
            self.transcript.append(
                ("facilitate · ANR · card not in view -> call number")
                if n % 3
                else "help · AR · wrong marks -> remove markers (User 2)"
            )
        strategies = tuple(self.activity.strategies)
        counts = ((7, 2), (1, 3), (0, 0), (40, 60))
        beliefs = {
            id: {
                s: Beta(1 + counts[(n + k) % 4][0], 1 + counts[(n + k) % 4][1])
                for k, s in enumerate(strategies)
            }
            for n, id in enumerate(ids)
        }
        self.posteriors.show(beliefs, {p.id: p.name for p in self.people}, (ids[0], strategies[1]))
        rows = [
            PolicyRow(
                f"{s.stage} · {s.request} · {s.user_state}",
                self.activity.expected.get(s, "call number"),
                1.0 if n % 4 else 0.62,
                n * 5,
                "" if n else "never shown",
            )
            for n, s in enumerate(self.activity.situations)
        ]
        self.policy.show(rows, rows[3].situation)
        self.log_view.write("Tangy greets everyone.", "good")
        self.log_view.write("The path to User 2 is blocked; Tangy waits and asks.", "warn")
        self.log_view.write("The camera does not answer. Tangy has stopped.", "bad")

    def action_go(self) -> None:
        """Move the robot to the next place."""
        at = self.places.index(self.room_view.scene.place)
        self.room_view.drive(self.places[(at + 1) % len(self.places)], 4.0)

    def on_room_view_arrived(self, event: RoomView.Arrived) -> None:
        """Record the place."""
        scene = self.room_view.scene
        self.room_view.show(
            Scene(event.place, scene.requests, scene.doing, scene.called, scene.card)
        )
        self.log_view.write(f"Tangy is at {event.place}.")

    def on_command_bar_given(self, event: CommandBar.Given) -> None:
        """Ask whether the typed command is meant."""
        self._ask(event.text)

    def action_ask(self) -> None:
        """Ask the question."""
        self._ask("call a numbr")

    def _ask(self, text: str) -> None:
        def answered(answer: Answer | None) -> None:
            if answer is not None and answer.yes:
                self.transcript.append(f"facilitate · ANR · card not in view -> {text}")
            else:
                self.bar.restore(text)

        dialog = QuestionDialog(
            "call number",
            heard=text,
            confidence=0.83,
            alternatives=("greet everyone", "go to the user", "tell a joke"),
        )
        self.app.push_screen(dialog, answered)

    def action_offer(self) -> None:
        """Offer choices."""
        choices = ("call number", "tell a joke", "go to the user (User 2)")
        self.app.push_screen(ChoicesDialog(heard="call a joke", confidence=0.45, choices=choices))

    async def action_listen(self) -> None:
        """Show the microphone in its next state."""
        self.heard = (self.heard + 1) % len(HEARD)
        await self.query_one(MicrophoneLine).remove()
        await self.mount(MicrophoneLine(HEARD[self.heard]), before=self.bar)

    def action_confirm(self) -> None:
        """Ask for a yes."""
        self.app.push_screen(
            ConfirmDialog(
                "Forget all that is known of User 2?",
                "Beliefs and name are removed. The log keeps the steps without the name.",
                yes="forget User 2",
                no="keep everything",
            )
        )

    def action_tell(self) -> None:
        """Show a message."""
        self.app.push_screen(
            MessageDialog("There is no policy yet.\nTeach Tangy a game first, then learn.", "Play")
        )

    def on_stop(self, message: Stop) -> None:
        """Report a heard STOP."""
        self.room_view.skip()
        self.log_view.write(f"Stopped: {message.reason}.", "bad")

    def _complete(self, typed: str) -> tuple[str, ...]:
        phrases = (p for b in self.activity.behaviours.values() for p in b.phrases)
        return tuple(p for p in phrases if p.startswith(typed.lower()))


def main(arguments: Sequence[str]) -> int:
    """Show the gallery."""
    people = int(arguments[arguments.index("--people") + 1]) if "--people" in arguments else 4
    kind = TerminalKind(ansi="--ansi" in arguments, ascii="--ascii" in arguments)
    app = TangyApp(lambda: GalleryScreen(people), kind=kind)
    if "--light" in arguments:
        app.theme = LIGHT.name
    return run_app(app)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
