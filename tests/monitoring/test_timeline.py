"""The drawing of a game agrees with the tables of its report."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from tangy_profiles.state import FRONT
from tangy_tui.monitoring.attention import attention_in
from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.pages.timeline import LANE, MANY, NARROW, stages_of, timeline
from tests.monitoring.test_attention import replay_of, state


def bars(replay: GameReplay, kind: str) -> list[tuple[float, float]]:
    """Return the bars of a kind: where each begins and ends."""
    drawn = timeline(replay, {}, {}, {stage: stage for stage in stages_of([replay])})
    found = re.findall(rf'class="{kind}" x="([\d.]+)" y="[\d.]+" width="([\d.]+)"', drawn)
    return [(float(x), float(x) + float(width)) for x, width in found]


@pytest.mark.parametrize("timed", [True, False])
def test_a_wait_is_drawn_until_tangy_arrives(timed: bool) -> None:
    asks, there = state(FRONT, ["ann"]), state("ann", ["ann"])
    replay = replay_of(state(FRONT), asks, asks, there, there, state(FRONT))
    replay.timed = timed
    ((begun, over),), ((arrived, left),) = bars(replay, "asks"), bars(replay, "visit")
    assert begun < over < left
    assert over == pytest.approx(arrived, abs=0.2)


def test_a_request_during_the_step_before_the_visit_is_drawn_as_long_as_the_table_tells() -> None:
    replay = replay_of(state(FRONT), state(FRONT), state("ann", ["ann"]), state(FRONT))
    asking = replace(replay.done[1], state=state(FRONT, ["ann"]))
    moments = [replace(m, what=asking) if m.what is replay.done[1] else m for m in replay.moments]
    replay = replace(replay, moments=moments)
    ((begun, over),), ((arrived, left),) = bars(replay, "asks"), bars(replay, "visit")
    assert over == pytest.approx(arrived, abs=0.2)
    assert attention_in(replay)["ann"].waits == [10.0]
    assert over - begun == pytest.approx(left - arrived, abs=0.2), "ten seconds each"


def test_a_number_that_is_called_during_a_visit_has_its_tick() -> None:
    replay = replay_of(state(FRONT), state("ann"), state("ann"), target="ann")
    called = replace(replay.done[1], target=None, draws=True)
    moments = [replace(m, what=called) if m.what is replay.done[1] else m for m in replay.moments]
    replay = replace(replay, moments=moments)
    drawn = timeline(replay, {}, {}, {stage: stage for stage in stages_of([replay])})
    assert drawn.count('class="tick"') == 1


def test_a_drawing_of_many_people_is_low_enough_to_print() -> None:
    def height(people: int) -> float:
        replay = replay_of(state(FRONT), state(FRONT))
        replay.game = replace(replay.game, people=tuple(f"user{n}" for n in range(people)))
        drawn = timeline(replay, {}, {}, {stage: stage for stage in stages_of([replay])})
        return float(drawn.split('viewBox="0 0 1000 ')[1].split('"')[0])

    assert height(MANY) - height(MANY - 1) == LANE
    assert height(MANY + 4) - height(MANY + 3) == NARROW
