"""The set-up of a live game in the console: the same choices and checks as on the screen."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import timedelta
from difflib import get_close_matches
from time import sleep

from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import command_reader
from tangy_tui.app.game_commands import (
    ChangePace,
    ChoosePatterns,
    ComesIn,
    EndGame,
    GameCommand,
    GoesAway,
    GoOn,
    Joins,
    LetWin,
    PlanTime,
    SetPace,
    StopRobot,
)
from tangy_tui.app.inquiry_grammar import read_inquiry
from tangy_tui.app.plan_grammar import lines_of
from tangy_tui.app.planned_time import planned_end
from tangy_tui.app.request_grammar import without_courtesy
from tangy_tui.app.robot_controls import STOPPED
from tangy_tui.app.set_up import MINUTES, SetUp
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.console.trying_devices import TryingDevices
from tangy_tui.text import set_up as text
from tangy_tui.text import set_up_lines as lines
from tangy_tui.text.control import noted_words
from tangy_tui.text.times import local_now

_NO = ("end", "n", "no", "quit", "leave")
"""Lines that do not begin a game that is not ready."""

_SEAT = re.compile(r"seat (.+?) (\d{1,2})", re.I)
_MINUTES = re.compile(r"time (\d{1,3})(?: minutes?)?", re.I)
_WORDS = re.compile(r"words (.+)", re.I)
_NAME = re.compile(r"rename (.+?) to (.+)", re.I)
_DUTY = re.compile(r"(?:on )?duty (.+)|(.+) is on duty", re.I)
_ACTIVITY = re.compile(r"activity (.+)", re.I)
_ROOM = re.compile(r"room (.+)", re.I)
_SHOW = "show"
_TRY = ("try", "try it", "switch on", "check")
NEAR = 0.7
"""The least similarity of a word to the command that it may have meant."""
_ACTIVITIES = ("activity", "activities")
_ROOMS = ("room", "rooms")


class SetUpLines:
    """Reads lines until staff begin or leave; does not switch the robot on."""

    def __init__(
        self, setup: SetUp, read: Callable[[], str | None], write: Callable[[str], None]
    ) -> None:
        """Read commands for a set-up."""
        self.setup = setup
        self._read, self._write = read, write
        self._command = command_reader(setup.workspace.activity, self._find)
        self._told: list[str] = []
        self._tries = False

    def run(self) -> bool:
        """Set up; return whether to switch the robot on, to begin the game or to try it first."""
        self._tell_all()
        self._write(lines.help_words(self.setup))
        while (line := self._read()) is not None:
            words = without_courtesy(line).strip(" .!")
            if words.casefold() in ("begin", *_TRY):
                self._tries = words.casefold() in _TRY
                return True
            if words.casefold() == _SHOW:
                self._tell_all()
                continue
            if words.casefold() in _ACTIVITIES:
                self._write(lines.activities_line(self.setup.activities().values()))
                continue
            if words.casefold() in _ROOMS:
                self._write(lines.rooms_line(self._rooms()))
                continue
            if read_inquiry(words) == "patterns":
                rules = self.setup.workspace.activity.rules
                self._write(lines.patterns_to_choose(one.name for one in rules.patterns))
                continue
            if not words or read_inquiry(words) == "help":
                self._write(lines.help_words(self.setup))
                continue
            try:
                done = self._do(words)
            except TangyError as error:
                self._write(str(error))
                continue
            if done is None:
                return False
            if done:
                self._tell_changes()
            else:
                self._tell_unknown(words)
        return False

    def _do(self, words: str) -> bool | None:
        """Carry out a command, for each person that it names; None: staff leave."""
        if self._own(words):
            return True
        done = [self._take(self._command(line)) for line in lines_of(words, self._command)]
        return done[0] if len(done) == 1 else all(done)

    def _tell_unknown(self, words: str) -> None:
        """Tell which command may have been meant, or that it works only in a game."""
        if self._command_in(words) is not None:
            self._write(lines.in_a_game_words(words))
            return
        first = words.partition(" ")[0].casefold()
        known = lines.commands_of(self.setup)
        near = get_close_matches(first, known, 1, NEAR)
        self._write(lines.not_known_words(words, near[0] if near else "", known))

    def use(self, read: Callable[[], str | None], write: Callable[[str], None]) -> None:
        """Read and write otherwise from now on."""
        self._read, self._write = read, write

    def begins_anyway(self, *, stopped: bool = False) -> bool:
        """Write the results of the checks; if one has failed, ask whether to begin.

        It also asks if staff want to try the robot first, and carries out what they try.

        Args:
            stopped: whether staff stopped the robot while it was switched on: then it asks, too.
        """
        for seconds in self.setup.settling():
            sleep(seconds)
        for check in self.setup.checks():
            self._write(f"  {text.NAMES[check.name]}: {text.line_of(check)}")
        not_ready = self.setup.not_ready
        if stopped:
            self._stop()
        if not_ready:
            self._write(lines.lines_anyway(not_ready))
        if self._tries:
            self._write(text.TRY_LINES)
        if not (not_ready or stopped or self._tries):
            return True
        trying = TryingDevices(self.setup, self._write)
        while (line := self._read()) is not None:
            words = without_courtesy(line).strip(" .!").casefold()
            if words in _NO:
                return False
            command = self._command_in(line)
            if words == "begin" or isinstance(command, GoOn):
                return True
            if isinstance(command, StopRobot):
                stopped = True
                self._stop()
            elif not trying.take(line, command, stopped=stopped):
                self._write(lines.begin_or_end(line.strip()))
        return False

    def _command_in(self, line: str) -> GameCommand | None:
        """Return the command of games in a line, if there is a right one."""
        try:
            return self._command(line)
        except TangyError:
            return None

    def _stop(self) -> None:
        """Stop the robot; beginning the game releases it."""
        if self.setup.world is not None:
            self.setup.world.link.stop(STOPPED)
        self._write(lines.lines_stopped())

    def _find(self, wanted: str) -> str:
        return self.setup.workspace.find_person(wanted).id

    def _tell_all(self) -> None:
        self._told = list(text.lines_of(self.setup))
        for line in self._told:
            self._write(line)

    def _tell_changes(self) -> None:
        """Write only the lines that changed: a screen reader reads each one out."""
        before, self._told = set(self._told), list(text.lines_of(self.setup))
        for line in [line for line in self._told if line not in before] or [lines.UNCHANGED]:
            self._write(line)

    def _own(self, words: str) -> bool:
        """Carry out a command that only exists before a game; return whether it was one."""
        setup = self.setup
        if seat := _SEAT.fullmatch(words):
            person = self._find(seat[1])
            if not 1 <= int(seat[2]) <= len(setup.seats):
                raise TangyError(lines.no_seat_words(len(setup.seats)))
            setup.move(person, int(seat[2]) - 1 - setup.seats.index(person))
        elif minutes := _MINUTES.fullmatch(words):
            setup.minutes = min(int(minutes[1]), 10 * MINUTES[-1])
        elif strength := _WORDS.fullmatch(words):
            setup.choose_strength(strength[1])
        elif name := _NAME.fullmatch(words):
            setup.rename(self._find(name[1]), name[2])
        elif duty := _DUTY.fullmatch(words):
            setup.take_duty(duty[1] or duty[2])
        elif wanted := _ACTIVITY.fullmatch(words):
            self._play(wanted[1])
        elif room := _ROOM.fullmatch(words):
            setup.choose_room(self._rooms().get(room[1].casefold(), room[1]))
        else:
            return False
        return True

    def _join(self, joins: Joins) -> None:
        if self.setup.teams_play:
            raise TangyError(text.TEAMS_PLAY)
        if (refused := self.setup.join(joins)) is not None:
            raise TangyError(noted_words(refused, self.setup.workspace.name))

    def _rooms(self) -> dict[str, str]:
        """Return the source of each room, by its title in lower case."""
        return {one.room.title.casefold(): one.source for one in self.setup.rooms() if one.room}

    def _play(self, wanted: str) -> None:
        """Change to another activity, given by name or title."""
        titles = self.setup.activities()
        called = {title.casefold(): name for name, title in titles.items()}
        self.setup.play(called.get(wanted.casefold(), wanted))
        if words := text.dropped_words(self.setup.dropped):
            self._write(words)
        self._command = command_reader(self.setup.workspace.activity, self._find)

    def _take(self, command: GameCommand | None) -> bool | None:
        """Take a command of games as a choice; None: staff leave."""
        setup = self.setup
        match command:
            case ComesIn(person):
                setup.away.discard(person)
            case GoesAway(person):
                setup.away.add(person)
            case ChoosePatterns(names):
                setup.patterns = list(names)
            case SetPace() | ChangePace() | LetWin() if not setup.calls:
                raise TangyError(noted_words(StaffNote("no cards"), setup.workspace.name))
            case SetPace(seconds):
                setup.pace = seconds
            case PlanTime() as planned:
                now = local_now()
                ends = planned_end(planned, now, now + timedelta(minutes=setup.minutes))
                left = 0.0 if ends is None else (ends - now).total_seconds()
                setup.minutes = round(left / 60)
            case ChangePace(by):
                setup.turn_pace(-by)
            case LetWin(several, visits):
                setup.several = setup.several if several is None else several
                setup.visits = setup.visits if visits is None else visits
            case Joins():
                self._join(command)
            case EndGame():
                return None
            case _:
                return False
        return True
