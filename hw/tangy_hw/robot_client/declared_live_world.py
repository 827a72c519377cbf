"""The live world of an activity declared by facts.

The interpreter keeps the facts, as in the simulated room. They change with observations (signs,
reports by staff, heard answers) and with the behaviours that the robot has carried out.
"""

from __future__ import annotations

from collections import deque
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tangy_hw.device_protocols import DeviceError, Picture
from tangy_hw.robot_client.chest_picture import chest_picture, standing_picture
from tangy_hw.robot_client.declared_tracker import DeclaredTracker
from tangy_hw.robot_client.fact_observation import FactObservation
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.stop_latch import ALONE
from tangy_profiles.behaviour import Action
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.game import DeclaredGame, Execution
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.declared.lots import drawn_game
from tangy_profiles.declared.memory import GameMemory, game_from, memory_of
from tangy_profiles.declared.model import PAUSE_SECONDS
from tangy_profiles.declared.player_reports import PlayerReport, read_report
from tangy_profiles.declared.progress import ProgressWatch
from tangy_profiles.declared.silence import silence
from tangy_profiles.declared.situation_words import words_now
from tangy_profiles.declared.speech import again, media, with_names, words
from tangy_profiles.declared.typed_observations import meant
from tangy_profiles.declared.vocabulary import ASKING, HERE, NO, YES
from tangy_profiles.defaults import ASK_AGAIN
from tangy_profiles.past_game import FACTS_UNKNOWN, OTHER_PEOPLE, OTHERWISE, NotResumable, PastGame
from tangy_profiles.scene import Scene
from tangy_profiles.state import EVERYBODY, FRONT, ActivityState, Outcome, Response, UnclearAnswer

if TYPE_CHECKING:
    from tangy_profiles.game_records import GameChange

SIGN = "sign"
"""The source of answers that people hold up."""
LOOK_SECONDS = 0.5  # between two observations of people
PATIENCES = 2.0  # windows of patience after which a person counts as not complying


