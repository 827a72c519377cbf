"""Evidence of a fault from a drive is kept as long as it matters."""

from __future__ import annotations

from typing import cast

from tangy_hw.navigation.navigator_protocol import NavigatorProtocol
from tangy_hw.robot_process.drive_monitor import KEPT_SECONDS, DriveMonitor
from tangy_profiles.health import Fact, Reading


class Navigator:
    """A navigator with given facts."""

    def __init__(self) -> None:
        self.told: dict[str, Fact] = {
            "path": "clear", "fit": 1.0, "spread": 0.1, "slip": 0.0, "still": 0.0,
        }  # fmt: skip

    def facts(self) -> dict[str, Fact]:
        return self.told

    def readings(self, age: float) -> tuple[Reading, Reading]:
        place = {name: self.told[name] for name in ("fit", "spread")}
        return (
            Reading("localisation", age, facts=place),
            Reading("navigator", age, facts={"path": self.told["path"]}),
        )


def test_a_lost_pose_is_remembered_until_the_robot_looks_round() -> None:
    navigator, now = Navigator(), [0.0]
    evidence = DriveMonitor(cast(NavigatorProtocol, navigator), lambda: now[0])
    navigator.told |= {"fit": 0.7, "spread": 1.5}
    evidence.note()
    navigator.told |= {"fit": 1.0, "spread": 0.1}
    now[0] = 100.0
    evidence.begin()
    evidence.keep()
    assert evidence.localisation(0.0).facts["spread"] == 1.5
    evidence.looked_round(found=False)
    assert evidence.localisation(0.0).facts["found"] is False
    evidence.looked_round(found=True)
    assert evidence.localisation(0.0).facts == {"fit": 1.0, "spread": 0.1}
    assert evidence.base(Reading("base")).facts["slip"] == 0.0


def test_wheel_slip_is_remembered_as_the_cause_of_a_lost_pose() -> None:
    navigator, now = Navigator(), [0.0]
    evidence = DriveMonitor(cast(NavigatorProtocol, navigator), lambda: now[0])
    navigator.told |= {"slip": 0.8, "fit": 0.7, "spread": 1.5}
    evidence.note()
    evidence.keep()
    navigator.told |= {"slip": 0.0, "fit": 1.0, "spread": 0.1}
    now[0] = 10 * KEPT_SECONDS
    assert evidence.base(Reading("base")).facts["slip"] == 0.8
    evidence.looked_round(found=True)
    assert evidence.base(Reading("base")).facts["slip"] == 0.0


def test_a_stall_is_reported_for_a_limited_time() -> None:
    navigator, now = Navigator(), [0.0]
    evidence = DriveMonitor(cast(NavigatorProtocol, navigator), lambda: now[0])
    navigator.told["still"] = 2.0
    evidence.note()
    evidence.keep()
    navigator.told["still"] = 0.0
    assert evidence.base(Reading("base")).facts["still"] == 2.0
    now[0] = KEPT_SECONDS
    assert evidence.base(Reading("base")).facts["still"] == 0.0
