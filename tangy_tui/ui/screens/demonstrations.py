"""The library of demonstrations: list, details, and edits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.widgets import Static

from tangy_profiles.errors import TangyError
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.conflicts import called_wrong
from tangy_tui.learning.demonstration_rows import ListRow, list_rows
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.library_entries import Edit
from tangy_tui.text import demonstrations as text
from tangy_tui.text.conflicts import NONE_LEFT
from tangy_tui.text.keys import with_keys
from tangy_tui.text.numbers import counted
from tangy_tui.text.quality import quality_words
from tangy_tui.text.situations import edit_words, step_words
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.panels import LOW, WIDE, key_line, panel
from tangy_tui.ui.widgets.demonstration_list import DemonstrationList
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript

TAKEN_BACK = "undone"
"""The state of a demonstration whose creation was undone; it is not listed."""


class DemonstrationsScreen(TangyScreen[None]):
    """All demonstrations, and the steps of the one at the cursor."""

    CSS_PATH = "demonstrations.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    AUTO_FOCUS = "#demonstrations"
    TITLE = "Demonstrations"
    HELP = (
        "What was shown to Tangy, by whom, and how much of the activity it shows. Below stand the "
        "steps of the demonstration under the cursor: tab goes there and up and down choose one. "
        "{put_away} puts a demonstration away or takes it back into use, {again} shows it again "
        "from the chosen step, {mark} marks several and {merge} makes one of them, {split} makes "
        "two after the chosen step. {undo} takes changes back, one by one, however old they are."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("put_away", "delete"),
        *bind("again"),
        *bind("mark"),
        *bind("merge"),
        *bind("split"),
        *bind("differences", "conflicts"),
        *bind("undo"),
        *bind("redo"),
        *bind("learn"),
        *bind("back", "leave"),
    ]

    def __init__(self, workspace: Workspace) -> None:
        """Create the screen of a workspace's demonstrations."""
        super().__init__()
        self._workspace = workspace
        self._editor = Editor(workspace.store, workspace.activity)
        self._library = self._editor.library
        self._rows: dict[str, ListRow] = {}
        self._marked: list[str] = []
        self._shown = ""
        self._refusal = ""

    def compose(self) -> ComposeResult:
        """Lay out the list, the notes on the chosen demonstration, and its steps."""
        yield StatusLine()
        yield panel(DemonstrationList())
        yield Static(id="notes", markup=False)
        yield panel(Transcript(empty=text.NO_STEPS, id="transcript"))
        yield key_line(
            "put_away", "filter", "undo", "again", "mark", "merge", "split", "differences",
            "learn", "back", "help",
        )  # fmt: skip

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Read the library again, which other screens may have changed."""
        self._read()

    # ---------------------------------------------------------------------------- the choice

    @property
    def _chosen(self) -> ListRow | None:
        return self._rows.get(str(self.query_one(DemonstrationList).chosen))

    @property
    def _step(self) -> int | None:
        """The step at the cursor, None if there is none."""
        return self.query_one(Transcript).chosen

    def on_choice_list_moved(self) -> None:
        """Show the steps of the demonstration at the cursor."""
        self._refusal, self._shown = "", ""
        self._show_chosen()

    def on_demonstration_list_chosen(self, event: DemonstrationList.Chosen) -> None:
        """Open the demonstration."""
        event.stop()
        self._open()

    def on_transcript_chosen(self, event: Transcript.Chosen) -> None:
        """Open the demonstration at the step."""
        event.stop()
        self._open()

    def _open(self) -> None:
        from tangy_tui.ui.screens.demonstration import DemonstrationScreen

        if (row := self._chosen) is not None:
            self.app.push_screen(DemonstrationScreen(self._workspace, row.id, self._step or 1))

    # --------------------------------------------------------------------------- the changes

    def action_delete(self) -> None:
        """Delete the chosen demonstration, or restore it."""
        row = self._chosen
        if row is None:
            return
        if self._library.entries[row.id].hidden:
            self._do(lambda: self._editor.restore(row.id))
            return
        self._confirm(text.delete_words(row), "delete it", lambda: self._editor.delete(row.id))

    def action_mark(self) -> None:
        """Mark the chosen demonstration, or unmark it."""
        row = self._chosen
        if row is not None:
            if row.id in self._marked:
                self._marked.remove(row.id)
            else:
                self._marked.append(row.id)
            self._show_list()

    def action_merge(self) -> None:
        """Merge the marked demonstrations, in the order of their marks."""
        ids = [id for id in self._marked if id in self._rows]
        if len(ids) < 2:
            self._say(text.MARK_FIRST)
            return
        if self._refused(*ids):
            return
        asked = text.merge_words([self._rows[id] for id in ids])
        self._confirm(asked, "merge them", lambda: self._editor.merge(*ids))

    def action_split(self) -> None:
        """Split the chosen demonstration after the chosen step."""
        row, step = self._chosen, self._step
        if row is None:
            return
        if step is None:
            self._say(text.CHOOSE_LAST)
            return
        if self._refused(row.id):
            return
        if step >= row.steps:
            self._say(text.nothing_after_words(step), bad=True)
            return
        asked = text.split_words(row, step)
        self._confirm(asked, "split it", lambda: self._editor.split(row.id, step))

    def _refused(self, *ids: str) -> bool:
        """Return whether a demonstration cannot be merged or split, and tell why."""
        for row in (self._rows[id] for id in ids):
            if not row.in_use:
                self._say(text.refused_words(row), bad=True)
                return True
        return False

    def action_undo(self) -> None:
        """Undo the last change."""
        self._do(self._editor.undo, "Taken back")

    def action_redo(self) -> None:
        """Redo the last undone change."""
        self._do(self._editor.redo, "Done again")

    def action_again(self) -> None:
        """Demonstrate the chosen game again from the chosen step."""
        row, step = self._chosen, self._step
        if row is None:
            return
        if step is None:
            self._say(text.CHOOSE_FIRST)
        else:
            from tangy_tui.ui.screens.demonstration import show_again

            self.app.run_worker(show_again(self.app, self._library, row.id, step))

    def action_conflicts(self) -> None:
        """Show the conflicts between demonstrations."""
        from tangy_tui.ui.screens.conflicts import ConflictsScreen

        if self._library.conflicts:
            self.app.push_screen(ConflictsScreen(self._workspace, then="go back to the list"))
        else:
            self._say(NONE_LEFT)

    async def action_learn(self) -> None:
        """Learn from the demonstrations in use."""
        await self.run_action("app.learn")

    def action_leave(self) -> None:
        """Take the cursor off the steps, or close the screen."""
        if self._step is not None:
            self.query_one(Transcript).release()
            self.query_one(DemonstrationList).focus()
        else:
            self.leave(None)

    def _confirm(self, asked: tuple[str, str], yes: str, change: Callable[[], Edit]) -> None:
        """Ask for confirmation, and make the change."""

        async def ask() -> None:
            question, detail = asked[0], with_keys(asked[1], keymap_of(self.app))
            if await self.app.push_screen_wait(ConfirmDialog(question, detail, yes=yes)):
                self._do(change)

        self.run_worker(ask(), name="confirm")

    def _do(self, change: Callable[[], Edit], before: str = "") -> None:
        """Make a change and describe it, or tell why it is not possible."""
        try:
            edit = change()
        except TangyError as error:
            self._say(str(error), bad=True)
            return
        self._marked.clear()
        self._refusal = ""
        self._read()
        words = edit_words(self._workspace.activity, self._library, edit)
        self._say(text.changed_words(words, before))

    def _say(self, sentence: str, *, bad: bool = False) -> None:
        app: Any = self.app
        app.clear_notifications()
        said = sentence[:1].upper() + sentence[1:]
        app.say(said, bad=bad)
        if bad:  # toasts disappear, but this line stays until the cursor moves
            self._refusal = said
            self._show_notes()

    # ------------------------------------------------------------------------------- showing

    def _read(self) -> None:
        self._library = self._editor.library
        every = list_rows(self._workspace.activity, self._library)
        rows = [row for row in every if row.state != TAKEN_BACK]
        self._rows = {row.id: row for row in rows}
        conflicts = len(self._library.conflicts)
        key = keymap_of(self.app).shown("differences")
        disagree = f", {counted(conflicts, 'conflict')}: press {key}" if conflicts else ""
        note = f"{sum(row.in_use for row in rows)} of {len(rows)} in use{disagree}"
        self.query_one(StatusLine).show(Status(mode="demonstrations", note=note))
        shown, step = self._shown, self._step
        self._shown = ""
        self._show_list()
        if step is not None and self._shown == shown:  # the cursor stays on its step
            self.query_one(Transcript).point(step)

    def _show_list(self) -> None:
        self.query_one(DemonstrationList).fill(list(self._rows.values()), self._marked)
        self._show_chosen()

    def _show_chosen(self) -> None:
        """Show notes and steps of the demonstration at the cursor, if it has changed."""
        row = self._chosen
        if row is None or row.id == self._shown:
            return
        self._shown = row.id
        workspace = self._workspace
        self._show_notes()
        steps = self._library.entries[row.id].demonstration.steps
        words = [step_words(workspace.activity, step, workspace.name) for step in steps]
        transcript = self.query_one(Transcript)
        transcript.border_title = text.steps_title(row.number)
        transcript.fill(words)
        transcript.mark_wrong([called_wrong(self._library.resolutions, step) for step in steps])

    def _show_notes(self) -> None:
        """Show the notes of a demonstration, or why an edit is not possible."""
        if (row := self._chosen) is not None:
            notes = ", ".join(quality_words(row.notes)) or "nothing to note"
            said = self._refusal or f"{row.number}: {row.state}; {notes}."
            self.query_one("#notes", Static).update(clean(said))
