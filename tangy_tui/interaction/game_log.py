"""The log of a running game: its clock, its steps, and people's responses."""

from __future__ import annotations

from tangy_profiles.game_records import AnswerNotClear, GameBeginning, GameStep
from tangy_profiles.past_game import PastGame
from tangy_profiles.people_records import ResponseAwaited, ResponseGiven
from tangy_profiles.state import Response
from tangy_profiles.store import Store
from tangy_tui.interaction.game_events import Acted
from tangy_tui.world import World, queue_of, remembered, since_when


class GameLog:
    """Logs the steps of games; call `begin` or `resume` for each."""

    def __init__(self, world: World, store: Store) -> None:
        self._world, self._store = world, store
        self._began = 0.0
        self._numbers = dict[str, int]()
        self._read = 0  # the last event of which the number is known

    @property
    def seconds(self) -> float:
        """The time played in s, without the time in which the game was interrupted."""
        return max(0.0, self._world.seconds - self._began)

    def number(self, game: str) -> int:
        """Return the number of a logged game, counted from 1 over all games of the log."""
        if game not in self._numbers:
            for event in self._store.events(GameBeginning, after=self._read):
                self._read = event.seq
                self._numbers.setdefault(event.record.game, len(self._numbers) + 1)
        return self._numbers[game]

    def begin(self) -> None:
        """Start the clock of a game."""
        self._began = self._world.seconds

    def resume(self, past: PastGame) -> None:
        """Continue the clock from the last step of an interrupted game."""
        self._began = self._world.seconds - past.seconds

    def step(self, game: str, acted: Acted, teacher: str) -> None:
        """Log a step, and the person's response or that it is awaited."""
        action, outcome, choice = acted.action, acted.outcome, acted.choice
        asking = queue_of(self._world)
        self._store.append(
            GameStep(
                game=game,
                behaviour=action.behaviour.name,
                target=action.target,
                strategy=action.strategy,
                share=acted.decision.share,
                teacher=teacher,
                draws=choice.draws if choice else None,
                numbers=outcome.numbers,
                completed=outcome.completed,
                seconds=outcome.seconds,
                clock=self.seconds,
                state=acted.state,
                after=acted.after,
                asking=asking,
                since=since_when(self._world, asking, self._began) or None,
                memory=remembered(self._world),
            )
        )
        for one in outcome.unclear:
            unclear = AnswerNotClear(
                game=game,
                fact=one.fact,
                said=one.said,
                certainty=one.certainty,
                source=one.source,
                asked_again=one.asked_again,
            )
            self._store.append(unclear, person=one.person)
        if outcome.response is not None:
            self._response(game, outcome.response)
        elif choice is not None and outcome.completed:  # staff may say later what they did
            awaited = ResponseAwaited(game=game)
            self._store.append(awaited, person=choice.person, strategy=choice.strategy)

    def _response(self, game: str, response: Response) -> None:
        self._store.append(
            ResponseGiven(game=game, followed=response.followed, seconds=response.seconds),
            person=response.person,
            strategy=response.strategy,
            complied=response.complied,
        )
