"""`tangy live`: options refused before a robot is opened."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_hw.navigation.map_files import write_map
from tangy_hw.navigation.occupancy import OccupancyMap, map_of_room
from tangy_profiles.errors import TangyError
from tangy_tui.app.robot_opening import check_map
from tangy_tui.app.workspace import Workspace


def refusal(workspace: Workspace, map_: Path) -> str:
    with pytest.raises(TangyError) as refused:
        check_map(workspace, str(map_))
    return str(refused.value)


def test_a_map_with_every_place_free_is_accepted(workspace: Workspace, tmp_path: Path) -> None:
    write_map(map_of_room(workspace.room, people=4), tmp_path / "room.yaml")
    check_map(workspace, str(tmp_path / "room.yaml"))


def test_an_invalid_map_is_refused_by_name(workspace: Workspace, tmp_path: Path) -> None:
    assert refusal(workspace, tmp_path / "none.yaml").startswith(
        f"{tmp_path / 'none.yaml'}: there is no"
    )
    (tmp_path / "words.yaml").write_text("some: words\n", encoding="utf-8")
    assert "words.yaml, line 1: 'some' is not known" in refusal(workspace, tmp_path / "words.yaml")


def test_a_map_of_another_room_is_refused_with_the_missing_place(
    workspace: Workspace, tmp_path: Path
) -> None:
    here = map_of_room(workspace.room, people=4)
    elsewhere = OccupancyMap(here.cells, here.resolution, (here.origin[0] + 7.5, here.origin[1]))
    write_map(elsewhere, tmp_path / "other.yaml")
    assert "the front (5, 1.2) cannot be driven to on it." in refusal(
        workspace, tmp_path / "other.yaml"
    )


def test_a_list_of_faults_is_refused_with_its_invalid_line(
    tangy: Callable[..., CompletedProcess[str]], tmp_path: Path
) -> None:
    faults = tmp_path / "faults"
    faults.write_text("# for the afternoon\ncamera-frozen@3\n\ncamera-frosen\n", encoding="utf-8")
    done = tangy("live", "--bench", "--inject", faults)
    assert done.returncode == 2
    assert f"{faults}, line 4: There is no fault 'camera-frosen'" in done.stderr


def test_a_robot_file_must_be_toml(
    tangy: Callable[..., CompletedProcess[str]], tmp_path: Path
) -> None:
    notes = tmp_path / "robot.md"
    notes.write_text("# Our robot\n", encoding="utf-8")
    for words in (("live", "--robot", notes), ("--robot", notes, "live")):
        done = tangy(*words)
        assert done.returncode == 2
        assert (
            done.stderr
            == f"tangy: {notes} is not a robot: the name of a robot's file ends in .toml.\n"
        )


def test_contradicting_microphone_options_are_refused(
    tangy: Callable[..., CompletedProcess[str]],
) -> None:
    for words, why in (
        (("--mic", "socket"), "--mic: Tangy listens in a live game on the screen"),
        (("--hands-free",), "There is nothing to listen to: name a microphone with --mic."),
    ):
        done = tangy("live", "--bench", "--headless", *words)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith(f"tangy: {why}")
