"""Who asks for help, as a game knows it: by signs that are seen, or by somebody's word."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_hw.robot_link import RobotLink
from tangy_profiles.tracker import Tracker

WITHDRAWN_SECONDS = 3.0  # without a sign after which somebody does not ask any more


class SeenRequests:
    """The requests of one game; times are the robot's, in s."""

    def __init__(self, people: Sequence[str], link: RobotLink) -> None:
        self._people = tuple(people)
        self._link = link
        self._by_word: dict[str, float] = {}
        self._without_sign: dict[str, float] = {}
        self._aside: set[str] = set()

    @property
    def signs(self) -> dict[str, float]:
        """Who has a sign up, and since when."""
        asks = self._link.state.asks
        return {self._people[seat - 1]: since for seat, since in asks if seat <= len(self._people)}

    @property
    def all(self) -> dict[str, float]:
        """Who asks, by a sign that was not set aside or by word, and since when."""
        signs = self.signs
        self._aside &= signs.keys()  # who has turned the sign down may put it up again
        return {p: since for p, since in signs.items() if p not in self._aside} | self._by_word

    def ask_for(self, person: str) -> None:
        """Ask on behalf of somebody who has no sign."""
        self._by_word[person] = self._link.time

    def over(self, person: str) -> None:
        """What somebody asked for by word is over."""
        self._by_word.pop(person, None)

    def set_aside(self, person: str) -> None:
        """Leave somebody's request at that, also while the sign stays up."""
        self.over(person)
        self._aside.add(person)

    def tell(self, tracker: Tracker) -> None:
        """Tell a game who asks, and who waits and does not ask any more."""
        asking, now = self.all, self._link.time
        for person, _ in sorted(asking.items(), key=lambda item: item[1]):
            tracker.ask(person)
        for person in list(tracker.queue):
            if person in asking or person == tracker.place:
                self._without_sign.pop(person, None)
            elif now - self._without_sign.setdefault(person, now) > WITHDRAWN_SECONDS:
                tracker.queue.remove(person)
