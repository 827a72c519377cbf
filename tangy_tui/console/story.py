"""The demo as frames of real teaching, learning and playing, each with a caption.

Nothing is canned: a session is taught, a forest is trained on it, a game is played with the policy
under execution monitoring, and each frame shows their results. The screen and the console show the
same frames.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from tangy_profiles.beliefs import Beliefs
from tangy_profiles.errors import TangyError
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT, Response
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted, BeliefUpdated
from tangy_tui.interaction.persuasion import StrategyChoice
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.explanation import explain
from tangy_tui.learning.library import read_library
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import (
    Executed,
    StepUndone,
    TeachingEvent,
    Undo,
)
from tangy_tui.learning.verification import Asked, Reply, Say
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text import demo as text
from tangy_tui.text.games import game_lines
from tangy_tui.text.remarks import remark_words
from tangy_tui.text.situations import step_words
from tangy_tui.text.teaching import teaching_lines

FAULT = next(kind.name for kind in KINDS.values() if kind.blinds and kind.helped)
"""The injected fault: the head camera is covered, which people at the table can fix."""

WORDS_A_SECOND = 4.0
LEAST, GLANCE = 1.0, 0.4  # s: for any caption; for a step under the same caption
MOST_BESIDE = 6.0  # s for the panel beside it: a user can pause the story to read more
GAMES_LATER = 17
"""The offset of the game's seed from the demonstration's: with the default seed, a person is asked
and says no after a few steps."""
MOST_STEPS = 400
"""A longer game counts as endless."""
LEAD_IN = 8
"""Steps before the mistake, unless a person asks for help earlier."""
FAULT_STEPS = 5
"""The fault is noticed and recovered from within this many steps."""


@dataclass(frozen=True, slots=True)
class StoryFrame:
    """One moment of the story.

    `scene` counts from 1, `lines` are those under `heading` so far and `new` the number of lines
    new in this frame, `typed` is the teacher's command and `asked` the question about it, `said`
    the robot's speech, `seconds` the time to read the frame.
    """

    scene: int
    caption: str
    room: Scene
    heading: str
    lines: tuple[str, ...]
    new: int
    said: str = ""
    typed: str = ""
    asked: str = ""
    seconds: float = LEAST


class Story:
    """Generates the frames; the events happen when their frame is requested."""

    def __init__(self, workspace: Workspace, seed: int) -> None:
        """Prepare the story in an empty data folder; `seed` seeds its games."""
        self._workspace, self._seed = workspace, seed
        self._activity = workspace.activity
        self._teaching = workspace.teaching(text.TEACHER, seed, guided=True)
        self._script = ScriptedTeacher(self._teaching)
        self._scene = 0
        self._heading = text.STEPS
        self._lines: list[str] = []
        self._told = 0
        self._said = ""
        self._caption = ""
        self.tally = Tally()
        """The totals of the game."""

    def frames(self) -> Iterator[StoryFrame]:
        """Yield the frames of the six scenes."""
        yield from self._question()
        yield from self._mistake()
        yield from self._learning()
        yield from self._playing()

    @property
    def beliefs(self) -> Mapping[str, Beliefs]:
        """The posteriors of each person after the game."""
        return self._game.persuasion.beliefs

    # ------------------------------------------------------------------------------ teaching

    def _question(self) -> Iterator[StoryFrame]:
        self._teaching.begin()
        self._world = self._teaching.world
        self._begin_scene(text.STEPS)
        yield self._frame(text.WELCOME.format(self._activity.title))
        yield from self._taught(self._next(), text.SHE_TYPES, text.IT_ASKS, text.SHE_SAYS_YES)
        yield from self._taught(self._next(), text.SECOND, text.SECOND, text.SECOND)
        yield from self._until_help(text.GOES_ON)

    def _mistake(self) -> Iterator[StoryFrame]:
        self._begin_scene(text.STEPS)
        if self._teaching.demonstration.finished:
            return
        right = self._next()
        wrong = self._slip(right)
        if wrong is not None:
            yield self._frame(text.SLIP, typed=wrong.text)
            asked = self._asked(wrong)
            yield self._frame(text.SLIP, typed=wrong.text, asked=asked)
            events = self._apply(Reply(yes=True))
            noticed = self._teaching.remark in events
            yield self._frame(text.NOTICED if noticed else text.NOT_NOTICED)
            self._apply(Undo())
            yield self._frame(text.TAKEN_BACK)
        yield from self._taught(right, text.NOW_RIGHT, text.NOW_RIGHT, text.NOW_RIGHT)
        while self._away:
            self._teach(self._next())
            yield self._frame(text.HELPED)

    def _learning(self) -> Iterator[StoryFrame]:
        self._begin_scene(text.STEPS)
        while not self._teaching.demonstration.finished:
            self._teach(self._next())
            yield self._frame(text.THE_REST, seconds=GLANCE)
        yield self._frame(text.THINKS)
        policy = self._policy = learn(self._workspace)
        activity, steps = self._activity, self._teaching.demonstration.steps
        seen = {step.state.situation for step in steps}
        self._show(text.LEARNT, text.learnt_lines(activity, policy))
        yield self._frame(text.learnt_caption(len(steps), len(seen), len(activity.situations)))
        shown = read_library(self._workspace.store, activity.name).demonstrations
        helping = [step.state.situation for step in steps if activity.reads(step.state.stage)]
        why = explain(policy, shown, (helping or [steps[-1].state.situation])[0])
        self._show(text.WHY, text.why_lines(activity, why))
        yield self._frame(text.why_caption(len(why.rests_on)))

    def _next(self) -> Say:
        command = self._script.command()
        if not isinstance(command, Say):
            raise TangyError(text.NOTHING_TO_SAY)
        return command

    def _asked(self, command: Say) -> str:
        """Give a command, and return the question about it."""
        events = self._apply(command)
        return next(event.question for event in events if isinstance(event, Asked))

    def _taught(self, command: Say, typed: str, asked: str, done: str) -> Iterator[StoryFrame]:
        """Teach a step, with captions for the command, the question and the result."""
        yield self._frame(typed, typed=command.text)
        question = self._asked(command)
        yield self._frame(asked, typed=command.text, asked=question)
        self._apply(Reply(yes=True))
        yield self._frame(done)

    def _teach(self, command: Say) -> None:
        self._apply(command)
        self._apply(Reply(yes=True))

    @property
    def _away(self) -> bool:
        """Whether the robot is with a person, in an unfinished game."""
        over = self._teaching.demonstration.finished
        return not over and self._teaching.world.observe().place != FRONT

    def _until_help(self, caption: str) -> Iterator[StoryFrame]:
        """Continue until a person needs help, but not for long."""
        for _ in range(LEAD_IN):
            if self._teaching.demonstration.finished or self._helps(self._next()):
                return
            self._teach(self._next())
            yield self._frame(caption, seconds=GLANCE)

    def _helps(self, command: Say) -> bool:
        """Return whether a command sends the robot to a person."""
        return command.text in {
            phrase
            for behaviour in self._activity.behaviours.values()
            if behaviour.visits
            for phrase in behaviour.phrases
        }

    def _slip(self, right: Say) -> Say | None:
        """Return a wrong command: to a person who did not ask, if possible."""
        attended = self._teaching.world.observe().attended
        others = [person for person in self._teaching.people if person != attended]
        for person in others if self._helps(right) else ():
            if person not in self._teaching.world.scene().requests:
                return Say(text.addressed(right.text, self._teaching.name(person)))
        return next((Say(one) for one in self._teaching.sayable if one != right.text), None)

    def _apply(self, command: Say | Reply | Undo) -> list[TeachingEvent]:
        """Apply a command to the session, and store the result as lines."""
        teaching = self._teaching
        events = teaching.apply(command)
        self._world = teaching.world
        for event in events:
            match event:
                case Executed():
                    words = step_words(
                        self._activity, event.step, teaching.name, event.outcome.numbers
                    )
                    self._lines.append(f"{event.number}. {words}")
                    self._said = event.speech
        remark = teaching.remark
        if remark is not None and remark in events:
            self._lines.append(f"! {remark_words(remark, self._activity, teaching.name)}")
        if undone := [event for event in events if isinstance(event, StepUndone)]:
            self._lines += [line for one in undone for line in teaching_lines(one, teaching)]
            self._said = ""
        return events

    # ------------------------------------------------------------------------------- playing

    def _playing(self) -> Iterator[StoryFrame]:
        """Play a game: until a person was persuaded, through a fault, and to its end."""
        self._game = self._workspace.supervision(self._policy, self._seed + GAMES_LATER)
        self._control = scripted_controller(self._game)
        self._show(text.GAME, ())
        self._begin_scene(text.GAME)
        for event in self._control.begin():
            self._tell(event)
        self._world = self._game.world
        yield self._frame(text.BEGINS)
        yield from self._persuading()
        self._begin_scene(text.GAME)
        yield from self._a_fault()
        yield from self._your_turn()

    def _persuading(self) -> Iterator[StoryFrame]:
        """Play until a person refused and was asked another way, or complied."""
        responses: list[Response] = []
        while not self._game.over and not any(response.complied for response in responses):
            for event in self._step():
                self._tell(event)
                match event:
                    case Acted(choice=StrategyChoice(strategy=strategy)):
                        words = text.ANOTHER_WAY if responses else text.SAYS_IT
                        yield self._frame(words.format(self._activity.strategies[strategy]))
                    case Acted():
                        yield self._frame(text.PLAYS, seconds=GLANCE)
                    case BeliefUpdated(response=response):
                        words = text.response_caption(response, responses, self._workspace.name)
                        responses.append(response)
                        yield self._frame(words)

    def _a_fault(self) -> Iterator[StoryFrame]:
        """Inject a fault, and play until Tangy has recovered."""
        if self._game.over or not isinstance(self._game.world, FaultyWorld):
            return
        self._game.world.inject(FAULT)
        yield self._frame(text.NOW_A_FAULT)
        for _ in range(FAULT_STEPS):
            for event in self._step():
                self._tell(event)
                match event:
                    case Diagnosed():
                        yield self._frame(text.DIAGNOSED)
                    case Moved(move=move) if move.kind == "asked":
                        yield self._frame(text.ASKS_PEOPLE)
                    case Moved(move=move) if move.kind == "recovered":
                        yield self._frame(text.RECOVERED)
                        return

    def _your_turn(self) -> Iterator[StoryFrame]:
        for _ in range(MOST_STEPS):
            if self._game.over:
                break
            for event in self._step():
                self._tell(event)
            yield self._frame(text.PLAYS_ON, seconds=GLANCE)
        self._begin_scene(text.BELIEVES)
        self._show(text.BELIEVES, text.belief_lines(self.beliefs, self._workspace.name))
        yield self._frame(text.BELIEVES_THIS)
        self._show(text.BELIEVES, [*self._lines, *text.YOUR_TURN_LINES])
        yield self._frame(text.YOUR_TURN)

    def _step(self) -> list[Event]:
        return go_on_by_script(self._control, expert=True)

    def _tell(self, event: Event) -> None:
        self.tally.add([event])
        self._lines += game_lines(event, self._game, self._workspace.name)
        if isinstance(event, Acted):
            self._said = event.speech

    # -------------------------------------------------------------------------------- frames

    def _begin_scene(self, heading: str) -> None:
        self._scene += 1
        self._heading = heading

    def _show(self, heading: str, lines: Sequence[str]) -> None:
        """Replace the lines of the panel."""
        self._heading, self._lines, self._told = heading, list(lines), 0
        self._said = ""

    def _frame(
        self, caption: str, *, typed: str = "", asked: str = "", seconds: float | None = None
    ) -> StoryFrame:
        lines, new = tuple(self._lines), len(self._lines) - self._told
        if seconds is None or caption != self._caption:
            said = len(f"{caption} {asked}".split())
            below = len(" ".join(lines[len(lines) - new :]).split())
            beside = min(MOST_BESIDE, below / WORDS_A_SECOND / 2)  # most people only scan it
            seconds = LEAST + said / WORDS_A_SECOND + beside
        self._told, self._caption = len(lines), caption
        return StoryFrame(
            scene=self._scene,
            caption=caption,
            room=self._world.scene(),
            heading=self._heading,
            lines=lines,
            new=new,
            said=self._said,
            typed=typed,
            asked=asked,
            seconds=seconds,
        )
