"""Requests for help in a game: by visible signs, or reported by staff."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from typing import Literal

from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client.commands import Commands
from tangy_profiles.health import OK, WARN, state_of
from tangy_profiles.robot import DeviceProfile
from tangy_profiles.tracker import Tracker

LOOK_SECONDS = 0.5  # between two looks at the signs
SIGN_SECONDS = 8.0  # for a person who was helped to take the sign down

WITHDRAWN_SECONDS = 3.0
"""Time without a sign after which a request counts as withdrawn: an arm may have covered it."""

SignState = Literal["", "no sensor", "silent", "set aside"]
"""Why a person's sign does not count; `set aside`: it counts after it has come down and up again.
"""


class HelpRequestTracker:
    """Requests in the games of one run; times are the robot's, in s."""

    def __init__(
        self, people: Sequence[str], commands: Commands, device: DeviceProfile | None = None
    ) -> None:
        """Prepare a game.

        Args:
            people: ids of the participants, in the order of their seats.
            commands: commands to the robot.
            device: sensor of the signs, if the robot has one.
        """
        self._people = tuple(people)
        self._commands = commands
        self._link = commands.link
        self._device = device
        self._by_word: dict[str, float] = {}
        self._met: set[str] = set()  # people whom the robot has visited since they asked by word
        self._without_sign: dict[str, float] = {}
        self._aside: set[str] = set()
        self._settling = ""  # whose request was just settled: the sign comes down a little later
        self._unseen: set[str] = set()  # people whose signs a sensor showed before it fell silent

    def begin(self, away: Collection[str]) -> None:
        """Begin a game: who asked by word in the one before and got no visit still waits.

        Signs count as they are up, also those that were set aside.
        """
        gone = {*away, *self._met}
        self._by_word = {one: at for one, at in self._by_word.items() if one not in gone}
        self._without_sign.clear()
        self._aside.clear()
        self._unseen.clear()
        self._settling = ""

    @property
    def signs(self) -> dict[str, float]:
        """People with a sign up, with the time (s) since when."""
        asks = self._link.state.asks
        return {self._people[seat - 1]: since for seat, since in asks if seat <= len(self._people)}

    @property
    def all(self) -> dict[str, float]:
        """Asking people, by word or by a sign not set aside, with the time (s) since when."""
        signs = self.signs
        self._aside &= signs.keys()  # after the sign has come down, it may go up again
        if self._unseen and self._sees:
            self._unseen.clear()
        aside = self._aside | self._unseen
        return {p: since for p, since in signs.items() if p not in aside} | self._by_word

    def sign_of(self, person: str) -> SignState:
        """Return why a person's sign would not count now, "" if it would; it changes nothing."""
        if self._device is None:
            return "no sensor"
        if not self._sees:
            return "silent"
        aside = person in self._aside | self._unseen and person not in self._by_word
        return "set aside" if aside and person in self.signs else ""

    @property
    def raised(self) -> tuple[str, ...]:
        """People whose signs are up and count, in the order in which they raised them.

        It changes nothing, so that a screen may ask while the game runs.
        """
        signs = sorted(self.signs.items(), key=lambda item: item[1])
        aside = self._aside | self._unseen | {self._settling}
        return tuple(person for person, _ in signs if person not in aside)

    @property
    def left(self) -> tuple[str, ...]:
        """People who still ask after a game, in the order in which they asked."""
        signs = {one: at for one, at in self.signs.items() if one in self.raised}
        words = {one: at for one, at in self._by_word.items() if one not in self._met}
        return tuple(sorted(asks := signs | words, key=lambda one: asks[one]))

    @property
    def by_word(self) -> tuple[str, ...]:
        """People for whom staff asked, or who asked before an interruption, in this order."""
        return tuple(self._by_word)

    def ask_for(self, person: str) -> None:
        """Record a request for a person by word; who asks already keeps their place."""
        self._by_word.setdefault(person, self.all.get(person, self._link.time))
        self._met.discard(person)

    def wait_on(self, waits: Mapping[str, float]) -> None:
        """Take open requests of games before the robot was switched on as requests by word.

        Their signs may not be seen again: staff may have asked for them.

        Args:
            waits: how long (s) each person has waited.
        """
        for person, wait in waits.items():
            self._by_word.setdefault(person, self._link.time - wait)

    def over(self, person: str) -> None:
        """End a person's request by word."""
        self._by_word.pop(person, None)

    def set_aside(self, person: str) -> None:
        """Close a person's request, even while the sign stays up."""
        self.over(person)
        self._aside.add(person)

    def stays_up(self, person: str) -> bool:
        """Record that a request was settled; return whether the sign is up even then.

        It counts as down if the robot cannot look. So does the last sight of a sensor that has
        fallen silent: such a sign is ignored until the sensor works again.
        """
        try:
            return self._waits_for_sign(person)
        except DeviceError:
            return False

    def _waits_for_sign(self, person: str) -> bool:
        """Give the person time to take the sign down; return whether it is still up."""
        self.over(person)
        began, self._settling = self._link.time, person
        try:
            self._commands.do("answered", seat=self._people.index(person) + 1)
            self._commands.settle()
            with self._commands.waiting_for("sign", person, SIGN_SECONDS):
                while person in self.all and self._link.time - began < SIGN_SECONDS:
                    self._look()
        finally:
            self._settling = ""
        if person in self.all and not self._sees:
            self._unseen.add(person)
        return person in self.all

    def look_twice(self, tracker: Tracker) -> None:
        """Wait until it is certain whether waiting people have taken their signs down.

        Changes are then attributed to the behaviour during which they happened, even the last of a
        game.
        """
        with suppress(DeviceError):  # the devices' readings show the problem
            while self._in_doubt(tracker):
                self._look()

    def _in_doubt(self, tracker: Tracker) -> bool:
        self.tell(tracker)
        return any(person in self._without_sign for person in tracker.queue)

    def _look(self) -> None:
        self._commands.wait(LOOK_SECONDS)
        self._commands.settle()

    @property
    def _sees(self) -> bool:
        """Whether the sensor of signs works."""
        own = (
            one for one in self._link.health() if self._device and one.device == self._device.name
        )
        reading = next(own, None)
        return reading is None or state_of(self._device, reading) in (OK, WARN)

    def tell(self, tracker: Tracker) -> None:
        """Update a game's requests: new ones, and withdrawn ones."""
        asking, now = self.all, self._link.time
        self._met |= {tracker.place} & self._by_word.keys()
        for person, _ in sorted(asking.items(), key=lambda item: item[1]):
            tracker.ask(person)
        for person in list(tracker.queue):
            if person in asking or person == tracker.place:
                self._without_sign.pop(person, None)
            elif now - self._without_sign.setdefault(person, now) > WITHDRAWN_SECONDS:
                tracker.withdraw(person)
                del self._without_sign[person]
