"""The teaching screen (III-A-2): the simulated room, the trajectory, and one line for commands."""

from __future__ import annotations

import asyncio
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.widgets import Static

from tangy_profiles.errors import TangyError
from tangy_tui.house import House
from tangy_tui.learning.demonstrating import (
    Begun,
    Executed,
    Finished,
    Next,
    StepUndone,
    TeacherCommand,
    Teaching,
    TeachingEvent,
    Undo,
)
from tangy_tui.learning.ears import Ears
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.verifying import Asked, NotUnderstood, Refused, Rejected, Reply, Say
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import LOW, WIDE, panel, room_panel
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tangy_tui.wording import counted, state_words, step_words

DRIVING_PACE = 4.0
"""How many times faster than the robot the picture of it drives: nobody waits for a picture."""


class TeachScreen(TangyScreen[bool]):
    """One teacher's session. Dismissed with True when the wanted demonstrations are complete."""

    CSS_PATH = "teach.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    AUTO_FOCUS = "#command-input"
    HELP = (
        "You are the teacher. Look at the room, decide what Tangy should do, and type it. Tangy "
        "asks whether it understood; press y and it is done. People press a button when they "
        "want help (?1, ?2, ... is whose turn it is): go to them, and the line Now says what "
        "Tangy sees there. Leave whenever you like: what you confirmed is kept."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("u", "undo", "Undo the last step"),
        Binding("ctrl+z", "undo", "Undo the last step", show=False, priority=True),
        Binding("r", "learn", "Learn from the demonstrations"),
        Binding("d", "next", "Another demonstration"),
        Binding("escape", "leave", "Leave; your steps are kept"),
    ]

    def __init__(
        self,
        house: House,
        teaching: Teaching,
        *,
        resume: bool = True,
        another: bool = False,
        ears: Ears | None = None,
        scripted: float | None = None,
    ) -> None:
        """Make the screen.

        Args:
            resume: take up an unfinished demonstration of this teacher.
            another: the session has begun already; begin its next demonstration.
            ears: where spoken commands come from, if they do.
            scripted: let a scripted teacher give the demonstration, this many steps a second.
        """
        super().__init__()
        self._house = house
        self._teaching = teaching
        self._resume = resume
        self._ears = ears
        self._scripted = scripted
        self._another = another
        phrases = (b.phrases[0] for b in teaching.activity.behaviours.values())
        self.HELP = f"{type(self).HELP} You can say: {', '.join(phrases)}."  # type: ignore[misc]
        self._free = asyncio.Event()

    def compose(self) -> ComposeResult:
        """Lay out status, room, what was said, the trajectory, the situation, the commands."""
        yield StatusLine()
        with Horizontal(id="body"):
            with Vertical(id="left"):
                yield room_panel(self._house)
                yield panel(LogView(id="log"))
            yield panel(
                Transcript(empty="No steps yet. Type what Tangy should do first.", id="transcript")
            )
        yield Static(id="now", markup=False)
        yield CommandBar(
            lambda typed: self._teaching.phrasebook.complete(typed),
            resting="u undo   d another game   r learn   : type   esc home",
            id="command",
        )

    def on_mount(self) -> None:
        """Begin the session."""
        teaching = self._teaching
        self._tell(teaching.apply(Next()) if self._another else teaching.begin(resume=self._resume))
        self._free.set()
        if self._scripted is not None:
            self.query_one(CommandBar).disabled = True
            self.run_worker(self._follow_script(self._scripted), name="scripted teacher")
        if self._ears is not None:
            self.run_worker(self._listen(self._ears), name="ears")

    # ------------------------------------------------------------------------------ commands

    def on_command_bar_given(self, event: CommandBar.Given) -> None:
        """Put a typed command to Tangy."""
        event.stop()
        match event.text.strip().lower():
            case "help":
                self.query_one(CommandBar).ready()
                self.app.run_worker(self.run_action("app.help"))
            case "stop":
                self.app.run_worker(self.run_action("app.stop"))
            case "undo":
                self.action_undo()
            case "next":
                self.action_next()
            case "quit" | "exit" | "leave":
                self.action_leave()
            case _:
                self._apply(Say(event.text))

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave a scripted teacher alone: who watches can only leave, or stop."""
        return self._scripted is None or action not in ("undo", "next", "learn")

    def action_undo(self) -> None:
        """Take the last step back."""
        self._apply(Undo())

    def action_next(self) -> None:
        """Begin another demonstration."""
        self._apply(Next())

    def action_leave(self) -> None:
        """Go back; what was verified is kept."""
        self.dismiss(False)

    async def action_learn(self) -> None:
        """Learn from all finished demonstrations, and show the policy."""
        await self.run_action("app.learn")

    def on_stop(self, message: Stop) -> None:
        """Let the robot stand; what was verified has been done."""
        self.query_one(RoomView).skip()
        self.query_one(CommandBar).ready()
        self._log.write("STOP: the simulated robot stands still.", "warn")

    def _apply(self, command: TeacherCommand) -> None:
        try:
            events = self._teaching.apply(command)
        except TangyError as error:  # the log could not be written, and nothing was done
            self._log.write(str(error), "bad")
            self.notify(str(error), severity="error", markup=False)
            self.query_one(CommandBar).ready()
            self._free.set()
        else:
            self._tell(events)

    # -------------------------------------------------------------------------------- events

    def _tell(self, events: list[TeachingEvent]) -> None:
        bar = self.query_one(CommandBar)
        for event in events:
            match event:
                case Asked():
                    self._ask(event)
                    return
                case NotUnderstood(heard, suggestions):
                    near = f" Did you mean: {', '.join(suggestions)}?" if suggestions else ""
                    self._log.write(f"I do not know what {heard!r} means.{near}", "warn")
                    bar.restore(heard)
                case Rejected(heard):
                    self._log.write("Not done. Give a new command.", "dim")
                    bar.restore(heard)
                case Refused(reason, heard):
                    self._log.write(reason, "warn")
                    if heard:
                        bar.restore(heard)
                case Executed():
                    self._show_step(event)
                case StepUndone(number, step):
                    self.query_one(Transcript).remove_last()
                    self._log.write(f"Step {number} is undone: {step.behaviour}.", "warn")
                    self.query_one(RoomView).say("")
                    self._show_scene(self._teaching.world.observe().place)
                case Begun(demonstration, resumed):
                    self._show_beginning(len(demonstration.steps), resumed)
                case Finished(demonstration):
                    self._finish(len(demonstration.steps))
        bar.ready()
        self._show_state()
        self._free.set()

    def _ask(self, asked: Asked) -> None:
        self._free.clear()
        if self._ears is not None:
            self._ears.shut()
        self.run_worker(self._verify(asked), name="question")

    async def _verify(self, asked: Asked) -> None:
        """Put the question, and give its answer to the session when its dialog has gone."""
        behaviours = self._teaching.activity.behaviours
        dialog = QuestionDialog(
            asked.question,
            heard=asked.heard if asked.confidence < 1 else "",
            confidence=asked.confidence if asked.confidence < 1 else None,
            alternatives=[behaviours[name].question for name in asked.alternatives],
        )
        answer = await self.app.push_screen_wait(dialog)
        while dialog.is_attached:  # noqa: ASYNC110 - the next one has the same id, and no event
            await asyncio.sleep(0)
        if self._ears is not None:
            self._ears.open()
        chosen = None if answer.alternative is None else answer.alternative + 1
        self._apply(Reply(answer.yes, chosen))

    def _show_step(self, event: Executed) -> None:
        self.query_one(Transcript).append(
            step_words(self._teaching.activity, event.step, self._teaching.name)
        )
        self._log.write(event.speech)
        self.query_one(RoomView).say(event.speech)
        self._show_scene(event.step.state.place)

    def _show_scene(self, came_from: str) -> None:
        room = self.query_one(RoomView)
        scene = self._teaching.world.scene()
        if came_from != scene.place:
            stand, people = self._house.room.stand, self._teaching.people
            way = stand(came_from, people).distance(stand(scene.place, people))
            room.drive(scene.place, way / self._house.robot.speed / DRIVING_PACE)
        room.show(scene)

    def _show_beginning(self, steps: int, resumed: bool) -> None:
        teaching = self._teaching
        self.query_one(Transcript).fill(
            [step_words(teaching.activity, s, teaching.name) for s in teaching.demonstration.steps]
        )
        self._show_scene(teaching.world.observe().place)
        if resumed:
            self._log.write(f"Going on where you left, after {counted(steps, 'step')}.", "good")
        else:
            self._log.write(
                f"A new game of {teaching.activity.title}, demonstrated by {teaching.teacher}.",
                "dim",
            )

    def _finish(self, steps: int) -> None:
        self._log.write(f"The game is complete: {counted(steps, 'step')}.", "good")

    def _show_state(self) -> None:
        teaching = self._teaching
        state = teaching.world.observe()
        self.query_one(StatusLine).show(
            Status(
                mode="teach",
                stage=state.stage if not teaching.world.over else "over",
                step=len(teaching.demonstration.steps),
                note=f"{teaching.teacher}'s game {teaching.demonstration.seed}",
            )
        )
        words = (
            "The game is over. Press esc, then d for another game, or r to let Tangy learn."
            if teaching.world.over
            else state_words(teaching.activity, state, teaching.world.scene(), teaching.name)
        )
        self.query_one("#now", Static).update(f"Now: {words}")

    @property
    def _log(self) -> LogView:
        return self.query_one(LogView)

    # ----------------------------------------------------------------- other ways to command

    async def _listen(self, ears: Ears) -> None:
        """Take spoken commands, one at a time: the next when the last is answered."""
        ears.tell = lambda sentence: self._log.write(sentence, "dim")
        try:
            async for said in ears:
                await self._free.wait()
                self._apply(said)
        except TangyError as error:
            self._log.write(str(error), "bad")

    async def _follow_script(self, pace: float) -> None:
        """Let the scripted teacher type, and answer as a person would."""
        teacher = ScriptedTeacher(self._teaching)
        bar = self.query_one(CommandBar)
        while not self._teaching.demonstration.finished:
            command = teacher.command()
            if isinstance(command, Say):
                bar.restore(command.text)
                await asyncio.sleep(0.4 / pace)
            events = self._teaching.apply(command)
            if events and isinstance(events[0], Asked):
                events = self._teaching.apply(Reply(yes=True))
            bar.restore("")
            self._tell(events)
            await asyncio.sleep(0.6 / pace)
        self.dismiss(True)
