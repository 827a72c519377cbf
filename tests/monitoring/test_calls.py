"""Calls about a halted robot: only an answer counts, and every stage is logged."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

from tangy_hw.calling import CallNews
from tangy_profiles.contacts import EXPERT, STAFF_ROLE, Contact
from tangy_profiles.errors import ProfileError
from tangy_profiles.game_records import CallMade
from tangy_profiles.game_world import BENCH
from tangy_profiles.robot import load_robot
from tangy_profiles.store import Store
from tangy_sim.worlds.injection import read_injection
from tangy_tui.app.simulated_worlds import game_world
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.calls import Calls
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text.calls import REHEARSAL, call_words, expert_words
from tangy_tui.text.live_news import live_lines
from tests.monitoring.conftest import Supervise
from tests.support.telephone import ANNA, STATION, Line
from tests.support.waiting import wait_until


@pytest.fixture
def line() -> Line:
    return Line()


@pytest.fixture
def calls(workspace: Workspace, line: Line, monkeypatch: pytest.MonkeyPatch) -> Calls:
    monkeypatch.setattr("tangy_tui.monitoring.supervision.FIRST_SECONDS", 0.0)
    robot = replace(workspace.robot, expert=ANNA, staff=STATION)
    return Calls(robot, workspace.store.append, line)


def logged(store: Store) -> list[tuple[str, str, str]]:
    return [(e.record.role, e.record.stage, e.record.said) for e in store.events(CallMade)]


def halted(supervise: Supervise, calls: Calls) -> Supervision:
    """Play until a lost link halts the robot, with calls."""
    game = supervise("link-lost@3")
    game.call_by(calls)
    game.begin()
    while game.halted is None:
        game.step()
    return game


def test_a_halt_calls_staff_and_staff_call_the_expert(
    supervise: Supervise, calls: Calls, line: Line
) -> None:
    game = halted(supervise, calls)
    wait_until(lambda: "Station 2" in line.told, "staff are called")
    assert calls.state(EXPERT) is None
    game.call_expert("Ada")
    wait_until(lambda: "Anna Berg" in line.told, "the expert is called")
    assert line.messages[1]["fault"] == "link-lost" and line.messages[1]["text"]


def test_failed_late_and_confirmed_calls_are_distinguished(
    supervise: Supervise, calls: Calls, line: Line, workspace: Workspace
) -> None:
    game = halted(supervise, calls)
    game.call_expert("Ada")
    words = [expert_words(game)]
    line.says("Anna Berg", "failed", "no line")
    words.append(expert_words(game))
    game.call_expert("Ada")  # repeated
    line.says("Anna Berg", "sent")
    words.append(expert_words(game))
    assert all("030 901820" in one for one in words)  # staff must telephone themselves
    line.says("Anna Berg", "answered", "I am on my way")
    assert "030 901820" not in expert_words(game) and "I am on my way" in expert_words(game)
    line.says("Anna Berg", "failed", "too late")
    assert "I am on my way" in expert_words(game)  # an answered call stays answered
    assert game.reached("Ada") and "I am on my way" in expert_words(game)
    stages = [stage for role, stage, _ in logged(workspace.store) if role == EXPERT]
    assert stages == ["tried", "failed", "tried", "sent", "answered"]


def test_an_answer_about_an_earlier_fault_does_not_count_for_a_later_one(
    supervise: Supervise, calls: Calls, line: Line, workspace: Workspace
) -> None:
    game = supervise("link-lost@3", "laser-disconnected@9")
    game.call_by(calls)
    game.begin()
    while game.halted is None:
        game.step()
    game.call_expert("Ada")
    wait_until(lambda: "Anna Berg" in line.told, "the expert is called")
    earlier = line.told["Anna Berg"]
    game.clear("Ada")
    while game.halted is None and not game.over:
        game.step()
    assert game.halted is not None and game.halted.code == "laser-disconnected"
    earlier(CallNews("answered", "Coming."))
    assert calls.state(EXPERT) is None
    assert logged(workspace.store)[-1] == (EXPERT, "answered", "Coming.")


class SlowButtons:
    """A chest screen whose first offer is delayed so that a later one could overtake it."""

    on_answer: Callable[[str], object]

    def __init__(self) -> None:
        self.shown: list[list[str]] = []
        self.first, self.passed = Event(), Event()

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        if not self.first.is_set():
            self.first.set()
            self.passed.wait(0.2)
        self.shown.append(list(calls.values()))
        self.passed.set()


def test_the_newest_offer_is_the_last_on_the_chest_screen(
    supervise: Supervise, workspace: Workspace, line: Line
) -> None:
    robot, buttons = replace(workspace.robot, staff=STATION), SlowButtons()
    calls = Calls(robot, list[object]().append, line, buttons=buttons)
    game = supervise("link-lost@3")
    game.begin()
    while game.halted is None:
        game.step()
    beginning = Thread(target=calls.begin, args=(game.halted,))
    beginning.start()
    assert buttons.first.wait(20)
    calls.end()
    beginning.join(20)
    assert buttons.shown[-1] == [], "nobody is called any more"


def test_a_robot_without_contacts_reports_no_call(
    supervise: Supervise, workspace: Workspace, line: Line
) -> None:
    robot = replace(workspace.robot, expert=Contact("Anna Berg", "030 901820"))
    game = supervise("link-lost@3")
    game.robot = robot
    game.call_by(Calls(robot, workspace.store.append, line))
    game.begin()
    while game.halted is None:
        game.step()
    game.call_expert("Ada")
    assert not line.messages and "calls nobody" in expert_words(game)
    assert logged(workspace.store) == []
    assert game.reached("Ada")  # staff telephoned her themselves
    assert logged(workspace.store) == [(EXPERT, "reached", "Ada")]
    assert "Anna Berg was reached, by Ada." in expert_words(game)  # nobody claims that she answered


def test_the_outcome_of_a_call_is_an_event_of_the_game(
    supervise: Supervise, calls: Calls, line: Line
) -> None:
    game = supervise("link-lost@3")
    game.call_by(calls)
    game.begin()
    told: list[CallMade] = []
    while game.halted is None:
        told += [one for one in game.step() if isinstance(one, CallMade)]
    told += [one for one in game.look() if isinstance(one, CallMade)]
    line.says("Station 2", "answered", "coming")
    told += [one for one in game.look() if isinstance(one, CallMade)]
    assert [(one.role, one.stage, one.said) for one in told] == [
        (STAFF_ROLE, "tried", ""),
        (STAFF_ROLE, "answered", "coming"),
    ]
    assert not game.look()  # each call only once
    assert live_lines(told, [], str) == [
        "The staff (command): a message is being sent.",
        "The staff (command): was reached, and answered: coming.",
    ]


def test_an_answer_after_the_game_is_not_reported_in_the_next(
    supervise: Supervise, calls: Calls, line: Line
) -> None:
    game = halted(supervise, calls)
    game.look()
    game.clear("Ada")
    game.begin()
    line.says("Station 2", "answered", "coming")
    assert not [one for one in game.look() if isinstance(one, CallMade)]


def test_the_bench_calls_people_only_in_a_rehearsal(
    workspace: Workspace, learnt: Policy, tmp_path: Path
) -> None:
    kept = tmp_path / "message"
    program = "import sys; open(sys.argv[1], 'w').write(sys.stdin.read()); print('answered: me')"
    ring = Contact("Station 2", command=(sys.executable, "-c", program, str(kept)))
    workspace.robot = replace(workspace.robot, staff=ring)
    world = game_world(
        workspace.activity, list(workspace.names), 1, [read_injection("link-lost@3")]
    )
    world.played_in = BENCH
    assert workspace.supervision(learnt, 1, world=world).calls is None
    game = workspace.supervision(learnt, 1, world=world, rehearsal=REHEARSAL)
    game.begin()
    while game.halted is None:
        game.step()
    wait_until(lambda: (STAFF_ROLE, "answered", "me") in logged(workspace.store), "they answer")
    message = json.loads(kept.read_text())
    assert message["text"].startswith(REHEARSAL) and game.halted.unnamed in message["text"]


def test_simulated_games_call_nobody(supervise: Supervise) -> None:
    assert supervise("link-lost@3").calls is None


def test_each_stage_of_a_call_has_its_own_words(calls: Calls) -> None:
    from tangy_tui.monitoring.calls import CallState

    stages = ("tried", "sent", "failed", "answered", "reached")
    words = [call_words(CallState(STAFF_ROLE, STATION, stage)) for stage in stages]  # type: ignore[arg-type]
    assert len(set(words)) == 5 and all("Station 2" in one for one in words)


@pytest.mark.parametrize(
    ("lines", "key"),
    [
        ('url = "ftp://x"', "expert.url"),
        ('url = "http://x"\ncommand = ["a"]', "expert.url"),
        ("command = 3", "expert.command"),
        ('colour = "red"', "expert"),
    ],
)
def test_an_invalid_contact_is_refused_with_its_key(
    lines: str, key: str, tmp_path: Any, workspace: Workspace
) -> None:
    file = tmp_path / "mine.toml"
    text = workspace.robot.file.read_text()
    file.write_text(f'{text}\n[expert]\nname = "Anna"\n{lines}\n')
    with pytest.raises(ProfileError, match=key):
        load_robot(str(file))
