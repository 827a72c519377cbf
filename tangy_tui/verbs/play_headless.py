"""Simulated games without staff: scripted staff play them to the end, and the results add up."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.interaction.game_events import GameEnded, Taught
from tangy_tui.interaction.tally import Tally
from tangy_tui.monitoring.fault import fault_documents
from tangy_tui.monitoring.scoring import GameScore, score_game, scores_document, summary
from tangy_tui.text.documents import lesson_document
from tangy_tui.text.outcomes import did_not_come, faults_played, score_lines
from tangy_tui.text.situations import lesson_words
from tangy_tui.ui import reports

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.online_learning import Lesson
    from tangy_tui.monitoring.supervision import Supervision


class HeadlessGames:
    """Simulated games without staff, and the totals of their results."""

    def __init__(
        self, workspace: Workspace, supervision: Supervision, past: PastGame | None
    ) -> None:
        """Start with empty totals; an interrupted game is resumed first."""
        self.tally = Tally()
        self._workspace, self._supervision = workspace, supervision
        self._lessons: list[Lesson] = []
        self._faults: list[dict[str, Any]] = []
        self._scores: list[GameScore] = []
        self._control = scripted_controller(supervision, past)
        workspace.door.attach(self._control)

    def play(self, games: int, *, expert: bool, quiet: bool) -> None:
        """Play some games.

        Args:
            games: their number.
            expert: scripted staff clear the faults that halt the robot.
            quiet: show no progress.
        """
        for _ in reports.progress(range(games), "Playing", quiet=quiet or games < 20):
            with self._workspace.store.transaction():  # one commit a game: .1 ms a step, not 4
                self._play(expert=expert)

    def _play(self, *, expert: bool) -> None:
        """Play a game, and add its results."""
        supervision, world = self._supervision, self._supervision.world
        self.tally.add(self._control.begin())
        stopped = None
        while not supervision.over:
            events = go_on_by_script(self._control, expert=expert)
            self.tally.add(events)
            stopped = next((e.stopped for e in events if isinstance(e, GameEnded)), None)
            self._lessons += [event.lesson for event in events if isinstance(event, Taught)]
        if isinstance(world, FaultyWorld):
            self.tally.add_injections(world.came, world.pending_injections)
            came = world.injection_log.all
            self._scores.append(
                score_game(self.tally.games, came, supervision.faults, supervision.book)
            )
        self._faults += fault_documents(supervision.faults, stopped)

    def document(self, *, injected: bool) -> dict[str, Any]:
        """Return what `tangy play --json` prints, with the faults that were to be `injected`."""
        beliefs = self._supervision.persuasion.beliefs
        told = self.tally.to_json(self._workspace.activity.situations, beliefs, self._faults)
        if self._lessons:
            told["answers"] = [lesson_document(self._workspace, one) for one in self._lessons]
        if injected:
            told["injected"] = self.tally.injected
            told["did_not_come_about"] = self.tally.absent
            told |= scores_document(self._scores)
        return told

    def print_results(self, games: int, *, injected: bool) -> None:
        """Print the totals of some games, with the scores if faults were to be `injected`."""
        for lesson in self._lessons:
            print(lesson_words(self._workspace.activity, lesson))
        reports.print_tally(self._workspace, self.tally, self._supervision.persuasion.beliefs)
        if injected:
            for line in score_lines(summary(self._scores)):
                print(line)
        for one, times in self.tally.absent.items():
            print(did_not_come(one, times, games))
        if self._faults:
            critical = sum(fault.get("criticality") == "critical" for fault in self._faults)
            print(faults_played(len(self._faults), critical))
