"""Changes by staff in a game besides its behaviours: pattern, calls, claims, attendance.

Both worlds share this part. Each change is logged as a `GameChange`, so that an interrupted game
can be restored.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tangy_profiles.activity import Activity
from tangy_profiles.card_face import called_cells
from tangy_profiles.cards import Deck, winning_state
from tangy_profiles.game_rules import GamePlan, Patterns
from tangy_profiles.state import FRONT

if TYPE_CHECKING:
    from tangy_profiles.game_records import ChangeKind, GameChange
    from tangy_profiles.tracker import Tracker


@dataclass(frozen=True, slots=True)
class DueChange:
    """A change that is due, its person, and its number of calls."""

    what: ChangeKind
    person: str = ""
    number: int = 0


@dataclass(frozen=True, slots=True)
class Won:
    """A win in the running game."""

    person: str
    pattern: str
    """Its label, "" if it has none."""
    calls: int = 0
    """How many numbers had been called; 0: unknown, as the game was interrupted since."""
    number: int = 0
    """The last of these numbers."""


class PlannedGame:
    """A world's game with staff's plan; call `choose` before it begins."""

    activity: Activity
    """The activity, with the deck of the current pattern."""
    own_deck: Deck
    """The activity's own deck."""
    people: tuple[str, ...]
    tracker: Tracker
    pace: float
    """The time between calls, in s."""
    game_plan = GamePlan()
    patterns: Patterns
    winner = ""
    """The winner, while others are visited before the game continues or ends."""
    _past_wins: tuple[Won, ...] = ()
    """The wins of this game, in order, up to the last one that the game went on after."""
    _asked_before: frozenset[str] | None = None
    """Who asked when somebody won, and has not been visited since; None: nobody has won yet."""
    vouched: frozenset[str] = frozenset()
    """The people whose cards win, whatever is observed."""
    away: frozenset[str] = frozenset()
    """The people who have left, or have not come yet."""
    all_called = False
    """Whether no number is left: each person gets a visit before the game ends."""
    looking = ""
    """The person whose card the robot is reading, before which no next step is decided."""
    said = ""
    """What the robot said last in this game, "" if the world cannot tell or it said nothing."""
    visiting: tuple[str, ...] = ()
    """The people in the queue who get a visit without a request, in order."""
    _visited: dict[str, int]
    _row_began: float
    """When the visits since the last call began, in s of `seconds`."""

    def choose(self, plan: GamePlan) -> None:
        """Set the plan of the next game.

        Raises:
            TangyError: it names an unknown pattern.
        """
        Patterns.of(self.activity.rules, self.activity.deck, plan.patterns)
        self.game_plan = plan
        if plan.pace:
            self.set_pace(plan.pace)

    def begin_plan(self) -> None:
        """Apply the plan at the beginning of a game."""
        self.patterns = Patterns.of(self.activity.rules, self.own_deck, self.game_plan.patterns)
        self.winner, self.visiting, self.all_called = "", (), False
        self.looking = self.said = ""
        self._past_wins = ()
        self._asked_before = None
        self.vouched, self.away = frozenset(), frozenset(self.game_plan.absent)
        self._visited, self._row_began = {}, 0.0
        self._play_pattern()

    def _play_pattern(self) -> None:
        """Use the deck of the current pattern."""
        if self.activity.deck != self.patterns.played:
            self.activity = replace(self.activity, deck=self.patterns.played)

    @property
    def plan_away(self) -> frozenset[str]:
        """The people who are absent when the next game begins."""
        return frozenset(self.game_plan.absent)

    def set_pace(self, seconds: float) -> None:
        """Set the time between calls, in s."""
        self.pace = seconds
        self.game_plan = replace(self.game_plan, pace=seconds)

    # ---------------------------------------------------------------- observation of the game

    @property
    def arrived(self) -> bool:
        """Whether the robot has arrived at its place; always True in simulation."""
        return True

    @property
    def bound_for(self) -> str:
        """The place that the robot is driving to; "" if it stands."""
        return ""

    @property
    def seconds(self) -> float:
        """The time of the world, in s."""
        raise NotImplementedError

    @property
    def called_now(self) -> tuple[int, ...]:
        """The numbers that count as called."""
        raise NotImplementedError

    @property
    def calling(self) -> tuple[int, ...]:
        """The numbers that are being said now, and do not count as called yet."""
        return ()

    @property
    def has_won(self) -> tuple[str, ...]:
        """Who has won in this game, in order."""
        return tuple(dict.fromkeys(one.person for one in self.all_wins))

    @property
    def all_wins(self) -> tuple[Won, ...]:
        """The wins of this game, in order."""
        return self._with_win(self._finisher) if self.tracker.finished else self._past_wins

    def _with_win(self, person: str) -> tuple[Won, ...]:
        """Return all wins, with one by the present pattern that a person may have made."""
        label, called = self.patterns.label, self.called_now
        known = any((one.person, one.pattern) == (person, label) for one in self._past_wins)
        if known or person not in self.people:
            return self._past_wins
        return (*self._past_wins, Won(person, label, len(called), called[-1] if called else 0))

    @property
    def _finisher(self) -> str:
        """The person with whom the game was finished."""
        queue, place = self.tracker.queue, self.tracker.place
        return place if place in queue or not queue else queue[0]

    def numbers_on(self, card: int) -> tuple[int, ...] | None:
        """Return the numbers of a card row by row; None if there is no such card."""
        raise NotImplementedError

    def holder(self, card: int) -> str:
        """Return the person who has a card; "" if unknown."""
        raise NotImplementedError

    @property
    def known_cards(self) -> dict[str, int]:
        """The people whose cards are known, with the numbers of these."""
        raise NotImplementedError

    def wins(self, card: int) -> bool | None:
        """Return whether a card wins by the called numbers; None if there is no such card."""
        numbers = self.numbers_on(card)
        if numbers is None:
            return None
        deck = self.patterns.played
        return deck.wins(called_cells(deck, numbers, set(self.called_now)))

    def is_won_before(self, person: str) -> bool:
        """Return whether the only winner is somebody else, whose claim was checked first."""
        return not self.game_plan.several and bool(self.vouched - {person})

    def judged(self, place: str, state: str | None) -> str | None:
        """Return the user state at a place; a verified claim counts as a win."""
        return winning_state(self.activity.user_states) if place in self.vouched else state

    @property
    def due(self) -> DueChange | None:
        """Return the change that is due before the next behaviour, or None."""
        tracker = self.tracker
        if tracker.place in tracker.queue or (tracker.place != FRONT and not self.all_called):
            self._visited[tracker.place] = len(self.called_now)
        if self._asked_before is not None:
            self._asked_before &= {*tracker.queue} - {tracker.closed}
        if tracker.finished:
            person = self._finisher if tracker.queue else ""
            if self.game_plan.several and (self._may_win_as_well(person) or self._unseen):
                return DueChange("others first", person)
            return DueChange("played on", person) if self.patterns.left else None
        if self.winner and not self._may_win_as_well(self.winner) and not self._unseen:
            return DueChange("played on" if self.patterns.left else "won", self.winner)
        if len(self.called_now) >= len(self.own_deck.numbers):
            return self._visit_due() if self.all_called else DueChange("all called")
        if calls := self._calls_due():
            return DueChange("calls first", number=calls)
        return self._visit_due()

    def _may_win_as_well(self, winner: str) -> list[str]:
        """Return who asked before somebody won, and may have the pattern at the same call.

        Those who ask later do not delay the end, nor do those whose card is known not to win; a
        claim that was checked always counts.
        """
        asked, known = self._asked_before, self.known_cards
        others = [person for person in self.tracker.queue if person != winner]
        waiting = [p for p in others if asked is None or p in asked]
        lose = {p for p in waiting if p in known and self.wins(known[p]) is False}
        return [p for p in others if p in self.vouched or (p in waiting and p not in lose)]

    def _calls_due(self) -> int:
        """Return how many calls come before the next visit; 0 for none."""
        tracker, rule = self.tracker, self.activity.rules.calls_first
        if not tracker.visits:
            self._row_began = self.seconds
        waits = tracker.place in tracker.queue or self.winner or self.vouched
        if rule is None or tracker.calls_first or waits or not tracker.queue:
            return 0
        here = len(self.people) - len(self.away)
        return rule.due(here, tracker.visits, self.seconds - self._row_began, self.pace)

    @property
    def _unseen(self) -> str:
        """The first person whose card was not checked since the last number; "" for none."""
        if not self.all_called:
            return ""
        here = (person for person in self.people if person not in self.away)
        return next((person for person in here if person not in self._visited), "")

    def calls_unvisited(self, person: str) -> int:
        """Return how many numbers have been called since the last visit to a person."""
        return len(self.called_now) - self._visited.get(person, 0)

    def _visit_due(self) -> DueChange | None:
        """Return the visit without a request that is due, or over.

        Who has had none for so many numbers waits from then on like those who ask, behind them.
        When all numbers have been called, each person gets one, and then the game is over.
        """
        queue, rules = self.tracker.queue, self.activity.rules
        if over := next((person for person in self.visiting if person not in queue), ""):
            return DueChange("visit over", over)
        if not self.tracker.begun():
            return None
        if self.all_called:
            if queue or self.tracker.place != FRONT:
                return None
            unseen, won = self._unseen, self.patterns.won
            return DueChange("visit", unseen) if unseen else DueChange("nobody won", number=won)
        if not self.game_plan.visits or not rules.unvisited or self.winner:
            return None
        others = [p for p in self.people if p not in self.away and p not in queue]
        longest = max(others, key=self.calls_unvisited, default="")
        due = longest and self.calls_unvisited(longest) >= rules.unvisited
        return DueChange("visit", longest) if due else None

    # ---------------------------------------------------------------------- changes

    def change(self, change: GameChange) -> None:
        """Apply a change."""
        person = change.person
        if change.what in ("others first", "played on") and person:
            self._past_wins = self._with_win(person)
        match change.what:
            case "patterns chosen":
                self.patterns.follow_with(change.patterns)
            case "others first":
                self.winner = person
                self.vouched -= {person}
                self.tracker.set_aside(person)
                if self._asked_before is None:
                    self._asked_before = frozenset(self.tracker.queue)
                for other in reversed(self._may_win_as_well(person)):
                    self.tracker.first(other)
            case "played on":
                self.winner, self._asked_before = "", None
                self.vouched = frozenset()
                self.tracker.set_aside(person)
                if self.patterns.advance():
                    self._play_pattern()
                if self.all_called:  # each card may win by the next pattern
                    self._visited = {}
            case "won":
                self.winner, self._asked_before = "", frozenset()
                self._wins_by_word(person)
            case "claimed":
                earlier = [one for one in self.tracker.queue if one in self.vouched]
                self._wins_by_word(person)
                for one in reversed(earlier):
                    self.tracker.first(one)
            case "left":
                self.away |= {person}
                self._plan_without(self.plan_away | {person})
                self._asks_no_more(person)
            case "came":
                self.away -= {person}
                self._plan_without(self.plan_away - {person})
            case "visit":
                self.visiting = (*self.visiting, person)
                self._asks(person)
            case "calls first":
                self.tracker.calls_first = change.number
            case "visit put off" | "visit over":  # logs of 0.6.0 and before have the first
                self.visiting = tuple(one for one in self.visiting if one != person)
                self._asks_no_more(person)  # a resumed game may have ended it between two steps
            case "all called":
                self.all_called, self._visited, self.tracker.calls_first = True, {}, 0
            case "nobody won":
                pass  # the game is over
            case "taken back":
                self.all_called = False
                self._take_back(change.number)
            case "several winners" | "one winner":
                self.game_plan = replace(self.game_plan, several=change.what == "several winners")
            case "visits on" | "visits off":
                self.game_plan = replace(self.game_plan, visits=change.what == "visits on")
            case "pace":
                self.set_pace(change.seconds)

    def _plan_without(self, away: frozenset[str]) -> None:
        """Set the people absent from the next game."""
        self.game_plan = replace(self.game_plan, absent=tuple(sorted(away)))

    def _wins_by_word(self, person: str) -> None:
        """Let a person win whatever is observed; the robot goes there to celebrate."""
        self.vouched |= {person}
        self.tracker.calls_first = 0
        self._asks(person)
        self.tracker.first(person)

    def _asks(self, person: str) -> None:
        """Open a request for a person who did not ask."""
        self.tracker.ask(person)

    def _asks_no_more(self, person: str) -> None:
        """Remove a person's request."""
        if person in self.tracker.queue:
            self.tracker.queue.remove(person)

    def _take_back(self, number: int) -> None:
        """Make a number count as not called."""
        raise NotImplementedError

    def announce(self, text: str) -> None:
        """Announce something to the group, if the world can speak."""


def as_planned(world: object) -> PlannedGame | None:
    """Return the world if staff can plan its games, which need cards; else None."""
    return world if isinstance(world, PlannedGame) and world.activity.deck.columns else None
