"""Words of the reports on a person over time and on a care home over months."""

from __future__ import annotations

import calendar
from collections import Counter
from collections.abc import Iterator, Sequence

from tangy_profiles.game_world import GameWorld
from tangy_tui.monitoring.attention import visiting
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.house import Month, PersonInGame, PersonOverTime, RobotLog
from tangy_tui.monitoring.presence import stays
from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.text.numbers import counted, listed, often
from tangy_tui.text.report import (
    asked_words,
    helped_words,
    response_words,
    time_words,
    usual_words,
    visiting_words,
    visits_words,
    waited_words,
)
from tangy_tui.text.results import ways_of
from tangy_tui.text.taking_part import stay_words, won_words
from tangy_tui.text.times import length, on_day
from tangy_tui.text.worlds import WORLDS_IN_REPORTS

NOTHING = "\N{EN DASH}"
MONTHS = "Month by month"
MONTH_COLUMNS = (
    "month", "games", "what was played", "time", "people", "asked for help", "waited",
    "never visited", "faults", "not played to the end",
)  # fmt: skip
WHO = "Who took part"
WHO_COLUMNS = (
    "person", "games", "last here", "asked for help", "waited", "visits", "time with Tangy",
    "did as asked", "won",
)  # fmt: skip
GAMES = "Game by game"
GAME_COLUMNS = (
    "when", "what was played", "there", "asked for help", "waited", "visits", "time with Tangy",
    "help given", "did as asked", "won",
)  # fmt: skip
ALL_THE_TIME = "all the time"
NO_VISIT = "none"
"""Of who was not there all the time: "never" would tell of a person who was forgotten."""
WORKS = "What works"
STRATEGY_COLUMNS = ("way of asking", "asked", "did it in time", "did it late", "share in time")
FAULTS = "What went wrong, and how often"
FAULT_COLUMNS = ("fault", "times", "critical", "last")
ROBOTS = "Robots"
ROBOT_COLUMNS = ("robot", "games", "time", "faults")
NOT_THERE = "Not in this log"
SAME_NAME = "People with the same name in the logs of several robots count as one person."
EACH_WORLD = "This report covers only these games. For others, add --world {others}."


def house_title(logs: Sequence[RobotLog]) -> str:
    """Return the title of a house's report."""
    return "The house" if len(logs) == 1 else f"The house, with {counted(len(logs), 'robot')}"


def scope(world: GameWorld, games: int) -> str:
    """Tell which games a report covers."""
    return f"{counted(games, 'game')}, {WORLDS_IN_REPORTS[world]}"


def others_words(worlds: Sequence[GameWorld]) -> str:
    """Name the worlds whose games are left out; "" if there are none."""
    return EACH_WORLD.format(others=listed(worlds, "or")) if worlds else ""


def notes(
    logs: Sequence[RobotLog],
    games: Sequence[tuple[RobotLog, GameReplay]],
    others: Sequence[GameWorld],
) -> Iterator[str]:
    """Tell what the figures of a report cover: visits, worlds, and the logs of several robots."""
    yield from filter(None, [visiting_words([replay for _, replay in games])])
    yield from filter(None, [others_words(others)])
    if len(logs) > 1:
        yield SAME_NAME


def month_rows(months: Sequence[Month]) -> Iterator[tuple[str, ...]]:
    """Write one row for each month."""
    for month in months:
        people = month.people
        every = [wait for person in people for wait in person.sum.waits]
        never = [person.name for person in people if person.sum.never_visited]
        replays = [replay for _, replay in month.games]
        faults = [fault for replay in replays for fault in replay.real_faults]
        critical = sum(fault.critical for fault in faults)
        yield (
            f"{calendar.month_name[month.month]} {month.year}",
            str(len(replays)),
            played_words(replays),
            length(sum(replay.seconds for replay in replays)),
            str(len(people)),
            often(sum(person.sum.requests for person in people)),
            usual_words(every) if every else NOTHING,
            ", ".join(never) or ("nobody" if visiting(replays)[0] else NOTHING),
            f"{len(faults)}, {critical} critical" if critical else str(len(faults)),
            str(sum(not replay.game.smooth for replay in replays)),
        )


