"""A guided game: one simulated game with every situation of an activity.

By chance, a person would have to demonstrate about three games to see every row of Table II. Here
the same people have the same cards, but a plan of missing situations decides who makes mistakes,
who asks for help, whose card is out of view, and which number comes next.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from random import Random
from typing import TypeVar

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action
from tangy_profiles.cards import CardState
from tangy_profiles.scene import ArrangedCard
from tangy_profiles.state import FRONT, ActivityState, Outcome
from tangy_sim.worlds.compliance import Preferences
from tangy_sim.worlds.guided_plan import FEWEST, LINE, Cue, GuidedPlan
from tangy_sim.worlds.users import SimulatedUser, UserModel
from tangy_sim.worlds.world import SimulatedWorld

Some = TypeVar("Some")


class GuidedWorld(SimulatedWorld):
    """A simulated world in which one game shows every situation of its activity.

    This holds for a teacher who does the expected; for others it keeps offering the missing
    situations. Nobody wins before that, as long as a number is left that completes no line. People
    make mistakes and ask on a cue, one at a time, not at the user model's rates.

    If an `after` stage can occur with and without a request, one game shows one of the two, and the
    game of the next seed the other. The same seed and actions give the same states on every
    machine.
    """

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        *,
        seed: int,
        users: UserModel | None = None,
        preferences: Preferences | None = None,
    ) -> None:
        self._game = seed
        self._guide = Random(f"{seed}/guide").random
        super().__init__(activity, people, seed=seed, users=users, preferences=preferences)

    def begin(self) -> ActivityState:
        """Deal new cards, plan a game with all situations missing, and return its first state."""
        state = super().begin()
        self.plan = GuidedPlan(self.activity, self._guide)
        self._next_ask = 0.0  # check people after every behaviour
        self._beats = self._played = 0  # calls, with or without a number; those acted upon
        self.cue: Cue | None = None
        self._next = self.plan.gap(0, self._guide())
        self._favourite = self._prepare_line().id
        self._turns = Counter({self._favourite: 1})  # requests of each person: others come first
        self._asks_at_end = self._game % 2 == 1
        self._game += 1
        return state

    @property
    def coming(self) -> ArrangedCard | None:
        """The coming situation, until the person has asked."""
        cue = self.cue
        if cue is None or cue.asked:
            return None
        return ArrangedCard(cue.person, cue.shows.name, cue.hidden and self.plan.lacks_hidden)

    def execute(self, action: Action) -> Outcome:
        """Execute an action of the robot, and let people follow the plan."""
        if not self.over:
            self.plan.show(self.tracker.state().situation)
        return super().execute(action)

    # ------------------------------------------------------------------------ which number comes

    def _prepare_line(self) -> SimulatedUser:
        """Draw all but one number of a person's line early, so that a win can come in time."""
        deck, uniform = self.activity.deck, self._guide
        player = self._pick(tuple(self.players.values()))
        numbers = list(player.cells(self._pick(deck.lines) & ~deck.free))
        if numbers:
            numbers.remove(self._pick(numbers))
        order = [n for n in self.order if n not in numbers]
        for number in numbers:
            order.insert(int(uniform() * max(self.plan.span - FEWEST, 1)), number)
        self.order = order
        return player

    def _draw(self, _: Action) -> tuple[int, ...]:
        self._beats += 1
        self._give_cue()
        if self._calls >= len(self.order):
            return ()
        number = self._choose()
        self.order.remove(number)
        self.order.insert(self._calls, number)
        self._calls += 1
        for player, cell in self._holders[number]:
            overlooked = self._overlooks(player, cell)
            player.called |= 1 << cell
            if not player.marked >> cell & 1 and not overlooked:
                player.did = (self.tracker.step, "marks", number)
                player.mark(cell)
        return (number,)

    def _choose(self) -> int:
        """Choose a number that the plan needs, or otherwise the least harmful one."""
        left, wished = self.order[self._calls :], self._wished()
        asking = {*self.tracker.queue, *([self.cue.person] if self.cue else [])}
        safe = {player.id for player in self.players.values() if not self._has_line(player)}

        def cost(number: int) -> tuple[int, int, int]:
            """Count cards with a new called line (asking people's, all), and corrected marks."""
            threatened = spoilt = theirs = 0
            for player, cell in self._holders[number]:
                if player.id in safe and self._completes(player.called, cell):
                    threatened += 1
                    theirs += player.id in asking
                spoilt += player.marked >> cell & 1
            return theirs, threatened, spoilt

        return min([n for n in left if n in wished] or left, key=cost)

    def _wished(self) -> tuple[int, ...]:
        """Return uncalled numbers one of which the cue needs now."""
        cue = self.cue
        if cue is None or cue.asked:
            return ()
        player = self.players[cue.person]
        open_cells = ~(player.called | player.marked)
        if cue.shows.checker == LINE and self._beats >= cue.asks_at:
            return player.cells(self._nearest_line(player) & ~player.called)
        if cue.shows.checker == "missing marks" and not self._shows(cue):
            cells = [c for c in player.cell.values() if not self._completes(player.called, c)]
            return player.cells(sum(1 << c for c in cells) & open_cells)
        return ()

    def _overlooks(self, player: SimulatedUser, cell: int) -> bool:
        """Return whether a person overlooks a number: by the plan, or to prevent a win."""
        cue = self.cue
        if cue is not None and cue.person == player.id and not cue.asked:
            if cue.shows.checker == "missing marks" and not self._shows(cue):
                return True
            if cue.shows.checker == LINE and self._beats >= cue.asks_at:
                return False
        return self._completes(player.marked, cell)

    # ------------------------------------------------------------------------- who does what when

    def _give_cue(self) -> None:
        """Give a person the next cue, as soon as it is due and nobody asks."""
        cue, tracker = self.cue, self.tracker
        if cue is not None and cue.asked and cue.person not in tracker.queue:
            self.cue = None
            self._next = self._beats - 1 + self.plan.gap(self._beats - 1, self._guide())
        if self.cue or tracker.queue or self._beats < self._next - 1:
            return
        if not tracker.begun() or self.plan.ended(tracker):
            return
        shows = self.plan.wanted(self._spent())
        if shows is not None:
            # A mistake is made one call before the request; a win may be up to two calls off.
            wait = int(3 * self._guide()) if shows.checker == LINE else 1
            hidden = self.plan.hides(self._guide(), self.users.occluded)
            person = self._choose_person(shows)
            self.plan.tried[shows.name] += 1
            self.cue = Cue(person.id, shows, hidden, max(self._next, self._beats + wait))

    def _let_people_ask(self) -> None:
        """Let the person with the cue act, and then ask, after every behaviour."""
        if not self.plan.drawing and self.tracker.place == FRONT:
            self._beats += 1  # without calls, count the behaviours at the front
            self._give_cue()
        if self.plan.ended(self.tracker):
            self._ask_at_the_end()
        elif self._beats > self._played and self.cue is not None and not self.cue.asked:
            self._act(self.cue)
        self._played = self._beats

    def _act(self, cue: Cue) -> None:
        player = self.players[cue.person]
        if not self._shows(cue):
            self._bring_about(cue, player)
        ready = self._shows(cue) or self._spent() or not self.plan.drawing
        if ready and self._beats >= cue.asks_at:
            cue.asked = True
            self._turns[player.id] += 1
            self.tracker.ask(player.id)

    def _bring_about(self, cue: Cue, player: SimulatedUser) -> None:
        """Let a person change their card so that it shows the state of the cue, if possible."""
        match cue.shows.checker:
            case "complete line":
                if self._has_line(player):
                    self._mark_as(player, player.called)
            case "missing marks":
                self._mark_as(player, player.marked & player.called)
                if not self._shows(cue) and self._beats >= cue.asks_at:
                    self._take_off(player)  # no number was left to be overlooked
            case "wrong marks":
                self._mark_as(player, player.called)
                self._slip(player)
            case _:
                self._mark_as(player, player.called)

    def _mark_as(self, player: SimulatedUser, cells: int) -> None:
        """Let a person correct their own mistakes."""
        if player.marked != cells:
            verb = "clears marks" if player.marked & ~cells else "marks"
            player.marked = cells
            player.did = (self.tracker.step - 1, verb, 0)

    def _take_off(self, player: SimulatedUser) -> None:
        """Let a person lose a marker from a called number."""
        marked = player.marked & player.called & ~self.activity.deck.free
        cells = [c for c in player.cell.values() if marked >> c & 1]
        if cells:
            self._mark_as(player, player.marked & ~(1 << self._pick(cells)))

    def _slip(self, player: SimulatedUser) -> None:
        """Let a person mark an uncalled number, preferably one that completes no line."""
        taken = player.marked | player.called
        cells = [c for c in player.cell.values() if not taken >> c & 1]
        harmless = [c for c in cells if not self._completes(taken, c)]
        if cells:
            cell = self._pick(harmless or cells)
            player.mark(cell)
            player.did = (self.tracker.step - 1, "marks", player.numbers[cell])

    def _ask_at_the_end(self) -> None:
        """Let a person ask in an ending that allows both, if this game is to show that."""
        if self._asks_at_end and not self.tracker.queue and self.plan.ends_freely(self.tracker):
            self._asks_at_end = False
            self.tracker.ask(self._choose_person(None).id)

    def _go_to_user(self, action: Action) -> tuple[int, ...]:
        tracker = self.tracker
        target = action.target or (tracker.queue[0] if tracker.queue else None)
        if target in self.players:
            tracker.arrive(target)
            self._in_view = False
            hidden = self.cue is not None and self.cue.hidden and self.plan.lacks_hidden
            if not hidden and target in tracker.queue:
                self._look_at_card()
        return ()

    # ---------------------------------------------------------------------------- what cards tell

    def _choose_person(self, shows: CardState | None) -> SimulatedUser:
        """Choose the person for the next cue: nearest to a line, or with the fewest requests."""
        players, turns = tuple(self.players.values()), self._turns
        if shows is not None and shows.checker == LINE:
            return min(players, key=lambda p: (self._left_of_line(p), p.id != self._favourite))
        able = [p for p in players if not self._has_line(p)] or players
        fewest = min(turns[p.id] for p in able)
        return self._pick([p for p in able if turns[p.id] == fewest])

    def _shows(self, cue: Cue) -> bool:
        return self.players[cue.person].judged(self.activity.card_states) == cue.shows.name

    def _nearest_line(self, player: SimulatedUser) -> int:
        lines = self.activity.deck.lines
        return min(lines, key=lambda line: (line & ~player.called).bit_count())

    def _left_of_line(self, player: SimulatedUser) -> int:
        return (self._nearest_line(player) & ~player.called).bit_count()

    def _completes(self, mask: int, cell: int) -> bool:
        """Return whether a cell added to a mask completes a line."""
        mask |= 1 << cell
        for line in self.activity.deck.lines_through[cell]:  # noqa: SIM110 - twice as fast as any()
            if mask & line == line:
                return True
        return False

    def _has_line(self, player: SimulatedUser) -> bool:
        """Return whether a whole line was called, so that a fully marked card can only win."""
        return self.activity.deck.wins(player.called)

    def _spent(self) -> bool:
        """Return whether nothing but wins can be shown any more."""
        return self._calls >= len(self.order) or all(map(self._has_line, self.players.values()))

    def _pick(self, choices: Sequence[Some]) -> Some:
        return choices[int(self._guide() * len(choices))]
