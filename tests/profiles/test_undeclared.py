"""A device or fact that the robot's file does not declare is refused with what to add."""

from __future__ import annotations

from pathlib import Path

import pytest

import tangy_profiles
from tangy_profiles.errors import ProfileError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.robot import load_robot
from tests.support.robots import robot_without

RULES = Path(tangy_profiles.__path__[0]) / "faults.toml"


def refused(folder: Path, key: str) -> str:
    text = RULES.read_text(encoding="utf-8")
    mine = folder / "mine.toml"
    mine.write_text(text.replace('"base.slip"', f'"{key}"', 1), encoding="utf-8")
    with pytest.raises(ProfileError) as error:
        load_faults(load_robot(), mine)
    return str(error.value)


def test_a_driver_of_an_undeclared_device_asks_for_its_entry(tmp_path: Path) -> None:
    drivers = '\n[drivers]\nbattery = { kind = "rosbridge" }\n'
    with pytest.raises(ProfileError, match=r"add a \[\[devices\]\] entry named 'battery'"):
        load_robot(str(robot_without(tmp_path, drivers=drivers)))


@pytest.mark.parametrize("key", ["base.temperature", "laser.xyz"])
def test_a_rule_about_an_undeclared_fact_asks_for_the_fact(tmp_path: Path, key: str) -> None:
    device, fact = key.split(".")
    told = refused(tmp_path, key)
    assert f"add facts.{fact} to {device} in the robot's file" in told


def test_a_misspelt_fact_names_the_nearest_one_first(tmp_path: Path) -> None:
    assert "did you mean 'base.slip'? Otherwise" in refused(tmp_path, "base.slop")


def test_a_rule_about_no_device_does_not_ask_for_a_fact(tmp_path: Path) -> None:
    assert "facts." not in refused(tmp_path, "basement.temperature")
