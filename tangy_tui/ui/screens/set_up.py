"""The screen on which staff set up a live game. Nothing moves before the begin key."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import ClassVar

from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.errors import TangyError
from tangy_tui.app.readiness import CHECKS, LOOK_SECONDS
from tangy_tui.app.robot_controls import STOPPED
from tangy_tui.app.rooms import KnownRoom
from tangy_tui.app.set_up import SetUp
from tangy_tui.text import set_up as text
from tangy_tui.text.keys import with_keys
from tangy_tui.text.program import NOT_POSSIBLE, NOTHING_MOVES
from tangy_tui.text.register import staff_names
from tangy_tui.text.rooms import CHOOSE_ROOM, OTHER_ROOM, places_words
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.tablet import TabletDialog
from tangy_tui.ui.joining import ask_new_name, ask_who_is_on_duty, ask_who_joins
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import WIDE, KeyLine, panel
from tangy_tui.ui.screens.set_up_lines import check_lines, game_lines, people_lines
from tangy_tui.ui.widgets.room_view import EMPTY, RoomView
from tangy_tui.ui.widgets.set_up_list import SetUpList
from tangy_tui.ui.widgets.status_line import Status, StatusLine

ChooseActivity = Callable[[], Awaitable[None]]
SwitchOn = Callable[[], Awaitable[LiveWorld | None]]


class SetUpScreen(TangyScreen[bool]):
    """People, choices and checks. Dismissed with whether to begin the game."""

    DEFAULT_CSS = """
    SetUpScreen #page { height: 1fr; }
    SetUpScreen #setup { width: 1fr; height: 1fr; }
    SetUpScreen #seats { display: none; width: 1fr; }
    SetUpScreen.-wide #seats { display: block; }
    """
    HORIZONTAL_BREAKPOINTS = WIDE
    HELP = (
        "Set a game up from top to bottom. Up and down choose a line, left and right a table. On a "
        "person Enter says whether they are here; space takes hold of them, the arrows carry them "
        "to another seat, and space lets them go; esc puts them back. {join} adds a person or a "
        "guest, {rename} gives a person another name. On a choice Enter, left and right change it; "
        "a number adds what the game is played for, or takes it away. Enter on Robot switches "
        "Tangy on: it stands still. Then Enter on Cards lets it read a card that you hold before "
        "it, Enter on Faces lets it look who is there, Enter on Sound lets it speak, and Enter on "
        "Tablet shows the address. {begin} begins the game: nothing moves before."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("begin"),
        Binding("b", "begin_how", show=False),
        *bind("join"),
        *bind("rename"),
        *(
            Binding(str(number), f"pattern({number})", text.GAME, id="number", show=False)
            for number in range(1, 10)
        ),
        *bind("back", "leave"),
    ]

    def __init__(
        self, setup: SetUp, switch_on: SwitchOn, choose: ChooseActivity | None = None
    ) -> None:
        """Show a set-up; `switch_on` starts the robot, `choose` asks for another activity."""
        super().__init__()
        self.setup = setup
        self._switch_on = switch_on
        self._choose = choose
        self._busy = self._stopped = False
        self._at_first = text.lines_of(setup)
        self._drawn: object = None

    def compose(self) -> ComposeResult:
        """Lay out the lines and the seats."""
        yield StatusLine()
        with Horizontal(id="page"):
            yield panel(SetUpList(), text.TITLE)
            yield Vertical(id="seats")
        yield KeyLine(*self._key_words())

    def _key_words(self) -> list[str | tuple[str, str]]:
        kind = getattr(self.app, "kind", None)
        in_ascii = kind is not None and kind.ascii
        patterns = len(self.setup.workspace.activity.rules.patterns)
        number = "1" if patterns == 1 else f"1-{patterns}"
        return [
            "begin",
            ("enter" if in_ascii else "↵", "change"),
            ("space" if in_ascii else "␣", "move"),
            *([(number, "played for")] if patterns else []),
            "join",
            "rename",
            "back",
            "help",
        ]

    def on_mount(self) -> None:
        """Show everything, and poll the readiness checks."""
        self.query_one(SetUpList).focus()
        self._show()
        self.set_interval(LOOK_SECONDS, self._show)

    def on_stop(self, message: Stop) -> None:
        """Stop the robot if it is on, and begin no game; only the begin key releases the robot."""
        if self.setup.world is not None:
            self.setup.world.link.stop(STOPPED)  # before drawing
        elif not self._busy:
            self._say(NOTHING_MOVES)
            return
        self._stopped = True
        self._say(text.STOPPED)

    def _say(self, words: str) -> None:
        """Show a sentence in the panel's title, where it covers no line; "" clears it."""
        ink = "$warning bold" if words else ""
        title = Content.assemble((clean(words or text.TITLE), ink))
        self.query_one(SetUpList).border_title = title

    def _draw_seats(self) -> None:
        """Draw the seats, also those of people who are away, beside the lines if there is room."""
        workspace, away = self.setup.workspace, frozenset(self.setup.away)
        name = staff_names(workspace.name)
        people = [replace(one, name=name(one.id)) for one in workspace.people]
        if self._drawn != (people, away, workspace.room):
            self._drawn = people, away, workspace.room
            seats = self.query_one("#seats", Vertical)
            seats.remove_children()
            if len(away) < len(people):
                room = RoomView(workspace.room, people, cards=self.setup.calls, id=None)
                room.show(replace(EMPTY, away=away))
                seats.mount(panel(room, text.SEATS))

    # ------------------------------------------------------------------------------- the lines

    def _show(self) -> None:
        setup = self.setup
        robot = text.robot_words(setup.check(CHECKS[0]))
        self.query_one(StatusLine).show(
            Status(
                mode="set up",
                robot=robot,
                stage="",
                game=None,
                step=None,
                note=text.people_words(setup),
                alarm=robot == text.NOT_READY,
            )
        )
        lines = self.query_one(SetUpList)
        width = lines.content_size.width
        lines.show([*people_lines(setup), *game_lines(setup, width), *check_lines(setup)])
        lines.border_subtitle = text.summary_words(setup.checks())
        self.query_one(KeyLine).show(*self._key_words())
        self._draw_seats()

    # -------------------------------------------------------------------------------- the keys

    def on_set_up_list_turned(self, event: SetUpList.Turned) -> None:
        """Change the line at the cursor by left or right."""
        event.stop()
        self._say("")
        line, by = event.line, event.by
        if line.kind == "choice":
            self._turn(line.id, by)
        self._show()

    def on_set_up_list_carried(self, event: SetUpList.Carried) -> None:
        """Show a person who is picked up at another's seat."""
        event.stop()
        self.setup.carry(event.line.id, event.to.id)
        self._say(text.carried_words(self.setup, event.line.id))
        self._show()

    def on_set_up_list_held(self, event: SetUpList.Held) -> None:
        """Explain how to move the person who is picked up."""
        event.stop()
        if event.person:
            self.setup.pick_up()
        self._say(text.carried_words(self.setup, event.person) if event.person else "")

    def on_set_up_list_entered(self, event: SetUpList.Entered) -> None:
        """Change the line at the cursor by Enter."""
        event.stop()
        self._say("")
        line = event.line
        if line.kind == "person":
            self.setup.toggle(line.id)
        elif line.kind == "choice":
            self._turn(line.id, 1)
        elif not self._busy:
            self.run_worker(self._check(line.id), name="check", group="check")
        else:
            self._say(text.STILL_BUSY)
        self._show()

    def _turn(self, id: str, by: int) -> None:
        setup = self.setup
        match id:
            case "several":
                setup.several = not setup.several
            case "visits":
                setup.visits = not setup.visits
            case "pace":
                setup.turn_pace(by)
            case "strength":
                setup.turn_strength(by)
            case "minutes":
                setup.turn_minutes(by)
            case "activity" if setup.world is not None:
                self._say(text.OTHER_ACTIVITY)
            case "activity" if self._choose is not None and not self._busy:
                change = partial(self._change_activity, self._choose)
                self.run_worker(self._ask(change), name="activity", group="check")
            case "room" if setup.world is not None:
                self._say(OTHER_ROOM)
            case "room" if not self._busy:
                self.run_worker(self._ask(self._choose_room), name="room", group="check")
            case "duty" if not self._busy:
                self.run_worker(self._ask(self._change_duty), name="duty", group="check")
            case "patterns":
                self._say(text.PATTERNS_HOW)

    def action_pattern(self, number: int) -> None:
        """Append a pattern, given by number, or remove it."""
        patterns = self.setup.workspace.activity.rules.patterns
        if number <= len(patterns):
            self.setup.toggle_pattern(patterns[number - 1].name)
            self._show()

    # ------------------------------------------------------------------------- who takes part

    def action_join(self) -> None:
        """Ask who else takes part, and whether for good."""
        if self.setup.world is not None or self.setup.teams_play:
            why = text.SEATED if self.setup.world is not None else text.TEAMS_PLAY
            self._say(why)
        elif not self._busy:
            self.query_one(SetUpList).put_down()
            self.run_worker(self._ask(self._join), name="join", group="check")

    def action_rename(self) -> None:
        """Ask for a new name of the person at the cursor."""
        line = self.query_one(SetUpList).chosen
        if line is not None and line.kind == "person" and not self._busy:
            self.run_worker(self._ask(partial(self._rename, line.id)), name="name", group="check")

    async def _change_activity(self, choose: Callable[[], Awaitable[None]]) -> None:
        self.setup.dropped = []
        await choose()
        self._say(text.dropped_words(self.setup.dropped))

    async def _choose_room(self) -> None:
        if room := await ask_room(self.app, self.setup.rooms()):
            self.setup.choose_room(room)

    async def _change_duty(self) -> None:
        if name := await ask_who_is_on_duty(self.app, self.setup.on_duty):
            self.setup.take_duty(name)

    async def _join(self) -> None:
        if who := await ask_who_joins(self.app):
            name, guest = who
            self.setup.add(name, guest=guest)

    async def _rename(self, person: str) -> None:
        if name := await ask_new_name(self.app, self.setup.workspace.name(person)):
            self.setup.rename(person, name)

    async def _ask(self, ask: Callable[[], Awaitable[None]]) -> None:
        """Ask a question, and tell if the answer is not possible."""
        try:
            await ask()
        except TangyError as error:
            await self.app.push_screen_wait(MessageDialog(str(error), title=NOT_POSSIBLE))
        self._show()

    # ------------------------------------------------------------------------------ the checks

    async def _check(self, name: str) -> None:
        self._busy = True
        try:
            await self._look_at(name)
        finally:
            self._busy = False
            self._show()

    async def _look_at(self, name: str) -> None:
        setup = self.setup
        if name == CHECKS[0]:
            if setup.world is None:
                setup.world = await self._switch_on()
        elif setup.world is None:
            self._say(text.SWITCH_FIRST)
        elif self._stopped:
            self._say(text.STOPPED)
        elif name == "tablet" and setup.world.link.tablet_page:
            self.app.push_screen(TabletDialog(setup.world.link.screen, setup.world.link.code))
        elif name == "cards":
            await self._look_at_card()
        elif name == "faces":
            seen = ""
            if setup.world.knows_faces:
                self._say(text.LOOKS)
                seen = await asyncio.to_thread(setup.look_at_face)
            nobody = text.BENCH_FACE if setup.on_bench else text.NO_FACE
            self._say(text.face_seen_words(setup.workspace.name(seen)) if seen else nobody)
        elif name == "sound" and setup.said:
            setup.heard = True
        elif name == "sound":
            said = await asyncio.to_thread(setup.speak, text.SOUND)
            self._say(text.SAID if said else text.NO_SOUND)

    async def _look_at_card(self) -> None:
        """Read a card, and mark its owner as present."""
        setup = self.setup
        self._say(text.LOOKS)
        card = await asyncio.to_thread(setup.look_at_card)
        if not card:
            self._say(text.BENCH_CARD if setup.on_bench else text.NO_CARD)
            return
        name = setup.workspace.name
        options = [Option(person, name(person)) for person in setup.seats]
        holder: str | None = setup.holder(int(card))
        if not holder:
            dialog = ChooseDialog(text.WHOSE.format(card), options)
            holder = await self.app.push_screen_wait(dialog)
        if holder:
            setup.comes_with(int(card), holder)
            self._say(text.card_seen_words(card, name(holder)))

    def action_begin(self) -> None:
        """Begin the game; if checks have failed, ask first."""
        if not self._busy:
            self.run_worker(self._begin(), name="begin", group="check")

    def action_begin_how(self) -> None:
        """Tell that a capital letter begins the game, so that no slip does."""
        self._say(with_keys(text.BEGIN_HOW, keymap_of(self.app)))

    async def _begin(self) -> None:
        self._stopped = False
        if self.setup.world is None:
            await self._check(CHECKS[0])
            for seconds in self.setup.settling():
                await asyncio.sleep(seconds)
                if self._stopped:
                    break
        if self.setup.world is None or self._stopped:
            return
        not_ready = [text.not_ready_words(check) for check in self.setup.not_ready]
        detail = " ".join([*not_ready, text.BEGIN_DETAIL])
        dialog = ConfirmDialog(text.BEGIN_ANYWAY, detail, yes="begin", no="wait")
        if not not_ready or await self.app.push_screen_wait(dialog):
            self.close(True)

    def action_leave(self) -> None:
        """Put a person back who is picked up; else close the screen, and switch Tangy off again.

        If choices would be lost, ask first.
        """
        if self.query_one(SetUpList).put_down():
            self.setup.put_back()
            self._show()
        elif not self._busy:
            self.run_worker(self._leave(), name="leave", group="leave", exclusive=True)

    async def _leave(self) -> None:
        changed = text.lines_of(self.setup) != self._at_first
        dialog = ConfirmDialog(text.LEAVE, text.LEAVE_DETAIL, yes="leave", no="stay")
        if not changed or await self.app.push_screen_wait(dialog):
            self.close(False)


async def ask_room(app: App[object], rooms: Iterable[KnownRoom]) -> str | None:
    """Return the source of the chosen room, None if none was chosen."""
    options = [
        Option(one.source, one.source if one.room is None else one.room.title,
               one.problem if one.room is None else places_words(one.room))
        for one in rooms
    ]  # fmt: skip
    return await app.push_screen_wait(ChooseDialog(CHOOSE_ROOM, options))
