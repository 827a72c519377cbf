"""Numbers of a live game, changes to it by staff, and the robot's part in them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from math import hypot
from typing import TypeAlias

from tangy_hw.device_protocols import DeviceError, Picture
from tangy_hw.robot_client.card_observations import CardObservations
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.commands import Commands
from tangy_hw.robot_client.count_down import CountDown
from tangy_hw.robot_client.help_requests import HelpRequestTracker
from tangy_profiles.activity import Activity
from tangy_profiles.cards import Deck
from tangy_profiles.game_records import ChangeKind, GameChange
from tangy_profiles.health import OK
from tangy_profiles.past_game import PastGame
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.robot import Robot
from tangy_profiles.room import SEAT, Room

LAST_CALLS = 5  # on the chest screen


class CallOrder:
    """The order of a game's numbers, drawn at its beginning."""

    def __init__(self, numbers: Sequence[int]) -> None:
        self.called: list[int] = []
        """Numbers that count as called, the latest last."""
        self.calling: tuple[int, ...] = ()
        """Numbers that are being said now, and do not count as called yet."""
        self._numbers = list(numbers)

    def resume(self, past: PastGame, activity: Activity) -> None:
        """Restore the state of an interrupted game."""
        self.called = past.called(activity)
        self._numbers = past.order(self._numbers, self.called)

    @property
    def next(self) -> tuple[int, ...]:
        """The next number, if one is left."""
        return tuple(self._numbers[len(self.called) : len(self.called) + 1])

    def count(self, numbers: Sequence[int]) -> None:
        """Count numbers as called, now that they were said."""
        self.called.extend(numbers)
        self.calling = ()

    def labels(self, deck: Deck, most: int = LAST_CALLS) -> tuple[str, ...]:
        """Return the labels of the latest numbers, at most `most`, the newest first."""
        return tuple(map(deck.label, self.called[: -most - 1 : -1]))

    def take_back(self, number: int) -> None:
        """Revert a call: the number counts as not called, and will be called last."""
        if number in self.called:
            self.called.remove(number)
            self._numbers.remove(number)
            self._numbers.append(number)


BESIDE = 0.6
"""Distance in m to its place within which the robot is shown as being there."""

SET_ASIDE: tuple[ChangeKind, ...] = ("others first", "played on", "left")
"""Changes that end a person's request, even while the sign stays up."""


Posture: TypeAlias = Mapping[str, Sequence[float]] | None
"""Joint angles in degrees, by limb; None: unchanged."""