class DeclaredLiveWorld(LiveWorld):
    """A room with a robot and people who play an activity declared by facts."""

    activity: DeclaredActivity
    game: DeclaredGame
    ahead: DeclaredGame
    """The game as it will be after the behaviour that the robot performs, else as it is."""
    sees_all = False
    """Whether everything that people do is reported, so that no report means no action."""

    def __init__(self, activity: DeclaredActivity, *both: Any, **named: Any) -> None:
        """Create the world of a robot that is switched on, as `LiveWorld` does."""
        self._told: deque[FactObservation] = deque()
        self.saying = self.said_before = ""
        """The speech of the behaviour in progress, with people by their ids; "": none yet."""
        self.unsure: FactObservation | None = None
        """Latest observation too uncertain to be judged: the person is asked again."""
        super().__init__(activity, *both, **named)

    def _begin(self) -> None:
        super()._begin()
        self.game = drawn_game(self.activity.declaration, self.people, self._order.random)
        for person in sorted(self.away):
            self.game.observe(HERE, person, NO)
        self.ahead, self.saying, self.said_before = self.game, "", ""
        self._progress = ProgressWatch(self.game)
        self.tracker = DeclaredTracker(self.activity, self.game)
        self._started = self.link.time
        self._did: dict[str, list[str]] = {}
        self._told.clear()
        self.unsure = None
        self._signs_up: dict[tuple[int, str, float], bool] = {}  # and whether each was sure
        self._asked_again: dict[str, int] = {}
        self._not_clear: list[UnclearAnswer] = []

    def resume(self, past: PastGame) -> ActivityState:
        """Resume an interrupted game, with the facts from the log.

        People who asked by a sign count as asking by word, because nobody holds up a sign
        meanwhile.

        Raises:
            NotResumable: other people take part, the activity was changed, or the log's version has
                no facts.
        """
        last = past.steps[-1]
        if past.beginning.people != self.people:
            raise NotResumable(OTHER_PEOPLE)
        if last.memory is None:
            raise NotResumable(FACTS_UNKNOWN)
        game = game_from(self.activity.declaration, self.people, last.memory)
        if game is None:
            raise NotResumable(OTHERWISE)
        for _ in range(past.beginning.number):
            self._begin()  # each game of a run has its own order of items
        self.game = self.ahead = game
        self.away = frozenset(self.people) - frozenset(game.here)
        self._plan_without(self.away)
        self.tracker = DeclaredTracker(self.activity, game)
        for change in past.since_step:
            self.change(change)
        self._started = self.link.time - game.now
        waits, asked = past.waits(self.activity), (*game.queue, *past.asked_for)
        self.requests.wait_on({p: waits.get(p, 0.0) for p in asked if p not in self.away})
        self.over = False
        self.commands.settle()
        self.commands.await_tablets()
        self.said_before, picture = standing_picture(game, self.seat_of)
        if picture is not None:
            with suppress(DeviceError):  # a dark screen is a fault of its own
                self.commands.perform("", picture)
        return self.observe()

    def change(self, change: GameChange) -> None:
        """Let a person leave or come back, in this game and the next."""
        super().change(change)
        if change.what in ("left", "came"):
            self.game.observe(HERE, change.person, YES if change.what == "came" else NO)

    @property
    def memory(self) -> GameMemory:
        """Everything known about the game now, for the log."""
        return memory_of(self.game)

    # ------------------------------------------------------------------------ observations

    def tell(
        self, who: str | None, said: str, certainty: float = 1.0, source: str = "staff"
    ) -> PlayerReport | None:
        """Add a report about a person, or their answer; it takes effect at the next observation.

        Args:
            who: the player; None if nobody is named.
            said: the words.
            certainty: their certainty, as a probability.
            source: source of the report, for the log.

        Returns:
            What the words state, taken in if it counts; None if they state no fact.
        """
        told = None if self.over else read_report(self.ahead, who, said, certainty, source)
        if told and told.counts:
            self.take(FactObservation(told.meant, certainty, source))
        return told

    def take(self, observed: FactObservation) -> None:
        """Add an observation of a fact; it takes effect at the next `observe`."""
        self._told.append(observed)

    def observe(self) -> ActivityState:
        """Return the joint state as it is known now."""
        if not self.over:
            self._listen()
            self._take_in()
            self.requests.tell(self.tracker)
        return joint_state(self.game)

    def look_again(self) -> ActivityState:
        """Return the joint state a moment later: there is nothing to read again."""
        return self.observe()

    def read_card(self, person: str, after: float = 0.0) -> None:
        """Do nothing, whatever the time `after` in s: there are no cards."""

    def _listen(self) -> None:
        """Take in the answer signs that were put up since, or that are sure only now."""
        before, self._signs_up = self._signs_up, {}
        for seat, letter, since, sure in self.link.state.shows:
            key = seat, letter, since
            certain = sure >= CERTAIN
            self._signs_up[key] = certain or before.get(key, False)
            known = key in before and (before[key] or not certain)
            if known or seat > len(self.people):
                continue
            found = meant(self.game, self.people[seat - 1], letter)
            fact = None if found is None else self.game.declaration.facts[found.fact]
            if found is not None and fact is not None and SIGN in fact.sources:
                self.take(FactObservation(found, sure, SIGN))

    def _take_in(self) -> None:
        """Apply the observations since the last look, each with its certainty."""
        while self._told:
            observed = self._told.popleft()
            fact, who, raw = observed.told
            self.game.now = self.link.time - self._started
            if observed.certainty < CERTAIN:
                self._note_unclear()  # nobody has asked again about the previous one
                self.unsure = observed
                continue
            if self.unsure is not None and self.unsure.told.who == who:
                self._note_unclear()  # repeated without being asked
            self._asked_again.pop(who or "", None)
            if fact == ASKING and who is not None:
                self.requests.ask_for(who)
            if self.game.observe(fact, who, raw, observed.certainty) and who is not None:
                self._did.setdefault(who, []).append(words_now(self.game, fact, who))

    # ------------------------------------------------------------------------ behaviours

    def execute(self, action: Action) -> Outcome:
        """Execute an action of the robot, and let people act; it can be aborted."""
        began = self.link.time
        if self.over:
            return Outcome(False, 0.0, (), None)
        name, game = action.behaviour.name, self.game
        whom = None if action.target in (None, EVERYBODY) else action.target
        game.now = self.link.time - self._started
        self._progress.begin(game)
        speech = image = self.broken = ""
        response: Response | None = None
        done = Execution(False)
        try:
            if game.allows(name, whom):
                speech, image = self._perform(action, whom)
                done = self._count(name, whom)
                self._progress.done(game)
                response = self._watch(done, action)
        except DeviceError as error:
            self.broken = str(error)
        self.ahead = game
        if not done.completed:
            game.failed()
        self.over = game.over
        self.commands.settle()
        if not self.broken and not self.over:
            self._let_people_act(name if done.completed else "", whom)
        seconds = max(0.0, self.link.time - began)
        unclear, self._not_clear = tuple(self._not_clear), []
        led, left = self._progress.end(game), game.rounds_left if self.over else 0
        told = (unclear, led, left, self.broken == ALONE)
        return Outcome(done.completed, seconds, (), response, speech, image, *told)

    def _perform(self, action: Action, whom: str | None) -> tuple[str, str]:
        """Speak, show, gesture and drive; return speech and picture text.

        Raises:
            DeviceError: it was aborted.
        """
        behaviour, game = action.behaviour, self.game
        drives = behaviour.drives
        if not drives and not self.lost:
            self._remedies.go_back(knows_place=True)  # staff may have driven it
        after = game.copy()
        after.execute(behaviour.name, whom)
        speech, image = words(after, game, behaviour.name, action.strategy, whom)
        self.ahead, self.saying, self.said_before = after, speech, ""
        _, heard = media(after, behaviour.name)
        self.say(
            with_names(speech, self.name_of),
            chest_picture(after, behaviour.name, whom, image, self.seat_of),
            self._robot.postures.get(action.posture, {}),
            with_names(speech, self.seat_of),
            heard.path if heard else "",
        )
        if drives and not self._arrives(after.place):
            raise DeviceError("The robot did not get there.")
        return speech, image

    def _arrives(self, place: str) -> bool:
        """Drive to a place, and identify the person there; return whether the robot has arrived."""
        if not self.drive(place):
            return False
        if place != FRONT and self.knows_faces:
            self._see_who(place)
        return True

    def _count(self, name: str, whom: str | None) -> Execution:
        """Count an executed behaviour, and wait for the signs of settled requests to come down."""
        asked = list(self.game.queue)
        done, self.ahead = self.game.execute(name, whom), self.game
        self._did.clear()
        for person in asked:
            if person in self.game.queue or self.game.over:
                continue
            if self.requests.stays_up(person):  # the request is not settled
                self.tracker.ask(person)
                self.game.closed = None
        return done

    def _watch(self, done: Execution, action: Action) -> Response | None:
        """Watch whether an invited person complies; None if that is unknown."""
        asked = next(((who, fact, value) for who, fact, value in done.invited if who), None)
        if asked is None:
            return None
        who, fact, value = asked
        began = before = self.link.time
        patience = self.activity.patience
        with self.commands.waiting_for("response", who, PATIENCES * patience):
            while True:
                self.commands.wait(LOOK_SECONDS)
                self._hear()
                now = self.link.time
                seconds = (before + now) / 2 - began  # it was done between the two looks
                if self.game.value(fact, who) == value:
                    return Response(who, action.strategy, True, seconds <= patience, seconds)
                if now - began > PATIENCES * patience:
                    missed = Response(who, action.strategy, False, False, now - began)
                    return missed if self.sees_all else None
                before = now

    def _let_people_act(self, behaviour: str, whom: str | None) -> None:
        """Wait until people have changed the state that the policy sees, at most for the pause.

        A person whom the behaviour addressed, and who does nothing in the pause, is asked again in
        the words of the file, and given another pause, which no timer ends.
        """
        declared = self.activity.declaration.behaviours.get(behaviour)
        pause = PAUSE_SECONDS if declared is None else declared.pause
        seen, until = self.game.seen(), self.link.time + pause
        words = again(self.game, behaviour, whom) if behaviour and whom is not None else []
        silent = not self._did.get(whom or "")
        held: float | None = None  # when the person was asked again
        try:
            while self.link.time < until and self.game.seen(held) == seen:
                with self.commands.waiting_for("act", whom or "", until - self.link.time):
                    self.commands.wait(LOOK_SECONDS, asks=True)
                self._hear()
                silent = silent and self.unsure is None and not self._did.get(whom or "")
                until += self._ask_again()
                over = self.link.time >= until and self.game.seen() == seen
                if over and silent and whom and words:
                    held, waits = self.game.now, self._ask_silent(words, whom, pause)
                    until = self.link.time + waits
        except DeviceError:  # the devices' readings show the problem
            return

    def may_ask_again(self, person: str | None) -> bool:
        """Return whether a person may be asked again after an unclear answer."""
        return person is not None and self._asked_again.get(person, 0) < self.activity.asking.visit

    def _note_unclear(self, *, asked_again: bool = False) -> None:
        """Record the unjudged answer for the log, and drop it."""
        observed, self.unsure = self.unsure, None
        if observed is None or not (who := observed.told.who):
            return
        fact, _, said = observed.told
        self._not_clear.append(
            UnclearAnswer(who, fact, said, observed.certainty, observed.source, asked_again)
        )

    def _ask_again(self) -> float:
        """Ask a person with an unclear answer again; return the duration in s.

        Raises:
            DeviceError: it could not be said or shown.
        """
        person = None if self.unsure is None else self.unsure.told.who
        asks = self.may_ask_again(person)
        self._note_unclear(asked_again=asks)
        if person is None or not asks:
            return 0.0
        began, times = self.link.time, self._asked_again.get(person, 0)
        self._asked_again[person] = times + 1
        text, seat = ASK_AGAIN[times % len(ASK_AGAIN)], self.seat_of(person)
        shown = Picture(text.replace("{name}", seat), asks=seat)
        self.say(text.replace("{name}", self.name_of(person)), shown)
        return self.link.time - began

    def _ask_silent(self, words: list[str], who: str, pause: float) -> float:
        """Ask a silent person again, if allowed; return how long to wait, in s.

        Raises:
            DeviceError: it could not be said or shown.
        """
        asks = self.may_ask_again(who) and who not in self.game.queue
        self._not_clear.append(silence(self.game, who, asked_again=asks))
        text = words.pop(0)
        if not asks:
            words.clear()
            return 0.0
        self._asked_again[who] = self._asked_again.get(who, 0) + 1
        shown = Picture(with_names(text, self.seat_of), asks=self.seat_of(who))
        self.say(with_names(text, self.name_of), shown)
        return pause

    def _hear(self) -> None:
        """Update the game with what people do now, also on a stepped bench."""
        self.commands.settle()
        self.game.now = self.link.time - self._started
        self._listen()
        self._take_in()
        self.requests.tell(self.tracker)

    def scene(self) -> Scene:
        """Return the scene for a screen to draw."""
        scene = super().scene()  # its tracker is a view of the game
        did = {who: ", ".join(acts) for who, acts in self._did.items()}
        return replace(scene, doing={**scene.doing, **did})
