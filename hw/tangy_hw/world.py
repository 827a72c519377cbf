"""The real world, as facilitation and monitoring see it: the door to a robot that is there.

It keeps what the game is about (the numbers that were called, whose card was read, whose turn it
is) by the same rules as the simulated one (`Tracker`), and fills it with what the robot sees:
cards and faces in pictures, signs that ask, the place where it arrived. What people do about a
request that was put to them is observed, within the activity's patience or later.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from math import hypot, pi
from random import Random
from typing import Any

from tangy_hw.devices import DeviceError, Picture, Pose
from tangy_hw.robot import BrokenOff
from tangy_hw.robot_link import RobotLink
from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.faults import Remedy
from tangy_profiles.health import Health
from tangy_profiles.robot import Robot
from tangy_profiles.room import Room
from tangy_profiles.scene import CardView, Scene
from tangy_profiles.state import FRONT, ActivityState, Outcome, Response
from tangy_profiles.tracker import Tracker

PACE_SECONDS = 30.0
"""From one call to the next at least, so that everybody can look and mark; in the paper's games
it took about as long."""
LOOK_SECONDS = 0.5  # between two looks at whether somebody does what they were asked
PATIENCES = 2.0  # windows of patience after which it is taken that it is not done
SIGN_SECONDS = 8.0  # in which somebody who was helped takes the sign down
WITHDRAWN_SECONDS = 3.0  # without a sign after which somebody does not ask any more
HELP_SECONDS = 25.0  # in which people do what the robot asks them for when it needs help
AWAY = 0.5  # metres from the front at which the robot goes there before a game
LAST_CALLS = 5  # that the chest screen shows
FACING = pi / 2  # the heading at which the robot faces the people


class LiveWorld:
    """One room with a robot and people in it. `begin` each game, `execute` behaviours."""

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
        """Make the world of a robot that is switched on.

        Args:
            activity: what is played.
            people: the ids of those who take part, in the order of their seats.
            link: the robot process.
            robot: its profile.
            room: where table and seats are.
            seed: the order of the numbers comes from it.
            names: what people are called.
            pace: s from one call to the next.
            knows_faces: the robot looks who it is that it has come to.
        """
        self.activity = activity
        self.people = tuple(people)
        self.over = True
        self.broken = ""
        """Why the last behaviour was not carried out to its end."""
        self.link = link
        self.looked: Callable[[str, str, Any], None] = _unheeded
        """Is told of each card ("card") and face ("face") that was looked at, with whose place it
        is at, and what was seen."""
        self.diagnosed: Callable[[Health], Mapping[str, bool]] = _nothing
        """Says which faults the devices show, by code, and whether each is critical: the robot
        then stops in the midst of whatever it does."""
        self._robot = robot
        self._room = room
        self._names = dict(names or {})
        self._pace = pace
        self._knows_faces = knows_faces
        self._order = Random(f"{seed}/calls")
        self._begin()

    def _begin(self) -> None:
        activity = self.activity
        self.tracker = Tracker(activity, self.people)
        self.called: list[int] = []
        self._numbers = activity.deck.shuffled(self._order.random)
        self._card: CardView | None = None
        self._by_word: dict[str, float] = {}  # who asked otherwise than by a sign, and when
        self._without_sign: dict[str, float] = {}
        self._due = 0.0  # when the next number may be called

    def begin(self) -> ActivityState:
        """Begin a new game and return its first state."""
        self._begin()
        self.over = False
        front = self._room.front
        pose = self.link.state.pose
        if hypot(pose.x - front.x, pose.y - front.y) > AWAY:
            with suppress(DeviceError):  # where it cannot, the first behaviour says so
                self._do("go", to=list(Pose(front.x, front.y, FACING)), name=FRONT)
        self._settle()
        return self.observe()

    def observe(self) -> ActivityState:
        """Return the joint state as the robot's sensors have it now."""
        if not self.over:
            self._hear_requests()
        return self.tracker.state()

    # ------------------------------------------------------------------------ behaviours

    def execute(self, action: Action) -> Outcome:
        """Let the robot carry out an action, and see what comes of it; it can be broken off."""
        behaviour, began = action.behaviour, self.link.time
        if self.over:
            return Outcome(False, 0.0, (), None)
        numbers: tuple[int, ...] = ()
        response: Response | None = None
        succeeded = False
        self.broken = ""
        try:
            if self.tracker.allows(behaviour):
                found = self._numbers_of(action)
                if found is not None:
                    numbers = found
                    response, succeeded = self._carry_out(action, numbers)
        except DeviceError as error:
            self.broken = str(error)
            numbers = () if isinstance(error, BrokenOff) else numbers
        self._executed(behaviour, succeeded)
        self._settle()
        return Outcome(succeeded, max(0.0, self.link.time - began), numbers, response)

    def _numbers_of(self, action: Action) -> tuple[int, ...] | None:
        """Return the numbers that an action is about; None if there is nothing to be asked."""
        card = self._card
        match action.behaviour.effect:
            case "draw":
                return tuple(self._numbers[len(self.called) : len(self.called) + 1])
            case "clear wrong marks" | "set missing marks" if card is None:
                return None
            case "clear wrong marks" if card is not None:
                return _numbers_at(card, card.marked & ~card.called) or None
            case "set missing marks" if card is not None:
                return _numbers_at(card, card.called & ~card.marked) or None
        return ()

    def _carry_out(self, action: Action, numbers: tuple[int, ...]) -> tuple[Response | None, bool]:
        """Do it; return what a person did about it, and whether the robot has done its part."""
        behaviour, tracker = action.behaviour, self.tracker
        if behaviour.effect == "draw":
            self._keep_pace()
        self._say(action, numbers)
        match behaviour.effect:
            case "draw":
                self.called.extend(numbers)
                self._due = self.link.time + self._pace
                self._do("wait", seconds=min(self._pace, LOOK_SECONDS), asks=True)
            case "go to user":
                target = action.target or (tracker.queue[0] if tracker.queue else None)
                return None, target is None or self._go(target)
            case "go to front":
                return None, self._go(FRONT)
            case "finish":
                self.over = True
        if not behaviour.persuades or tracker.place == FRONT:
            return None, True
        if behaviour.effect == "none" and tracker.place not in self._signs(shown=True):
            return None, True  # nothing of what the person does about it can be seen
        return self._response(action, numbers), True

    def _say(self, action: Action, numbers: tuple[int, ...]) -> None:
        """Speak, show and gesture."""
        target = action.target
        name = self._names.get(target, target) if target is not None else ""
        fill, deck = self.activity.fill, self.activity.deck
        called = numbers if action.behaviour.effect == "draw" else ()
        picture = Picture(
            fill(action.image, name, numbers),
            deck.label(called[0]) if called else "",
            tuple(deck.label(number) for number in self.called[: -LAST_CALLS - 1 : -1]),
            name if action.behaviour.attends else "",
        )
        self._do(
            "perform",
            text=fill(action.speech, name, numbers),
            picture=picture._asdict(),
            posture=_posture(self._robot, action.posture),
        )

    def _keep_pace(self) -> None:
        wait = self._due - self.link.time
        if wait > 0:
            self._do("wait", seconds=wait)

    def _go(self, place: str) -> bool:
        """Drive to a place; beside a person, see who it is and look at the card."""
        stand = self._room.stand(place, self.people)
        done = self._do("go", to=list(Pose(stand.x, stand.y, FACING)), name=place)
        if not done.get("arrived"):
            return False
        self.tracker.arrive(place)
        self._card = None
        if place != FRONT:
            if self._knows_faces:
                self.looked("face", place, self._do("face").get("person"))
            if place in self.tracker.queue:
                self._read_card(place)
        return True

    def _read_card(self, person: str, after: float = 0.0) -> None:
        """Look at the card beside the robot, and keep what is seen of it."""
        card = self._look(after)
        state = str(card["state"])
        self.looked("card", person, card)
        self.tracker.seen = state if state != self.activity.unread else None

    def _look(self, after: float = 0.0) -> dict[str, Any]:
        """Look at the card; `_card` is what was seen, None if it could not be read."""
        card = self._do("card", called=self.called, after=after)
        self._card = None
        if card["card"] is not None:
            deck, place = self.activity.deck, self.tracker.place
            numbers = numbers_of(deck, card["card"], self.link.setup.deck_seed)
            called = called_cells(deck, numbers, set(self.called))
            if card["state"] != self.activity.unread:
                self._card = CardView(place, numbers, card["marked"], called)
        return card

    # ------------------------------------------------------------------------ what people do

    def _response(self, action: Action, numbers: tuple[int, ...]) -> Response:
        """Watch whether the person beside the robot does what was put to them, and when."""
        person, patience = self.tracker.place, self.activity.patience
        began = before = self.link.time
        reminded = False
        while True:
            done = self._is_done(action.behaviour, numbers)
            now = self.link.time
            seconds = (before + now) / 2 - began  # it was done between two looks
            if done:
                return Response(person, action.strategy, True, seconds <= patience, seconds)
            if now - began > PATIENCES * patience:
                return Response(person, action.strategy, False, False, now - began)
            if now - began > patience and not reminded:
                reminded = True
                name = self._names.get(person, person)
                words = self.activity.fill(action.image, name, numbers)
                self._do("perform", picture=Picture(words, asks=name)._asdict())
            before = now

    def _is_done(self, behaviour: Behaviour, numbers: tuple[int, ...]) -> bool:
        """Look whether what a behaviour asks for has been done."""
        place = self.tracker.place
        if behaviour.effect == "none":
            self._do("wait", seconds=LOOK_SECONDS)
            self._settle()
            return place not in self._signs(shown=True)
        card = self._look(LOOK_SECONDS)
        state = card["state"]
        if behaviour.effect == "bring card closer":
            done = state != self.activity.unread
        elif card["card"] is None:
            done = False
        else:
            face = numbers_of(self.activity.deck, card["card"], self.link.setup.deck_seed)
            asked = sum(1 << cell for cell, number in enumerate(face) if number in numbers)
            wanted = asked if behaviour.effect == "set missing marks" else 0
            done = card["marked"] & asked == wanted and not card["hidden"] & asked
        if done:
            self.looked("card", place, card)
        if place in self.tracker.queue:
            self.tracker.seen = state if state != self.activity.unread else None
        return bool(done)

    def _executed(self, behaviour: Behaviour, succeeded: bool) -> None:
        """Let a behaviour count; whose request it settled is to take the sign down."""
        tracker = self.tracker
        seen = tracker.seen
        tracker.executed(behaviour, succeeded=succeeded)
        closed = tracker.closed
        if closed is None or self.over:
            return
        self._by_word.pop(closed, None)
        seat = self.people.index(closed) + 1
        began = self.link.time
        try:
            self._do("answered", seat=seat)
            self._settle()
            while closed in self._signs() and self.link.time - began < SIGN_SECONDS:
                self._do("wait", seconds=LOOK_SECONDS)
                self._settle()
        except DeviceError:
            return
        if closed in self._signs():  # it still asks: nothing that was done has ended that
            tracker.queue.insert(0, closed)
            tracker.closed, tracker.seen = None, seen

    def _signs(self, *, shown: bool = False) -> dict[str, float]:
        """Return who asks now, and since when; `shown`: by a sign alone."""
        signs = {
            self.people[seat - 1]: since
            for seat, since in self.link.state.asks
            if seat <= len(self.people)
        }
        return signs if shown else signs | self._by_word

    def _hear_requests(self) -> None:
        """Take note of who asks, and of who waits and does not ask any more."""
        signs, tracker, now = self._signs(), self.tracker, self.link.time
        for person, _ in sorted(signs.items(), key=lambda item: item[1]):
            tracker.ask(person)
        for person in list(tracker.queue):
            if person in signs or person == tracker.place:
                self._without_sign.pop(person, None)
            elif now - self._without_sign.setdefault(person, now) > WITHDRAWN_SECONDS:
                tracker.queue.remove(person)

    def ask_for(self, person: str) -> None:
        """Ask for help on behalf of a person who did not, or could not."""
        self._by_word[person] = self.link.time

    def call_again(self) -> None:
        """Say and show the last number once more.

        Raises:
            DeviceError: it could not be said.
        """
        if self.called:
            label = self.activity.deck.label(self.called[-1])
            before = tuple(
                self.activity.deck.label(n) for n in self.called[-2 : -LAST_CALLS - 2 : -1]
            )
            self._do("perform", text=label, picture=Picture(label, label, before)._asdict())

    def void_call(self) -> int | None:
        """Take the last call back: its number counts as not called, and comes again later."""
        if not self.called:
            return None
        number = self.called.pop()
        self._numbers.remove(number)
        self._numbers.append(number)
        return number

    # ------------------------------------------------------------------------ what is there

    def scene(self) -> Scene:
        """Return what there is to see, for a screen to draw."""
        tracker = self.tracker
        asking = set(tracker.queue)
        doing = {p: "asks for help" if p in asking else "watches" for p in self.people}
        return Scene(
            self.link.state.going or tracker.place,
            tuple(tracker.queue),
            doing,
            tuple(self.called),
            self._card if self._card is not None and self._card.person == tracker.place else None,
        )

    def health(self) -> Health:
        """Return what the robot's devices report."""
        return self.link.health()

    def recover(self, remedy: Remedy) -> float:
        """Let the robot, a user or an expert do something about a fault; return the s it took."""
        began = self.link.time
        if remedy.kind == "halt":  # before and beside anything else
            self.link.stop(remedy.fault)
            return 0.0
        with suppress(DeviceError):  # what has not helped is seen by what the devices report
            self._recover(remedy)
        return max(0.0, self.link.time - began)

    def _recover(self, remedy: Remedy) -> None:
        person, tracker = remedy.person, self.tracker
        if remedy.speech or remedy.image:
            name = "" if person is None else self._names.get(person, person)
            picture = Picture(remedy.image, asks=name)
            self._do("perform", text=remedy.speech, picture=picture._asdict())
        match remedy.kind:
            case "ask":
                self._await_help(remedy)
            case "resume":
                self.link.release()
            case "spin":
                self._do("spin")
            case "restart":
                self._do("restart", device=remedy.device)
            case "replan":
                self._do("replan")
            case "do without":
                self._do("relax")
            case "set aside" if person in tracker.queue:
                tracker.queue.remove(person)
                self._by_word.pop(person, None)
                self._do("answered", seat=self.people.index(person) + 1)
                if person == tracker.place:
                    tracker.seen = None
        self._settle()

    def _await_help(self, remedy: Remedy) -> None:
        """Give people time to help, and see whether they have."""
        place, began = self.tracker.place, self.link.time
        while self.link.time - began < HELP_SECONDS:
            if remedy.device:
                self._do("wait", seconds=1.0)
                self._do("replan")
                self.link.beat()
                if remedy.fault not in self.diagnosed(self.health()):
                    return
            elif place in self.tracker.queue:
                self._read_card(place, after=1.0)
                self._settle()
                if self.tracker.seen is not None or place not in self._signs():
                    return
            else:
                self._do("wait", seconds=1.0)

    # ------------------------------------------------------------------------ the robot

    def _do(self, do: str, **what: Any) -> dict[str, Any]:
        """Let the robot do something; it is broken off where devices report what is critical."""
        asked = self.link.ask(do, **what)
        broken = False
        while not self.link.wait(asked):
            if not broken and (critical := self._critical()):
                broken = True
                self.link.ask("cancel", why=critical)
        return asked.result()

    def _critical(self) -> str:
        """Name a critical fault that the devices show, "" if they show none."""
        found = self.diagnosed(self.health())
        return next((code for code, critical in found.items() if critical), "")

    def _settle(self) -> None:
        """Let the robot see what is there now, where its time stands still meanwhile."""
        if self.link.setup.stepped:
            self.link.do("settle")


def _numbers_at(card: CardView, cells: int) -> tuple[int, ...]:
    return tuple(number for cell, number in enumerate(card.numbers) if cells >> cell & 1)


def _posture(robot: Robot, name: str) -> dict[str, list[float]]:
    return {limb: list(angles) for limb, angles in robot.postures[name].items()}


def _unheeded(_what: str, _place: str, _seen: Any) -> None:
    """Take no note."""


def _nothing(_: Health) -> Mapping[str, bool]:
    return {}
