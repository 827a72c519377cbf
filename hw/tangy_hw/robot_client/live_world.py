"""The real world for facilitation and monitoring: the interface to a connected robot.

It keeps the state of the game (called numbers, the card read, whose turn it is) by the same rules
as the simulated world (`Tracker`), and updates it with the robot's observations: cards and faces in
images, signs, the place of arrival. Responses to requests are observed within the activity's
patience or later.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from math import pi
from random import Random
from typing import Any, assert_never

from tangy_hw.device_protocols import DeviceError, Picture, Pose
from tangy_hw.robot_client.card_observations import CardObservations
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.commands import Commands
from tangy_hw.robot_client.count_down import CountDown
from tangy_hw.robot_client.help_requests import HelpRequestTracker
from tangy_hw.robot_client.live_plan import CallOrder, LivePlan
from tangy_hw.robot_client.recovery_actions import RecoveryActions
from tangy_hw.robot_client.response_watch import LOOK_SECONDS, watch_response
from tangy_hw.robot_client.staff_card_reports import StaffCardReports
from tangy_hw.robot_process.drive_monitor import LOST_SPREAD
from tangy_hw.robot_process.stop_latch import ALONE, Preempted
from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.faults import Remedy
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_world import LIVE, GameWorld
from tangy_profiles.health import Health
from tangy_profiles.known_cards import KnownCards
from tangy_profiles.known_devices import reads_cards
from tangy_profiles.past_game import PastGame
from tangy_profiles.robot import Robot
from tangy_profiles.room import Point, Room
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT, ActivityState, Outcome, Response
from tangy_profiles.tracker import Tracker

PACE_SECONDS = 30.0
"""Minimum time between calls, so that all can look and mark; about as in the paper."""
FACING = pi / 2  # heading of the robot when it faces the people


class LiveWorld(LivePlan):
    """A room with a robot and people. `begin` starts each game, `execute` runs behaviours."""

    played_in: GameWorld = LIVE

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        link: RobotLink,
        robot: Robot,
        room: Room,
        *,
        seed: int,
        names: Mapping[str, str] | None = None,
        pace: float = PACE_SECONDS,
        knows_faces: bool = False,
    ) -> None:
        """Create the world of a robot that is switched on.

        Args:
            activity: the activity.
            people: ids of the participants, in the order of their seats.
            link: the robot process.
            robot: the robot's profile.
            room: the room, with table and seats.
            seed: seed of the order of the numbers.
            names: people's names, by id.
            pace: s between calls.
            knows_faces: whether the robot identifies the person that it has come to.
        """
        self.activity, self.own_deck = activity, activity.deck
        self.people = tuple(people)
        self.over = True
        self.broken = ""
        """Why the last behaviour was aborted, "" if it was not."""
        self.link = link
        self.commands = Commands(link)
        self.cards = CardObservations(activity, self.commands)
        sees = reads_cards(robot) or not activity.deck.columns
        self.eyes = None if sees else StaffCardReports(activity, self.commands)
        """Staff who report the cards, if the robot has no camera that reads them."""
        self._remedies = RecoveryActions(self)
        self._robot = robot
        self._room = room
        self._names = dict(names or {})
        self.pace = pace
        self.knows_faces = knows_faces
        self._order = Random(f"{seed}/calls")
        self._paused = (0, 0.0)  # pauses before this game
        self.requests = HelpRequestTracker(
            self.people, self.commands, robot.devices.get("requests")
        )
        self._begin()

    def _begin(self) -> None:
        self.begin_plan()
        self.tracker = Tracker(self.activity, self.people)
        self.calls = CallOrder(self.activity.deck.shuffled(self._order.random))
        self.cards.begin()
        self.requests.begin(self.away)
        self.sitting: dict[str, str] = {}
        """People seen at other places than their own in this game."""
        self._count_down = CountDown(lambda: self.link.time)

    def begin(self) -> ActivityState:
        """Begin a new game and return its first state."""
        self._begin()
        self._paused = self.link.state.pauses
        self.over = False
        with suppress(DeviceError):  # if it fails, the first behaviour tries again
            self._remedies.go_back(knows_place=not self.lost)
        self.commands.settle()
        return self.observe()

    def resume(self, past: PastGame) -> ActivityState:
        """Resume an interrupted game, or raise NotResumable."""
        for _ in range(past.beginning.number):
            self._begin()  # each game of the run has its own order

        def change(one: GameChange) -> None:
            self.calls.called = past.called_by(self.activity, one.steps)  # for wins of that time
            self.change(one)

        past.follow(self.tracker, change)
        asked = (*self.tracker.queue, *past.asked_for)  # these after the last step
        waits = past.waits(self.activity)
        self.requests.wait_on({p: waits.get(p, 0.0) for p in asked if p not in self.away})
        self.calls.resume(past, self.activity)
        self._visited = past.visited(self.activity)
        self._row_began = self.seconds - past.since_call(self.activity)
        self._recall(past.cards)
        self._remedies.looks_first = self.tracker.place in self.tracker.queue
        self.over = False
        self.commands.settle()
        self.commands.await_tablets()
        return self.observe()

    def _recall(self, cards: KnownCards) -> None:
        """Know again whose card it was in an interrupted game."""
        self.cards.dealt.recall(cards.given, cards.seen)

    @property
    def called(self) -> list[int]:
        """Numbers that count as called, the latest last."""
        return self.calls.called

    @property
    def lost(self) -> bool:
        """Whether the robot is not localised: its possible poses are too far apart."""
        health = self.link.health()
        facts = next((r.facts for r in health if r.device == "localisation"), {})
        return float(facts.get("spread", 0.0)) >= LOST_SPREAD

    def observe(self) -> ActivityState:
        """Return the current joint state, as the robot's sensors see it."""
        if not self.over:
            self.requests.tell(self.tracker)
        return self.tracker.state()

    def look_again(self) -> ActivityState:
        """Take a second look at the card beside the robot; return the new state.

        A stop, or an error, ends the look at once.
        """
        with suppress(DeviceError):
            place = self.tracker.place
            if place in self.tracker.queue and not self.over and self.eyes is None:
                with self.looking_at(place):
                    self.read_card(place, after=LOOK_SECONDS)
            self.commands.settle()
            self.link.beat()
        return self.observe()

    # ------------------------------------------------------------------------ behaviours

    def execute(self, action: Action) -> Outcome:
        """Execute an action of the robot, and observe the outcome; it can be aborted."""
        behaviour, began = action.behaviour, self.link.time
        if self.over:
            return Outcome(False, 0.0, (), None)
        numbers: tuple[int, ...] = ()
        response: Response | None = None
        succeeded, obsolete, self.broken = False, False, ""
        try:
            if self.tracker.allows(behaviour):
                if not behaviour.drives and not self.lost:
                    obsolete = self._remedies.take_place()  # staff may have driven it
                found = None if obsolete else self._numbers_of(action)
                if found is not None:
                    numbers = found
                    response, succeeded = self._carry_out(action, numbers)
        except DeviceError as error:
            self.broken, numbers, self.calls.calling = str(error), (), ()
        self._executed(behaviour, succeeded)
        self.commands.settle()
        if not self.broken and not self.over:
            self.requests.look_twice(self.tracker)
        seconds, cut = max(0.0, self.link.time - began), self.broken == ALONE
        return Outcome(succeeded, seconds, numbers, response, cut_short=cut, obsolete=obsolete)

    def _numbers_of(self, action: Action) -> tuple[int, ...] | None:
        """Return the numbers of an action; None if there is nothing to ask."""
        match action.behaviour.effect:
            case "draw":
                return self.calls.next
            case "clear wrong marks" | "set missing marks":
                return (self.eyes or self.cards).asked_about(action.behaviour)
            case "none" | "bring card closer" | "go to user" | "go to front" | "finish":
                return ()
            case forgotten:
                assert_never(forgotten)

    def _carry_out(self, action: Action, numbers: tuple[int, ...]) -> tuple[Response | None, bool]:
        """Carry it out; return a person's response, and whether the robot has done its part."""
        behaviour, tracker = action.behaviour, self.tracker
        if behaviour.calls:
            self._keep_pace()
        if behaviour.shows_card and self.eyes is not None:
            self.read_card(tracker.place)  # no camera: nobody need move the card
            return None, True
        self._announce(action, numbers)
        match behaviour.effect:
            case "draw":
                self.calls.count(numbers)
                self._count_down.begin(self.pace)
                with suppress(Preempted):  # it counts as called, whatever happens now
                    self.commands.wait(min(self.pace, LOOK_SECONDS), asks=True)
            case "go to user":
                target = action.target or (tracker.queue[0] if tracker.queue else None)
                return None, target is None or self._go(target)
            case "go to front":
                return None, self._go(FRONT)
            case "finish":
                self.over = True
            case "none" | "clear wrong marks" | "set missing marks" | "bring card closer":
                pass  # it is said and shown; the response is observed below
            case forgotten:
                assert_never(forgotten)
        if not behaviour.persuades or tracker.place == FRONT:
            return None, True
        if behaviour.only_talks and tracker.place not in self.requests.signs:
            return None, True  # the person's response cannot be observed
        return watch_response(self, action, numbers), True

    def _announce(self, action: Action, numbers: tuple[int, ...]) -> None:
        """Speak, show and gesture; the public screen shows seats instead of people's names."""
        name, fill, deck = self.name_of(action.target), self.activity.fill, self.activity.deck
        seat, behaviour = self.seat_of(action.target), action.behaviour
        called = self.calls.calling = numbers if action.behaviour.calls else ()
        picture = Picture(
            fill(action.image, seat, numbers),
            deck.label(called[0]) if called else "",
            self.calls.labels(deck),
            seat if behaviour.attends and not behaviour.persuades else "",
        )
        speech, written = (
            fill(action.speech, called, numbers, aloud=True) for called in (name, seat)
        )
        self.say(speech, picture, self._robot.postures.get(action.posture, {}), written)

    def name_of(self, person: str | None) -> str:
        """Return the name of the person who sits at a seat, "" for nobody."""
        if person is None:
            return ""
        sitting = self.who(person)
        return self._names.get(sitting, sitting)

    def who(self, place: str) -> str:
        """Return who sits at a place, by the robot's observations."""
        return self.sitting.get(place, place)

    def _keep_pace(self) -> None:
        if wait := self.calls_in:
            self.commands.wait(wait)

    def _go(self, place: str) -> bool:
        """Drive to a place; beside a person, identify them and look at the card."""
        if not self.drive(place):
            return False
        with self.looking_at(place):
            self.tracker.arrive(place)
            self._remedies.looks_first = False
            self.cards.leave()
            if self.eyes is not None:
                self.eyes.leave()
            if place != FRONT and self.knows_faces:
                self._see_who(place)
            if place in self.tracker.queue:
                self.read_card(place)
        return True

    def _see_who(self, place: str) -> None:
        """Identify the person at a place, to address them and attribute responses to them."""
        person = self.commands.do("face").get("person")
        self.cards.looked("face", place, person)
        if person in self.people:
            self.sitting.pop(place, None)
            if person != place:
                self.sitting[place] = person

    def drive(self, place: str) -> bool:
        """Drive to a place, whatever the state of the game; return whether it has arrived.

        Raises:
            DeviceError: it has to stop.
        """
        to = self.stand(place)
        done = self.commands.do("go", to=list(Pose(to.x, to.y, FACING)), name=place)
        return bool(done.get("arrived"))

    def stand(self, place: str) -> Point:
        """Return where the robot stands at a place of the game."""
        return self._room.stand(place, self.people)

    def read_card(self, person: str, after: float = 0.0) -> None:
        """Read the card beside the robot, `after` s from now, and keep the reading.

        A robot without a camera for cards asks staff.

        Raises:
            DeviceError: it cannot look.
        """
        if self.eyes is not None:
            state = None if person in self.vouched else self.eyes.ask(person, self.called)
            self.tracker.seen = self.judged(person, state)
            return
        sitting = self.who(self.tracker.place)
        card = self.cards.look(self.tracker.place, self.called, after, person=sitting)
        self.cards.looked("card", person, card)
        self.tracker.seen = self.state_on(card)

    def state_on(self, card: dict[str, Any]) -> str | None:
        """Return the user activity state of a card reading, None if unread."""
        state = str(card["state"])
        seen = state if state != self.activity.unread else None
        return self.judged(self.tracker.place, seen)

    def _executed(self, behaviour: Behaviour, succeeded: bool) -> None:
        """Count a behaviour; wait for the sign of a request that it settled to come down."""
        tracker, seen = self.tracker, self.tracker.seen
        tracker.executed(behaviour, succeeded=succeeded)
        closed = tracker.closed
        if closed is None or self.over:
            return
        if self.requests.stays_up(closed):  # the request is not settled
            tracker.queue.insert(0, closed)
            tracker.closed, tracker.seen = None, seen

    # ------------------------------------------------------------------------ scene

    def scene(self) -> Scene:
        """Return the scene for a screen to draw, with the signs that are up now."""
        tracker, asking, view = self.tracker, self.asking, self.cards.view
        doing = {p: "asks for help" if p in asking else "watches" for p in self.people}
        seen = view if view is not None and view.person == tracker.place else None
        place = self.link.state.going or tracker.place
        return Scene(place, asking, doing, tuple(self.called), seen, self.away)

    @property
    def pauses(self) -> tuple[int, float]:
        """Number and total s of the robot's waits for late data in this game."""
        (count, seconds), (before, until) = self.link.state.pauses, self._paused
        return max(0, count - before), round(max(0.0, seconds - until), 2)

    @property
    def seconds(self) -> float:
        """Time of the robot, in s."""
        return self.link.time

    def health(self) -> Health:
        """Return the readings of the robot's devices."""
        return self.link.health()

    def recover(self, remedy: Remedy) -> float:
        """Let the robot, a user or an expert handle a fault; return the duration in s.

        Not included: the time for which it stood still before. The clock of the game has that.
        """
        return self._remedies.do(remedy)
