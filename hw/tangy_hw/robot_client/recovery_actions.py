"""Recovery in a live world: asking people, looking round, restarting devices."""

from __future__ import annotations

import time
from contextlib import suppress
from math import hypot
from typing import TYPE_CHECKING

from tangy_hw.device_protocols import DeviceError, Picture
from tangy_hw.robot_process.stop_latch import FAULT
from tangy_profiles.faults import Remedy

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld

SLIPPED = "wheels-slip"  # the fault for which a robot that knows its place no more is stopped
AWAY = 0.5  # metres from where it should be at which the robot drives there
BACK_SECONDS = 3.0  # of real time, in which all is back that a lost link had taken along
HELP_SECONDS = 25.0  # in which people do what the robot asks them for when it needs help


class RecoveryActions:
    """The remedies of a world for faults of its robot or at its table."""

    def __init__(self, world: LiveWorld) -> None:
        self._world = world

    def do(self, remedy: Remedy) -> float:
        """Do something about a fault; return the s it took, of the robot's time."""
        link = self._world.link
        began = link.time
        if remedy.kind == "call expert" and (link.silent or link.state.failed):
            with suppress(DeviceError):  # another robot process, which stands still as well
                link.restart()
                link.stop(remedy.fault, by=FAULT)
        if remedy.kind == "halt":  # before and beside anything else
            link.stop(remedy.fault, by=FAULT)
            return 0.0
        with suppress(DeviceError):  # what has not helped is seen by what the devices report
            self._do(remedy)
        return max(0.0, link.time - began)

    def _do(self, remedy: Remedy) -> None:
        world, person = self._world, remedy.person
        commands, tracker = world.commands, world.tracker
        if remedy.speech or remedy.image:
            name, seat = world.name_of(person), world.seat_of(person)
            shown, written = (
                text.replace(name, seat) if name else text for text in (remedy.image, remedy.speech)
            )
            world.say(remedy.speech, Picture(shown, asks=seat), written=written)
        match remedy.kind:
            case "ask":
                self._await_help(remedy)
            case "resume":
                world.link.release(by=FAULT)
                if world.lost:  # it slipped, or was pushed, while it was seen to
                    self.go_back(knows_place=False)
            case "spin":
                self.go_back(knows_place=False)
            case "look again":
                self._look_again(remedy)
            case "restart":
                commands.do("restart", device=remedy.device)
            case "replan":
                commands.do("replan")
            case "do without":
                commands.do("relax")
            case "set aside" | "leave to staff" if person is not None and person in tracker.queue:
                tracker.withdraw(person)
                world.requests.set_aside(person)
                commands.do("answered", seat=world.people.index(person) + 1)
                if person == tracker.place:
                    tracker.seen = None
        commands.settle()
        world.link.beat()  # what was done shows in what the robot says of itself now

    def go_back(self, *, knows_place: bool) -> None:
        """Let the robot be where it should be in the game; it turns first if it is lost.

        Raises:
            DeviceError: it has to stand still, or does not find its place or its way.
        """
        world = self._world
        place = world.tracker.place
        if not knows_place:
            with world.commands.heedless(SLIPPED):  # what it is known by is over when it is found
                found = world.commands.do("spin").get("found")
            if not found:
                raise DeviceError("The robot does not find its place.")
            world.link.beat()
        at, pose = world.stand(place), world.link.state.pose
        if hypot(pose.x - at.x, pose.y - at.y) > AWAY and not world.drive(place):
            raise DeviceError("The robot does not get back to where it was.")

    def _look_again(self, remedy: Remedy) -> None:
        """See whether what halted the robot is gone, now that staff say so."""
        commands, link = self._world.commands, self._world.link
        if link.state.frozen:  # staff have seen that; it stands until it is let go on
            link.tell("seen to")
            link.beat()
        commands.do("replan")
        if self._world.lost:  # only looking round can show whether it knows its place
            link.release(by=FAULT)
            try:
                self.go_back(knows_place=False)
            finally:
                link.beat()
                if remedy.fault in commands.diagnosed(link.health()):
                    link.stop(remedy.fault, by=FAULT)
        link.beat()
        self._await_others(remedy)

    def _await_others(self, remedy: Remedy) -> None:
        """Wait a moment for what comes back later than what halted the robot, as cameras do."""
        link, until = self._world.link, time.monotonic() + BACK_SECONDS
        while time.monotonic() < until and not link.setup.stepped:
            found = self._world.commands.diagnosed(link.health())
            if remedy.fault in found or not any(found.values()):
                return
            link.beat()

    def _await_help(self, remedy: Remedy) -> None:
        """Give people time to help, and see whether they have."""
        world = self._world
        commands, place, began = world.commands, world.tracker.place, world.link.time
        while world.link.time - began < HELP_SECONDS:
            if remedy.device:
                commands.wait(1.0)
                commands.do("replan")
                world.link.beat()
                if remedy.fault not in commands.diagnosed(world.health()):
                    return
            elif place in world.tracker.queue:
                world.read_card(place, after=1.0)
                commands.settle()
                if world.tracker.seen is not None or place not in world.requests.all:
                    return
            else:
                commands.wait(1.0)
