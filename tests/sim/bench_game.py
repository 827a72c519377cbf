"""A robot that knows the truth, and plays in the bench's world by Table II: a peer for tests."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from math import atan2, hypot, pi
from random import Random

from tangy_profiles.activity import load_activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.person import load_people
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.state import FRONT, Situation
from tangy_profiles.tracker import Tracker
from tangy_sim.device_simulator.drive import EXACT
from tangy_sim.device_simulator.world import BenchWorld

ACTIVITY, ROOM, ROBOT = load_activity("bingo"), load_room(), load_robot()
TICK = 0.1


def bench(seed: int = 1, count: int = 4, *, exact: bool = True) -> BenchWorld:
    """Make a world with sample people, before any game."""
    odometer = EXACT if exact else None
    return BenchWorld(ROOM, ROBOT, ACTIVITY, load_people(count), seed=seed, odometer=odometer)


def say(world: BenchWorld, behaviour: str, name: str = "", *numbers: int) -> None:
    """Let the robot speak a behaviour's words to their end."""
    text = ACTIVITY.fill(ACTIVITY.behaviours[behaviour].speech["neutral"], name, numbers)
    world.say(text)
    while text not in world.said:
        world.step(TICK)
    world.said.clear()


def drive_to(world: BenchWorld, place: str, seconds: float = 60.0) -> bool:
    """Drive straight to a place and face the people; return whether that worked."""
    goal = world.room.stand(place, world.people.ids)
    until = world.now + seconds
    while world.now < until:
        pose = world.wheels.pose
        dx, dy = goal.x - pose.x, goal.y - pose.y
        far = hypot(dx, dy)
        wanted = pi / 2 if far < 0.05 else atan2(dy, dx)
        off = (wanted - pose.heading + pi) % (2 * pi) - pi
        if far < 0.05 and abs(off) < 0.05:
            world.drive(0.0, 0.0)
            world.step(0.3)
            return True
        ahead = 0.0 if abs(off) > 0.15 or far < 0.05 else min(0.5, far)
        world.drive(ahead, max(-1.0, min(1.0, 2 * off)))
        world.step(TICK)
    return False


@dataclass
class Player:
    """Plays games in turn, and counts situations."""

    world: BenchWorld
    tracker: Tracker = field(init=False)
    rows: Counter[Situation] = field(default_factory=Counter)

    def play(self, seed: int = 1, most: int = 400) -> None:
        """Play a game to its end."""
        world = self.world
        world.begin()
        self.tracker = Tracker(ACTIVITY, world.people.ids)
        self.tracker.place = world.people.place
        self._order = ACTIVITY.deck.shuffled(Random(seed).random)
        for _ in range(most):
            if world.people.game.over:
                return
            self._look()
            state = self.tracker.state()
            self.rows[state.situation] += 1
            self._do(ACTIVITY.behaviours[ACTIVITY.expected[state.situation]], state.attended)
        assert most < 400, "no end"

    def _look(self) -> None:
        """Look at the signs, and at the card beside the robot."""
        world, tracker = self.world, self.tracker
        assert set(tracker.queue) <= set(world.asking), "a sign came down without a reason"
        for person in world.asking:
            tracker.ask(person)
        tracker.seen = None
        if tracker.place in tracker.queue:
            sitter = world.people.sitters[tracker.place]
            tracker.seen = None if sitter.hides else world.people.judged(sitter.id)

    def _do(self, behaviour: Behaviour, attended: str | None) -> None:
        world, tracker = self.world, self.tracker
        name = next((p.name for p in load_people(8) if p.id == attended), "")
        if behaviour.calls:
            say(world, behaviour.name, "", self._order[len(world.people.game.called)])
            world.step(6.0)
        elif behaviour.drives:
            say(world, behaviour.name, name)
            place = attended or FRONT
            assert drive_to(world, place)
            assert world.people.place == place
            tracker.arrive(place)
        elif behaviour.corrects:
            player = world.people.sitters[tracker.place].player
            wrong = player.marked & ~player.called
            missing = player.called & ~player.marked
            mask = wrong if behaviour.clears_marks else missing
            say(world, behaviour.name, name, *player.cells(mask))
            if behaviour.clears_marks:
                self._wait(lambda: not player.marked & wrong)
            else:
                self._wait(lambda: not missing & ~player.marked)
        else:
            say(world, behaviour.name, name)
            if behaviour.shows_card:
                self._wait(lambda: not world.people.sitters[tracker.place].hides)
        self._look()
        tracker.executed(behaviour)
        if tracker.closed is not None:
            closed = tracker.closed
            self._wait(lambda: closed not in world.asking)

    def _wait(self, holds: Callable[[], bool], seconds: float = 25.0) -> None:
        until = self.world.now + seconds
        while not holds():
            assert self.world.now < until, "nothing happened"
            self.world.step(TICK)
