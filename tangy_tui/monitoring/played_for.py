"""What a game was played for, pattern by pattern, and who won with each, from the log alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_rules import Patterns
from tangy_tui.monitoring.attention import wins
from tangy_tui.monitoring.replay import Done, GameReplay, Moment


@dataclass(frozen=True, slots=True)
class PlayedFor:
    """A pattern of a game, and its winners in order; "" for an activity without named patterns.

    The game can end before a chosen pattern is `reached`.
    """

    pattern: str
    winners: tuple[str, ...] = ()
    reached: bool = True

    def to_json(self) -> dict[str, Any]:
        """Return the pattern and its winners as `--json` prints them."""
        return {"pattern": self.pattern, "winners": list(self.winners), "reached": self.reached}


def played_for(replay: GameReplay) -> tuple[PlayedFor, ...]:
    """Return the patterns that were chosen for a game, in order, with those not reached.

    It is empty if the activity is unknown or nobody can win in it. The activity's own pattern has
    the name of the pattern that staff could have chosen for it.
    """
    known = replay.activity
    if known is None or not any(one.needs for one in known.behaviours.values()):
        return ()
    rules, deck = known.rules, known.deck
    usual = next((one.name for one in rules.patterns if one.on(deck) == deck), "")
    try:
        patterns = Patterns.of(rules, deck, replay.game.patterns)
    except TangyError:  # the activity has changed since
        return (PlayedFor(""),)
    won = wins(replay)
    found, winners = list[PlayedFor](), list[str]()

    def end() -> None:
        name = usual if patterns.present is None else patterns.present.name
        found.append(PlayedFor(name, tuple(winners)))
        winners.clear()

    for moment in sorted([*replay.moments, *replay.staff_changes], key=_order):
        match moment.what:
            case Done() as done if done.number in won:
                winners.append(done.after.place)
            case GameChange(what="patterns chosen", patterns=names):
                patterns.follow_with([n for n in names if n in {p.name for p in rules.patterns}])
            case GameChange(what="played on"):
                end()
                patterns.advance()
            case _:
                pass
    end()
    return (*found, *(PlayedFor(one.name, reached=False) for one in patterns.left))


def _order(moment: Moment) -> tuple[int, str]:
    return moment.step, moment.at