def played_words(replays: Sequence[GameReplay]) -> str:
    """Name what was played, and how often if more than once: "Trivia (twice), Bingo"."""
    counts = Counter(replay.title for replay in replays)
    return ", ".join(t if n == 1 else f"{t} ({often(n)})" for t, n in counts.items())


def who_rows(people: Sequence[PersonOverTime]) -> Iterator[tuple[str, ...]]:
    """Write one row for each person."""
    for person in people:
        added = person.sum
        yield (
            person.name,
            str(len(person.games)),
            on_day(person.games[-1].at),
            asked_words(added),
            waited_words(added),
            visits_words(added),
            time_words(added),
            response_words(person.answers),
            str(added.won or ""),
        )


def game_rows(games: Sequence[PersonInGame]) -> Iterator[tuple[str, ...]]:
    """Write one row for each game of a person."""
    for one in games:
        got = one.attention
        there = stay_words(stays([one.replay]).get(got.id, ()))
        yield (
            on_day(one.at),
            one.replay.title,
            there or ALL_THE_TIME,
            asked_words(got),
            waited_words(got),
            NO_VISIT if there and got.never_visited else visits_words(got),
            time_words(got),
            helped_words(got, filter(None, [one.replay.activity])),
            response_words(one.answers),
            won_words(one.replay, got.id) or ("yes" if got.won else ""),
        )


def strategy_rows(person: PersonOverTime) -> Iterator[tuple[str, ...]]:
    """Write one row for each strategy: how often it was used, and how often it worked.

    It has its words of the session's report.
    """
    known = [answer for answer in person.answers if answer.complied is not None]
    activities = [one.replay.activity for one in person.games]
    ways = {name: way for one in activities if one is not None for name, way in ways_of(one)}
    used = Counter(answer.strategy for answer in known)
    did = Counter(answer.strategy for answer in known if answer.complied)
    late = Counter(one.strategy for one in known if not one.complied and one.followed)
    for strategy, times in used.most_common():
        yield (
            ways.get(strategy, strategy),
            str(times),
            str(did[strategy]),
            str(late[strategy]),
            f"{did[strategy] / times:.0%}",
        )


def fault_rows(games: Sequence[tuple[RobotLog, GameReplay]]) -> Iterator[tuple[str, ...]]:
    """Write one row for each kind of fault, the most frequent first."""
    found: dict[str, list[tuple[Fault, GameReplay]]] = {}
    for _, replay in games:
        for fault in replay.real_faults:
            found.setdefault(fault.code, []).append((fault, replay))
    for same in sorted(found.values(), key=len, reverse=True):
        fault, replay = same[-1]
        critical = "yes" if fault.critical else ""
        yield fault.name, str(len(same)), critical, on_day(replay.game.at)


def robot_rows(logs: Sequence[RobotLog], world: GameWorld) -> Iterator[tuple[str, ...]]:
    """Write one row for each robot."""
    for log in logs:
        own = [replay for replay in log.replays if replay.game.world == world]
        faults = sum(len(replay.real_faults) for replay in own)
        yield log.label, str(len(own)), length(sum(r.seconds for r in own)), str(faults)


def nobody_called(name: str, there: Sequence[str]) -> str:
    """Tell that nobody with a name took part in these games, and who did."""
    who = f" {listed(there)} did." if there else ""
    return f"Nobody called {name!r} took part in these games.{who}"


def written_words(tables: Sequence[tuple[str, int]], place: object) -> str:
    """Tell which tables were written, with how many rows each."""
    told = listed(f"{name} ({counted(rows, 'row')})" for name, rows in tables)
    return f"Written to {place}: {told}."
