"""The bench's people in an activity declared by facts.

They follow the game by the robot's speech, with the same interpreter, and act some seconds later,
with the probabilities in the activity's file. A wish for help is a sign; other actions are in
`acts`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from random import Random

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.acts import Act, acts, raw
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.declared.memory import GameMemory, game_from
from tangy_profiles.declared.model import Fact
from tangy_profiles.declared.vocabulary import ASKING, HERE, NO, YES, Named
from tangy_profiles.person import Person
from tangy_sim.device_simulator.faults import Faults
from tangy_sim.device_simulator.people import CLEAR, TURNS_DOWN, People
from tangy_sim.device_simulator.signs import LETTERS
from tangy_sim.device_simulator.sitters import Sitter
from tangy_sim.device_simulator.speech_reception import HeardLine
from tangy_sim.worlds.clarity import UNCLEAR, Clarity
from tangy_sim.worlds.compliance import respond
from tangy_sim.worlds.users import SimulatedUser

WHOSE_TURN: Named = "whose turn"
ACTS = (1.0, 6.0)  # s between a sentence and an action that follows it


class DeclaredPeople(People):
    """The group in such an activity: nobody has a card, and all follow the game by ear."""

    def __init__(
        self, activity: DeclaredActivity, people: Sequence[Person], faults: Faults, *, seed: int
    ) -> None:
        self._declaration = activity.declaration
        self._draw = Random(f"{seed}/people").random
        self._clarity = Clarity(seed, UNCLEAR)
        super().__init__(activity, people, faults, seed=seed)

    def begin(self, now: float) -> None:
        """Begin a game at a time in s."""
        super().begin(now)
        self._began = now
        self._unheard: dict[str, Act] = {}  # unclear answer of each person
        self.perceived: tuple[int, ...] = ()
        """Rows of the items whose picture or sound comes with the next sentence."""
        self.known = DeclaredGame(self._declaration, self.ids)
        """State of the game as the people understand it."""
        for person in self.asking:
            self.known.observe(ASKING, person, YES)

    def remember(self, memory: GameMemory) -> None:
        """Restore an interrupted game, in a room in which nobody holds up a sign."""
        game = game_from(self._declaration, tuple(self.ids), memory)
        if game is not None:
            self.known = game
            self._began = self.now - game.now
            self.game.opened = True

    def notice_away(self) -> None:
        """Update who has left, and who has come back."""
        for person in self.ids:
            self.known.observe(HERE, person, NO if person in self.away else YES)

    def _seat(self) -> dict[str, Sitter]:
        deck = self.activity.deck
        return {person: Sitter(SimulatedUser(person, deck, ()), 0) for person in self.ids}

    def judged(self, person: str) -> str:
        """Return the user activity state of a person without a card."""
        return self.activity.unread

    # -------------------------------------------------------------- what the robot does

    def step(self, now: float) -> None:
        """Advance the time to `now`, in s."""
        self.known.now = now - self._began
        super().step(now)

    def hear(self, heard: HeardLine) -> None:
        """React to a sentence that the robot has finished."""
        if heard.fault:
            self._asked_to_help(heard)
            return
        if heard.again:
            self._asked_again(heard.person or self.known.addressed or "")
            return
        behaviour, game = heard.behaviour, self.known
        if behaviour is None or self.game.over:
            return
        for person in self.shown:
            self._after(TURNS_DOWN, partial(self.shown.pop, person, None))
        declared = game.declaration.behaviours[behaviour.name]
        named = (game.whom(one) for one in declared.to)
        whom = heard.person or next((one for one in named if one is not None), None)
        whom = None if not heard.person and "group" in declared.to[:1] else whom
        by_lot = game.declaration.turns == "by lot"
        if heard.person and by_lot and declared.to == (WHOSE_TURN,):
            game.turn = game.players.index(heard.person)  # only the robot knows the lots
        done = game.execute(behaviour.name, whom)
        if heard.turn:
            game.turn = game.players.index(heard.turn)
        rows, self.perceived = heard.rows or self.perceived, ()
        if rows and game.row not in rows and game.row >= 0:
            order = list(game.order)
            order[game.round - 1] = rows[0]
            game.order = tuple(order)
        self.game.opened = True
        self.game.over = game.over
        for person in self.asking:
            if person not in game.queue:
                self._after(TURNS_DOWN, partial(self._closed, self.sitters[person]))
        for who, fact, value in done.invited:
            for one in (who,) if who else game.here:
                self._invited(Act(fact, one, value), heard.strategy)
        if not game.over:
            for act in acts(game, drawn=self._draw):
                self._after(ACTS, partial(self._acts, act))

    def _asked_again(self, person: str) -> None:
        """Let a person repeat an unclear answer, or answer after all."""
        act = self._unheard.pop(person, None)
        if self.game.over:
            return
        drawn = [act] if act is not None else list(acts(self.known, drawn=self._draw))
        for one in drawn:
            if one.who == person:
                self._after(ACTS, partial(self._acts, one))

    def ask(self, person: str) -> None:
        """Let a person raise their sign now."""
        self._acts(Act(ASKING, person, YES))

    def _invited(self, act: Act, strategy: str) -> None:
        """Let a person comply with a request: in time, late, or not at all."""
        patience, who = self.activity.patience, act.who or ""
        response = respond(self.preferences, who, strategy, patience, self._compliance)
        self.game.responses.append(response)
        if response.complied:
            seconds = response.seconds * (patience - CLEAR) / patience
            self._agenda.at(self.now + seconds, partial(self._acts, act))

    def _acts(self, act: Act) -> None:
        """Let a person act, if there is still a reason to."""
        game = self.known
        if not self._may(act):
            return
        fact = game.declaration.facts[act.fact]
        said = act.value if act.fact == ASKING else raw(game, fact, act.value)
        if self.game.over:
            return
        sure = self._clarity.certainty() if fact.checks and act.who is not None else 1.0
        if sure < CERTAIN and act.who is not None:
            self._unheard[act.who] = act
            self.game.acts.append((act.fact, act.who, said, sure))
            return
        if not game.observe(act.fact, act.who, said):
            return
        if act.fact == ASKING and act.who is not None:
            sitter = self.sitters[act.who]
            sitter.asks_since, sitter.visited = self.now, False
        elif letter := self._letter(fact, said):
            self.shown[act.who or ""] = letter
        else:
            self.game.acts.append((act.fact, act.who or "", said, sure))

    def _letter(self, fact: Fact, said: str) -> str:
        """Return the letter of an answer that is held up on a sign ("": it is not)."""
        if "sign" not in fact.sources:
            return ""
        items, row = self._declaration.items, self.known.row
        options = [items.value(row, column) for column in fact.options]
        return dict(zip(options, LETTERS, strict=False)).get(said, "")

    def _may(self, act: Act) -> bool:
        """Return whether the conditions of the habits for an action hold now."""
        habits = (one for one in self._declaration.habits if one.fact == act.fact)
        when = [condition for habit in habits for condition in habit.when]
        return all(self.known.holds(one, act.who) for one in when)

    def _turn_down(self, sitter: Sitter) -> None:
        super()._turn_down(sitter)
        self.known.observe(ASKING, sitter.id, NO)
