"""Live games without a screen: with staff at the lines, or headless."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from tangy_hw.device_protocols import DeviceFailed
from tangy_profiles.errors import TangyError
from tangy_profiles.known_devices import reads_cards
from tangy_profiles.reading import plain
from tangy_tui.app.live_games import LiveGames, News
from tangy_tui.app.on_duty import on_duty
from tangy_tui.app.robot_opening import WorldOpening, at_front
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.switching_on import switched_on
from tangy_tui.console.inputs import is_typed, line_reader
from tangy_tui.console.leaving_out import leaves_out, on_or_without
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.console.typed_lines import typed_lines
from tangy_tui.text.calls import REHEARSAL
from tangy_tui.text.command_line import SWITCHING_ON
from tangy_tui.text.live_games import part_words, report_words
from tangy_tui.text.live_news import live_lines
from tangy_tui.text.missing_devices import missing_words, staff_needed
from tangy_tui.text.outcomes import faults_logged, score_lines
from tangy_tui.text.set_up import as_before_words
from tangy_tui.text.tablet import screen_words
from tangy_tui.verbs.common import as_given, print_json, print_line
from tangy_tui.verbs.live_lines import LiveLines
from tangy_tui.verbs.playing import SCRIPTED, recall

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_tui.learning.policy import Policy
    from tangy_tui.monitoring.supervision import Event, Supervision
    from tangy_tui.verbs.live import PreparedGames


class GamesWithoutScreen:
    """Live games of a command: set up, switch the robot on, `play`."""

    def __init__(self, games: PreparedGames) -> None:
        """Take the options of the command.

        Raises:
            TangyError: the games need staff at the lines.
        """
        self._games, self._given, self._workspace = games, games.given, games.workspace
        self._opening = games.opening(games.seed)
        self._policy = games.policy
        self._set_up: SetUpLines | None = None
        self._as_before: SetUp | None = None
        """The choices of the last game, if it is played again without a set-up."""
        self._console: LiveLines | None = None
        robot, activity = self._workspace.robot, self._workspace.activity
        sees = reads_cards(robot) or not activity.deck.columns
        if robot.drivers and not (self._given.bench or self._given.plain_lines or sees):
            raise TangyError(staff_needed(activity.object))

    def play(self) -> bool:
        """Play the games; return whether none stopped early."""
        if not self._sets_up():
            return True
        if not self._given.as_json:
            print(SWITCHING_ON, file=sys.stderr)
        with self._at_the_lines():
            return self._play_all()

    def _sets_up(self) -> bool:
        """Let staff at the lines set a new game up; return whether they play."""
        given, workspace = self._given, self._workspace
        if given.plain_lines and self._games.past is None and is_typed(None):
            setup = SetUp.of(workspace, given.pace)
            known = setup.offer_last_plan()
            if not given.begin:
                self._set_up = SetUpLines(setup, line_reader(None), print_line)
            elif known:
                self._as_before = setup
        played_before = workspace.profile
        if self._set_up is not None and not self._set_up.run():
            return False
        if workspace.profile != played_before:
            self._policy = recall(workspace, "", quiet=given.as_json)
        return True

    @contextmanager
    def _at_the_lines(self) -> Iterator[None]:
        """Connect the terminal, if staff use the lines."""
        if not self._given.plain_lines:
            yield
            return
        workspace = self._workspace
        with typed_lines(print_line) as typed:
            by_name = self._given.teacher is not None
            by = self._games.who if by_name else on_duty(workspace.store.folder)
            self._console = LiveLines(workspace, self._given.games, by, typed)
            yield

    def _play_all(self) -> bool:
        """Switch the robot on, again after each person who joins, and play.

        Returns whether no game stopped early.
        """
        with self._switched_on(self._opening) as world:
            self._tell_devices(world)
            if not self._begins(world):
                return True
            fine = self._play_first(world)
        console = self._console
        if console is None:
            return fine
        while console.joined:
            again = self._switched_on(at_front(self._opening))
            with (
                console.keeping(f"tangy live --resume{as_given(self._given.data)}"),
                again as world,
            ):
                self._tell_tablet(world)
                fine = console.play(self._supervision(console.policy, world), world)
        print_line(report_words(self._given.report))
        return fine

    def _switched_on(self, opening: WorldOpening) -> AbstractContextManager[LiveWorld]:
        """Switch the robot on; as fast as possible if nobody plays and no link delays it."""
        given = self._given
        stepped = given.bench and not given.plain_lines and given.link is None

        def switch_on() -> AbstractContextManager[LiveWorld]:
            return switched_on(
                opening, stepped=stepped, tell=self._tell_part, meanwhile=self._take_lines
            )

        return on_or_without(switch_on, self._leaves_out)

    def _leaves_out(self, error: DeviceFailed) -> bool:
        """Ask a person at the lines whether to go on without a device that does not start."""
        console = self._console
        if console is None or not console.typed:
            return False
        return leaves_out(self._workspace, error, console.read, console.write)

    def _tell_devices(self, world: LiveWorld) -> None:
        """Tell the address of the tablet's page, and which devices the robot lacks."""
        given, workspace = self._given, self._workspace
        if given.as_json:
            return
        if given.plain_lines or not given.bench:
            self._tell_tablet(world)
        if self._set_up is None:  # the set-up tells it in console mode
            for words in missing_words(workspace.robot, workspace.activity):
                self._note(words)

    def _begins(self, world: LiveWorld) -> bool:
        """Carry the set-up out on the robot; return whether staff begin the game."""
        console, lines = self._console, self._set_up
        if console is None:
            return True
        if console.early.leaves:
            return False
        if lines is not None:
            lines.setup.world = world
            stopped, console.early.stopped = console.early.stopped, False
            lines.use(console.read, console.write)
            if not lines.begins_anyway(stopped=stopped):
                return False
            lines.setup.carry_out(world)
        if (before := self._as_before) is not None:
            before.carry_out(world)
            self._note(as_before_words(before))
        return True

    def _play_first(self, world: LiveWorld) -> bool:
        """Play up to a game that a person joins; return whether none stopped early."""
        supervision, past = self._supervision(self._policy, world), self._games.past
        if self._console is not None:
            return self._console.play(supervision, world, past)
        return self._play_headless(LiveGames(self._workspace, supervision, past))

    def _supervision(self, policy: Policy, world: LiveWorld) -> Supervision:
        """Return what runs the games on a robot that is on."""
        lines = self._given.plain_lines
        # Only people who are there can rehearse a call: a batch of games must not page anybody.
        return self._workspace.supervision(
            policy,
            self._games.seed,
            asks=lines or self._games.who == SCRIPTED,
            world=world,
            rehearsal=REHEARSAL if lines and not self._given.expert else "",
        )

    def _play_headless(self, played: LiveGames) -> bool:
        """Play games, print their events, and return whether none stopped early."""
        from tangy_tui.ui import reports

        given = self._given

        def tell(events: list[Event], news: list[News]) -> None:
            for line in [] if given.as_json else live_lines(events, news, self._workspace.name):
                print(plain(line), flush=True)

        bar = reports.progress(
            range(given.games), "Playing", quiet=given.as_json or given.games < 2
        )
        played.play(bar, expert=bool(given.expert), tell=tell)
        if given.as_json:
            print_json(played.document())
        else:
            self._print_results(played)
        return not played.tally.stopped

    def _print_results(self, played: LiveGames) -> None:
        """Print the totals of headless games."""
        from tangy_tui.ui import reports

        document = played.document()
        reports.print_tally(self._workspace, played.tally, played.beliefs)
        for name in ("reads", "identities"):
            if name in document:
                counts = ", ".join(f"{count} {word}" for word, count in document[name].items())
                print(f"{name}: {counts}")
        if "pose_error_m" in document:
            off = document["pose_error_m"]
            print(f"pose error: median {off['median']} m, p95 {off['p95']} m")
            print(f"real-time factor: {document['real_time_factor']}")
        if "score" in document:
            for line in score_lines(document["score"]):
                print(line)
        if document["faults"]:
            print(faults_logged(len(document["faults"])), file=sys.stderr)

    def _note(self, words: str) -> None:
        """Print a line: above the one that is being typed, or on standard error."""
        if self._console is not None and self._console.typed:
            self._console.write(plain(words))
        else:
            print(plain(words), file=sys.stderr)

    def _tell_part(self, part: str) -> None:
        """Tell staff which part of the robot starts."""
        if self._given.plain_lines:
            self._note(f"  {part_words(part, self._workspace.robot)} ...")

    def _tell_tablet(self, world: LiveWorld) -> None:
        """Tell the address of the page for the robot's tablet, if there is one."""
        if world.link.screen:
            self._note(screen_words(world.link.screen, world.link.code))

    def _take_lines(self) -> None:
        """Take lines while the robot is switched on."""
        if self._console is not None:
            self._console.meanwhile()
