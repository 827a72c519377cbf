"""Explanations to people who block the robot: soon, once, and again only after a while."""

from __future__ import annotations

import asyncio

from tangy_hw.navigation.surroundings import Blocker
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_hw.robot_process.wait_explanations import AFTER_SECONDS, AGAIN_SECONDS, WaitExplanations

WORDS = {"walking": "After you.", "standing": "May I?"}
LONGEST = 5.0  # s after which every wait must have been explained


async def said(yields_to: list[Blocker], *, halted: bool = False) -> list[tuple[float, str]]:
    """Return the spoken sentences with their times, for a wait of 0.1 s in each state."""
    heard: list[tuple[float, str]] = []
    now = 0.0

    async def says(text: str) -> None:
        heard.append((now, text))
        if halted:
            raise Preempted("stopped")

    explanations = WaitExplanations(WORDS, says)
    for one in yields_to:
        explanations.note(one, now)
        await asyncio.sleep(0)
        now += 0.1
    return heard


async def test_a_person_who_blocks_the_robot_hears_why_within_seconds() -> None:
    ((at, words),) = await said(["walking"] * 40)
    assert words == WORDS["walking"] and AFTER_SECONDS <= at <= LONGEST


async def test_a_passing_person_hears_nothing() -> None:
    assert await said([*["walking"] * 8, *[""] * 5] * 3) == []  # type: ignore[list-item]


async def test_an_explanation_is_repeated_only_after_a_while() -> None:
    heard = await said(["standing"] * 200)
    assert [words for _, words in heard] == [WORDS["standing"]] * 3
    assert heard[1][0] - heard[0][0] >= AGAIN_SECONDS


async def test_a_robot_stopped_in_the_meantime_says_nothing_more() -> None:
    assert len(await said(["walking"] * 30, halted=True)) == 1


async def test_an_activity_without_words_gives_no_explanation() -> None:
    explanations = WaitExplanations({}, lambda text: asyncio.sleep(0))
    for tick in range(60):
        explanations.note("walking", tick / 10)
