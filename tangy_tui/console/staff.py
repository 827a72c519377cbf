"""Games with staff at the lines: they run by themselves, and each line may step in at any time.

One thread runs the games, another reads the lines, so that a STOP waits for nothing. At the end of
the lines nobody is there any more: a game that goes on is played to its end, one that waits for
somebody is ended.
"""

from __future__ import annotations

import queue
import re
import threading
import time
from collections.abc import Callable, Sequence

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.app.command_grammar import MEANINGS, nearest_command, read_command
from tangy_tui.app.game_commands import Confirm, EndGame, Pause, StaffNote, StopRobot
from tangy_tui.app.game_controller import GameController, Told
from tangy_tui.console.faults import HALTED, advice_lines, list_lines
from tangy_tui.console.games import belief_lines, game_lines, why_lines
from tangy_tui.interaction.game_events import DoneOnce, GameEnded, Taught
from tangy_tui.learning.verification import (
    ANSWERS,
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Rejected,
    Reply,
    Say,
    Verified,
    answer_help,
)
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text.control import noted_words, proposal_words
from tangy_tui.text.situations import Name, state_words, verification_lines

LOOK_SECONDS = 0.1  # between two looks at the devices, and for the next line
LONGEST_WAIT = 600.0  # s that a script may wait
HELP = "You can type, at any time:"
NOBODY = "Nobody is there any more, so the game ends here."
NO_MORE = "There are no more lines: the game goes on by itself."
_WAIT = re.compile(
    r"wait (?:(\d{1,3}(?:\.\d{1,2})?)(?: ?s)?|until (asked|halted|called|over|paused))"
)


