"""The panels of the playing screen: which are visible, and what they explain."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.screen import Screen

from tangy_profiles.declared.typed_observations import open_options
from tangy_profiles.errors import TangyError
from tangy_profiles.present_moment import as_present
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.interruption import earlier_part
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.tally import Tally
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text.earlier import before_words, earlier_messages
from tangy_tui.text.games import (
    ANSWER_FIRST,
    LEAVE_DETAIL,
    NO_UNSEEN_FAULT,
    REPORT_AFTER_LEAVING,
    REPORT_AT_END,
    REPORT_AT_HOME,
    SEEN,
    dropped_words,
)
from tangy_tui.text.keys import with_keys
from tangy_tui.text.register import staff_names
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.camera_session import CameraSession
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.fault_console import FaultConsole
from tangy_tui.ui.game_picture import GamePicture
from tangy_tui.ui.hearing import HearingLine, hearing_of
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.message_history import remember, remember_before
from tangy_tui.ui.panels import KeyLine, panel, room_panel
from tangy_tui.ui.screens import play_keys
from tangy_tui.ui.screens.play_keys import keys
from tangy_tui.ui.screens.play_view import ViewSource, show_view
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.call_board import CallBoard
from tangy_tui.ui.widgets.fault_banner import FaultBanner
from tangy_tui.ui.widgets.fault_list import FaultList
from tangy_tui.ui.widgets.log_view import Kind, LogView
from tangy_tui.ui.widgets.policy_table import PolicyTable
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript

CHOOSABLE = ("transcript", "policy", "posteriors", "log", "faults")
STAFF = "staff"
INSIDE = ("transcript", "policy", "posteriors")
"""Panels that show how Tangy decides, reached by a key."""
ON_THE_LEFT = ("log", "faults")
"""Panels below the room; if only one panel is visible at a time, they replace the others."""


class PlayPanels(TangyScreen[Tally]):
    """Room, steps, policy, posteriors, log and faults of supervised games."""

    mode = "play"
    """The name of the screen on the status line."""
    LETTERS_FOLLOW = play_keys.LETTERS_FOLLOW
    FIRST = CHOOSABLE[0]
    """The panel that is shown first."""
    ALLOW_IN_MAXIMIZED_VIEW = f"{TangyScreen.ALLOW_IN_MAXIMIZED_VIEW},#banner,#microphone"

    def __init__(self, workspace: Workspace, control: GameController) -> None:
        """Create the panels of a controller's games."""
        super().__init__()
        self._workspace = workspace
        self.control = control
        self._supervision = control.supervision
        self.picture = GamePicture(self, workspace, control.supervision)
        self.picture.played = lambda: control.view().seconds
        self.picture.scene = lambda: control.plan.scene
        self._faults = FaultConsole(self, workspace, control, tell=self._tell, failed=self._fail)

    def on_mount(self) -> None:
        """Show what the log has of a game before it was interrupted."""
        control, workspace = self.control, self._workspace
        part = earlier_part(workspace, control.past, joined=control.after_joining)
        self._faults.earlier = part
        if part is None:  # an interruption of another game is not one of this
            remember_before(self.app, "", ())
        elif not part.joined:
            told = earlier_messages(part, workspace.activity, workspace.name)
            remember_before(self.app, before_words(part.at), told)

    def _tell(self, events: list[Event], known: bool = False) -> None:
        """Show events; a dialog tells why a game stopped, unless that is `known`."""
        raise NotImplementedError

    def steer(self, text: str, sure: float) -> None:
        """Handle a spoken steering command, or a person's answer (`sure`: likelihood)."""
        raise NotImplementedError

    def _open_options(self) -> Sequence[str]:
        """Return the options of the question that people are asked now."""
        now = as_present(self._supervision.world)
        return () if now is None else open_options(now.ahead)

    def _fail(self, reason: str) -> None:
        """Pause because an event could not be stored."""
        raise NotImplementedError

    def compose(self) -> ComposeResult:
        """Lay out the panels; at 80 columns, keys 1 to 6 choose the visible one."""
        yield StatusLine()
        yield FaultBanner()
        with Horizontal(id="body"):
            with Vertical(id="left"):
                yield room_panel(self._workspace)
                yield panel(FaultList(self._workspace.name))
                yield panel(LogView(id="log"))
            with Vertical(id="right"):
                yield panel(StaffPanel())
                yield panel(CallBoard(self._workspace.activity.deck))
                yield panel(Transcript(id="transcript"))
                yield panel(PolicyTable())
                yield panel(Posteriors(world=self._supervision.world.played_in))
        if (hearing := hearing_of(self.app)) is not None:
            yield HearingLine(hearing, self.steer, self._open_options)
        yield KeyLine(*keys(going=True))

    def action_panel(self, name: str) -> None:
        """Show a panel if not all are visible, and focus it."""
        enlarged = self.maximized is not None
        self.minimize()
        if name in INSIDE or name == STAFF:
            self.set_class(name == STAFF, "-staff")
        for id in CHOOSABLE:
            self.query_one(f"#{id}").set_class(id == name, "-chosen")
        self.set_class(name in ON_THE_LEFT, "-left")
        self.set_class(name == "room", "-room")
        if name != "room":
            chosen = self.query_one(f"#{name}")
            chosen.focus()
            if enlarged:
                self.maximize(chosen)

    def action_inside(self) -> None:
        """Switch between Tangy's decisions and the view for staff."""
        self.action_panel(INSIDE[0] if self.has_class("-staff") else STAFF)
        self.show_staff()

    def show_staff(self) -> None:
        """Update the view for staff."""
        world = self._supervision.world
        view = self.control.view()
        if (past := self.control.past) is not None and self._supervision.over:  # staff are asked
            called = tuple(past.called(world.activity))
            view = replace(view, seconds=past.seconds, called=called, paused=0.0)
            self.query_one(RoomView).show(replace(world.scene(), called=called))
        elif view.called != self.query_one(RoomView).scene.called or self._seen_since():
            self.picture.show_scene(0, drive=False, pace=0)
        show_view(
            self.query_one(StaffPanel),
            self.query_one(CallBoard),
            view,
            self._source(),
        )
        self.picture.show_stage()
        self.picture.show_speech()

    def _seen_since(self) -> bool:
        """Whether the room lacks what the robot has seen since it was drawn, during a step."""
        return False

    def _source(self) -> ViewSource:
        """Return what the view for staff is shown with."""
        name = staff_names(self._workspace.name)
        world = self._supervision.world
        report = REPORT_AT_HOME if self._leads_home else REPORT_AT_END
        return ViewSource(world, self.control, name, self.picture.said, report)

    def _leave_detail(self, follow: int) -> str:
        """Tell what happens if staff leave in the middle of a game, which some were to follow."""
        report = REPORT_AT_HOME if self._leads_home else REPORT_AFTER_LEAVING
        return f"{LEAVE_DETAIL.format(report=report)} {dropped_words(follow)}".strip()

    @property
    def _leads_home(self) -> bool:
        """Whether the home screen follows when staff leave, and not the end of the program."""
        return bool(getattr(self.app, "leads_home", True))

    def went_back(self) -> bool:
        """Close a message, take the cursor off the steps, or show the next step again.

        Return whether there was anything to go back from.
        """
        if self.query("Toast"):
            self.app.clear_notifications()
            return True
        steps, staff = self.query_one(Transcript), self.query_one(StaffPanel)
        if steps.has_focus and steps.chosen is not None:
            steps.release()
            return True
        return bool(staff.display and staff.return_to_top())

    def action_sensors(self) -> None:
        """Show the state of all devices above the game, which continues."""
        try:
            screen = self._sensors_screen(lambda: self.query_one(StatusLine).status)
        except TangyError as error:
            self._tell_now(str(error), "warn")
            return
        self.app.push_screen(screen)

    def _sensors_screen(self, shown: Callable[[], Status]) -> Screen[None]:
        """Create the screen of devices: those of a simulated game, and real cameras."""
        from tangy_tui.ui.screens.sensors import SensorsScreen

        eyes: CameraSession | None = getattr(self.app, "eyes", None)
        sensors = None if eyes is None else eyes.sensors()
        health = self._supervision.world.health
        return SensorsScreen(self._workspace, sensors, health=health, shown=shown)

    def id_of(self, wanted: str) -> str:
        """Return the id of a person by name or id; raises TangyError if nobody is called so."""
        return self._workspace.find_person(wanted).id

    def on_fault_list_chosen(self, event: FaultList.Chosen) -> None:
        """Show all about a fault."""
        event.stop()
        if (dialog := self._faults.dialog(event.id)) is not None:
            self.app.push_screen(dialog)

    def action_acknowledge(self) -> None:
        """Acknowledge the fault in the banner, after confirmation."""
        if (fault := self._faults.unseen) is not None:
            self._sure(
                SEEN,
                fault.name,
                lambda: self._acknowledge(fault),
                lambda: not self._faults.shows(fault),
            )
        else:
            asks = self._faults.asked_about is not None
            self._tell_now(ANSWER_FIRST if asks else NO_UNSEEN_FAULT, "dim")

    def _told(self, text: str) -> str:
        """Insert the keys of actions into a sentence."""
        return with_keys(text, keymap_of(self.app))

    def _sure(
        self,
        question: str,
        detail: str,
        then: Callable[[], None],
        obsolete: Callable[[], bool] | None = None,
    ) -> None:
        """Run an action that cannot be undone, after confirmation, unless that is `obsolete`."""

        def answered(sure: bool | None) -> None:
            if sure:
                then()

        self.app.push_screen(ConfirmDialog(question, detail, obsolete=obsolete), answered)

    def _acknowledge(self, fault: Fault) -> None:
        try:
            if not self._faults.see(fault):
                self._tell_now(NO_UNSEEN_FAULT, "dim")
        except TangyError as error:
            self._fail(str(error))

    def on_descendant_focus(self) -> None:
        """Update the banner's key: while an input line has the focus, letters are no keys."""
        if self.query(FaultBanner):
            self._faults.show()

    def on_descendant_blur(self) -> None:
        """Update the banner's key: letters are keys again."""
        self.on_descendant_focus()

    def action_inject(self) -> None:
        """Inject a fault into the simulated room, or lift one."""
        if refusal := self._faults.injection.refuses():
            self._tell_now(refusal, "warn")
        else:
            self.app.push_screen(self._faults.injection.dialog(), self._inject)

    def _inject(self, kind: str | None) -> None:
        try:
            said, shown = self._faults.injection.inject(kind)
        except TangyError as error:  # it cannot be logged, so it is not done
            said, shown = str(error), False
        if shown:  # the screen shows it already, and a toast would cover that
            self._write(said, "dim")
        elif said:
            self._tell_now(said, "dim")

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable talking without push-to-talk, and claims in an activity without them."""
        if action == "claim":
            return bool(self._workspace.activity.rules.claim)
        hearing = hearing_of(self.app)
        return action != "talk" or (hearing is not None and hearing.by_key)

    async def action_talk(self) -> None:
        """Start or end an utterance (push-to-talk)."""
        await self.run_action("app.talk")

    @property
    def _asking(self) -> AskingPanel | None:
        """The panel of Tangy's open question, if there is one."""
        panels = self.query(AskingPanel)
        return panels.first() if panels else None

    def take_sentence(self, sentence: str, kind: Kind = "dim") -> bool:
        """Show a sentence below Tangy's question, and in the log; False: there is no question."""
        if self._asking is not None:
            self._asking.say(sentence)
            self._write(sentence, kind)
        return self._asking is not None

    def _tell_now(self, sentence: str, kind: Kind) -> None:
        """Show the result of a key, or why it has no effect, at every window size."""
        sentence = self._told(sentence)
        if self.take_sentence(sentence, kind):
            remember(self.app, sentence)
        else:
            self._write(sentence, kind)
            if self.query_one(LogView).display:
                remember(self.app, sentence)
            else:
                self.app.clear_notifications()
                self.notify(
                    sentence,
                    severity="warning" if kind in ("warn", "bad") else "information",
                    markup=False,
                )

    def _write(self, sentence: str, kind: Kind) -> None:
        self.query_one(LogView).write(self._told(sentence), kind)
