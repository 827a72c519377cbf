"""Secondary symptoms: devices behind a lost link are no faults until they were healthy once."""

from __future__ import annotations

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import Evidence, FaultBook
from tangy_profiles.health import ERROR, Health, Reading
from tangy_profiles.robot import load_robot
from tangy_sim.worlds.devices import WELL
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.detection import device_evidence
from tangy_tui.monitoring.diagnosis import diagnose
from tangy_tui.monitoring.secondary_symptoms import GRACE_SECONDS, SecondarySymptoms
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text.faults import still_there_words
from tests.support.games import codes, moves

ROBOT = load_robot()
LONG = 4.0  # s of silence
NOT_THE_LINK = tuple(name for name in ROBOT.devices if name != "link")


def silent(*devices: str) -> Health:
    """Return readings of which these devices have been silent for a long time."""
    return tuple(r._replace(age=LONG) if r.device in devices else r for r in WELL)


class Seen:
    """The faults that remain without secondary symptoms, as devices come and go."""

    def __init__(self) -> None:
        self.book: FaultBook = load_faults(ROBOT)
        self.secondary = SecondarySymptoms(self.book, ROBOT.devices)

    def at(self, now: float, health: Health) -> list[str]:
        evidence: Evidence = self.secondary.without(device_evidence(ROBOT, health), lambda: now)
        found = diagnose(self.book, evidence)
        self.secondary.take(found, evidence)
        return [one.rule.code for one in found]


@pytest.mark.parametrize("device", NOT_THE_LINK)
def test_a_device_that_returns_after_the_link_is_no_separate_fault(device: str) -> None:
    seen = Seen()
    assert seen.at(0.0, silent(*ROBOT.devices)) == ["link-lost"]
    assert seen.at(4.0, silent(device)) == []
    assert seen.at(4.0 + GRACE_SECONDS / 2, silent(device)) == []
    assert seen.at(4.0 + GRACE_SECONDS, WELL) == []


@pytest.mark.parametrize("device", NOT_THE_LINK)
def test_a_device_silent_beyond_its_grace_period_is_a_fault(device: str) -> None:
    seen = Seen()
    seen.at(0.0, silent(*ROBOT.devices))
    assert seen.at(4.0, silent(device)) == []
    (code,) = seen.at(4.0 + GRACE_SECONDS + 0.1, silent(device))
    assert code != "link-lost"


@pytest.mark.parametrize("device", NOT_THE_LINK)
def test_a_recovered_device_that_falls_silent_is_a_fault(device: str) -> None:
    seen = Seen()
    seen.at(0.0, silent(*ROBOT.devices))
    assert seen.at(4.0, WELL) == []
    assert len(seen.at(4.2, silent(device))) == 1


def test_a_repeatedly_lost_link_explains_its_devices_each_time() -> None:
    seen = Seen()
    for began in range(0, 20, 4):
        assert seen.at(began, silent(*ROBOT.devices)) == ["link-lost"]
        assert seen.at(began + 2.0, silent("laser", "camera")) == []


def test_an_emergency_stop_is_reported_despite_a_lost_link() -> None:
    seen = Seen()
    seen.at(0.0, silent(*ROBOT.devices))
    latched = Reading("stop_button", 0.0, "OK", {"latched": True})
    back = tuple(latched if r.device == "stop_button" else r for r in silent("laser"))
    assert seen.at(4.0, back) == ["emergency-stop"]


def test_a_lost_link_does_not_explain_devices_that_were_well() -> None:
    seen = Seen()
    assert seen.at(0.0, silent("link")) == ["link-lost"]
    assert seen.at(1.0, silent("voice")) == ["voice-dead"]


class Robot:
    """Devices with given readings."""

    def __init__(self) -> None:
        self.readings: Health = WELL

    def health(self) -> Health:
        return self.readings


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Robot:
    monkeypatch.setattr("tangy_tui.app.partly_live_world.OLDEST", -1.0)
    return Robot()


@pytest.fixture
def game(workspace: Workspace, learnt: Policy, robot: Robot) -> Supervision:
    game = workspace.supervision(learnt, 3, live=robot.health)
    game.begin()
    return game


def stalled(game: Supervision, robot: Robot) -> list[str]:
    """Let a robot fall silent, and come back without two devices; return the reported faults."""
    robot.readings = silent(*ROBOT.devices)
    told = game.look()
    robot.readings = silent("laser", "camera")
    return codes(told + game.look())


def test_a_stall_of_the_robot_is_one_fault_until_it_is_cleared(
    game: Supervision, robot: Robot
) -> None:
    assert stalled(game, robot) == ["link-lost"]
    robot.readings = WELL
    game.acknowledge("Ada")
    told = game.clear("Ada") + game.look()
    assert moves(told) == ["cleared"] and game.halted is None
    assert [fault.code for fault in game.faults] == ["link-lost"]


def frozen(seconds: float) -> Health:
    """Return readings of a robot that answers again and reports the length of its freeze."""
    link = Reading("link", 0.0, ERROR, {"frozen": seconds})
    return tuple(link if r.device == "link" else r for r in WELL)


def test_a_frozen_robot_is_diagnosed_as_frozen(game: Supervision, robot: Robot) -> None:
    robot.readings = frozen(LONG)
    assert codes(game.look()) == ["control-frozen"]
    assert game.halted is not None and "stood still" in game.halted.console


def test_a_lost_link_that_was_a_freeze_stays_one_fault(game: Supervision, robot: Robot) -> None:
    robot.readings = silent(*ROBOT.devices)
    told = game.look()
    robot.readings = frozen(LONG)
    assert codes(told + game.look()) == ["link-lost"]
    assert game.halted is not None
    assert "stood still: 4" in still_there_words(game.halted, game)
    robot.readings = WELL
    game.acknowledge("Ada")
    assert moves(game.clear("Ada") + game.look()) == ["cleared"]


def test_a_device_still_silent_after_clearing_halts_the_robot_again(
    game: Supervision, robot: Robot
) -> None:
    assert stalled(game, robot) == ["link-lost"]
    robot.readings = silent("laser")
    game.acknowledge("Ada")
    told = game.clear("Ada")
    assert codes(told) == ["laser-disconnected"]
    assert game.halted is not None and game.halted.code == "laser-disconnected"


def test_a_new_game_forgets_secondary_symptoms(game: Supervision, robot: Robot) -> None:
    stalled(game, robot)
    game.leave()
    game.begin()
    assert codes(game.look()) == ["laser-disconnected", "camera-disconnected"]
