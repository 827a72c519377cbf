"""The playing screen: Tangy facilitates by itself; room, steps, policy, posteriors and log."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical

from tangy_profiles.errors import TangyError
from tangy_tui.house import House
from tangy_tui.interaction.facilitation import (
    Acted,
    Facilitation,
    GameBegun,
    GameEnded,
    GameEvent,
    Learnt,
)
from tangy_tui.interaction.tally import Tally
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import LOW, WIDE, key_line, panel, room_panel
from tangy_tui.ui.screens.policy import policy_rows
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyTable
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tangy_tui.wording import counted

SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Times life; at 1 a game takes the half hour that it takes among people."""

DRIVING_SHARE = 0.5
"""The share of a step's time in which the picture of the robot drives."""


class PlayScreen(TangyScreen[Tally]):
    """Games by the learnt policy, watched at any speed. Dismissed with what they added up to."""

    CSS_PATH = "play.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    HELP = (
        "Tangy plays by what it has learnt. p pauses and goes on, n does one step, < and > change "
        "the speed, e skips to the end of the game, g begins another. On the right: how sure "
        "Tangy is of its policy, and what it believes about which way of speaking works with whom."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("p", "pause", "Pause or go on"),
        Binding("n", "one_step", "One step"),
        Binding("greater_than_sign,full_stop", "speed(1)", "Faster", key_display=">"),
        Binding("less_than_sign,comma", "speed(-1)", "Slower", key_display="<"),
        Binding("e", "skip", "Skip to the end of the game"),
        Binding("g", "again", "Another game"),
        Binding("1", "panel('room')", "Room", show=False),
        Binding("2", "panel('transcript')", "Steps", show=False),
        Binding("3", "panel('policy')", "Policy", show=False),
        Binding("4", "panel('posteriors')", "Posteriors", show=False),
        Binding("5", "panel('log')", "Log", show=False),
        Binding("escape", "leave", "Leave"),
    ]

    def __init__(
        self,
        house: House,
        facilitation: Facilitation,
        *,
        games: int = 1,
        speed: float = 20,
        leave_after: float | None = None,
    ) -> None:
        """Make the screen.

        Args:
            games: how many are played one after another.
            speed: times life.
            leave_after: seconds after the last game at which the screen closes by itself.
        """
        super().__init__()
        self._house = house
        self._facilitation = facilitation
        self._games = games
        self._speed = speed
        self._leave_after = leave_after
        self._tally = Tally()
        self._going = asyncio.Event()
        self._going.set()
        self._nudge = asyncio.Event()
        self._skipping = False
        self._single = False
        self._stopped = False
        self._halted = False
        self._status = Status(mode="play")

    def compose(self) -> ComposeResult:
        """Lay out the panels; which of them are seen at 80 columns `1` to `5` choose."""
        yield StatusLine()
        with Horizontal(id="body"):
            with Vertical(id="left"):
                yield room_panel(self._house)
                yield panel(LogView(id="log"))
            with Vertical(id="right"):
                yield panel(Transcript(id="transcript"))
                yield panel(PolicyTable())
                yield panel(Posteriors())
        yield key_line(
            ("p", "pause"), ("n", "step"), ("< >", "speed"), ("e", "end"), ("g", "again"),
            ("1-5", "panels"), ("esc", "back"), ("?", "help"),
        )  # fmt: skip

    def on_mount(self) -> None:
        """Show what is known, and begin."""
        activity = self._house.activity
        self.query_one(PolicyTable).show(policy_rows(activity, self._facilitation.policy))
        self._show_beliefs(None)
        self.action_panel("transcript")
        self.run_worker(self._play(), name="game", exclusive=True)

    # ---------------------------------------------------------------------------------- keys

    def action_pause(self) -> None:
        """Pause, or go on; after a STOP this is what lets the robot move again."""
        if self._going.is_set():
            self._going.clear()
        else:
            self._stopped = False
            self._going.set()
        self._nudge.set()
        self._show_status()

    def action_one_step(self) -> None:
        """Do one step and pause."""
        if self._refused() or self._facilitation.over:
            return
        self._single = True
        self._going.set()
        self._nudge.set()

    def action_speed(self, by: int) -> None:
        """Play faster or slower."""
        nearest = min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - self._speed))
        self._speed = SPEEDS[min(len(SPEEDS) - 1, max(0, nearest + by))]
        self._nudge.set()
        self._show_status()

    def action_skip(self) -> None:
        """Play the rest of the game at once."""
        if self._refused() or self._facilitation.over:
            return
        self._skipping = True
        self._going.set()
        self._nudge.set()

    def action_again(self) -> None:
        """Play one more game."""
        self._games += 1
        if self._facilitation.over and self._tally.games + 1 == self._games:
            self.run_worker(self._play(), name="game", exclusive=True)

    def action_panel(self, name: str) -> None:
        """Show a panel where there is no room for all of them, and give it the keys."""
        enlarged = self.maximized is not None
        self.minimize()
        for id in ("transcript", "policy", "posteriors", "log"):
            self.query_one(f"#{id}").set_class(id == name, "-chosen")
        self.set_class(name == "log", "-log")
        if name != "room":
            chosen = self.query_one(f"#{name}")
            chosen.focus()
            if enlarged:
                self.maximize(chosen)

    def action_leave(self) -> None:
        """Go back."""
        self.dismiss(self._tally)

    def on_stop(self, message: Stop) -> None:
        """Stop the robot: nothing more is executed until somebody lets it go on."""
        self._skipping = False
        self._stopped = True
        self._going.clear()
        self._nudge.set()
        self.query_one(RoomView).skip()
        self.query_one(LogView).write("STOP. Press p to go on.", "bad")
        self._show_status()

    def _refused(self) -> bool:
        """Say, after a STOP, that it has to be lifted first."""
        if self._stopped:
            self.query_one(LogView).write("Tangy was stopped: press p to go on first.", "warn")
        return self._stopped

    # ---------------------------------------------------------------------------------- game

    async def _play(self) -> None:
        try:
            await self._play_games()
        except TangyError as error:  # the log could not be written, so nothing more is done
            self._halted = True
            self.query_one(LogView).write(str(error), "bad")
            self._show_status()
            await self._say_why(str(error))

    async def _play_games(self) -> None:
        facilitation = self._facilitation
        while self._tally.games < self._games:
            self._tell(facilitation.begin())
            while not facilitation.over:
                await self._going.wait()
                if self._single:
                    self._single = False
                    self._going.clear()
                events = facilitation.step()
                self._tell(events)
                if self._skipping:
                    await asyncio.sleep(0)  # let the screen and the keys live
                else:
                    await self._wait(events)
            self._skipping = False
        if self._leave_after is not None:
            await asyncio.sleep(self._leave_after)
            self.dismiss(self._tally)

    async def _wait(self, events: list[GameEvent]) -> None:
        """Let a step's time pass; a key that changes the pace ends it early."""
        seconds = sum(e.outcome.seconds for e in events if isinstance(e, Acted))
        self._nudge.clear()
        with suppress(TimeoutError):
            await asyncio.wait_for(self._nudge.wait(), seconds / self._speed)

    def _tell(self, events: list[GameEvent]) -> None:
        self._tally.add(events)
        log = self.query_one(LogView)
        for event in events:
            match event:
                case GameBegun(_, number, state):
                    log.write(f"Game {number} begins.", "dim")
                    self._halted = False
                    self.query_one(RoomView).say("")
                    self.query_one(Transcript).clear()
                    self._status = Status(mode="play", stage=state.stage, game=number)
                    self._show_scene(0, drive=False)
                case Acted():
                    self._show_step(event)
                case Learnt(response, belief):
                    name = self._house.name(response.person)
                    what = "complied" if response.complied else "followed, but late"
                    log.write(
                        f"{name} {what}: {response.strategy} has worked "
                        f"{belief.alpha - 1:.0f} of {belief.trials} times.",
                        "good" if response.complied else "dim",
                    )
                    self._show_beliefs((response.person, response.strategy))
                case GameEnded(_, steps, None):
                    words = f"The game is over after {counted(steps, 'step')}."
                    log.write(f"{words} g plays another.", "good")
                case GameEnded(_, steps, str(reason)):
                    log.write(f"The game stopped after {counted(steps, 'step')}. {reason}", "bad")
                    self._halted = True
                    self.run_worker(self._say_why(reason), name="why")
        self._show_status()

    async def _say_why(self, reason: str) -> None:
        """Tell why a game could not go on, at every size of the window."""
        if self._leave_after is None:
            text = f"{reason}\nEsc leads home, where t teaches; g plays another game."
            await self.app.push_screen_wait(MessageDialog(text, title="The game stopped"))

    def _show_step(self, event: Acted) -> None:
        activity, house = self._house.activity, self._house
        words = activity.in_words(event.state.situation)
        target = f" ({house.name(event.action.target)})" if event.action.target else ""
        how = f", {event.choice.strategy}" if event.choice else ""
        self.query_one(Transcript).append(f"{words} -> {event.action.behaviour.name}{target}{how}")
        self.query_one(LogView).write(event.speech)
        self.query_one(RoomView).say(event.speech)
        self.query_one(PolicyTable).highlight(words)
        if event.choice is not None:
            self._show_beliefs((event.choice.person, event.choice.strategy))
        self._status = Status(
            mode="play",
            stage=event.after.stage,
            game=self._facilitation.games,
            step=event.number,
        )
        self._show_scene(event.outcome.seconds, drive=event.state.place != event.after.place)

    def _show_scene(self, seconds: float, *, drive: bool) -> None:
        room = self.query_one(RoomView)
        scene = self._facilitation.world.scene()
        if drive and not self._skipping:
            room.drive(scene.place, seconds / self._speed * DRIVING_SHARE)
        room.show(scene)

    def _show_beliefs(self, highlight: tuple[str, str] | None) -> None:
        names: Mapping[str, str] = self._house.names
        self.query_one(Posteriors).show(self._facilitation.persuasion.beliefs, names, highlight)

    def _show_status(self) -> None:
        status = self._status
        self.query_one(StatusLine).show(
            Status(
                mode="play",
                robot="STOPPED" if self._stopped else "ASKS" if self._halted else "OK",
                stage="over" if self._facilitation.over else status.stage,
                game=status.game,
                step=status.step,
                note=self._note(),
                alarm=self._stopped or self._halted,
            )
        )

    def _note(self) -> str:
        """Say what the keys would do next, or how fast it goes."""
        if self._stopped:
            return "p goes on"
        if self._facilitation.over:
            return "g plays again"
        return f"x{self._speed:g}" if self._going.is_set() else "paused"