class LivePlan(PlannedGame):
    """The part of a live world that staff change; see `LiveWorld`."""

    link: RobotLink
    commands: Commands
    _robot: Robot
    cards: CardObservations
    calls: CallOrder
    over: bool
    requests: HelpRequestTracker
    _count_down: CountDown
    _room: Room

    def say(
        self,
        speech: str,
        picture: Picture,
        posture: Posture = None,
        written: str = "",
        sound: str = "",
    ) -> None:
        """Speak, show, gesture, and play a WAV; without a voice the screen shows the speech.

        `written` replaces the speech on the public screen, if given.

        Raises:
            DeviceError: neither speech nor screen worked.
        """
        self.said = speech or self.said
        in_words = picture._replace(text=written or speech)
        if speech and not self._has_voice:
            self.commands.perform(speech, in_words, posture, sound)
            return
        done = self.commands.perform(speech, picture, posture, sound)
        if speech and not done.get("said"):  # it has just failed, or the robot has no voice
            self.commands.perform("", in_words)

    @contextmanager
    def looking_at(self, person: str) -> Iterator[None]:
        """Mark that a person's card is being read: what comes next depends on it."""
        self.looking = person if person in self.tracker.queue else ""
        try:
            yield
        finally:
            self.looking = ""

    @property
    def _has_voice(self) -> bool:
        health = self.link.health()
        if "voice" not in self._robot.devices:
            return False
        return all(reading.state == OK for reading in health if reading.device == "voice")

    def seat_of(self, person: str | None) -> str:
        """Return the public word for a person: their seat, or a team's name; "" for nobody."""
        if person not in self.people:
            return ""
        if person in self.activity.teams:
            return person
        return f"{self._room.seat_word or SEAT} {self.people.index(person) + 1}".capitalize()

    @property
    def queue(self) -> tuple[str, ...]:
        """Who asks for help, in the order in which they are served; after the game nobody.

        A request by word counts at once, also before the game takes it in after its present step.
        """
        if self.over:
            return ()
        queue = tuple(self.tracker.queue)
        new = (one for one in self.requests.by_word if one not in queue and one not in self.away)
        return *queue, *new

    @property
    def asked_at(self) -> Mapping[str, float]:
        """When each person asked who asks by a sign or by word, in s of the robot's time."""
        return self.requests.all

    @property
    def asking(self) -> tuple[str, ...]:
        """The queue, and behind it people whose signs the game takes in after its present step.

        After a game, it is who still waits.
        """
        if self.over:
            return tuple(one for one in self.requests.left if one not in self.plan_away)
        queue = self.queue
        known = {*queue, *self.away}
        return *queue, *(one for one in self.requests.raised if one not in known)

    @property
    def arrived(self) -> bool:
        """Whether it stands at its place in the game, rather than being on its way or moved."""
        state = self.link.state
        if not state.number or state.going:
            return not state.going
        to = self._room.stand(self.tracker.place, self.people)
        return hypot(to.x - state.pose.x, to.y - state.pose.y) <= BESIDE

    @property
    def bound_for(self) -> str:
        """The place that the robot is driving to, "" if it stands."""
        return self.link.state.going

    @property
    def called_now(self) -> tuple[int, ...]:
        """Numbers that count as called."""
        return tuple(self.calls.called)

    @property
    def calling(self) -> tuple[int, ...]:
        """The numbers that are being said now, and do not count as called yet."""
        return self.calls.calling

    def numbers_on(self, card: int) -> tuple[int, ...] | None:
        """Return the numbers of a printed card, None if there is no such card."""
        return self.cards.numbers_on(card)

    def holder(self, card: int) -> str:
        """Return the owner of a card, as told or seen; "" if unknown."""
        return self.cards.dealt.owner(card)

    @property
    def known_cards(self) -> dict[str, int]:
        """The people whose cards are known, with the numbers of these."""
        known = {person: self.cards.dealt.card_of(person) for person in self.people}
        return {person: card for person, card in known.items() if card is not None}

    def _play_pattern(self) -> None:
        super()._play_pattern()
        deck = self.activity.deck
        chosen = {"patterns": list(deck.patterns), "together": deck.together}
        self.cards.wins = None if deck == self.own_deck else chosen

    @property
    def calls_in(self) -> float:
        """Time in s until the next number may be called."""
        return self._count_down.seconds

    def hold_calls(self, *, held: bool) -> None:
        """Hold the count-down to the next call, or let it go on where it was."""
        self._count_down.hold(held=held)

    def set_pace(self, seconds: float) -> None:
        """Set the s between calls, also for the next call."""
        self._count_down.lengthen(seconds - self.pace)
        super().set_pace(seconds)

    def change(self, change: GameChange) -> None:
        """Apply a change to the game, and close requests that it settles."""
        super().change(change)
        if change.what in SET_ASIDE:
            self.requests.set_aside(change.person)

    def _asks(self, person: str) -> None:
        super()._asks(person)
        self.requests.ask_for(person)

    def _asks_no_more(self, person: str) -> None:
        super()._asks_no_more(person)
        self.requests.set_aside(person)

    def _take_back(self, number: int) -> None:
        self.calls.take_back(number)

    def announce(self, text: str) -> None:
        """Speak to the group, and show the text; failures show in the devices' readings."""
        with suppress(DeviceError):
            self.say(text, Picture(text, "", self.calls.labels(self.activity.deck)))

    def call_again(self) -> None:
        """Say and show the last number once more.

        Raises:
            DeviceError: it could not be said.
        """
        if self.calls.called:
            label, *before = self.calls.labels(self.activity.deck, LAST_CALLS + 1)
            self.say(label, Picture(label, label, tuple(before)))