class StaffLines:
    """Games by lines. `run` them."""

    def __init__(
        self,
        controller: GameController,
        name: Name,
        find_person: Callable[[str], str],
        read: Callable[[], str | None],
        write: Callable[[str], None],
        *,
        teacher: str = "",
        speed: float | None = None,
        also: Callable[[Sequence[Event]], Sequence[str]] = lambda events: (),
        demonstrations: Callable[[], Sequence[Demonstration]] | None = None,
    ) -> None:
        """Take a seat.

        Args:
            controller: of the games.
            name: what a person is called.
            find_person: returns the id of a person by name or id.
            read: returns the next line, None at their end; it may wait for it.
            write: writes a line; it is called by one thread at a time.
            teacher: who answers.
            speed: times life, in which the time of a simulated game passes; None: a robot's own.
            also: is told all events, and returns what else is to be written.
            demonstrations: gives all there are, for the grounds of a question.
        """
        self._controller = controller
        self._game = controller.supervision
        self._name, self._find_person = name, find_person
        self._read, self._teacher, self._speed = read, teacher, speed
        self._also, self._demonstrations = also, demonstrations
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._writing = threading.Lock()
        self._write_line = write
        self._prompted = ""
        self._calls = 0
        self._alone = self._stopped = self._ended = False
        self._title = frozenset(self._game.world.activity.title.casefold().split())

    def run(self, games: int) -> bool:
        """Play games; return whether all came to their end, or to that which staff set."""
        threading.Thread(target=self._read_all, daemon=True).start()
        for _ in range(games):
            if self._game.halted is not None:
                self._write(f"No other game is begun: nobody cleared {self._game.halted.name!r}.")
                break
            self._tell(self._controller.begin())
            playing = threading.Thread(target=self._play, daemon=True)
            playing.start()
            try:
                self._take_lines(playing)
                playing.join()
            except BaseException:  # the program was told to end
                self._controller.abandon()
                raise
        for line in belief_lines(self._game, self._name):
            self._write(line)
        return not self._stopped

    # ----------------------------------------------------------------------------- the game

    def _play(self) -> None:
        """Play one game to its end, in a thread of its own."""
        controller, game = self._controller, self._game
        while not game.over:
            before = game.seconds
            try:
                events = controller.next()
            except TangyError as error:  # the log could not be written, so nothing more is done
                self._tell([*controller.apply(Pause()), StaffNote("cannot", str(error))])
                continue
            self._tell(events)
            self._prompt()
            if self._alone and controller.phase not in ("running", "idle"):
                self._write(NOBODY)
                self._tell(controller.give_up() or controller.apply(EndGame()))
            passed = 0.0 if self._speed is None else (game.seconds - before) / self._speed
            if not game.over and (passed or not events):
                controller.nudge.wait(passed or LOOK_SECONDS)

    def _prompt(self) -> None:
        """Say once what Tangy waits for."""
        proposal = self._controller.proposal
        asked = "" if proposal is None else proposal_words(proposal, self._name)
        if not asked and self._controller.phase == "halted":
            asked = HALTED
        if asked != self._prompted:
            self._prompted = asked
            if asked:
                self._write(asked)

    def _tell(self, told: Sequence[Told]) -> None:
        answered = next((e.teacher for e in told if isinstance(e, Taught | DoneOnce)), "")
        events: list[Event] = []
        for one in told:
            if isinstance(one, StaffNote):
                self._ended |= one.kind == "ended" and not self._alone
                self._write(noted_words(one, self._name))
            elif isinstance(one, Asked | Offered | NotUnderstood | Refused | Rejected):
                for line in verification_lines(one):
                    self._write(line)
            elif not isinstance(one, Verified):
                events.append(one)
                broken_off = isinstance(one, GameEnded) and one.stopped is not None
                self._stopped |= broken_off and not self._ended
                for line in game_lines(one, self._game, self._name, answered):
                    self._write(line)
        for line in filter(None, self._also(events)):
            self._write(line)

    def _write(self, line: str) -> None:
        with self._writing:
            self._write_line(line)

    # ----------------------------------------------------------------------------- the lines

    def _read_all(self) -> None:
        while (line := self._read()) is not None:
            self._lines.put(line)
        self._lines.put(None)

    def _take_lines(self, playing: threading.Thread) -> None:
        while playing.is_alive():
            try:
                line = self._lines.get(timeout=LOOK_SECONDS)
            except queue.Empty:
                continue
            if line is None:
                self._alone = True
                if not self._game.over and self._controller.phase == "running":
                    self._write(NO_MORE)
                self._controller.nudge.set()
                playing.join()
            else:
                self._take(line.strip(), playing)

    def _take(self, text: str, playing: threading.Thread) -> None:
        if not text or text.startswith("#"):
            return
        controller = self._controller
        if wait := _WAIT.fullmatch(text.casefold()):
            self._wait(float(wait[1] or LONGEST_WAIT), wait[2], playing)
            return
        try:
            command = read_command(text, self._find_person, self._title)
        except TangyError as error:
            self._write(str(error))
            return
        if isinstance(command, StopRobot) and controller.answers.verifying:
            controller.answers.reply(Reply(yes=False))
        answer = text.casefold()
        if command is not None:
            self._tell(controller.apply(command))
        elif controller.answers.verifying and (answer in ANSWERS or answer.isdecimal()):
            number = int(answer) if answer.isdecimal() else None
            said = controller.answers.reply(Reply(ANSWERS.get(answer, False), number))
            self._tell([said])
            if isinstance(said, Verified):
                self._answer(said)
        elif controller.proposal is not None and answer in ANSWERS:
            self._tell(controller.apply(Confirm(ANSWERS[answer])))
        elif (told := self._asked(answer)) is not None:
            for line in told:
                self._write(line)
        elif self._game.question is not None:
            self._tell([controller.answers.say(Say(text))])
        else:
            near = nearest_command(text)
            meant = f" Did you mean: {near}?" if near else ""
            self._write(plain(f"I do not know {text[:60]!r} here.{meant} Type: help."))

    def _answer(self, verified: Verified) -> None:
        try:
            self._tell(self._controller.answer(verified))
        except TangyError as error:
            self._write(str(error))

    def _asked(self, word: str) -> list[str] | None:
        """Return the answer to a word that asks for something, or None."""
        game, activity = self._game, self._game.world.activity
        match word:
            case "help" | "?":
                if (verifying := self._controller.answers.verifying) is not None:
                    return answer_help(verifying)
                meanings = (f"  {key}: {what}" for key, what in MEANINGS)
                return [HELP, *meanings, "While Tangy asks, type what it should do, in words."]
            case "where":
                state = game.world.observe()
                seen = state_words(activity, state, game.world.scene(), self._name)
                how = self._controller.phase
                return [f"Now: {activity.in_words(state.situation)}. {seen} ({how})"]
            case "why":
                return why_lines(game, self._demonstrations)
            case "what" | "what to do":
                return advice_lines(game) or ["Nothing is wrong."]
            case "faults":
                return list_lines(game.faults)
        return None

    def _wait(self, seconds: float, what: str | None, playing: threading.Thread) -> None:
        """Let time pass before the next line, or until something has come about."""
        until = time.monotonic() + min(seconds, LONGEST_WAIT)
        calls = self._count_calls()
        while time.monotonic() < until and playing.is_alive():
            phase = self._controller.phase
            came = {
                "asked": phase == "asking",
                "halted": phase == "halted",
                "paused": phase == "paused",
                "called": self._count_calls() > calls,
            }
            if what is not None and came.get(what):
                return
            time.sleep(LOOK_SECONDS / 2)

    def _count_calls(self) -> int:
        return len(self._game.world.scene().called)
