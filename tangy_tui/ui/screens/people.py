"""The people screen: what works with each person, with how much data, and corrections by staff."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import PLAYED_WORLDS
from tangy_tui.app.aloud import hear
from tangy_tui.app.joining import let_join
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.feedback import FeedbackEntry
from tangy_tui.interaction.record import PersonSummary
from tangy_tui.text import people as text
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.answer import AnswerDialog
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.method import MethodChoice, MethodDialog
from tangy_tui.ui.dialogs.pronunciation import NewPronunciation, PronunciationDialog
from tangy_tui.ui.joining import ask_new_name, ask_who_joins
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import LOW, WIDE, key_line, panel
from tangy_tui.ui.person_lines import (
    history_lines,
    people_lines,
    strategy_hint,
    strategy_lines,
)
from tangy_tui.ui.widgets.choice_list import ChoiceList
from tangy_tui.ui.widgets.status_line import Status, StatusLine

WHY = {True: "that was not compliance", False: "that was not a refusal"}
"""The reason for voiding a response, by whether it counted as compliance."""


class PeopleScreen(TangyScreen[None]):
    """Everybody in a sentence each; strategies and history of the chosen person."""

    CSS_PATH = "people.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    HELP = (
        "Above, everybody with what works in a sentence. Below, of the person that is chosen, "
        "each way of asking and the history game by game. tab goes from one panel to the next. "
        "{put_away} switches the chosen way of asking off or on; in the history it leaves the "
        "chosen response out. Every change is asked about first, and {undo} takes the last one "
        "back. {pronounce} is for how a name is said, so that Tangy hears it. {join} adds "
        "a person or a guest, {rename} gives the chosen person another name. What is known is "
        "kept apart for simulated games, games on the bench, and live ones: {world} shows the "
        "next of them."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("put_away", name=text.PUT_AWAY),
        *bind("feedback"),
        *bind("method"),
        *bind("pronounce"),
        *bind("undo"),
        *bind("join"),
        *bind("rename"),
        *bind("world"),
        *bind("back", "leave"),
    ]

    def __init__(self, workspace: Workspace) -> None:
        """Create the screen."""
        super().__init__()
        self._workspace = workspace
        self._feedback = workspace.memory().feedback
        self._world = workspace.memory().world
        self._records: dict[str, PersonSummary] = {}
        self._told = ""

    def compose(self) -> ComposeResult:
        """Lay out the three panels."""
        yield StatusLine(self._status)
        with Container(id="body"):
            with Container(id="left"):
                yield panel(ChoiceList("People", text.PEOPLE_HELP, id="people"))
                yield panel(ChoiceList("What works", text.STRATEGIES_HELP, id="strategies"))
            yield panel(ChoiceList("History", text.HISTORY_HELP, id="history"))
        yield key_line(
            "panel", "put_away:off", "feedback", "method", "undo", "pronounce", "join", "rename",
            "world", "filter", "back", "help",
        )  # fmt: skip

    @property
    def _status(self) -> Status:
        return Status(mode="people", note=f"{self._workspace.activity.title}, {self._world} games")

    def action_world(self) -> None:
        """Show the data of the next world: simulated, bench or live."""
        self._world = PLAYED_WORLDS[(PLAYED_WORLDS.index(self._world) + 1) % len(PLAYED_WORLDS)]
        self._feedback = self._workspace.memory(self._world).feedback
        self.query_one(StatusLine).show(self._status)
        self._read()
        self._say(text.world_words(self._world))

    def on_mount(self) -> None:
        """Fill the panels from the log."""
        self._read()
        self._list("people").focus()

    def on_choice_list_moved(self, event: ChoiceList.Moved) -> None:
        """Show the chosen person, or describe the chosen strategy."""
        if event.choices.id == "people":
            self._show_person()
        elif event.choices.id == "strategies":
            self._show_hint()

    def action_put_away(self) -> None:
        """Void the chosen response, or switch the chosen strategy off or on."""
        if self._list("history").has_focus:
            self._void()
        else:
            self._switch()

    def _void(self) -> None:
        """Ask whether to void the chosen response."""
        entry = self._entry()
        if entry is None or not entry.counts:
            self._say(text.CHOOSE_COUNTING)
            return
        person, why = self._record.person, WHY[bool(entry.complied)]

        self._ask(
            (text.VOID, text.void_detail(entry, person.name)),
            f"{why}: leave it out",
            lambda: self._feedback.void(person.id, entry.seq, why),
        )

    def action_feedback(self) -> None:
        """Ask for the person's response to the chosen request."""
        entry = self._entry()
        if entry is None or not entry.open:
            self._say(text.CHOOSE_OPEN)
            return
        person = self._record.person

        def answered(complied: bool | None) -> None:
            if complied is not None:
                self._do(
                    lambda: self._feedback.give(person.id, entry.strategy, complied, entry.seq)
                )

        self.app.push_screen(AnswerDialog(*text.comply_words(entry, person.name)), answered)

    def _switch(self) -> None:
        """Ask whether to switch the chosen strategy for this person."""
        strategy, record = str(self._list("strategies").chosen), self._record
        on = strategy in record.known.off
        among = self._workspace.activity.strategies
        state = "on again" if on else "off"
        self._ask(
            text.switch_words(strategy, record.person.name, on=on),
            f"switch it {state}",
            lambda: self._feedback.switch(record.person.id, strategy, on, among),
        )

    def action_method(self) -> None:
        """Choose how Tangy persuades this person."""
        person, known = self._record.person, self._record.known
        default = self._workspace.activity.persuasion

        def take(answer: MethodChoice | None) -> None:
            if answer is not None:
                self._do(lambda: self._feedback.choose_method(person.id, answer.chosen))

        self.app.push_screen(MethodDialog(person.name, known.chosen, known.own, default), take)

    def action_join(self) -> None:
        """Ask who joins the group, and add them."""

        async def join() -> None:
            if who := await ask_who_joins(self.app):
                self._do(lambda: let_join(self._workspace, who[0], guest=who[1]))

        self.run_worker(join(), name="join", exclusive=True)

    def action_rename(self) -> None:
        """Ask for a new name of the chosen person."""
        person = self._workspace.find_person(self._record.person.id)

        async def rename() -> None:
            if name := await ask_new_name(self.app, person.name):
                self._do(lambda: self._workspace.rename(person, name))

        self.run_worker(rename(), name="rename", exclusive=True)

    def action_pronounce(self) -> None:
        """Show, speak or change the pronunciation of the person's name."""
        person = self._workspace.find_person(self._record.person.id)

        def take(new: NewPronunciation | None) -> None:
            if new is not None:
                self._do(lambda: self._workspace.pronounce(person, new.phones))

        dialog = PronunciationDialog(person, self._hear, self._workspace.check_said)
        self.app.push_screen(dialog, take)

    def _hear(self, phones: str) -> None:
        """Speak phones in the background."""
        self.run_worker(self._heard(phones), group="hear", exclusive=True)

    async def _heard(self, phones: str) -> None:
        try:
            await hear(phones)
        except TangyError as error:
            self._say(str(error), bad=True)

    def action_undo(self) -> None:
        """Ask whether to undo the last change to this person."""
        person = self._record.person
        change = self._feedback.last_change(person.id)
        if change is None:
            self._say(text.nothing_back_words(person.name))
            return
        self._ask(
            text.take_back_words(change, person.name),
            "take it back",
            lambda: self._feedback.undo(person.id),
        )

    def action_leave(self) -> None:
        """Close the screen."""
        self.leave(None)

    @property
    def _record(self) -> PersonSummary:
        """The record of the chosen person."""
        chosen = str(self._list("people").chosen)
        self._told = chosen if chosen in self._records else self._told
        return self._records.get(self._told, next(iter(self._records.values())))

    def _list(self, id: str) -> ChoiceList:
        return self.query_one(f"#{id}", ChoiceList)

    def _entry(self) -> FeedbackEntry | None:
        """Return the chosen entry of the history."""
        chosen = self._list("history").chosen
        return next((entry for entry in self._record.history if entry.seq == chosen), None)

    def _read(self) -> None:
        """Read everything from the log again."""
        records = self._workspace.records(world=self._world)
        self._records = {record.person.id: record for record in records}
        self._list("people").show(lambda width, _: people_lines(records, width))
        self._show_person()

    def _show_person(self) -> None:
        record = self._record
        strategies, history = self._list("strategies"), self._list("history")
        strategies.border_title = clean(text.strategies_title(record.person.name)).replace(
            "[", "\\["
        )
        strategies.set_class(record.known.chosen.prior == "people", "-lent")
        strategies.show(lambda width, height: strategy_lines(record, width, height))
        history.show(lambda width, _: history_lines(record, width))
        self._show_hint()

    def _show_hint(self) -> None:
        strategies = self._list("strategies")
        hint = strategy_hint(self._workspace.activity.strategies, strategies.chosen)
        strategies.border_subtitle = hint.replace("[", "\\[")

    def _ask(self, asked: tuple[str, str], yes: str, change: Callable[[], object]) -> None:
        """Make a change after confirmation."""

        def answered(sure: bool | None) -> None:
            if sure:
                self._do(change)

        dialog = ConfirmDialog(*asked, yes=yes, no="leave it as it is")
        self.app.push_screen(dialog, answered)

    def _do(self, change: Callable[[], object]) -> None:
        """Make a change and show the result, or tell why it is not possible."""
        try:
            change()
        except TangyError as error:
            self._say(str(error), bad=True)
        self._read()

    def _say(self, sentence: str, *, bad: bool = False) -> None:
        severity = "error" if bad else "information"
        self.notify(clean(sentence), severity=severity, markup=False)  # type: ignore[arg-type]
