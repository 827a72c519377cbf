"""The application on a terminal: the order of its screens, and what each of them needs."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any, TypeVar

from textual.app import SystemCommand
from textual.worker import Worker, WorkerCancelled, WorkerFailed

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import SIMULATED
from tangy_tui.app.game_to_play import GameToPlay
from tangy_tui.text import program as text
from tangy_tui.text.program import NOT_POSSIBLE, NOT_YET
from tangy_tui.text.rooms import no_chosen_room
from tangy_tui.text.session_reports import REPORTS
from tangy_tui.ui import policy_opening
from tangy_tui.ui.blank_screen import BEHIND
from tangy_tui.ui.camera_session import CameraSession
from tangy_tui.ui.demo import tell_story_aside
from tangy_tui.ui.drills import hold_drill
from tangy_tui.ui.first_start import change_teacher, first_start, rename_teacher
from tangy_tui.ui.interruption import ask_about_interrupted
from tangy_tui.ui.live_games import play_from_home
from tangy_tui.ui.policy_comparison import compare_policies
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.session_reports import show_reports
from tangy_tui.ui.showing_again import show_again
from tangy_tui.ui.sounding import SoundingApp

if TYPE_CHECKING:
    from textual.screen import Screen

    from tangy_hw.perception.camera_hub import CameraHub
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policy import Policy
    from tangy_tui.learning.teaching_session import TeachingSession
    from tangy_tui.ui.messages import OpenStep

T = TypeVar("T")


PLAYING = 20.0
"""The speed of watched games (ratio to real time) if Tangy is silent and none is given."""

Start = Callable[["Program"], Coroutine[Any, Any, None]]
"""What the application does first, above its home screen."""


class Program(SoundingApp):
    """Tangy's screens around one workspace."""

    def __init__(
        self,
        workspace: Workspace,
        start: Start | None = None,
        *,
        sensors: CameraHub | None = None,
        live: bool = False,
        asks_name: bool = False,
        **settings: Any,
    ) -> None:
        """Create the application; without a `start` it waits on the home screen."""
        pictures = workspace.store.folder
        super().__init__(self._home, pictures=pictures, activity=workspace.activity, **settings)
        self.workspace = workspace
        self._start, self._asks_name = start, asks_name
        self.new_teacher = False
        """Whether the teacher has just given a name, and so gets the tour."""
        self.eyes = CameraSession(workspace, sensors, live=live)
        self.leads_home = True
        """Whether the home screen follows after a game, and not the end of the program."""
        self._busy = False
        self._opening = False
        self._told: set[str] = set()

    def on_mount(self) -> None:
        """Report the log's problems, and start."""
        self._tell_of_log()
        self.run_worker(first_start(self, self._start, asks=self._asks_name))

    def _home(self) -> Screen[Any]:
        def far() -> Mapping[str, str]:
            from tangy_tui.ui.progress_summary import how_far  # not before the first frame

            found = how_far(self.workspace)
            self.call_later(self._tell_of_log)
            return found

        home = HomeScreen(far, note=self.workspace.activity.title)
        home.set_class(self._start is not None, BEHIND)
        return home

    def show_home(self) -> None:
        """Show the home screen, hidden so far behind the questions at the start."""
        for screen in self.screen_stack:
            screen.remove_class(BEHIND)

    def _tell_of_log(self) -> None:
        """Report the problems of the log and the events left out, each once."""
        store = self.workspace.store
        aside = [store.aside[seq] for seq in sorted(store.aside)]
        if len(aside) > 1:
            aside = [text.left_out_words(aside[0], len(aside) - 1)]
        if problem := self.workspace.room_problem:
            aside.append(no_chosen_room(problem))
        for sentence in (*store.notices, *aside):
            if sentence not in self._told:
                self._told.add(sentence)
                self.say(sentence, bad=True, seconds=60)

    # ---------------------------------------------------------------------------------- ways

    def on_home_screen_chosen(self, event: HomeScreen.Chosen) -> None:
        """Open the choice, unless one is being opened: a key may arrive twice."""
        if self._busy or self._opening or not isinstance(self.screen, HomeScreen):
            return
        if self.screen.has_class(BEHIND):  # the key was typed before anything was seen
            return
        match event.id:
            case "teach":
                self.teach(self.workspace.teaching(self.workspace.teacher, None))
            case "guided":
                self.teach(self.workspace.teaching(self.workspace.teacher, None, guided=True))
            case "library":
                self.action_library()
            case "learn":
                self._open(self._learn())
            case "play":
                self._open(self.play())
            case "rehearse":
                self._open(self.drill())
            case "policy":
                self._open(self._show_policy())
            case "people":
                self.people()
            case "reports":
                self._open(show_reports(self))
            case "sensors":
                self._open(self.sensors())
            case "demo":
                self._open(tell_story_aside(self))
            case "activity":
                from tangy_tui.ui.activity_choice import choose_at_home

                self._open(choose_at_home(self))
            case "name":
                self._open(change_teacher(self))
            case "live":
                self._open(self.live())

    def _open(self, way: Coroutine[Any, Any, None]) -> None:
        """Run a choice that takes time; no other choice is opened from home meanwhile."""
        self._opening = True

        async def go() -> None:
            try:
                await way
            finally:
                self._opening = False

        self.run_worker(go())

    def teach(self, teaching: TeachingSession) -> None:
        """Open the teaching screen."""
        from tangy_tui.ui.screens.teach import TeachScreen

        self.push_screen(TeachScreen(self.workspace, teaching, tour=self.take_tour()))

    def take_tour(self) -> bool:
        """Return whether the tour is due; it is due once."""
        tour, self.new_teacher = self.new_teacher, False
        return tour

    def action_name(self) -> None:
        """Change the teacher's name."""
        self.run_worker(change_teacher(self))

    def rename_teacher(self, name: str) -> None:
        """Set the teacher's name that was given in a command."""
        rename_teacher(self, name)

    def on_open_step(self, event: OpenStep) -> None:
        """Show a step in its demonstration."""
        from tangy_tui.ui.screens.demonstration import DemonstrationScreen

        self.push_screen(DemonstrationScreen(self.workspace, event.demonstration, event.number))

    async def show_again(self, id: str, kept: int) -> None:
        """Demonstrate a game again after its first `kept` steps."""
        await show_again(self, id, kept)

    def people(self) -> None:
        """Open the people screen."""
        from tangy_tui.ui.screens.people import PeopleScreen

        self.push_screen(PeopleScreen(self.workspace))

    async def sensors(self) -> None:
        """Open the screen of devices and cameras, and wait until it is closed."""
        from tangy_tui.ui.screens.sensors import SensorsScreen

        try:
            screen = SensorsScreen(self.workspace, self.eyes.sensors())
        except TangyError as error:
            await self.tell(str(error), title=NOT_POSSIBLE)
            return
        await self.push_screen_wait(screen)

    async def on_unmount(self) -> None:
        """Close the cameras with the application."""
        await self.eyes.close()

    def action_library(self) -> None:
        """Open the library, unless it is open."""
        from tangy_tui.ui.screens.demonstrations import DemonstrationsScreen

        if not any(isinstance(screen, DemonstrationsScreen) for screen in self.screen_stack):
            self.push_screen(DemonstrationsScreen(self.workspace))

    def action_guided(self) -> None:
        """Teach in a guided game, which replaces one that is being taught."""
        from tangy_tui.ui.screens.teach import TeachScreen

        if self._busy or self._opening:
            return
        if isinstance(self.screen, TeachScreen):
            self.screen.dismiss(False)
        teaching = self.workspace.teaching(self.workspace.teacher, None, guided=True)
        self.call_next(self.teach, teaching)

    def action_learn(self) -> None:
        """Learn from all finished demonstrations."""
        self.run_worker(self._learn())

    async def _learn(self) -> None:
        from tangy_tui.app.training import learn
        from tangy_tui.ui.screens.conflicts import ConflictsScreen, settle_conflicts

        if self._busy or any(isinstance(s, ConflictsScreen) for s in self.screen_stack):
            return
        if not await settle_conflicts(self, self.workspace, "let Tangy learn"):
            return
        policy = await self.in_thread(text.LEARNING, lambda: learn(self.workspace))
        if policy is not None:
            await self.open_policy(policy)

    async def _show_policy(self) -> None:
        policy = await self.load_policy()
        if policy is not None:
            await self.open_policy(policy)

    async def play(
        self,
        games: int = 1,
        speed: float | None = None,
        seed: int | None = None,
        wanted: str = "",
        teacher: str = "",
        injections: Sequence[str] = (),
        past: PastGame | None = None,
    ) -> None:
        """Open the playing screen with a policy.

        Args:
            games: the number of games.
            speed: a ratio to real time; by default 1 if Tangy speaks or its cameras are real,
                otherwise faster.
            seed: seeds the random generators.
            wanted: the policy: its name or digest, "" for the last.
            teacher: who answers Tangy's questions.
            injections: faults to inject.
            past: an interrupted game to resume first; None: ask about one if there is any.
        """
        from tangy_tui.ui.screens.play import PlayScreen

        policy, room = await self.load_policy(wanted), self.workspace.chosen_room
        chosen = await ask_about_interrupted(self, SIMULATED) if past is None else GameToPlay(past)
        if policy is None or chosen is None:
            return
        workspace, past = self.workspace, chosen.past
        seed = seed if past is None else past.beginning.seed
        speed = speed or (1.0 if self.speaker.on or self.eyes.live else PLAYING)
        async with self.eyes.watching() as live:
            supervision = workspace.supervision(
                policy, seed, asks=True, injections=injections, live=live
            )
            screen = PlayScreen(
                workspace, supervision, games=games, speed=speed, teacher=teacher, past=past
            )
            if live is None and past is None:
                await self.push_screen(screen)
                return
            await self.push_screen_wait(screen)
        if past is not None:
            workspace.leave_resumed_game(room)

    async def action_play(self, wanted: str = "") -> None:
        """Let Tangy run a game in the simulated room, from home, teaching, or a policy."""
        from tangy_tui.ui.screens.policy import PolicyScreen
        from tangy_tui.ui.screens.teach import TeachScreen

        if isinstance(self.screen, HomeScreen | TeachScreen | PolicyScreen):
            await self.play(wanted=wanted)

    async def live(self) -> None:
        """Play a live game: on the robot if its file names drivers, otherwise on the bench."""
        policy = await self.load_policy()
        if policy is not None:
            await play_from_home(self, policy)

    async def drill(self) -> None:
        """Open a drill for rehearsing faults."""
        await hold_drill(self)

    def action_compare(self) -> None:
        """Compare two policies, or the demonstrations of two teachers."""
        self.run_worker(self.compare())

    async def compare(self, first: str | None = None) -> None:
        """Open the comparison of two policies to choose; `first` is one of them already."""
        await compare_policies(self, first)

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """List the commands of the palette that have no key."""
        yield from super().get_system_commands(screen)
        yield SystemCommand(*text.COMPARE_POLICIES, self.action_compare)
        yield SystemCommand(*REPORTS, lambda: self.run_worker(show_reports(self)))

    async def action_phrases(self) -> None:
        """Open the phrasebook; the microphone is closed while it speaks a word."""
        from tangy_tui.app.aloud import hear
        from tangy_tui.ui.screens.phrases import PhrasesScreen

        async def say(phones: str) -> None:
            with nullcontext() if self.hearing is None else self.hearing.deaf():
                await hear(phones)

        if not any(isinstance(screen, PhrasesScreen) for screen in self.screen_stack):
            await self.push_screen(PhrasesScreen(self.workspace, say))

    def action_other_policy(self) -> None:
        """Open another stored policy."""
        self.run_worker(self._other_policy())

    async def _other_policy(self) -> None:
        from tangy_tui.ui.screens.compare import choose_policy

        chosen = await choose_policy(self, self.workspace)
        policy = None if chosen is None else await self.load_policy(chosen)
        if policy is not None:
            await self.open_policy(policy)

    async def open_policy(self, policy: Policy) -> None:
        """Open the screen of a policy, and wait until it is closed."""
        await policy_opening.open_policy(self, policy)

    async def load_policy(self, wanted: str = "") -> Policy | None:
        """Learn the stored policy again; notices about it come before it is used."""
        return await policy_opening.load_policy(self, wanted)

    async def tell(self, text: str, title: str) -> None:
        """Show a message in a dialog, and wait until it is closed."""
        from tangy_tui.ui.dialogs.message import MessageDialog

        await self.push_screen_wait(MessageDialog(text, title=title))

    async def in_thread(self, what: str, work: Callable[[], T]) -> T | None:
        """Run slow work in a thread; None if it failed, and the reason was shown."""
        if self._busy:
            return None
        self._busy = True
        self.show_work(what)
        try:
            worker: Worker[T] = self.run_worker(
                work, thread=True, exit_on_error=False, group="thread"
            )
            return await worker.wait()
        except WorkerCancelled:
            return None  # the program is ending
        except WorkerFailed as failed:
            if not isinstance(failed.error, TangyError):
                raise
            self.call_later(self.clear_notifications)
            await self.tell(str(failed.error), title=NOT_YET)
            return None
        finally:
            self._busy = False
            # Later: quick work may be done before its notification was even shown.
            self.call_later(self.clear_notifications)
