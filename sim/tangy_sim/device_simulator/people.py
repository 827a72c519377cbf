"""The bench's people: they hear calls, mark cards, make mistakes, raise signs, and follow requests.

They play with the same rates as those of `tangy_sim.worlds.world`, but in continuous time, reacting
some seconds after an event. Rates are per call. Because robots take different times for a call,
people's time advances with what they hear: by one call for each behaviour before the group, by
`away_calls` for each at a seat. Random streams are separate.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from random import Random
from typing import assert_never

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.card_face import LAST_CARD, USUAL_SEED, numbers_of
from tangy_profiles.person import Person
from tangy_profiles.state import FRONT, Response
from tangy_sim.device_simulator.agenda import Agenda
from tangy_sim.device_simulator.faults import Faults
from tangy_sim.device_simulator.sitters import GameProgress, Sitter
from tangy_sim.device_simulator.speech_reception import HeardLine
from tangy_sim.worlds.compliance import Preferences, preferences_in_turn, respond
from tangy_sim.worlds.faulty_world import HELPS
from tangy_sim.worlds.users import SimulatedUser, UserModel, load_users, waiting_calls, waiting_time

MARKS = (1.5, 5.0)  # s after a call until it is marked
SLIPS = (1.0, 8.0)  # s after a call until a mistaken mark
ASKS = (0.5, 2.0)  # s from a reason to ask until the sign is up
TURNS_DOWN = (0.4, 1.2)  # s from being helped until it is down
HELPS_AFTER = (3.0, 8.0)  # s from a robot's request for help until somebody helps
CLEAR = 1.0  # s: nobody acts so near the end of a window that the outcome would be ambiguous
GIVES_UP = 3  # refused requests after which a person takes the sign down
HIDES = ("away", "edge", "sheet")
"""How a card is out of view: absent, mostly outside the image, under a sheet."""


class People:
    """The group at the table. `begin` deals; `hear`, `meet` and `leave` are the robot's actions."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[Person],
        faults: Faults,
        *,
        seed: int,
        users: UserModel | None = None,
        preferences: Preferences | None = None,
    ) -> None:
        self.activity = activity
        self.ids = tuple(person.id for person in people)
        self.users = users or load_users()
        self.preferences = preferences or preferences_in_turn(
            self.ids, tuple(activity.strategies), self.users
        )
        self._faults = faults
        self._cards = Random(f"{seed}/cards").random
        self._uniform = Random(f"{seed}/users").random
        self._compliance = Random(f"{seed}/compliance")
        self._moments = Random(f"{seed}/moments").random
        self._chance = Random(f"{seed}/faults").random
        rules = activity.stage_rules
        self._openers = {rule.behaviour for rule in rules if rule.condition == "before"}
        self._agenda, self.away = Agenda(), set[str]()
        self.sitters: dict[str, Sitter] = {}
        self.begin(0.0)

    def begin(self, now: float) -> None:
        """Deal new cards and begin a game at a time in s.

        Who asked in vain in the game before still waits. Nobody else asks before it is opened.
        """
        waits = {id: s.asks_since for id, s in self.sitters.items() if not s.visited}
        self.now = now
        self.game = GameProgress()
        self._agenda.clear()
        self._calls = 0  # numbers called
        self._time = 0.0  # in calls
        self._left_to_open, self._driven_to = set(self._openers), ""
        self.shown: dict[str, str] = {}  # letters that people hold up on answer signs
        self._speak = False  # whether people were told to ask aloud
        self.place = FRONT
        self.sitters = self._seat()
        for sitter in self.sitters.values():
            sitter.player.slips_at = waiting_calls(self._uniform, self.users.slip)
            sitter.asks_since = None if sitter.id in self.away else waits.get(sitter.id)

    def _seat(self) -> dict[str, Sitter]:
        """Seat people, each with a new card."""
        deck, dealt = self.activity.deck, list[int]()
        while len(dealt) < len(self.ids):
            dealt.append(self._new_card(dealt))
        return {
            person: Sitter(SimulatedUser(person, deck, numbers_of(deck, card, USUAL_SEED)), card)
            for person, card in zip(self.ids, dealt, strict=True)
        }

    def _new_card(self, dealt: Collection[int]) -> int:
        """Draw a card that nobody has."""
        while True:
            card = 1 + int(self._cards() * LAST_CARD)
            if card not in dealt:
                return card

    def resume(self, cards: Mapping[str, int], called: Sequence[int]) -> None:
        """Go on with an interrupted game, in which everybody has marked what was called.

        Args:
            cards: the card of each person; others keep theirs, or get a new one if somebody has it.
            called: the numbers that count as called.
        """
        deck = self.activity.deck
        self.game.called, self._calls, self._time = [*called], len(called), float(len(called))
        dealt = set(cards.values())
        for person, sitter in self.sitters.items():
            if person in cards:
                sitter.card = cards[person]
            elif sitter.card in dealt:
                sitter.card = self._new_card(dealt)
            dealt.add(sitter.card)
            player = SimulatedUser(person, deck, numbers_of(deck, sitter.card, USUAL_SEED))
            player.catch_up(called)
            player.slips_at = self._calls + waiting_calls(self._uniform, self.users.slip)
            sitter.player = player
        self._left_to_open.clear()
        self._open()

    @property
    def asking(self) -> tuple[str, ...]:
        """People whose signs are up, the longest waiting first."""
        up = [(s.asks_since, s.id) for s in self.sitters.values() if s.asks_since is not None]
        return tuple(person for _, person in sorted(up, key=lambda one: one[0]))

    def judged(self, person: str) -> str:
        """Return the true user activity state of a person's card."""
        return self.sitters[person].player.judged(self.activity.card_states)

    # -------------------------------------------------------------- what the robot does

    def step(self, now: float) -> None:
        """Advance the time to `now`, in s."""
        self.now = now
        if "request-withdrawn" in self._faults.present:
            self._withdraw()
        self._agenda.run(now)

    def meet(self, person: str) -> None:
        """React to the robot's arrival; at a seat, the card may be out of view."""
        self.place = person
        sitter = self.sitters.get(person)
        if sitter is None:
            return
        sitter.moved += 1
        sitter.visited = True
        hides = HIDES[int(self._moments() * len(HIDES))]
        hidden = self._uniform() < self.users.occluded
        if sitter.asks_since is not None and self._faults.concerns("card-out-of-sight", person):
            hidden = True
        sitter.hides = hides if hidden else ""

    def leave(self) -> None:
        """React to the robot's departure."""
        sitter = self.sitters.get(self.place)
        self.place = ""
        if sitter is None:
            return
        sitter.hides = ""
        fault = self._faults.present.get("never-complies")
        if fault is not None and fault.person == sitter.id:
            self._after((1.0, 3.0), partial(self._turn_down, sitter))  # the person has given up

    def hear(self, heard: HeardLine) -> None:
        """React to a sentence that the robot has finished."""
        if heard.fault:
            self._asked_to_help(heard)
            return
        behaviour = heard.behaviour
        if behaviour is None or self.game.over:
            return
        away = self.place != FRONT or behaviour.visits
        self._time += self.users.away_calls if away else 1.0
        sitter = self.sitters.get(heard.person or self.place)
        match behaviour.effect:
            case "draw":
                for number in heard.numbers:
                    self._call(number)
            case "go to user":
                self._driven_to = sitter.id if sitter is not None else ""
            case "finish":
                self.game.over = True
            case "none" | "clear wrong marks" | "set missing marks" | "bring card closer":
                pass  # done on compliance
            case "go to front":
                pass  # nobody waits for it
            case forgotten:
                assert_never(forgotten)
        if sitter is not None and behaviour.persuades:
            self._persuaded(sitter, behaviour, heard)
        if not self.game.opened:
            self._left_to_open.discard(behaviour.name)
            if not self._left_to_open:
                self._open()
        elif not self.game.over:
            self._let_people_ask()

    # ------------------------------------------------------------------------ the game

    def _call(self, number: int) -> None:
        if number not in self.game.called:
            self.game.called.append(number)
            self._calls += 1
        for sitter in self.sitters.values():
            player = sitter.player
            cell = player.cell.get(number)
            if cell is None or self.activity.deck.free >> cell & 1:
                continue
            player.called |= 1 << cell
            if not player.marked >> cell & 1 and self._uniform() >= self.users.miss:
                self._after(MARKS, partial(self._mark, sitter, cell))
        for sitter in self.sitters.values():
            if self._calls >= sitter.player.slips_at:
                waits = waiting_calls(self._uniform, self.users.slip)
                sitter.player.slips_at = self._calls + waits
                self._after(SLIPS, partial(self._slip, sitter))

    def _mark(self, sitter: Sitter, cell: int) -> None:
        if not sitter.player.marked >> cell & 1 and sitter.player.mark(cell):
            self._ask_soon(sitter)

    def _slip(self, sitter: Sitter) -> None:
        slip = sitter.player.slip(self._uniform)
        if slip is not None and slip[1]:
            self._ask_soon(sitter)

    def _open(self) -> None:
        self.game.opened = True
        rate = self.users.ask * self.users.ask_with_error
        for sitter in self.sitters.values():
            sitter.player.asks_at = self._time + waiting_time(self._uniform, rate)

    def _let_people_ask(self) -> None:
        """Draw requests at the higher rate of cards with an error, and thin those of the others."""
        users, uniform = self.users, self._uniform
        rate = users.ask * users.ask_with_error
        for sitter in self.sitters.values():
            player = sitter.player
            while self._time >= player.asks_at:
                player.asks_at += waiting_time(uniform, rate)
                if uniform() * users.ask_with_error < 1.0 or player.has_error:
                    self._ask_soon(sitter)

    def ask(self, person: str) -> None:
        """Let a person raise their sign now."""
        self._ask(self.sitters[person])

    def _ask_soon(self, sitter: Sitter) -> None:
        self._after(ASKS, partial(self._ask, sitter))

    def _ask(self, sitter: Sitter) -> None:
        if sitter.asks_since is None and not (self.game.over or sitter.id in self.away):
            sitter.asks_since, sitter.visited = self.now, False
            if self._speak and "requests-silent" in self._faults:
                self.game.spoken.append(sitter.id)

    def _turn_down(self, sitter: Sitter) -> None:
        sitter.asks_since = None

    def _closed(self, sitter: Sitter) -> None:
        """Turn down the sign of a person who was helped, unless a fault keeps it up."""
        if sitter.asks_since is None:
            return
        if self._faults.concerns("request-stuck", sitter.id):
            self._faults.present["request-stuck"].shown = True
            return
        self._turn_down(sitter)

    # -------------------------------------------------------------- what people are asked

    def _persuaded(self, sitter: Sitter, behaviour: Behaviour, heard: HeardLine) -> None:
        """Let a person respond to a request: in time, late, or not at all."""
        patience = self.activity.patience
        response = respond(self.preferences, sitter.id, heard.strategy, patience, self._compliance)
        asked = behaviour.about_card
        if asked and self._faults.concerns("never-complies", sitter.id):
            self._refuses(sitter, response)
            return
        vain = behaviour.corrects and "no-effect" in self._faults
        seconds = _shown(response.seconds, response.complied, patience)
        self.game.responses.append(response._replace(seconds=seconds))
        self._agenda.at(self.now + seconds, partial(self._does, sitter, behaviour, heard, vain))

    def _refuses(self, sitter: Sitter, response: Response) -> None:
        """Let a person ignore a request, and give up after the third."""
        patience = self.activity.patience
        gone = response._replace(followed=False, complied=False, seconds=2 * patience)
        self.game.responses.append(gone)
        sitter.refused += 1
        if sitter.refused >= GIVES_UP:
            self._agenda.at(self.now + 2 * patience - CLEAR, partial(self._turn_down, sitter))

    def _does(self, sitter: Sitter, behaviour: Behaviour, heard: HeardLine, vain: bool) -> None:
        """Carry out a request; if `vain`, another cell may get the same error."""
        player, before = sitter.player, sitter.player.marked
        judged = self.judged(sitter.id)
        named = heard.cells(player)
        match behaviour.effect:
            case "bring card closer":
                if not self._faults.concerns("card-out-of-sight", sitter.id):
                    self._lay(sitter)
                return
            case "clear wrong marks":
                player.marked &= ~named | self.activity.deck.free
                others = ~(player.marked | player.called | named)
            case "set missing marks":
                player.marked |= named
                others = player.marked & player.called & ~named & ~self.activity.deck.free
            case "none" | "draw" | "go to user" | "go to front" | "finish":
                others = 0
            case forgotten:
                assert_never(forgotten)
        if vain and "no-effect" in self._faults and self._spoils(sitter, others, judged):
            self._faults.lift("no-effect")
        if behaviour.closes == "always":
            self._closed(sitter)
        elif (
            behaviour.closes == "when correct"
            and player.marked != before
            and self.judged(sitter.id) == self.activity.card_states[-1].name
        ):
            self._after(TURNS_DOWN, partial(self._closed, sitter))

    def _spoils(self, sitter: Sitter, cells: int, judged: str) -> bool:
        """Make one of some cells wrong without changing the judgement, if possible.

        If the request completed a line, not every cell can be used.
        """
        player = sitter.player
        order = [1 << cell for cell in range(len(player.numbers)) if cells >> cell & 1]
        first = int(self._chance() * len(order))
        for cell in (*order[first:], *order[:first]):
            player.marked ^= cell
            if self.judged(sitter.id) == judged:
                return True
            player.marked ^= cell
        return False

    def _lay(self, sitter: Sitter) -> None:
        sitter.hides = ""
        sitter.moved += 1

    # ---------------------------------------------------------------- when something is wrong

    def hide(self, person: str) -> None:
        """Move a card out of the robot's view, by a fault."""
        self.sitters[person].hides = HIDES[int(self._moments() * len(HIDES))]

    def lifted(self, kind: str, person: str) -> None:
        """Apply the consequences of a fault's end."""
        sitter = self.sitters.get(person)
        if sitter is None:
            return
        if kind == "card-out-of-sight":
            self._lay(sitter)
        elif kind == "request-stuck":
            self._turn_down(sitter)

    def _asked_to_help(self, heard: HeardLine) -> None:
        """Let people help, most of the time, after the robot has asked for it."""
        if heard.fault == "requests-silent":
            self._speak = True
            self.game.spoken += self.asking
        helped = self._faults.helped(heard.fault)
        if helped and self._chance() < HELPS:
            for kind in helped:
                self._after(HELPS_AFTER, partial(self._faults.lift, kind))

    def _withdraw(self) -> None:
        """Let a waiting person, whom the robot is not busy with, take the sign down."""
        busy = self.place if self.place in self.sitters else self._driven_to
        asking = self.asking
        others = [p for p in asking if p != (busy if busy in asking else asking[0])]
        if others:
            self._turn_down(self.sitters[others[int(self._chance() * len(others))]])
            self._faults.lift("request-withdrawn")

    def _after(self, between: tuple[float, float], happens: Callable[[], object]) -> None:
        low, high = between
        self._agenda.at(self.now + low + (high - low) * self._moments(), happens)


def _shown(seconds: float, complied: bool, patience: float) -> float:
    """Return the time of a visible response: clearly within the patience, or after it."""
    if complied:
        return seconds * (patience - CLEAR) / patience
    return patience + CLEAR + (seconds - patience) * (patience - 2 * CLEAR) / patience
