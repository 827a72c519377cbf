"""The activity simulator (III-A-3, IV-C): a robot, people with cards, one game after another.

A discrete-event simulation: time advances with each behaviour, counted in calls (about half a
minute each), and people's mistakes and requests are scheduled events. Three random streams (cards,
users, compliance) have separate seeds, so that a change in the use of one does not shift the
others; only `Random.random` is used, which is stable across Python versions.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from random import Random
from typing import assert_never

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.faults import Remedy
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.health import Health
from tangy_profiles.past_game import PastGame
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.robot import Robot
from tangy_profiles.scene import CardView, Scene
from tangy_profiles.state import FRONT, ActivityState, Outcome, Response
from tangy_profiles.tracker import Tracker
from tangy_sim.worlds.compliance import Preferences, preferences_in_turn, respond
from tangy_sim.worlds.devices import well
from tangy_sim.worlds.users import SimulatedUser, UserModel, load_users, waiting_calls, waiting_time

AGREEING, MORE_LOOKS = 3, 2
"""Looks at a card that must agree before it counts as read, and additional looks."""


class SimulatedWorld(PlannedGame):
    """A room with a simulated group. `begin` starts each game; `execute` runs a behaviour.

    The same seed gives the same games on every machine. `players` are the people with their cards,
    by id, and `order` is the order of this game's numbers; neither is visible to the robot.
    """

    agreeing = AGREEING
    """Looks at a card that must agree before it counts as read."""
    fused_looks = (0, 0)
    """Number of looks at cards, and how many of them the others overruled."""

    played_in: GameWorld = SIMULATED

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        *,
        seed: int,
        users: UserModel | None = None,
        preferences: Preferences | None = None,
        robot: Robot | None = None,
    ) -> None:
        self._well = well(robot)
        self.activity = activity
        self.own_deck = activity.deck
        self.people = tuple(people)
        self.users = users or load_users()
        self.preferences = preferences or preferences_in_turn(
            self.people, tuple(activity.strategies), self.users
        )
        self.pace = self.users.call_seconds
        self._cards = Random(f"{seed}/cards")
        self._uniform = Random(f"{seed}/users").random
        self._compliance = Random(f"{seed}/compliance")
        self.begin()

    @property
    def pauses(self) -> tuple[int, float]:
        """Number and total s of the robot's waits for late data: always 0."""
        return 0, 0.0

    def begin(self) -> ActivityState:
        """Deal new cards and begin a game; return its first state."""
        self.begin_plan()
        activity, deck, cards = self.activity, self.activity.deck, self._cards.random
        self.over = False
        self.tracker = Tracker(activity, self.people)
        self.order = deck.shuffled(cards)
        self._calls = 0
        self._now = self._sooner = 0.0
        self.players = {p: SimulatedUser(p, deck, deck.deal(cards)) for p in self.people}
        self._holders: dict[int, list[tuple[SimulatedUser, int]]] = {n: [] for n in deck.numbers}
        for player in self.players.values():
            for number, cell in player.cell.items():
                if not deck.free >> cell & 1:
                    self._holders[number].append((player, cell))
            player.slips_at = waiting_calls(self._uniform, self.users.slip)
        self._next_slip = min(p.slips_at for p in self.players.values())
        self._next_ask = 1e18
        self._in_view = False  # whether the card beside the robot can be read
        self._opened = False
        return self.tracker.state()

    def resume(self, past: PastGame) -> ActivityState:
        """Resume an interrupted game, or raise NotResumable."""
        state = past.replay(self)
        self._visited = past.visited(self.activity)
        self._row_began = self.seconds - past.since_call(self.activity)
        return state

    def observe(self) -> ActivityState:
        """Return the current joint state, as the robot's sensors see it."""
        return self.tracker.state()

    def execute(self, action: Action) -> Outcome:
        """Execute an action of the robot, and advance the time."""
        tracker, behaviour = self.tracker, action.behaviour
        if self.over:
            return Outcome(False, 0.0, (), None)
        succeeded = tracker.allows(behaviour)
        beside = tracker.place
        numbers = self._take_effect(action)
        if numbers is None:
            succeeded, numbers = False, ()
        response: Response | None = None
        if behaviour.persuades and beside != FRONT and succeeded:
            response = self._respond(beside, action)
        self._count(behaviour, succeeded)
        calls = 1.0 if beside == FRONT and tracker.place == FRONT else self.users.away_calls
        self._now += calls
        if self.pace != self.users.call_seconds:
            self._sooner += calls * (self.users.call_seconds - self.pace)
        if self._now >= self._next_ask:
            self._let_people_ask()
        elif not self._opened and tracker.begun():
            self._open()
        if self._in_view and tracker.seen is None and tracker.place in tracker.queue:
            self._look_at_card()  # the same person asks again, with the card still in view
        return Outcome(succeeded, calls * self.pace, numbers, response)

    @property
    def seconds(self) -> float:
        """Time in this game, in s."""
        return self._now * self.users.call_seconds - self._sooner

    def who(self, place: str) -> str:
        """Return who sits at a person's place: always that person."""
        return place

    def scene(self) -> Scene:
        """Return the scene as a teacher or a member of staff sees it."""
        tracker = self.tracker
        asking = () if self.over else tuple(tracker.queue)  # after the game nobody is served
        doing: dict[str, str] = {}
        for player in self.players.values():
            step, verb, number = player.did
            if step >= tracker.step - 1 and not self.over:
                doing[player.id] = f"{verb} {self.activity.deck.label(number)}" if number else verb
            else:
                doing[player.id] = "asks for help" if player.id in asking else "watches"
        card: CardView | None = None
        if tracker.seen is not None:
            beside = self.players[tracker.place]
            card = CardView(beside.id, beside.numbers, beside.marked, beside.called)
        called = tuple(self.order[: self._calls])
        return Scene(tracker.place, asking, doing, called, card, self.away)

    def health(self) -> Health:
        """Return the readings of devices without faults (see `FaultyWorld`)."""
        return self._well

    def recover(self, remedy: Remedy) -> float:
        """Do nothing, in 0 s: there are no faults to recover from."""
        return 0.0

    # Effects return the affected numbers, or None if they had no effect.

    def _take_effect(self, action: Action) -> tuple[int, ...] | None:
        """Apply the effect of an action; return the affected numbers, None if it failed."""
        match action.behaviour.effect:
            case "none":
                return ()
            case "draw":
                return self._draw(action)
            case "clear wrong marks":
                return self._clear_wrong_marks(action)
            case "set missing marks":
                return self._set_missing_marks(action)
            case "bring card closer":
                return self._bring_card_closer(action)
            case "go to user":
                return self._go_to_user(action)
            case "go to front":
                return self._go_to_front(action)
            case "finish":
                return self._finish(action)
            case forgotten:
                assert_never(forgotten)

    def _draw(self, _: Action) -> tuple[int, ...] | None:
        if self._calls >= len(self.order):
            return ()
        number = self.order[self._calls]
        self._calls += 1
        step, uniform, miss = self.tracker.step, self._uniform, self.users.miss
        for player, cell in self._holders[number]:
            bit = 1 << cell
            player.called |= bit
            if player.marked & bit:
                continue  # marked too early by mistake, and correct from now on
            if uniform() >= miss:
                player.did = (step, "marks", number)
                if player.mark(cell):
                    self._ask(player)
        if self._calls >= self._next_slip:
            self._let_people_slip()
        return (number,)

    def _let_people_slip(self) -> None:
        for player in self.players.values():
            if self._calls >= player.slips_at:
                player.slips_at = self._calls + waiting_calls(self._uniform, self.users.slip)
                slip = player.slip(self._uniform)
                if slip is not None:
                    number, filled = slip
                    player.did = (self.tracker.step, "marks", number)
                    if filled:
                        self._ask(player)
        self._next_slip = min(p.slips_at for p in self.players.values())

    def _open(self) -> None:
        """Open the game: from now on people may ask for help."""
        self._opened = True
        rate = self.users.ask * self.users.ask_with_error
        for player in self.players.values():
            player.asks_at = self._now + waiting_time(self._uniform, rate)
        self._next_ask = min(p.asks_at for p in self.players.values())

    def _let_people_ask(self) -> None:
        """Draw requests at the higher rate of cards with an error, and thin those of the others."""
        users, uniform = self.users, self._uniform
        rate = users.ask * users.ask_with_error
        for player in self.players.values():
            while self._now >= player.asks_at:
                player.asks_at += waiting_time(uniform, rate)
                asks = uniform() * users.ask_with_error < 1.0 or player.has_error
                if asks and self._ask(player):
                    player.did = (self.tracker.step, "asks for help", 0)
        self._next_ask = min(p.asks_at for p in self.players.values())

    def _ask(self, player: SimulatedUser) -> bool:
        """Let a present person ask for help; return whether the request is seen and new."""
        return player.id not in self.away and self.tracker.ask(player.id)

    def _respond(self, beside: str, action: Action) -> Response | None:
        """Let the person beside the robot respond to a request."""
        return respond(
            self.preferences, beside, action.strategy, self.activity.patience, self._compliance
        )

    def _count(self, behaviour: Behaviour, succeeded: bool) -> None:
        """Count an executed behaviour."""
        self.tracker.executed(behaviour, succeeded=succeeded)

    def _go_to_user(self, action: Action) -> tuple[int, ...] | None:
        tracker = self.tracker
        target = action.target or (tracker.queue[0] if tracker.queue else None)
        if target in self.players:
            tracker.arrive(target)
            self._in_view = False
            if self._uniform() >= self.users.occluded and target in tracker.queue:
                self._look_at_card()
        return ()

    def _go_to_front(self, _: Action) -> tuple[int, ...] | None:
        self.tracker.arrive(FRONT)
        self._in_view = False
        return ()

    def _bring_card_closer(self, _: Action) -> tuple[int, ...] | None:
        if self.tracker.place in self.tracker.queue:
            self._did("moves the card")
            self._look_at_card()
        return ()

    def _clear_wrong_marks(self, _: Action) -> tuple[int, ...] | None:
        return self._correct(lambda player: player.marked & ~player.called, "clears marks")

    def _set_missing_marks(self, _: Action) -> tuple[int, ...] | None:
        return self._correct(lambda player: player.called & ~player.marked, "marks")

    def _correct(self, errors: Callable[[SimulatedUser], int], verb: str) -> tuple[int, ...] | None:
        """Let the person beside the robot correct the visible mistakes on the card, if any."""
        if self.tracker.seen is None:
            return None
        player = self.players[self.tracker.place]
        mask = errors(player)
        if not mask:
            return None
        player.marked ^= mask
        self._did(verb)
        self._look_at_card()
        return player.cells(mask)

    def _finish(self, _: Action) -> tuple[int, ...] | None:
        self.over = True
        return ()

    def _did(self, verb: str) -> None:
        self.players[self.tracker.place].did = (self.tracker.step, verb, 0)

    def _look_at_card(self) -> None:
        """Read the card beside the robot until enough looks agree, because one may be misread."""
        looks: Counter[str | None] = Counter()
        for _ in range(self.agreeing + MORE_LOOKS):
            self.read_card()
            looks[self.tracker.seen] += 1
            if looks[self.tracker.seen] == self.agreeing:
                break
        else:
            self.tracker.seen = looks.most_common(1)[0][0]
        taken, wrong = self.fused_looks
        wrong += looks.total() - looks[self.tracker.seen]
        self.fused_looks = (taken + looks.total(), wrong)

    def read_card(self) -> None:
        """Take one look at the card beside the robot."""
        self._in_view = True
        card = self.players[self.tracker.place]
        self.tracker.seen = self.judged(card.id, card.judged(self.activity.card_states))

    # ------------------------------------------------------------------- what staff change

    @property
    def called_now(self) -> tuple[int, ...]:
        """Numbers that count as called."""
        return tuple(self.order[: self._calls])

    def numbers_on(self, card: int) -> tuple[int, ...] | None:
        """Return the numbers of a card; cards are numbered by their places."""
        holder = self.holder(card)
        return self.players[holder].numbers if holder else None

    def holder(self, card: int) -> str:
        """Return the person with a card; "" if there is no such card."""
        return self.people[card - 1] if 1 <= card <= len(self.people) else ""

    @property
    def known_cards(self) -> dict[str, int]:
        """Everybody, with the number of their card."""
        return {person: card for card, person in enumerate(self.people, 1)}

    def _play_pattern(self) -> None:
        super()._play_pattern()
        for player in getattr(self, "players", {}).values():
            player.deck = self.activity.deck

    def _take_back(self, number: int) -> None:
        """Revert the call of a number: people remove their markers, and it comes last."""
        if number not in self.order[: self._calls]:
            return
        self.order.remove(number)
        self.order.append(number)
        self._calls -= 1
        for player in self.players.values():
            player.uncall(number)
