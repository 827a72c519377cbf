"""One demonstration, step by step: situation, words, behaviour, and result."""

from __future__ import annotations

from typing import Any, ClassVar

from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.state import FRONT
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.conflicts import called_wrong
from tangy_tui.learning.demonstration_rows import heard_words, state_of
from tangy_tui.learning.library import read_library
from tangy_tui.learning.library_entries import Library
from tangy_tui.learning.quality import quality_notes
from tangy_tui.text.demonstrations import AGAIN_DETAIL, NO_STEPS, NOT_LEARNT, again_words
from tangy_tui.text.numbers import counted
from tangy_tui.text.quality import quality_words
from tangy_tui.text.situations import step_words
from tangy_tui.text.times import local_time
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import LOW, WIDE, key_line, panel
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript


async def show_again(app: App[Any], library: Library, id: str, number: int) -> None:
    """Demonstrate a game again from a step, if the teacher confirms."""
    dialog = ConfirmDialog(
        again_words(library.name(id), number),
        AGAIN_DETAIL,
        yes="show it again",
        no="leave it as it is",
    )
    if await app.push_screen_wait(dialog):
        program: Any = app
        await program.show_again(id, number - 1)


class DemonstrationScreen(TangyScreen[None]):
    """The steps of a demonstration, with the step at the cursor in detail."""

    CSS_PATH = "demonstration.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    AUTO_FOCUS = "#transcript"
    TITLE = "Demonstration"
    HELP = (
        "One demonstration from its first step to its last. Up and down choose a step; below it "
        "stands what was said, what was done and what followed. {again} shows it again from the "
        "step that is chosen: everything before it stays as it is."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("again"),
        *bind("back", "leave"),
    ]

    def __init__(self, workspace: Workspace, id: str, number: int = 1) -> None:
        """Create the screen.

        Args:
            workspace: the workspace of the demonstration.
            id: the id of the demonstration.
            number: the step at the cursor, from 1.
        """
        super().__init__()
        self._workspace = workspace
        self._library: Library = read_library(workspace.store, workspace.activity.name)
        self._entry = self._library.find(id)
        self._number = number
        self._heard = heard_words(workspace.store, self.shown)

    @property
    def shown(self) -> Demonstration:
        """The demonstration."""
        return self._entry.demonstration

    def compose(self) -> ComposeResult:
        """Lay out the summary, the steps, and the chosen step."""
        name = self._library.name(self.shown.id)
        yield StatusLine(Status(mode=name, note=state_of(self._entry)))
        yield Static(self._summary(), id="summary", markup=False)
        yield panel(Transcript(empty=NO_STEPS, id="transcript"))
        with panel(VerticalScroll(id="step"), "This step"):
            yield Static(id="told", markup=False)
        yield key_line(
            ("up down", "choose a step"), "again:show again from here", "filter", "back", "help"
        )

    def on_mount(self) -> None:
        """Show the steps, with the cursor on the wanted one."""
        steps = self.query_one(Transcript)
        workspace = self._workspace
        steps.fill([step_words(workspace.activity, s, workspace.name) for s in self.shown.steps])
        steps.mark_wrong([self._wrong(step) for step in self.shown.steps])
        self.call_after_refresh(steps.point, self._number)
        self._tell(min(max(1, self._number), len(self.shown.steps)))

    def on_transcript_moved(self, event: Transcript.Moved) -> None:
        """Describe the step at the cursor."""
        self._tell(event.number or len(self.shown.steps))

    def action_again(self) -> None:
        """Demonstrate the game again from the chosen step, if the teacher confirms."""
        self.app.run_worker(self._again(self._number))

    async def _again(self, number: int) -> None:
        await show_again(self.app, self._library, self.shown.id, number)

    def action_leave(self) -> None:
        """Close the screen."""
        self.leave(None)

    def _wrong(self, step: Step) -> bool:
        return called_wrong(self._library.resolutions, step)

    def _summary(self) -> str:
        entry, shown = self._entry, self.shown
        notes = quality_notes(self._workspace.activity, entry, self._library)
        parts = [f"by {shown.teacher}", local_time(entry.at), counted(len(shown.steps), "step")]
        return clean(", ".join([*parts, *quality_words(notes)]))

    def _tell(self, number: int) -> None:
        self._number = max(1, number)
        if 1 <= number <= len(self.shown.steps):
            told = self.query_one("#told", Static)
            told.update(self._step_content(number, self.shown.steps[number - 1]))

    def _step_content(self, number: int, step: Step) -> Content:
        activity, name = self._workspace.activity, self._workspace.name
        place = "at the front" if step.state.place == FRONT else f"with {name(step.state.place)}"
        done = activity.behaviour_words(step.behaviour) + (
            f", for {name(step.target)}" if step.target else ""
        )
        lines = [
            ("Step", f"{number} of {len(self.shown.steps)}"),
            ("Situation", f"{activity.in_words(step.state.situation)}; Tangy is {place}"),
            ("Heard", self._heard.get(number, "")),
            ("Done", done + ("" if step.completed else " (could not be carried out)")),
            ("Learnt", NOT_LEARNT if self._wrong(step) else ""),
            ("Then", activity.in_words(step.after.situation)),
        ]
        parts: list[str | tuple[str, str]] = []
        for label, text in lines:
            if text:
                parts += [(f"{label:<11}", "$ink-dim"), clean(text), "\n"]
        return Content.assemble(*parts).rstrip()
