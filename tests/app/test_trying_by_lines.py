"""Cards, faces and sound are tried by lines before a game, once the robot is on."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.game_world import LIVE
from tangy_tui.app.readiness import Check, CheckName
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.text import set_up as text


class Robot:
    """What a robot that is on sees and says, in a set-up by lines."""

    def __init__(self, workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
        self.setup, self.written = SetUp.of(workspace), list[str]()
        self.card, self.face = "17", "user3"
        self.cards: dict[int, str] = {}
        self.missing: list[CheckName] = []
        self.spoken, self.stops = list[str](), list[str]()
        dealt = SimpleNamespace(
            owner=lambda card: self.cards.get(card, ""),
            give=lambda person, card: self.cards.update({card: person}),
        )
        self.world = SimpleNamespace(
            cards=SimpleNamespace(dealt=dealt),
            link=SimpleNamespace(stop=self.stops.append),
            played_in=LIVE,
        )
        monkeypatch.setattr(self.setup, "checks", list)
        monkeypatch.setattr(self.setup, "check", self.check)
        monkeypatch.setattr(self.setup, "look_at_card", lambda: self.card)
        monkeypatch.setattr(self.setup, "speak", self.speak)
        monkeypatch.setattr(self.setup, "look_at_face", self.look)

    def check(self, name: CheckName) -> Check:
        return Check(name, "not told" if name in self.missing else "not checked")

    def speak(self, words: str) -> bool:
        self.spoken.append(words)
        return True

    def look(self) -> str:
        self.setup.away.discard(self.face)
        return self.face

    def tries(self, *lines: str) -> bool:
        """Type `try`, and these lines once the robot is on; return whether the game begins."""
        typed = iter(("try", *lines))
        console = SetUpLines(self.setup, lambda: next(typed, None), self.written.append)
        assert console.run()
        self.written.clear()
        self.setup.world = cast(LiveWorld, self.world)
        return console.begins_anyway()


@pytest.fixture
def data_folder(tmp_path: Path) -> Path:
    return tmp_path / "data"


@pytest.fixture
def robot(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> Robot:
    return Robot(workspace, monkeypatch)


def test_the_game_begins_only_when_staff_say_so(robot: Robot) -> None:
    assert robot.tries("sound", "begin") and robot.spoken == [text.SOUND]
    assert not robot.tries("sound", "end")
    assert not robot.tries("sound")


def test_a_card_marks_its_owner_as_present(robot: Robot) -> None:
    robot.setup.away |= {"user2", "user4"}
    assert robot.tries("card", "User 2 has card 17", "card", "begin")
    assert robot.setup.away == {"user4"} and robot.cards == {17: "user2"}
    name = robot.setup.workspace.name("user2")
    assert robot.written.count(text.card_seen_words("17", name)) == 2
    assert robot.written.count(text.whose_line("17")) == 1


def test_a_face_marks_a_person_as_present(robot: Robot) -> None:
    robot.setup.away |= {"user3"}
    assert robot.tries("face", "begin")
    assert not robot.setup.away
    assert text.face_seen_words(robot.setup.workspace.name("user3")) in robot.written


def test_sound_counts_once_staff_have_heard_it(robot: Robot) -> None:
    robot.tries("sound")
    assert not robot.setup.heard and text.SAID_BY_LINES in robot.written
    robot.tries("heard")
    assert robot.setup.heard


def test_nothing_seen_is_told(robot: Robot) -> None:
    robot.card = robot.face = ""
    robot.tries("read card", "who is there?")
    assert {text.NO_CARD, text.NO_FACE_BY_LINES} <= {*robot.written}


def test_a_robot_without_the_device_tells_so(robot: Robot) -> None:
    robot.missing = ["cards", "faces", "sound"]
    robot.tries("card", "face", "sound")
    told = [text.line_of(Check(name, "not told")) for name in robot.missing]
    assert [line for line in robot.written if line in told] == told and not robot.spoken


def test_a_stopped_robot_tries_nothing(robot: Robot) -> None:
    assert robot.tries("stop", "sound", "card", "begin")
    assert len(robot.stops) == 1 and not robot.spoken
    assert robot.written.count(text.STOPPED) == 2
