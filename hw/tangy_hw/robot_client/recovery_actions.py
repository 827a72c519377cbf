"""Recovery actions in a live world: asking people, turning to localise, restarting devices."""

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

SLIPPED = "wheels-slip"  # fault code of slipping wheels, after which the robot may be lost
AWAY = 0.5  # metres from its place in the game above which it drives back
BACK_SECONDS = 3.0  # of real time, for devices that come back later than a lost link
HELP_SECONDS = 25.0  # for people to do what the robot asks for in a fault


class RecoveryActions:
    """Remedies for faults of a world's robot or at its table."""

    def __init__(self, world: LiveWorld) -> None:
        self._world = world
        self.looks_first = False
        """Whether the game was resumed beside a card that this robot has not seen."""

    def do(self, remedy: Remedy) -> float:
        """Carry out a remedy; return its duration in s of the robot's time."""
        link = self._world.link
        began = link.time
        if remedy.kind == "call expert" and (link.silent or link.state.failed):
            with suppress(DeviceError):  # the new robot process is halted too
                link.restart()
                link.stop(remedy.fault, by=FAULT)
        if remedy.kind == "halt":  # before anything else
            link.stop(remedy.fault, by=FAULT)
            return 0.0
        with suppress(DeviceError):  # the devices' readings show whether it helped
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
                if world.lost:  # it slipped or was pushed meanwhile
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
        world.link.beat()  # wait until its readings show the effect

    def go_back(self, *, knows_place: bool) -> None:
        """Return to the robot's place in the game; localise first if it is lost.

        Raises:
            DeviceError: it has to stop, is not localised, or finds no way.
        """
        world = self._world
        place = world.tracker.place
        if not knows_place:
            with world.commands.ignoring_faults(SLIPPED):  # localising ends this fault
                found = world.commands.do("spin").get("found")
            if not found:
                raise DeviceError("The robot does not find its place.")
            world.link.beat()
        at, pose = world.stand(place), world.link.state.pose
        if hypot(pose.x - at.x, pose.y - at.y) > AWAY and not world.drive(place):
            raise DeviceError("The robot does not get back to where it was.")

    def take_place(self) -> bool:
        """Return to the robot's place in the game; look at the card there if it has not yet.

        The log tells the state of a card, but not the numbers that a request names.

        Returns:
            Whether the card is in another state now, so that Tangy has to decide again.

        Raises:
            DeviceError: it has to stop, or finds no way.
        """
        self.go_back(knows_place=True)
        if not self.looks_first:
            return False
        tracker = self._world.tracker
        before = tracker.seen
        self._world.read_card(tracker.place)
        self.looks_first = False
        return tracker.seen != before

    def _look_again(self, remedy: Remedy) -> None:
        """Check whether the reason for a halt is gone, when staff say so."""
        commands, link = self._world.commands, self._world.link
        if link.state.frozen:  # staff know about the freeze; it stands until released
            link.tell("seen to")
            link.beat()
        commands.do("replan")
        if self._world.lost:  # only turning shows whether it can localise
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
        """Wait a moment for devices that recover later, such as cameras."""
        link, until = self._world.link, time.monotonic() + BACK_SECONDS
        while time.monotonic() < until and not link.setup.stepped:
            found = self._world.commands.diagnosed(link.health())
            if remedy.fault in found or not any(found.values()):
                return
            link.beat()

    def _await_help(self, remedy: Remedy) -> None:
        """Give people time to help, and check whether they have."""
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
