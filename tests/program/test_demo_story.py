"""The demo consists of real runs: its frames match the log, the policy and the game."""

from __future__ import annotations

from contextlib import closing
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tangy_profiles.game_records import FaultDiagnosed
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.demo import tell
from tangy_tui.console.story import Story, StoryFrame
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.policies import need_policy
from tangy_tui.text import demo as text

MINUTES = (2, 5)
"""The shortest and the longest time to read the story."""


@cache
def told() -> tuple[tuple[StoryFrame, ...], list[object], dict[str, str]]:
    """Tell the story once: its frames, the faults in its log, and the people of its steps."""
    with TemporaryDirectory() as folder, closing(Workspace(Path(folder))) as workspace:
        frames = tuple(Story(workspace, 1).frames())
        (shown,) = read_demonstrations(workspace.store, "bingo")
        assert shown.finished
        faults: list[object] = list(workspace.store.events(FaultDiagnosed))
        policy = need_policy(workspace.store, workspace.activity, "")
        assert policy.demonstrations == (shown.id,)
        steps = {str(n): step.target or "" for n, step in enumerate(shown.steps, 1)}
        return frames, faults, steps


def frames_of(caption: str) -> list[StoryFrame]:
    return [frame for frame in told()[0] if frame.caption == caption]


def test_a_question_is_shown_before_its_behaviour() -> None:
    (asked,) = frames_of(text.IT_ASKS)
    assert asked.asked
    assert not asked.lines
    (done,) = frames_of(text.SHE_SAYS_YES)
    assert asked.asked in done.lines[0]


def test_a_mistake_is_noticed_undone_and_not_learnt() -> None:
    slip = frames_of(text.SLIP)[-1]
    (noticed,) = frames_of(text.NOTICED)
    (back,) = frames_of(text.TAKEN_BACK)
    assert slip.room == back.room
    assert noticed.room != slip.room
    wrong, right = noticed.lines[-2], frames_of(text.NOW_RIGHT)[-1].lines[-1]
    number, kept = right.split(".")[0], told()[2]
    assert wrong.startswith(f"{number}. ")
    assert f"(User {kept[number].removeprefix('user')})" in right
    assert f"(User {kept[number].removeprefix('user')})" not in wrong


def test_a_person_who_refuses_is_asked_in_another_way() -> None:
    (worked,) = [f for f in told()[0] if f.caption.startswith("That worked.")]
    assert worked.scene == 4
    before = [f.caption for f in told()[0][: told()[0].index(worked)] if f.scene == 4]
    assert any(
        "does it a little late" in caption or "would rather not" in caption for caption in before
    )


def test_a_simulated_fault_is_diagnosed_and_recovered() -> None:
    assert len(told()[1]) == 1
    kinds = [text.NOW_A_FAULT, text.DIAGNOSED, text.ASKS_PEOPLE, text.RECOVERED]
    assert [len(frames_of(caption)) for caption in kinds] == [1, 1, 1, 1]


def test_the_demo_runs_at_reading_pace() -> None:
    seconds = sum(frame.seconds for frame in told()[0])
    assert MINUTES[0] * 60 < seconds < MINUTES[1] * 60
    captions = {frame.caption: frame.seconds for frame in reversed(told()[0])}
    for caption, shown in captions.items():
        assert len(caption.split()) / shown < 4, caption


def test_captions_fit_the_two_lines_of_a_small_screen() -> None:
    assert all(len(frame.caption) < 2 * 76 - 14 for frame in told()[0][1:])


@pytest.mark.slow
@pytest.mark.parametrize("activity", ["exercises", "memory", "trivia"])
def test_other_activities_have_a_demo(tmp_path: Path, activity: str) -> None:
    with closing(Workspace(tmp_path, activity=activity)) as workspace:
        scenes = [frame.scene for frame in Story(workspace, 1).frames()]
    assert scenes == sorted(scenes)
    assert {1, 2, 3, 4, 6} <= set(scenes)


def test_the_demo_by_lines_prints_each_scene_and_caption_once(tmp_path: Path) -> None:
    said: list[str] = []
    with closing(Workspace(tmp_path)) as workspace:
        tally = tell(workspace, 1, said.append)
    assert tally["games"] == 1
    heads = [line for line in said if line.startswith("Scene ")]
    assert heads == [text.scene_words(number) for number in range(1, len(text.SCENES) + 1)]
    assert len([line for line in said if line.strip() == text.RECOVERED]) == 1
    assert said[-2].strip() == text.YOUR_TURN_LINES[-1]
