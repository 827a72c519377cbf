"""Scores diagnoses against injected faults: recall and precision by kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any

from tangy_profiles.faults import FaultBook
from tangy_sim.worlds.injection_log import Injected
from tangy_tui.monitoring.drill_rounds import round_kinds
from tangy_tui.monitoring.fault import ENDINGS, Fault

Z = 1.96  # of a 95% interval


def share_interval(share: float, n: int) -> tuple[float, float]:
    """Return the Wilson 95% interval of a share in n trials, within [0, 1]."""
    middle = (share + Z * Z / (2 * n)) / (1 + Z * Z / n)
    half = Z * sqrt(share * (1 - share) / n + Z * Z / (4 * n * n)) / (1 + Z * Z / n)
    return max(0.0, min(share, middle - half)), min(1.0, max(share, middle + half))


@dataclass(frozen=True)
class ScoredInjection:
    """One injected fault and its diagnosis, in steps; recovery in s of game time."""

    game: int
    kind: str
    step: int
    could_show: int | None
    seen: int | None
    named: int | None
    called: str
    """The code of its first diagnosis; "" if it was not detected."""
    recovered: float | None
    """The time (s) from its diagnosis until it was over, or Tangy continued with it."""

    def to_json(self) -> dict[str, Any]:
        """Return it as `--json` lists it; `step` is when it occurred."""
        return {
            "game": self.game,
            "fault": self.kind,
            "step": self.step,
            "could_show": self.could_show,
            "seen": self.seen,
            "named": self.named,
            "called": self.called,
            "recovered_after": self.recovered,
        }


@dataclass(frozen=True)
class GameScore:
    """The injected faults of one game, and the codes of false alarms."""

    injections: tuple[ScoredInjection, ...]
    false_alarms: tuple[str, ...]


def score_game(
    number: int, injected: Sequence[Injected], faults: Sequence[Fault], book: FaultBook
) -> GameScore:
    """Match the diagnosed faults of a game to the injected ones.

    The right diagnosis is the code of the injected kind, or that of its combination with other
    injected kinds (no voice and no screen: mute). A wrong code, while a detectable injection has no
    right diagnosis yet, counts as a wrong diagnosis of that injection. All others are false alarms,
    except a fault that takes over from a rightly diagnosed one whose requests failed.
    """
    told = [fault for fault in faults if not fault.asks_only]
    right = {id(one): _codes(one, injected, book) for one in injected}
    named: dict[int, Fault] = {}
    mistaken: dict[int, Fault] = {}
    false: list[str] = []
    for fault in told:
        there = [one for one in injected if one.step <= fault.step + 1]
        new = [one for one in there if id(one) not in named and fault.code in right[id(one)]]
        if new:
            together = fault.code != new[0].kind.code
            named |= dict.fromkeys(map(id, new if together else new[:1]), fault)
        elif not (
            any(fault.code in right[id(one)] for one in there)
            or any(takes_over(fault, one) for one in named.values())
        ):
            open_ = [one for one in there if id(one) not in named and one.could_show is not None]
            if open_:
                mistaken.setdefault(id(open_[-1]), fault)
            else:
                false.append(fault.code)
    scored = []
    for one in injected:
        found, wrong = named.get(id(one)), mistaken.get(id(one))
        first = min(filter(None, (found, wrong)), key=lambda f: f.seconds, default=None)
        seen = None if first is None else first.step
        scored.append(
            ScoredInjection(
                number,
                one.kind.name,
                one.step,
                one.could_show if seen is None else one.could_show or seen,
                seen,
                None if found is None else found.step,
                "" if first is None else first.code,
                None if found is None else seconds_to_recover(found),
            )
        )
    return GameScore(tuple(scored), tuple(false))


def takes_over(fault: Fault, earlier: Fault) -> bool:
    """Return whether a fault takes over from an earlier one with the same person."""
    last = earlier.moves[-1] if earlier.moves else None
    left = last is not None and last.kind == "left" and last.seconds == fault.seconds
    return left and earlier.person == fault.person is not None


def _codes(one: Injected, injected: Sequence[Injected], book: FaultBook) -> frozenset[str]:
    came = {other.kind.name for other in injected}
    together = (
        way.code
        for way in round_kinds(book)
        if len(way.injections) > 1 and one.kind.name in way.injections and came >= {*way.injections}
    )
    return frozenset((one.kind.code, *together))


def seconds_to_recover(fault: Fault) -> float | None:
    """Return the time (s) from diagnosis to recovery or toleration, or None."""
    for move in fault.moves:
        if move.kind in ENDINGS or move.kind == "went on":
            return move.seconds - fault.seconds
    return None


def summary(games: Sequence[GameScore]) -> dict[str, Any]:
    """Return recall and precision, overall and by kind, with n and 95% intervals.

    Recall: the share of detectable injections with a right diagnosis. Precision of a kind: the
    share of detected injections whose first diagnosis was right; overall, false alarms count too.
    """
    every = [one for game in games for one in game.injections]
    false = [code for game in games for code in game.false_alarms]
    kinds = dict.fromkeys(one.kind for one in every)
    return {
        "kinds": {kind: _of_kind([one for one in every if one.kind == kind]) for kind in kinds},
        "recall": _recall(every),
        "precision": share_document([*_right_at_first(every), *(False for _ in false)]),
        "false_alarms": {code: false.count(code) for code in dict.fromkeys(false)},
        "games_with_a_false_alarm": sum(bool(game.false_alarms) for game in games),
    }


def scores_document(games: Sequence[GameScore]) -> dict[str, Any]:
    """Return every injection and the summary, as `--json` prints them."""
    scored = [one.to_json() for game in games for one in game.injections]
    return {"scored": scored, "score": summary(games)}


def _recall(those: Sequence[ScoredInjection]) -> dict[str, Any]:
    return share_document([one.named is not None for one in those if one.could_show is not None])


def _right_at_first(those: Sequence[ScoredInjection]) -> list[bool]:
    return [one.named == one.seen for one in those if one.seen is not None]


def _of_kind(those: Sequence[ScoredInjection]) -> Mapping[str, Any]:
    return {
        "came": len(those),
        "recall": _recall(those),
        "precision": share_document(_right_at_first(those)),
        "recovered": sum(one.recovered is not None for one in those),
    }


def share_document(flags: Sequence[bool]) -> dict[str, Any]:
    """Return the number of flags, the share that is true, and its 95% interval."""
    if not flags:
        return {"n": 0, "share": None, "interval": None}
    share = sum(flags) / len(flags)
    low, high = share_interval(share, len(flags))
    return {"n": len(flags), "share": round(share, 3), "interval": [round(low, 3), round(high, 3)]}
