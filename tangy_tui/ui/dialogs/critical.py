"""The dialog of a critical fault: the fault, the advice, and the keys to clear it."""

from __future__ import annotations

from typing import ClassVar, Protocol

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from tangy_profiles.contacts import EXPERT
from tangy_profiles.errors import TangyError
from tangy_profiles.robot import Robot
from tangy_tui.monitoring.calls import CallState
from tangy_tui.monitoring.fault import OVER, Fault
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text import halts
from tangy_tui.text.calls import advised_call, calling_words, staff_words
from tangy_tui.text.fault_views import ALSO_WRONG, HOW_KNOWN
from tangy_tui.text.faults import (
    ages_of,
    evidence_of,
    fault_time,
    known_now,
    mark_of,
    still_there_words,
)
from tangy_tui.text.keys import with_keys
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.fault import advice_lines, evidence_lines, moves_so_far
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys
from tangy_tui.ui.widgets.page import Page, PageLine, heading, paragraph
from tangy_tui.ui.widgets.status_line import Status, StatusLine

ACTIONS = ("acknowledge", "expert", "reached", "accept", "back")


class HaltedRobot(Protocol):
    """What staff can do about the fault that halts the robot."""

    supervision: Supervision

    @property
    def takes_time(self) -> bool:
        """Whether commands about the fault take time."""

    @property
    def restarts(self) -> bool:
        """Whether calling the expert also restarts the robot process."""

    @property
    def simulated(self) -> bool:
        """Whether the expert is simulated, like the room."""

    def acknowledge(self) -> None:
        """Acknowledge the fault."""

    async def call_expert(self) -> None:
        """Call the expert, and recover what Tangy can."""

    def reached(self) -> None:
        """Log that staff reached the expert."""

    async def clear(self) -> None:
        """Clear the fault, if it is gone, so that the robot continues."""

    def give_up(self) -> None:
        """End the game."""


