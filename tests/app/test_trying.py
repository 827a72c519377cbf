"""A trial game lists people's actions after each step, and who stayed silent."""

from __future__ import annotations

from pathlib import Path

from tangy_profiles.declared.activity import read_declared
from tangy_profiles.person import load_people
from tangy_tui.app.trying import tried_game
from tangy_tui.text.activities import SAYS_NOTHING, activity_lines, people_did, tried_lines
from tests.support.changed import changed_trivia
from tests.support.declared import declared
from tests.support.media import guess_the_sound


def test_several_actions_of_a_person_after_a_step_are_listed() -> None:
    told = [
        did
        for seed in range(1, 6)
        for step in tried_game(declared("exercises"), 3, seed)
        for did in step.doing.values()
    ]
    assert any(", " in did for did in told)


def test_actions_of_people_are_worded_by_the_file_and_kept_as_facts() -> None:
    steps = list(tried_game(declared("trivia"), 3, 1))
    told = {did for step in steps for did in step.doing.values()}
    assert "it is right" in told or "it is wrong" in told
    assert not any(":" in did for did in told)
    answers = [act for step in steps for act in step.facts if act.fact == "answer"]
    assert {act.value for act in answers} <= {"right", "wrong"} and answers


def test_the_person_of_each_step_has_a_name() -> None:
    names = {one.name for one in load_people(3)}
    steps = [step for step in tried_game(declared("trivia"), 3, 1) if "an answer" in step.situation]
    assert steps
    assert all(any(name in step.situation for name in names) for step in steps)


def test_silent_people_who_are_asked_again_are_listed(tmp_path: Path) -> None:
    rarely = ('turn is yes"], chance = 0.4', 'turn is yes"], chance = 0.1')
    steps = list(tried_game(changed_trivia(tmp_path, rarely), 2, 1))
    silent = [step for step in steps if step.silent]
    assert {step.behaviour for step in silent} == {"ask question"}
    assert SAYS_NOTHING in people_did(silent[0].doing, silent[0].silent)


def test_pictures_and_sounds_are_listed_by_step_and_in_total(tmp_path: Path) -> None:
    file = guess_the_sound(tmp_path)
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace('picture = "{photo}"', 'picture = "{photo}"\npause = 12'))
    activity = read_declared(file)
    steps = list(tried_game(activity, 2, 1))
    (first,) = next(step.media for step in steps if step.behaviour == "play a sound")
    assert first.endswith(".wav")
    told = [line for step in steps for line in tried_lines(step)]
    assert f"   Tangy shows or plays: {first}" in told
    whole = "\n".join(activity_lines(activity))
    assert "start clock, plays {clip}\n" in whole
    assert "next turn, shows {photo}, waits 12 s\n" in whole
