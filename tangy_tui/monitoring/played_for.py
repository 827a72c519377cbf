"""What a game was played for, and who won with which card, from the log alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_rules import Patterns
from tangy_profiles.game_world import SIMULATED
from tangy_profiles.known_cards import KnownCards
from tangy_tui.monitoring.attention import wins
from tangy_tui.monitoring.replay import Done, GameReplay, Moment, Noted


@dataclass(frozen=True, slots=True)
class Win:
    """A person who won, with the card, at which call, and when Tangy celebrated it (UTC)."""

    person: str
    card: int | None = None
    """None: there are no cards, or nobody knew whose card it was."""
    call: int = 0
    """How many numbers had been called, without those taken back; 0: nothing is called."""
    number: int = 0
    """The last of these numbers."""
    at: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return the win as `--json` prints it."""
        return {
            "person": self.person,
            "card": self.card,
            "call": self.call or None,
            "number": self.number or None,
            "at": self.at,
        }


@dataclass(frozen=True, slots=True)
class PlayedFor:
    """A pattern of a game, and its wins in order; "" for an activity without named patterns.

    The game can end before a chosen pattern is `reached`.
    """

    pattern: str
    wins: tuple[Win, ...] = ()
    reached: bool = True

    @property
    def winners(self) -> tuple[str, ...]:
        """The people who won, in order."""
        return tuple(win.person for win in self.wins)

    def to_json(self) -> dict[str, Any]:
        """Return the pattern and its winners as `--json` prints them."""
        return {
            "pattern": self.pattern,
            "winners": list(self.winners),
            "wins": [win.to_json() for win in self.wins],
            "reached": self.reached,
        }


def played_for(replay: GameReplay) -> tuple[PlayedFor, ...]:
    """Return the patterns that were chosen for a game, in order, with those not reached.

    It is empty if the activity is unknown or nobody can win in it. The activity's own pattern has
    the name of the pattern that staff could have chosen for it.
    """
    known = replay.activity
    if known is None or not any(one.needs for one in known.behaviours.values()):
        return ()
    rules, deck = known.rules, known.deck
    try:
        patterns = Patterns.of(rules, deck, replay.game.patterns)
    except TangyError:  # the activity has changed since
        return (PlayedFor(""),)
    won = wins(replay)
    found, winners = list[PlayedFor](), list[Win]()
    notes, called, claimed = list[Noted](), list[int](), dict[str, int]()

    def end() -> None:
        current = patterns.current
        found.append(PlayedFor("" if current is None else current.name, tuple(winners)))
        winners.clear()
        claimed.clear()

    for moment in sorted([*replay.moments, *replay.staff_changes], key=_order):
        match moment.what:
            case Done(draws=True, completed=True, numbers=numbers):
                called += numbers
            case Done() as done if done.number in won:
                who = done.after.place
                card = claimed.get(who) or _card_of(who, replay, notes)
                last = called[-1] if called else 0
                winners.append(Win(who, card, len(called), last, moment.at))
            case Noted(did="claim right", person=who, detail=card_number) if who:
                claimed[who] = int(card_number)
            case Noted(taken_back=number) as note:
                if number in called:
                    called.reverse()
                    called.remove(number)
                    called.reverse()
                notes.append(note)
            case GameChange(what="patterns chosen", patterns=names):
                patterns.follow_with([n for n in names if n in {p.name for p in rules.patterns}])
            case GameChange(what="played on"):
                end()
                patterns.advance()
            case _:
                pass
    end()
    return (*found, *(PlayedFor(one.name, reached=False) for one in patterns.left))


def _card_of(person: str, replay: GameReplay, notes: Iterable[Noted]) -> int | None:
    """Return the number of a person's card, if it was known by then."""
    if not replay.activity or not replay.activity.deck.columns:
        return None
    if replay.game.world == SIMULATED:  # simulated cards have the numbers of the seats
        return replay.game.people.index(person) + 1 if person in replay.game.people else None
    known = KnownCards.of(notes)
    return known.given.get(person, known.seen.get(person))


def wins_of(replay: GameReplay, person: str) -> list[tuple[str, Win]]:
    """Return the wins of a person in a game, each with its pattern."""
    found = played_for(replay)
    return [(one.pattern, win) for one in found for win in one.wins if win.person == person]


def _order(moment: Moment) -> tuple[int, str]:
    return moment.step, moment.at