class CriticalDialog(Dialog[None]):
    """Stays open until its fault is cleared or the game is given up; esc does not just hide it."""

    DEFAULT_CSS = """
    CriticalDialog { background: $background; }  /* a dimmed game would take long to draw */
    CriticalDialog > .box {
        width: 76; height: 1fr; max-height: 32; padding: 0 1;
        border: heavy $error; border-title-color: $error;
    }
    CriticalDialog Page { height: 1fr; }
    CriticalDialog .now { height: auto; max-height: 3; text-style: bold; }
    CriticalDialog .said { height: auto; color: $warning; text-style: bold; }
    CriticalDialog KeyLine { padding: 0; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("acknowledge", "nothing"),
        *bind("expert", "nothing"),
        *bind("reached", "nothing"),
        *bind("accept", "nothing"),
        *bind("back", "nothing", name=halts.GIVE_UP_KEY),
    ]
    HELP = (
        "Tangy has stopped and stands still. {acknowledge} says that you have seen it. {expert} "
        "calls the expert, if the robot's file says how, and shows whom to call; {reached} says "
        "that you have reached them. {accept} lets Tangy go on, if the fault is gone; otherwise "
        "nothing moves. Esc gives the game up, after asking. Up and down scroll."
    )

    def __init__(
        self, desk: HaltedRobot, fault: Fault, robot: Robot, *, clock: Clock | None = None
    ) -> None:
        super().__init__(None)
        self._desk = desk
        self._fault = fault
        self._robot = robot
        self._clock = clock
        self.fresh_keys = FreshKeys()
        self._status = Status()
        self._now = ""
        self._doing = ""
        """The command in progress, in words; other keys wait for it."""
        self._done = False
        self._call = self._call_state()  # the state of the call to the expert when last shown
        self._staff = staff_words(desk.supervision)  # the same for the call to staff

    @property
    def fault(self) -> Fault:
        """The fault that halts the robot."""
        return self._fault

    def compose(self) -> ComposeResult:
        """Lay out the status line, which stays visible, and the fault with its keys."""
        yield StatusLine(self._status)
        fault = self._fault
        said = self._seen if fault.acknowledged else halts.SEEN_FIRST
        box = Vertical(
            Page(self._write),
            Static(self._is_there(), classes="now", markup=False),
            Static(f"! {with_keys(said, keymap_of(self.app))}", classes="said", markup=False),
            KeyLine(*self._key_words()),
            id="critical",
            classes="box",
        )
        box.border_title = self._title()
        yield box

    @property
    def _seen(self) -> str:
        return halts.SEEN_REHEARSED if self._desk.simulated else halts.SEEN

    def _title(self) -> Content:
        return Content(clean(halts.title(known_now(self._fault, self._desk.supervision))))

    def on_mount(self) -> None:
        """Focus the page, and accept keys from now on."""
        for page in self.query(Page):  # it may open while the program is ending
            page.focus()
        self.fresh_keys.watch(self, self._clock)

    def show(self, status: Status) -> None:
        """Update the status line and the fault."""
        self._status = status
        for line in self.query(StatusLine):
            line.show(status)
        self.look()
        self._show_page()
        self._show_keys()

    def _show_page(self) -> None:
        for page in self.query(Page):
            page.show(self._write, None)

    def _show_keys(self) -> None:
        for keys in self.query(KeyLine):
            keys.show(*self._key_words())

    def look(self) -> None:
        """Update whether the fault is still present."""
        if self._doing:  # another thread is checking it
            return
        if self._call != self._call_state() is not None:
            self.say(self._whom_to_call(False))
            self._show_keys()
            self._show_page()
        if self._staff != (staff := staff_words(self._desk.supervision)):
            self._staff = staff
            self.say(staff)
            self._show_page()
        before = self._now
        words = self._is_there()
        if words != before:
            for box in self.query("#critical"):
                box.border_title = self._title()
            for now in self.query(".now").results(Static):
                now.update(words)

    def _is_there(self) -> str:
        told = still_there_words(self._fault, self._desk.supervision)
        self._now = clean(with_keys(told, keymap_of(self.app)))
        return self._now

    def say(self, sentence: str) -> None:
        """Show the result of a key, or what has to be done first."""
        for said in self.query(".said").results(Static):
            said.update(f"! {clean(with_keys(sentence, keymap_of(self.app)))}")

    def take_sentence(self, sentence: str) -> bool:
        """Show a sentence of the application here, so that nothing covers the fault."""
        self.say(sentence)
        return True

    def on_stop(self, message: Stop) -> None:
        """Stay open on STOP: the robot stands still, and the fault is still present."""
        message.prevent_default()  # STOP answers other dialogs with no
        self.say(halts.STOPPED)

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Close if the fault was cleared while another screen was on top."""
        if self._done:
            self.answer(None)

    async def on_key(self, event: events.Key) -> None:
        """Run the action of a key, if the fault was visible before."""
        key = keymap_of(self.app).action(event.key)
        if key not in ACTIONS or not self.fresh_keys.take(event):
            return
        if self._doing:
            self.say(halts.wait_words(self._doing))
        elif self._desk.takes_time and (doing := self._takes(key)):
            self._doing = doing
            self.say(doing)
            self._show_keys()
            self.run_worker(self._tried(key), group="doing")
        else:
            await self._tried(key)

    def _takes(self, key: str) -> str:
        """Describe the action of a key if it takes time; "" if it does not."""
        if key == "expert" and not self._called:
            if self._desk.restarts:
                return halts.RESTARTING
            calls = self._desk.supervision.calls
            if calls is not None and (contact := calls.to_call(EXPERT)) is not None:
                return calling_words(contact)
            return halts.CALLING if self._desk.simulated else ""
        return halts.LOOKING if key == "accept" and self._fault.acknowledged else ""

    async def _tried(self, key: str) -> None:
        try:
            await self._do(key)
        except TangyError as error:
            self.say(halts.failed_words(error))
        finally:
            self._doing = ""
            self._show_keys()

    async def _do(self, key: str) -> None:
        fault, desk = self._fault, self._desk
        match key:
            case "acknowledge":
                desk.acknowledge()
                self.say(self._seen)
            case "expert":
                restarts = desk.restarts
                if not self._called:
                    await desk.call_expert()
                self.say(self._whom_to_call(restarts and not desk.restarts))
            case "reached":
                desk.reached()
                self.say(self._whom_to_call(False))
            case "accept" if not fault.acknowledged:
                self.say(halts.SEEN_FIRST)
            case "accept":
                await desk.clear()
                if desk.supervision.halted is fault:
                    self.say(halts.STILL_THERE)
                else:
                    self._done = True
                    self.answer(None)
            case _:
                self.run_worker(self._confirm(), group="give up", exclusive=True)

    def _whom_to_call(self, restarted: bool) -> str:
        """Tell whom to call, and the state of the call."""
        self._call = self._call_state()
        if self._desk.simulated:
            return halts.rehearsed_words(self._desk.supervision)
        return halts.called_words(self._desk.supervision, restarted=restarted)

    def _call_state(self) -> CallState | None:
        calls = self._desk.supervision.calls
        return None if calls is None else calls.state(EXPERT)

    @property
    def _called(self) -> bool:
        """Whether the expert was called: no call failed, and no later check found the fault."""
        if (state := self._call_state()) is not None and state.stage == "failed":
            return False
        kinds = [m.kind for m in self._fault.moves if m.kind in ("expert called", "still there")]
        return kinds[-1:] == ["expert called"]

    async def _confirm(self) -> None:
        """Give the game up, after confirmation."""
        dialog = ConfirmDialog(
            halts.GIVE_UP,
            halts.GIVE_UP_DETAIL,
            yes="give the game up",
            no="back to the fault",
        )
        if not await self.app.push_screen_wait(dialog):
            return
        try:
            self._desk.give_up()
        except TangyError as error:
            self.say(halts.failed_words(error))
        else:
            self.answer(None)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    def _key_words(self) -> tuple[str, ...]:
        if self._doing:
            return ("stop", "help")
        seen = () if self._fault.acknowledged else ("acknowledge",)
        game = self._desk.supervision
        waits = halts.to_be_reached(game) and (self._called or self._call_state() is not None)
        reached = ("reached",) if waits else ()
        return (*seen, "expert", *reached, "accept", "back:give up", "help")

    def _write(self, width: int) -> list[PageLine]:
        supervision = self._desk.supervision
        fault = known_now(self._fault, supervision)
        book, robot = supervision.book, self._robot
        lines = paragraph(clean(fault.console), width, "strong")
        lines += paragraph(halts.halted_words(fault), width)
        others = [f for f in supervision.faults if f is not self._fault and f.status != OVER]
        if others:
            lines += paragraph(clean(f"{ALSO_WRONG}: {', '.join(f.name for f in others)}."), width)
        if len(fault.moves) > 1:
            lines += paragraph(clean(halts.last_move_words(fault, fault.moves[-1])), width, "dim")
        lines += heading(halts.WHOM_TO_CALL)
        lines += advice_lines(fault.advice, width)
        if self._desk.simulated:
            lines += paragraph(with_keys(halts.REHEARSED, keymap_of(self.app)), width, "strong")
        lines += paragraph(clean(advised_call(supervision)), width)
        if staff := staff_words(supervision):
            lines += paragraph(clean(staff), width)
        label = supervision.world.activity.behaviour_words
        pieces = evidence_of(fault, book, robot, label)
        pieces += ages_of(fault, book, robot, supervision.world.health())
        if pieces:
            lines += heading(HOW_KNOWN) + evidence_lines(pieces, width)
        lines += heading(halts.SO_FAR) + moves_so_far(fault, width)
        if others:
            lines += heading(ALSO_WRONG)
        for other in others:
            words = f"{mark_of(other)} {fault_time(other, other.seconds)} {other.name}"
            lines += paragraph(clean(words), width)
        return lines
