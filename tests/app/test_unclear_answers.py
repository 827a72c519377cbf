"""Unclear answers reported by staff or by speech: the person is asked again."""

from __future__ import annotations

from pathlib import Path
from typing import cast

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_profiles.defaults import ASK_AGAIN
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_tui.app.game_commands import Tell
from tangy_tui.app.robot_controls import RobotControls
from tests.hw.links import FakeLink
from tests.support.changed import patient_trivia


def test_an_unclear_answer_is_asked_again_before_staff_are_asked(tmp_path: Path) -> None:
    link, activity = FakeLink(("user1", "user2")), patient_trivia(tmp_path)
    world = DeclaredLiveWorld(
        activity,
        ("user1", "user2"),
        cast(RobotLink, link),
        load_robot(),
        load_room(),
        seed=1,
        names={"user1": "Ann", "user2": "Ben"},
    )
    world.begin()
    noted: list[str] = []
    controls = RobotControls(world, lambda did, **_: noted.append(did), lambda: False, paced=False)

    def do(name: str, target: str | None = None) -> None:
        world.execute(activity.action(activity.behaviour(name), target, None))

    do("welcome everyone")
    do("ask question", "user1")
    said = len(link.said)
    for number in range(activity.asking.visit):
        assert controls.do(Tell(None, "b?")).kind == "told unclear"
        do("allow time")
        text = ASK_AGAIN[number % len(ASK_AGAIN)].replace("{name}", "Ann")
        assert text in link.said[said:]
        said = len(link.said)
    refused = controls.do(Tell(None, "b?"))
    assert refused.kind == "not told" and refused.words
    assert world.observe().stage == "listen"
    assert controls.do(Tell(None, "b")).kind == "told wrong"
    assert world.observe().stage == "judge"


def test_only_a_certain_spoken_answer_is_judged(tmp_path: Path) -> None:
    link, activity = FakeLink(("user1", "user2")), patient_trivia(tmp_path)
    world = DeclaredLiveWorld(
        activity, ("user1", "user2"), cast(RobotLink, link), load_robot(), load_room(), seed=1
    )
    world.begin()
    noted: list[tuple[str, str]] = []

    def note(did: str, *, person: str = "", detail: str = "") -> None:
        noted.append((did, person))

    controls = RobotControls(world, note, lambda: False, paced=False)
    for name, target in (("welcome everyone", None), ("ask question", "user1")):
        world.execute(activity.action(activity.behaviour(name), target, None))
    option = activity.declaration.items.value(world.game.row, "a")
    assert controls.do(Tell(None, option, 0.5, "speech")).kind == "told unclear"
    assert world.observe().stage == "listen"
    done = world.execute(activity.action(activity.behaviour("allow time"), None, None))
    assert [(one.source, one.asked_again) for one in done.unclear] == [("speech", True)]
    assert controls.do(Tell(None, option, 0.95, "speech")).kind == "told right"
    assert world.observe().stage == "judge"
    assert ("heard", "user1") in noted
