"""Live games without a screen: scripted staff play them to the end, and the results add up."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.beliefs import Beliefs
from tangy_profiles.known_devices import missing_devices
from tangy_profiles.past_game import PastGame
from tangy_tui.app.card_news import BY, CardNews, CardNote, doubt_document
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.scripted_staff import go_on_by_script
from tangy_tui.app.seats import Seated, Seats
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.fault import fault_documents
from tangy_tui.monitoring.scoring import GameScore, score_game, scores_document
from tangy_tui.monitoring.supervision import Event, Supervision

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace


News: TypeAlias = CardNote | Seated
"""News about cards, or about who sits where."""
Tell: TypeAlias = Callable[[list[Event], list[News]], None]


class LiveGames:
    """Live games and the totals of their results."""

    def __init__(
        self, workspace: Workspace, supervision: Supervision, past: PastGame | None = None
    ) -> None:
        """Start with empty totals; an interrupted game is resumed first."""
        self._past = past
        self.tally = Tally()
        self.faults: list[dict[str, Any]] = []
        self.card_doubts: list[dict[str, Any]] = []
        """Why Tangy did not judge cards, as JSON data."""
        self.scores: list[GameScore] = []
        """The injected faults and their outcomes, game by game."""
        self.seconds = 0.0
        """Duration of the games in the robot's time, in s."""
        self.took = 0.0
        self._workspace = workspace
        self._supervision = supervision
        self._seats = Seats()
        self._cards = CardNews()

    def play(
        self,
        games: Iterable[int],
        *,
        expert: bool,
        tell: Tell = lambda events, news: None,
    ) -> None:
        """Play games, one after another.

        Args:
            games: one item for each game to play.
            expert: staff are there to clear what halts the robot.
            tell: is called with new events and news.
        """
        for _ in games:
            began = time.monotonic()
            self._play(expert, tell)
            self.took += time.monotonic() - began

    def _play(self, expert: bool, tell: Tell) -> None:
        game, world = self._supervision, self._supervision.world
        assert isinstance(world, LiveWorld)  # noqa: S101 - other games are played elsewhere
        past, self._past = self._past, None
        control = GameController(game, SCRIPTED, robot=world, paced=False, past=past)
        self._workspace.door.attach(control)
        events = control.begin()
        tell(events, self.take(events))
        since = world.link.time
        stopped = None
        while not game.over:
            events = go_on_by_script(control, expert=expert)
            stopped = next((e.stopped for e in events if isinstance(e, GameEnded)), stopped)
            tell(events, self.take(events))
        self.seconds += world.link.time - since
        self.faults += fault_documents(game.faults, stopped)
        if isinstance(world, BenchedWorld):
            self.tally.add_injections(world.came, world.pending_injections)
            came = world.injection_log.all
            self.scores.append(score_game(self.tally.games, came, game.faults, game.book))

    def take(self, events: Sequence[Event]) -> list[News]:
        """Count events, log news about cards, and return it with the news about seats."""
        self.tally.add(list(events))
        game, world = self._supervision, self._supervision.world
        assert isinstance(world, LiveWorld)  # noqa: S101 - other games are played elsewhere
        notes = self._cards.take(events, world.cards)
        for note in notes:
            game.note(note.did, BY, person=note.person, detail=note.detail)
            if note.doubt is not None:
                self.card_doubts.append(doubt_document(note.doubt, game.game.games))
        return [*notes, *self._seats.news(events, world.sitting)]

    @property
    def beliefs(self) -> Mapping[str, Beliefs]:
        """The Beta posteriors of each person."""
        return self._supervision.persuasion.beliefs

    def document(self) -> dict[str, Any]:
        """Return what `tangy live --json` prints."""
        world = self._supervision.world
        found = self.tally.to_json(self._workspace.activity.situations, self.beliefs, self.faults)
        found["card_doubts"] = self.card_doubts
        found["missing_devices"] = list(missing_devices(self._workspace.robot))
        if isinstance(world, BenchedWorld):
            found |= world.score.to_json()
            found["real_time_factor"] = round(self.seconds / self.took, 2) if self.took else None
            if world.injections:
                found["injected"] = self.tally.injected
                found["did_not_come_about"] = self.tally.absent
                found |= scores_document(self.scores)
        return found
