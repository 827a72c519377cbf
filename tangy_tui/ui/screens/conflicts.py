"""The conflicts screen: the answers to one situation side by side, to choose the right one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Grid
from textual.widgets import Static

from tangy_profiles.errors import TangyError
from tangy_profiles.teaching_records import Settlement
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.conflicts import Conflict
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.library_entries import Edit
from tangy_tui.text import conflicts as text
from tangy_tui.text.keys import with_keys
from tangy_tui.text.situations import edit_words
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.words import WordsDialog
from tangy_tui.ui.keys import Key, bind, keymap_of
from tangy_tui.ui.panels import LOW, WIDE, KeyLine, panel
from tangy_tui.ui.type_ahead_guard import FreshKeys
from tangy_tui.ui.widgets.answer_steps import AnswerSteps
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.status_line import Status, StatusLine


class ConflictsScreen(TangyScreen[bool]):
    """Shows one conflict after another. Dismissed with True to continue, False to go back."""

    CSS_PATH = "conflicts.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    TITLE = "Conflicts"
    HELP = (
        "Demonstrations gave different answers to the same situation. Nothing is outvoted behind "
        "your back: say which answer is right, and the other steps are not learnt from. Enter "
        "opens the step under the cursor, tab goes to the other answer, {undo} takes your last "
        "answer back. What you leave open Tangy asks about when it comes up in a game."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("1", "nothing", text.THIS_IS_RIGHT, key_display="1-9", id="number"),
        Binding("0", "nothing", text.ALL_ARE_RIGHT, id="number"),
        *bind("another", "other", name=text.ANOTHER_IS_RIGHT),
        *bind("undo"),
        Binding("enter", "nothing", text.OPEN_OR_GO_ON, id="open"),
        Binding("escape", "nothing", text.LEAVE_OPEN, id="back"),
    ]

    def __init__(self, workspace: Workspace, *, then: str = "go on") -> None:
        """Create the screen; `then` names what follows after the last conflict."""
        super().__init__()
        self._workspace = workspace
        self._then = then
        self._editor = Editor(workspace.store, workspace.activity)
        self._library = self._editor.library
        self._conflicts: list[Conflict] = self._library.conflicts
        self._answered: list[Edit | None] = []
        self._keys = FreshKeys()

    @property
    def _present(self) -> Conflict | None:
        """The present conflict, None after the last one."""
        at = len(self._answered)
        return self._conflicts[at] if at < len(self._conflicts) else None

    def compose(self) -> ComposeResult:
        """Lay out the situation, the answers, the question, and its resolution."""
        yield StatusLine()
        yield Static(id="situation", markup=False)
        yield Grid(id="answers")
        yield Static(id="asked", markup=False)
        yield panel(LogView(id="log"), "Answers")
        yield KeyLine(*self._key_words())

    async def on_mount(self) -> None:
        """Show the first conflict."""
        await self._show()

    async def on_key(self, event: events.Key) -> None:
        """Handle an answer, if the conflict was visible before."""
        key = event.character or event.key
        if event.key not in ("escape", "enter"):
            if not key.isdecimal():
                return
        elif event.key == "enter" and self._present is not None:
            return  # Enter opens the step at the cursor
        if self._keys.take(event):
            await self._take(event.key)

    async def _take(self, key: str) -> None:
        present = self._present
        if present is None:
            if key in ("enter", "escape"):
                self.close(key == "enter")
        elif key == "escape":
            await self._leave_open(present)
        elif key == "0":
            await self._resolve(present, *present.answers)
        elif key.isdecimal() and 1 <= int(key) <= len(present.answers):
            await self._resolve(present, list(present.answers)[int(key) - 1])

    def on_answer_steps_chosen(self, event: AnswerSteps.Chosen) -> None:
        """Open a step in its demonstration."""
        from tangy_tui.ui.screens.demonstration import DemonstrationScreen

        event.stop()
        shown = event.shown
        self.app.push_screen(
            DemonstrationScreen(self._workspace, shown.demonstration, shown.number)
        )

    def action_other(self) -> None:
        """Choose an answer that no demonstration gives."""
        if (present := self._present) is not None:
            self.run_worker(self._other(present), name="other")

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    # --------------------------------------------------------------------------- the answers

    async def _resolve(self, conflict: Conflict, *right: str) -> None:
        try:
            edit = self._editor.resolve(conflict, *right)
        except TangyError as error:
            self._log.write(str(error), "bad")
            return
        self._answered.append(edit)
        words = edit_words(self._workspace.activity, self._library, edit)
        aside = len(edit.done.resolution.wrong) if isinstance(edit.done, Settlement) else 0
        self._log.write(text.settled_words(words, aside), "good")
        await self._show()

    async def _other(self, conflict: Conflict) -> None:
        """Let the user choose a behaviour that was not demonstrated here."""
        activity = self._workspace.activity
        others = [b for b in activity.behaviours if b not in conflict.answers]
        dialog = WordsDialog(text.OTHER, list(map(activity.behaviour_words, others)))
        chosen = await self.app.push_screen_wait(dialog)
        if chosen is not None and conflict is self._present:
            await self._resolve(conflict, activity.behaviour_named(chosen))

    async def _leave_open(self, conflict: Conflict) -> None:
        self._answered.append(None)
        words = self._workspace.activity.in_words(conflict.situation)
        self._log.write(text.left_open_words(words), "warn")
        await self._show()

    async def action_undo(self) -> None:
        """Undo the last answer, and ask again."""
        if not self._answered:
            self._log.write(text.NOTHING_TAKEN_BACK, "warn")
            return
        edit = self._answered[-1]
        try:
            if edit is not None:
                self._editor.undo()
        except TangyError as error:
            self._log.write(str(error), "bad")
            return
        self._answered.pop()
        self._log.write(text.TAKEN_BACK, "warn")
        await self._show()

    # ------------------------------------------------------------------------------- showing

    async def _show(self) -> None:
        self._keys = FreshKeys()
        present, count = self._present, len(self._conflicts)
        note = f"{len(self._answered) + 1} of {count}" if present is not None else "all reviewed"
        self.query_one(StatusLine).show(Status(mode="conflicts", note=note))
        await self._show_answers(present)
        self.query_one("#situation", Static).update(
            self._summary() if present is None else self._situation(present)
        )
        self.query_one(KeyLine).show(*self._key_words())
        asked = text.keys_words(self._then) if present is None else text.ASKED
        self.query_one("#asked", Static).update(with_keys(asked, keymap_of(self.app)))
        self._keys.watch(self)

    async def _show_answers(self, present: Conflict | None) -> None:
        grid = self.query_one(Grid)
        await grid.remove_children()
        if present is None:
            self.set_focus(None)
            return
        columns = [
            panel(AnswerSteps(self._workspace, self._library, number, behaviour, steps))
            for number, (behaviour, steps) in enumerate(present.answers.items(), 1)
        ]
        grid.styles.grid_size_columns = min(len(columns), 4 if self.has_class("-wide") else 2)
        await grid.mount(*columns)
        columns[0].focus()

    def _key_words(self) -> Sequence[str | Key]:
        """Return the keys that have an effect now."""
        undo: list[str | Key] = ["undo"] if self._answered else []
        if self._present is None:
            return [f"open:{self._then}", *undo, "back", "help"]
        answers: list[str | Key] = [("1-9", "right"), ("0", "all"), "another", "open", "filter"]
        return [*answers, *undo, "back:leave open", "help"]

    def _situation(self, conflict: Conflict) -> str:
        words = self._workspace.activity.in_words(conflict.situation)
        return clean(text.situation_words(words))

    def _summary(self) -> str:
        left = sum(edit is None for edit in self._answered)
        return text.done_words(len(self._answered) - left, left)

    @property
    def _log(self) -> LogView:
        return self.query_one(LogView)


async def settle_conflicts(app: Any, workspace: Workspace, then: str) -> bool:
    """Let the user settle the conflicts, if there are any; return whether to continue."""
    if not Editor(workspace.store, workspace.activity).library.conflicts:
        return True
    return bool(await app.push_screen_wait(ConflictsScreen(workspace, then=then)))
