"""Games in the console, with staff who type at any time or by turns.

At any time (`run`): every line may intervene. One thread runs the games, one reads the lines, one
carries out commands that wait for the current behaviour. The end of the input ends a waiting game.

By turns (`run_by_turns`): a line is read only when Tangy waits for staff, as scripts need it.
"""

from __future__ import annotations

import queue
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TypeAlias

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import command_reader, read_answer
from tangy_tui.app.freeze_watch import FreezeWatch
from tangy_tui.app.game_commands import (
    AT_ONCE,
    CallExpert,
    Confirm,
    EndGame,
    GameCommand,
    GoOn,
    Pause,
    StopRobot,
)
from tangy_tui.app.game_controller import ControllerOutput, GameController
from tangy_tui.app.plan_grammar import lines_of
from tangy_tui.app.scripted_staff import go_on_by_script
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.console.answering import AnsweredQuestions
from tangy_tui.console.confirming import ConfirmingStaff
from tangy_tui.console.freezes import FreezeLines
from tangy_tui.console.in_progress import ProgressLines
from tangy_tui.console.inputs import ReadAhead, any_waits
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.console.script_waits import ScriptWaits
from tangy_tui.console.telling import GameTelling
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.language.stop_sentence import prepare
from tangy_tui.learning.verification import Reply, Say, Verified
from tangy_tui.monitoring.earlier import EarlierPart
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text import staff_lines
from tangy_tui.text.calls import expert_line
from tangy_tui.text.games import belief_lines
from tangy_tui.text.interruptions import GOES_ON_LATER
from tangy_tui.text.questions import ANSWER_HELP
from tangy_tui.text.situations import Name

Task: TypeAlias = Callable[[], Sequence[ControllerOutput]]
LOOK_SECONDS = 0.1  # between two checks of the devices, and for the next line
WORKS_SECONDS = 5.0  # for pending commands when the last game ended


