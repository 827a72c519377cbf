"""The program line by line: for a pipe, a script, a screen reader or a simple terminal.

It drives the same sessions as the screens. One thing is said per line, and nothing is drawn.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from contextlib import suppress
from threading import Thread
from typing import Any

from tangy_profiles.beliefs import probability_best
from tangy_profiles.reading import plain
from tangy_tui.interaction.facilitation import (
    Acted,
    Facilitation,
    GameBegun,
    GameEnded,
    GameEvent,
    Learnt,
)
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
from tangy_tui.learning.verifying import Asked, NotUnderstood, Refused, Rejected, Reply, Say
from tangy_tui.wording import Name, counted, state_words, step_words

Read = Callable[[], str | None]
"""Returns the next line, or None when there are no more."""
Write = Callable[[str], None]

HELP = "Commands: a behaviour in words, or one of: undo, where, help, next, quit."


class TeachingLines:
    """A teaching session by lines. `run` returns when the teacher leaves or the input ends."""

    def __init__(
        self,
        teaching: Teaching,
        read: Read,
        write: Write,
        ears: Ears | None = None,
        *,
        scripted: bool = False,
    ) -> None:
        """Make the session.

        Args:
            ears: spoken commands, if there are any; their questions are answered from `read`.
            scripted: the lines are all there already, so what is spoken goes before them.
        """
        self._together = ears is not None and ears.live and not scripted
        self._teaching = teaching
        self._read = read
        self._write = write
        self._ears = ears
        self._spoken: asyncio.Future[Say | None] | None = None
        self._typed: asyncio.Future[str | None] | None = None
        if ears is not None:
            ears.tell = write

    async def run(self, *, resume: bool = True) -> None:
        """Teach until `quit` or the end of the input. What was verified is kept."""
        teaching, write = self._teaching, self._write
        write(f"Teaching {teaching.activity.title}. {HELP}")
        self._tell(teaching.begin(resume=resume))
        self._where()
        while (line := await self._next_line()) is not None:
            command = self._command(line) if isinstance(line, str) else line
            if command == "quit":
                break
            if not isinstance(command, str):
                self._tell(teaching.apply(command))
        demonstration = teaching.demonstration
        if not demonstration.finished and demonstration.steps:
            write(
                f"Left after {counted(len(demonstration.steps), 'step')}. What you confirmed is "
                "kept: the next `tangy teach` goes on from here."
            )

    async def _next_line(self) -> str | Say | None:
        """Return what comes next: the spoken command if one is due, otherwise a line.

        A recording goes before the lines, so that a script can answer it; somebody who is
        speaking now may as well type.
        """
        if self._ears is None or self._teaching.question is not None:
            return await self._line()
        spoken = self._spoken = self._spoken or asyncio.ensure_future(anext(self._ears, None))
        typed = self._typed = self._typed or (self._reading() if self._together else None)
        waiting: list[asyncio.Future[Any]] = [spoken] if typed is None else [spoken, typed]
        done, _ = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
        if typed in done:
            return await self._line()
        said, self._spoken = await spoken, None
        if said is None:
            self._ears = None
            return await self._line()
        return said

    def _reading(self) -> asyncio.Future[str | None]:
        """Read a line beside the program, in a thread that does not hold up its end."""
        loop = asyncio.get_running_loop()
        line: asyncio.Future[str | None] = loop.create_future()

        def give(read: str | None) -> None:
            if not line.done():
                line.set_result(read)

        def wait() -> None:
            read = self._read()
            with suppress(RuntimeError):  # the program has ended meanwhile
                loop.call_soon_threadsafe(give, read)

        Thread(target=wait, daemon=True).start()
        return line

    async def _line(self) -> str | None:
        line, self._typed = self._typed or self._reading(), None
        return await line

    def _command(self, line: str) -> TeacherCommand | str:
        text = line.strip()
        lower = text.lower()
        if not text or text.startswith("#"):
            return "nothing"
        if self._teaching.question is not None and lower != "quit":
            if lower in ("y", "n"):
                return Reply(yes=lower == "y")
            if lower.isdigit():
                return Reply(yes=False, alternative=int(lower))
            self._write("Please answer Y to execute it, or N to give a new command.")
            return "nothing"
        match lower:
            case "quit" | "exit" | "leave":
                return "quit"
            case "undo":
                return Undo()
            case "next":
                return Next()
            case "where":
                self._where()
            case "help" | "?":
                self._write(HELP)
                for behaviour in self._teaching.activity.behaviours.values():
                    self._write(f"  {behaviour.question}: say {behaviour.phrases[0]!r}")
            case _:
                return Say(text)
        return "nothing"

    def _where(self) -> None:
        teaching = self._teaching
        state = teaching.world.observe()
        self._write(
            f"Now: {teaching.activity.in_words(state.situation)}. "
            + state_words(teaching.activity, state, teaching.world.scene(), teaching.name)
        )

    def _tell(self, events: Iterable[TeachingEvent]) -> None:
        for event in events:
            for line in teaching_lines(event, self._teaching):
                self._write(line)
            if isinstance(event, Executed | StepUndone) and not self._teaching.world.over:
                self._where()


def teaching_lines(event: TeachingEvent, teaching: Teaching) -> list[str]:
    """Put one event of a teaching session into lines."""
    match event:
        case Asked(_, question, heard, confidence, alternatives):
            lines = [f"Did you say: {question}? Type Y to execute it or N for a new command."]
            if confidence < 1:
                lines.append(f"  heard {plain(heard)!r}, {confidence:.0%} sure")
            lines += [
                f"  {number} instead: {teaching.activity.behaviour(other).question}"
                for number, other in enumerate(alternatives, 1)
            ]
            return lines
        case NotUnderstood(heard, suggestions):
            near = f" Did you mean: {', '.join(suggestions)}?" if suggestions else ""
            return [f"I do not know what {plain(heard)!r} means.{near} Type help for all commands."]
        case Refused(reason, _):
            return [reason]
        case Rejected(heard):
            return [f"Not done: {plain(heard)}. Give a new command."]
        case Executed(number, step, _, _, speech, _):
            return [
                f"{number}. {step_words(teaching.activity, step, teaching.name)}",
                f"   Tangy says: {speech}",
            ]
        case StepUndone(number, step):
            return [f"Step {number} is undone: {step.behaviour}."]
        case Begun(demonstration, resumed):
            if resumed:
                return [
                    f"Going on with {teaching.teacher}'s demonstration of "
                    f"{len(demonstration.steps)} steps (game {demonstration.seed})."
                ]
            return [f"A new demonstration by {teaching.teacher} (game {demonstration.seed})."]
        case Finished(demonstration):
            return [
                f"The game is over; {len(demonstration.steps)} steps were demonstrated. "
                "Type next for another demonstration, or quit."
            ]


def game_lines(event: GameEvent, facilitation: Facilitation, name: Name) -> list[str]:
    """Put one event of a game into lines."""
    activity = facilitation.world.activity
    match event:
        case GameBegun(_, number, _):
            return [f"Game {number} begins."]
        case Acted(number, state, decision, choice, action, _, _, speech):
            target = f" ({name(action.target)})" if action.target else ""
            how = f", {choice.strategy}" if choice else ""
            return [
                f"{number}. {activity.in_words(state.situation)} -> "
                f"{action.behaviour.name}{target}{how}, {decision.share:.0%} of the votes",
                f"   Tangy says: {speech}",
            ]
        case Learnt(response, belief):
            what = "complied" if response.complied else "followed, but late"
            profile = facilitation.persuasion.beliefs[response.person]
            best = max(profile, key=lambda strategy: profile[strategy].mean)
            return [
                f"   {name(response.person)} {what} ({response.strategy} now "
                f"{belief.alpha - 1:.0f} of {belief.trials}; best so far: {best})."
            ]
        case GameEnded(_, steps, stopped):
            if stopped is not None:
                return [f"The game stopped after {steps} steps. {stopped}"]
            return [f"The game is over after {steps} steps."]


def belief_lines(facilitation: Facilitation, name: Name) -> list[str]:
    """Put what is believed of everybody into one line each."""
    lines: list[str] = []
    for person, profile in facilitation.persuasion.beliefs.items():
        best = probability_best(profile)
        parts = [
            f"{strategy} {belief.alpha - 1:.0f}/{belief.trials} (best {best[strategy]:.0%})"
            for strategy, belief in profile.items()
        ]
        lines.append(f"{name(person)}: " + ", ".join(parts))
    return lines


def play_by_lines(facilitation: Facilitation, games: int, name: Name, write: Write) -> None:
    """Play games and tell everything that happens."""
    for _ in range(games):
        events = facilitation.begin()
        while True:
            for event in events:
                for line in game_lines(event, facilitation, name):
                    write(line)
            if facilitation.over:
                break
            events = facilitation.step()
    for line in belief_lines(facilitation, name):
        write(line)
