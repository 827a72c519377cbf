"""A simulated room for any declared activity: the interpreter, and people who act at random.

Time advances with each behaviour: by the duration of its speech, and a pause in which people may
act. Random streams for items, people and compliance have separate seeds; only `Random.random` is
used.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.acts import Act, acts, raw, take_in
from tangy_profiles.declared.game import Execution
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.declared.lots import drawn_game
from tangy_profiles.declared.progress import ProgressWatch
from tangy_profiles.declared.silence import silence
from tangy_profiles.declared.situation_words import value_words
from tangy_profiles.declared.speech import again, media, words
from tangy_profiles.declared.vocabulary import HERE, NO, YES
from tangy_profiles.faults import Remedy
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.health import Health
from tangy_profiles.past_game import PastGame
from tangy_profiles.robot import Robot
from tangy_profiles.scene import Scene
from tangy_profiles.state import EVERYBODY, ActivityState, Outcome, Response, UnclearAnswer
from tangy_sim.worlds.clarity import Clarity
from tangy_sim.worlds.compliance import Preferences, preferences_in_turn, respond
from tangy_sim.worlds.devices import well
from tangy_sim.worlds.users import load_users

SECONDS_A_WORD = 0.4  # s
ASKING_AGAIN = 6.0  # s until a person has repeated an answer


class DeclaredWorld:
    """A room in which games of a declared activity are played.

    The same seed and the same actions give the same games on every machine.
    """

    played_in: GameWorld = SIMULATED
    game_plan = GamePlan()

    def __init__(
        self,
        activity: DeclaredActivity,
        people: Sequence[str],
        *,
        seed: int,
        preferences: Preferences | None = None,
        unclear: float = 0.0,
        robot: Robot | None = None,
    ) -> None:
        """Create the room.

        Args:
            activity: the activity.
            people: ids of the people who take turns.
            seed: seed of the random generators.
            preferences: each person's probability of complying with each strategy.
            unclear: probability that an answer to be judged is unclear.
            robot: the robot whose devices `health` reports; None: all simulated devices.
        """
        self._well = well(robot)
        self.activity: Activity = activity
        self._declaration = activity.declaration
        self.people = tuple(people)
        self.preferences = preferences or preferences_in_turn(
            self.people, tuple(activity.strategies), load_users()
        )
        self._items = Random(f"{seed}/items").random
        self._people_draw = Random(f"{seed}/people").random
        self._clarity = Clarity(seed, unclear)
        self._compliance = Random(f"{seed}/compliance")
        self.begin()

    @property
    def seconds(self) -> float:
        """Time in this game, in s."""
        return self.game.now

    @property
    def pauses(self) -> tuple[int, float]:
        """Number and total s of the robot's waits for late data: always 0."""
        return 0, 0.0

    def begin(self) -> ActivityState:
        """Begin a new game with shuffled items, and return its first state."""
        self.game = drawn_game(self._declaration, self.people, self._items)
        for person in self.game_plan.absent:
            self.game.observe(HERE, person, NO)
        self._progress = ProgressWatch(self.game)
        self.over = False
        self.happened: dict[str, list[Act]] = {}
        """People's actions after the last behaviour, in order; "" is the whole group."""
        self._not_clear: list[UnclearAnswer] = []
        self._asked_again: dict[str, int] = {}
        return self.observe()

    def resume(self, past: PastGame) -> ActivityState:
        """Resume an interrupted game, or raise NotResumable."""
        return past.replay(self)

    @property
    def away(self) -> frozenset[str]:
        """People who have left, or have not come yet."""
        return frozenset(self.people) - frozenset(self.game.here)

    def choose(self, plan: GamePlan) -> None:
        """Play the next game with the people of a plan; other choices are ignored."""
        self.game_plan = plan

    def change(self, change: GameChange) -> None:
        """Let a person leave or come back, in this game and the next."""
        if change.what in ("left", "came"):
            self.game.observe(HERE, change.person, YES if change.what == "came" else NO)
            self.game_plan = replace(self.game_plan, absent=tuple(sorted(self.away)))

    def observe(self) -> ActivityState:
        """Return the current joint state."""
        return joint_state(self.game)

    def execute(self, action: Action) -> Outcome:
        """Execute an action of the robot, and then let people act."""
        game = self.game
        if game.over:
            return Outcome(False, 0.0, (), None)
        self._progress.begin(game)
        before, behaviour = game.copy(), action.behaviour.name
        pause = self._declaration.behaviours[behaviour].pause
        whom = None if action.target in (None, EVERYBODY) else action.target
        done = game.execute(behaviour, whom)
        self._progress.done(game)
        speech, image = (
            words(self.game, before, action.behaviour.name, action.strategy, whom)
            if done.completed
            else ("", "")
        )
        _, sound = media(game, behaviour) if done.completed else (None, None)
        seconds = 1.0 + SECONDS_A_WORD * len(speech.split()) + (sound.seconds if sound else 0.0)
        self.happened.clear()
        self._not_clear.clear()
        response = self._respond(done, action)
        self._pass(seconds)
        self.over = game.over
        if not game.over:
            self._let_people_act(pause)
            if done.completed and whom is not None:
                self._ask_silent(behaviour, whom)
        seconds += pause + ASKING_AGAIN * sum(one.asked_again for one in self._not_clear)
        unclear, led = tuple(self._not_clear), self._progress.end(self.game)
        left = self.game.rounds_left if self.over else 0
        return Outcome(done.completed, seconds, (), response, speech, image, unclear, led, left)

    def words_of(self, act: Act) -> str:
        """Describe what a person did, in the words of the file."""
        return value_words(self._declaration.facts[act.fact], act.value)

    def who(self, place: str) -> str:
        """Return who sits at a person's place: always that person."""
        return place

    def scene(self) -> Scene:
        """Return the scene for a screen to draw."""
        game = self.game
        asking = () if self.over else tuple(game.queue)  # after the game nobody is served
        doing = {
            one: ", ".join(self.words_of(act) for act in self.happened.get(one, ()))
            or ("asks for help" if one in asking else "watches")
            for one in self.people
        }
        return Scene(game.place, asking, doing, (), None, self.away)

    def health(self) -> Health:
        """Return the readings of devices without faults."""
        return self._well

    def recover(self, remedy: Remedy) -> float:
        """Do nothing, in 0 s: there are no faults to recover from."""
        return 0.0

    def _respond(self, done: Execution, action: Action) -> Response | None:
        """Let invited people comply, or not."""
        response: Response | None = None
        patience = self.activity.patience
        for person, fact, value in done.invited:
            for one in (person,) if person else self.game.here:
                reply = respond(self.preferences, one, action.strategy, patience, self._compliance)
                if person or reply.complied:
                    self._take_in(Act(fact, one, value))
                response = reply if person else None
        return response

    def _pass(self, seconds: float) -> None:
        """Advance the time while the robot speaks, in s."""
        self.game.now += seconds

    def _let_people_act(self, pause: float) -> None:
        """Let people act in a pause of a length in s."""
        self.game.now += pause
        for act in acts(self.game, drawn=self._people_draw):
            if self._understood(act):
                self._take_in(act)

    def _ask_silent(self, behaviour: str, who: str) -> None:
        """Ask a silent person again, with the file's sentences, as often as the limits allow."""
        game, seen = self.game, self.game.seen()
        for _ in again(game, behaviour, who):
            answers = any(one.person == who and one.said for one in self._not_clear)
            if answers or who in self.happened or game.seen() != seen:
                return
            asks = self._may_ask_again(who)
            self._not_clear.append(silence(game, who, asked_again=asks))
            if not asks:
                return
            for act in acts(game, drawn=self._people_draw):
                if act.who == who and self._understood(act):
                    self._take_in(act)

    def _understood(self, act: Act) -> bool:
        """Return whether an act is understood, after asking again if an answer is unclear.

        An unclear answer is observed as unclear, and not judged.
        """
        fact = self._declaration.facts[act.fact]
        if not fact.checks or act.who is None:
            return True
        asks = True
        while asks:
            certainty = self._clarity.certainty()
            if certainty >= CERTAIN:
                return True
            take_in(self.game, act, certainty)
            said, asks = raw(self.game, fact, act.value), self._may_ask_again(act.who)
            self._not_clear.append(
                UnclearAnswer(act.who, act.fact, said, certainty, "simulated", asks)
            )
        return False

    def _may_ask_again(self, who: str) -> bool:
        """Return whether a person may be asked again, and let that time pass; limited in a row."""
        times = self._asked_again.get(who, 0)
        if times >= self.activity.asking.visit:
            return False
        self._asked_again[who] = times + 1
        self.game.now += ASKING_AGAIN
        return True

    def _take_in(self, act: Act) -> None:
        if take_in(self.game, act):
            self.happened.setdefault(act.who or "", []).append(act)
            self._asked_again.pop(act.who or "", None)