class StaffLines:
    """Games in the console; `run` them."""

    def __init__(
        self,
        controller: GameController,
        name: Name,
        find_person: Callable[[str], str],
        read: Callable[[], str | None],
        write: Callable[[str], None],
        *,
        speed: float | None = None,
        also: Callable[[Sequence[Event]], Sequence[str]] = lambda events: (),
        demonstrations: Callable[[], Sequence[Demonstration]] | None = None,
        yes: TypedYes | None = None,
        before: StaffLines | None = None,
        ahead: ReadAhead | None = None,
        watch: FreezeWatch | None = None,
        earlier: EarlierPart | None = None,
    ) -> None:
        """Connect staff to games.

        Args:
            controller: runs the games.
            name: returns a person's name for an id.
            find_person: returns the id of a person by name or id.
            read: blocks for the next line, and returns None at the end.
            write: writes a line; is called by one thread at a time.
            speed: of simulated time (ratio to real time); None: the robot's own time.
            also: is called with all events, and returns further lines to write.
            demonstrations: returns all demonstrations, to explain decisions.
            yes: parses a typed yes.
            before: the games that a person has joined.
            ahead: the lines, if they are being read already; then `read` is not called.
            watch: detects that the program was frozen.
            earlier: what happened before the first game was interrupted.
        """
        self._controller, self._name = controller, name
        self._game = controller.supervision
        self._read, self._speed = read, speed
        self._yes = yes or TypedYes()
        self._progress = ProgressLines(controller, name)
        telling = self._telling = GameTelling(controller, name, write, self._progress, also)
        telling.stopped = before is not None and before._telling.stopped
        self._sure = ConfirmingStaff(controller, name, self._yes, telling.write)
        self._freezes = FreezeLines(controller, self._sure, telling.write, watch)
        self._waits = ScriptWaits(controller, self._tell_progress)
        self._inquiries = Inquiries(
            controller, name, demonstrations, find_person, earlier, telling.last
        )
        self._questions = AnsweredQuestions(controller, self._yes, self._inquiries, telling.write)
        telling.verify = lambda said: self._questions.verify(said, self._typed)
        self._ahead = ReadAhead(read) if ahead is None else ahead
        self._by_turns = self._leaves = False  # leaves: while no game could begin
        self.played = 0
        self._begun = threading.Event()
        self._tasks: queue.Queue[Task | None] = queue.Queue()
        activity = self._game.world.activity
        self._command = command_reader(activity, find_person, lambda: controller.asks_next)

    def run(self, games: int) -> bool:
        """Play, up to a game that somebody joins; return whether none stopped early."""
        prepare()
        self._ahead.begin()
        self._freezes.guard.keep_looking()
        working = threading.Thread(target=self._work_off, daemon=True)
        working.start()
        for _ in range(games):
            if self._left_uncleared():
                break
            self._begun.clear()
            playing = threading.Thread(target=self._play, daemon=True)
            playing.start()
            try:
                self._take_lines(playing)
                playing.join()
            except BaseException:  # the program is ending
                goes_on = self._game.game.steps > 0 and not self._game.over
                self._controller.interrupt()
                if goes_on:
                    with suppress(OSError):  # the terminal may be gone
                        self._telling.write(GOES_ON_LATER)
                raise
            if self._controller.joined:
                break
            self.played += 1
            self._ahead.early.clear()
        self._tasks.put(None)
        working.join(WORKS_SECONDS)
        return self._controller.joined or self._end()

    def run_by_turns(self, games: int, *, scripted: bool = False, expert: bool = False) -> bool:
        """Play games, reading a line only when Tangy waits; return as `run` does.

        Args:
            games: the number of games.
            scripted: a scripted teacher answers, and no line is read.
            expert: scripted staff clear the faults that halt Tangy; otherwise the lines do.
        """
        controller = self._controller
        self._by_turns = True
        for _ in range(games):
            if self._left_uncleared():
                break
            self._telling.tell(controller.begin())
            while not self._game.over:
                halted = self._game.halted is not None
                if controller.phase == "running" or (expert if halted else scripted):
                    events = go_on_by_script(controller, expert=expert)
                    self._telling.tell([*controller.plan.late_notes(), *events])
                    continue
                self._questions.prompt(self._typed)
                line = None if scripted else self._read()
                if line is None:
                    self._telling.tell(controller.give_up() or controller.apply(EndGame()))
                else:
                    self._take(line.strip())
        return self._end()

    def _left_uncleared(self) -> bool:
        """Return whether an uncleared fault prevents another game, and tell so."""
        if (fault := self._game.halted) is not None:
            self._telling.write(staff_lines.not_begun(fault.name))
        return fault is not None

    def _end(self) -> bool:
        if not self._controller.robot.there:  # reports tell staff what works with whom
            self._telling.write_all(belief_lines(self._game, self._name))
        return not self._telling.stopped

    # ----------------------------------------------------------------------------- the game

    def _play(self) -> None:
        """Play one game in its own thread."""
        controller, game = self._controller, self._game
        if controller.stopped:
            self._telling.tell([StaffNote("stopped")])
        while not (events := controller.begin()):  # staff stopped the robot between two games
            if self._ahead.ended or self._leaves:
                self._telling.write(
                    staff_lines.NOBODY if self._ahead.ended else staff_lines.NOT_BEGUN
                )
                self._telling.stopped |= self._ahead.ended
                return
            controller.nudge.wait(LOOK_SECONDS)
        self._telling.tell(events)
        self._begun.set()
        while not game.over:
            before = game.seconds
            try:
                events = controller.next()
            except TangyError as error:  # logging failed, so pause
                self._telling.tell([*controller.apply(Pause()), StaffNote("cannot", str(error))])
                continue
            self._telling.tell([*controller.plan.late_notes(), *events])
            self._questions.prompt(self._typed)
            busy = self._tasks.unfinished_tasks
            if self._ahead.ended and not busy and controller.waits:
                self._telling.write(staff_lines.NOBODY)
                self._telling.tell(controller.give_up() or controller.apply(EndGame()))
            passed = 0.0 if self._speed is None else (game.seconds - before) / self._speed
            if not game.over and (passed or not events):
                controller.nudge.wait(passed or LOOK_SECONDS)

    # ----------------------------------------------------------------------------- the lines

    def _take_lines(self, playing: threading.Thread) -> None:
        """Handle lines while a game runs. Until it has begun, only a STOP is handled at once.

        In a script with waits, a STOP comes in its order. Lines for Tangy's next action are kept
        until Tangy asks for it.
        """
        early = self._ahead.early
        while playing.is_alive():
            self._tell_progress()
            if early and self._begun.is_set() and not self._controller.taking_over:
                self._take_or_wait(early.popleft(), playing)
                continue
            if self._ahead.ended:
                if self._begun.wait(LOOK_SECONDS):
                    playing.join(LOOK_SECONDS)  # a longer wait could delay a signal
                continue
            try:
                line = self._ahead.lines.get(timeout=LOOK_SECONDS)
            except queue.Empty:
                continue
            if line is None:
                self._sure.drop()
                self._ahead.ended = not early
                ends = self._controller.ending or (self._begun.is_set() and self._game.over)
                if early:  # handle them first
                    self._ahead.lines.put(None)
                    time.sleep(LOOK_SECONDS)
                elif not (ends or self._controller.waits):
                    self._telling.write(staff_lines.NO_MORE)
                self._controller.nudge.set()
            elif (
                self._sure.open
                or self._is_due(line, early)
                or (not any_waits(early) and self._needs_no_game(line))
            ):
                self._take_or_wait(line.strip(), playing)
            else:
                early.append(line.strip())

    def _tell_progress(self) -> None:
        """Write what Tangy does now, and what it asks about a card or after a freeze."""
        self._freezes.ask(self._typed)
        self._telling.tell_lines(self._progress.news() if self._begun.is_set() else ())
        if self._ahead.ended and self._progress.asks:
            self._telling.tell([*self._controller.apply(EndGame())])

    def _is_due(self, line: str, early: deque[str]) -> bool:
        """Return whether to handle a line now: a game has begun, and no earlier line waits.

        Only urgent commands, above all a STOP, overtake earlier lines.
        """
        begun, taking_over = self._begun.is_set(), self._controller.taking_over
        if not begun or not taking_over or any_waits(early):  # a script keeps its order
            return begun and not early
        try:  # until Tangy asks for its next action, only commands are handled
            command = self._command(line)
        except TangyError:
            return not early
        return isinstance(command, AT_ONCE) if early else command is not None

    def _needs_no_game(self, line: str) -> bool:
        """Return whether a line is a STOP, or continues or ends the game after one."""
        try:
            command = self._command(line)
        except TangyError:
            return False
        stopped = self._controller.stopped
        self._leaves |= stopped and isinstance(command, EndGame)
        after = stopped and isinstance(command, GoOn | EndGame)
        return after or isinstance(command, StopRobot)

    def _take_or_wait(self, text: str, playing: threading.Thread) -> None:
        if not self._waits.wait(text, playing.is_alive):
            self._take(text)

    def _work_off(self) -> None:
        """Carry out the queued commands, one after the other."""
        while (task := self._tasks.get()) is not None:
            self._telling.tell(task())
            self._tasks.task_done()

    def _do_next(self, task: Task) -> None:
        """Do a task after those in the queue; at once if lines are read by turns."""
        if self._by_turns:
            self._telling.tell(task())
        else:
            self._tasks.put(task)

    @property
    def _typed(self) -> queue.SimpleQueue[str | None] | None:
        """The lines read ahead; None if each line is read when it is due."""
        return None if self._by_turns else self._ahead.lines

    def _carry_out(self, command: GameCommand) -> None:
        """Carry out a command now, or queue it for its turn while lines are read."""
        if isinstance(command, CallExpert) and self._game.halted is not None:
            self._telling.write(expert_line(self._game))
        self._telling.ended |= isinstance(command, EndGame)
        refused = self._controller.refuses(command)
        if refused or self._by_turns or isinstance(command, AT_ONCE):
            self._telling.tell([refused] if refused else self._controller.apply(command))
            return
        if isinstance(command, EndGame):
            self._controller.break_off()
        self._controller.plan.say_early(command)
        self._tasks.put(self._telling.queue(command))

    def _take(self, text: str) -> None:
        if not text or text.startswith("#"):
            return
        controller = self._controller
        if more := self._sure.no_and_more(text):
            self._take(more)
            return
        try:
            each = lines_of(text, self._command)
        except TangyError as error:
            self._telling.write(str(error))
            return
        for line in each if len(each) > 1 else ():
            self._take(line)
        if len(each) > 1:
            return
        command = self._command(text)
        if isinstance(command, StopRobot):
            self._sure.drop()
            if controller.answers.verifying:
                controller.answers.reply(Reply(yes=False))
        told = self._inquiries.lines(text) if command is None else None
        if command is not None and read_answer(text) is None:
            self._sure.give_way(command, text)
        if self._sure.open:
            self._telling.write_all(told or () if read_answer(text) is None else ())
            if (confirmed := self._sure.answer(text)) is not None:
                self._carry_out(confirmed)
                self._do_next(self._sure.end_of_hold())
        elif command is not None and self._sure.ask(command, self._typed):
            pass  # its answer comes in a later line
        elif command is not None:
            self._carry_out(command)
        elif (reply := self._questions.answer(text)) is not None:
            self._take_reply(reply)
        elif told is not None:
            self._telling.write_all(told)
        elif controller.answers.verifying:
            self._telling.write(ANSWER_HELP)
        elif self._game.question is not None:
            self._telling.tell([controller.answers.say(Say(text))])
        else:
            self._telling.write(self._inquiries.unknown(text))
        for kept in self._sure.behind():
            self._take(kept)

    def _take_reply(self, reply: ControllerOutput | Confirm | str) -> None:
        if isinstance(reply, str):
            self._telling.write(reply)
        elif isinstance(reply, Confirm):
            self._carry_out(reply)
        else:
            self._telling.tell([reply])
            if isinstance(reply, Verified):
                self._answer(reply)

    def _answer(self, said: Verified) -> None:
        """Carry out an answer, which takes time."""

        def answer() -> Sequence[ControllerOutput]:
            try:
                return self._controller.answer(said.behaviour, said.target)
            except TangyError as error:
                return [StaffNote("cannot", str(error))]

        self._do_next(answer)
