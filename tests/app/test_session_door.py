"""Other consoles watch games over a socket in the data folder, and can stop the robot."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store
from tangy_tui.app.game_commands import GoOn
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.scripted_staff import go_on_by_script
from tangy_tui.app.session_door import (
    FILE,
    LONGEST_LINE,
    MOST_GUESTS,
    SessionDoor,
    reachable,
)
from tangy_tui.app.watching import Guest, NobodyThere, WatchedLog
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tests.support.games import watched_game
from tests.support.waiting import wait_until


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def control(workspace: Workspace, learnt: Policy) -> GameController:
    """A game after five steps that other consoles may watch."""
    return watched_game(workspace, learnt)


@pytest.fixture
def guest(control: GameController, data_folder: Path) -> Iterator[Guest]:
    """A console that watches."""
    guest = Guest(data_folder)
    yield guest
    guest.close()


def seen(guest: Guest) -> Guest:
    wait_until(lambda: guest.look() and guest.view is not None, "the game is seen")
    return guest


def test_a_guest_sees_the_operator_and_the_scene(guest: Guest, control: GameController) -> None:
    view = seen(guest).view
    assert view is not None
    assert (view.driver, view.world, view.step, view.phase) == (
        "scripted",
        "simulated",
        5,
        "running",
    )
    assert view.scene == control.supervision.world.scene()
    assert guest.pid == os.getpid()


def test_the_first_look_waits_until_the_game_is_seen(
    control: GameController, data_folder: Path
) -> None:
    guest = Guest(data_folder)
    assert guest.look_first() and guest.view is not None
    guest.close()


def test_a_guest_sees_what_changes(guest: Guest, control: GameController) -> None:
    seen(guest)
    go_on_by_script(control, expert=False)
    wait_until(lambda: guest.look() and guest.view is not None and guest.view.step == 6)


def test_a_guest_stops_the_robot_and_the_log_names_the_guest(
    guest: Guest, control: GameController, workspace: Workspace
) -> None:
    told: list[str] = []
    workspace.door.attach(control, told.append)
    guest.stop("Bea")
    assert guest.answered()
    assert (control.phase, told) == ("stopped", ["Bea"])
    (action,) = (e.record for e in workspace.store.events(StaffAction))
    assert action.by == "Bea"


def test_a_stop_without_a_game_is_not_acknowledged(
    guest: Guest, control: GameController, workspace: Workspace
) -> None:
    workspace.door.detach(control)
    guest.stop("Bea")
    assert not guest.answered()
    assert control.phase == "running"


def test_a_missing_program_is_reported(tmp_path: Path) -> None:
    guest = Guest(tmp_path)
    assert not guest.look()
    with pytest.raises(NobodyThere):
        guest.stop("Bea")


def test_a_guest_notices_that_the_program_has_ended(guest: Guest, workspace: Workspace) -> None:
    seen(guest)
    workspace.door.close()
    wait_until(lambda: not guest.look())
    assert not (workspace.store.folder / FILE).exists()


def test_a_stale_socket_is_replaced(workspace: Workspace) -> None:
    left = socket.socket(socket.AF_UNIX)
    with reachable(workspace.store.folder) as place:
        left.bind(f"{place}/{FILE}")
    left.close()
    workspace.door.open()
    guest = Guest(workspace.store.folder)
    assert guest.look()
    guest.close()


def test_only_the_user_can_connect(control: GameController, data_folder: Path) -> None:
    assert (data_folder / FILE).stat().st_mode & 0o777 == 0o600


def test_a_deep_folder_has_a_socket(tmp_path: Path) -> None:
    deep = tmp_path / ("far" * 30) / ("down" * 20)
    workspace = Workspace(deep)
    workspace.door.open()
    guest = Guest(deep)
    assert guest.look()
    guest.close()
    workspace.close()


@pytest.mark.parametrize(
    "said", [b"\xff\x00\n", b"[" * 900 + b"\n", b'{"stop": 5}\n', b"x" * (LONGEST_LINE + 5), b"\n"]
)
def test_a_guest_can_only_stop_the_robot(
    said: bytes, control: GameController, guest: Guest, data_folder: Path
) -> None:
    with socket.socket(socket.AF_UNIX) as strange, reachable(data_folder) as place:
        strange.connect(f"{place}/{FILE}")
        strange.sendall(said)
        seen(guest)
    assert control.phase == "running"


def test_guests_that_do_not_read_delay_nobody(
    control: GameController, guest: Guest, data_folder: Path
) -> None:
    deaf = []
    with reachable(data_folder) as place:
        for _ in range(MOST_GUESTS - 1):
            deaf.append(socket.socket(socket.AF_UNIX))
            deaf[-1].connect(f"{place}/{FILE}")
    seen(guest)
    guest.stop("Bea")
    assert guest.answered()
    for one in deaf:
        one.close()


def test_each_event_of_the_log_is_sent_once(control: GameController, data_folder: Path) -> None:
    with Store.open(data_folder, write=False) as store:
        log = WatchedLog(store)
        first = log.news()
        assert first is not None and first.begun
        steps = [moment.step for moment in first.moments]
        assert log.news() is None
        go_on_by_script(control, expert=False)
        more = log.news()
        assert more is not None and not more.begun
        assert [moment.step for moment in more.moments if moment.step > max(steps)]
        assert more.replay.moments[: len(first.moments)] == list(first.moments)


def test_a_stop_reaches_the_robot_after_the_door_reopened(
    guest: Guest, control: GameController, workspace: Workspace, data_folder: Path
) -> None:
    seen(guest)
    workspace.door.close()
    again = SessionDoor(data_folder)
    again.attach(control)
    again.open()
    guest.stop("Bea")
    assert guest.answered()
    assert control.phase == "stopped"
    again.close()


def test_a_stop_arrives_despite_the_maximum_number_of_guests(
    control: GameController, data_folder: Path
) -> None:
    others = [Guest(data_folder) for _ in range(MOST_GUESTS)]
    for other in others:
        seen(other)
    late = Guest(data_folder)
    late.stop("Bea")
    assert late.answered()
    assert control.phase == "stopped"
    for one in (*others, late):
        one.close()


def test_a_name_of_any_length_stops_the_robot(guest: Guest, control: GameController) -> None:
    guest.stop("Beatrix é" * LONGEST_LINE)
    assert guest.answered()
    assert control.phase == "stopped"


def test_the_door_survives_errors_of_the_screen(
    guest: Guest, control: GameController, workspace: Workspace
) -> None:
    def breaks(guest: str) -> None:
        raise RuntimeError("no screen is there")

    workspace.door.attach(control, breaks)
    guest.stop("Bea")
    assert guest.answered()
    control.apply(GoOn())
    guest.stop("Cy")
    assert guest.answered()
    assert control.phase == "stopped"


def test_a_late_guest_sees_the_current_state(control: GameController, data_folder: Path) -> None:
    early = seen(Guest(data_folder))
    early.close()
    go_on_by_script(control, expert=False)
    late = Guest(data_folder)
    wait_until(lambda: late.look() and late.view is not None)
    assert late.view is not None and late.view.step == 6
    late.close()


def test_a_game_of_an_operator_with_any_name_can_be_watched(
    guest: Guest, control: GameController
) -> None:
    control.by = "Andr\udce9"  # a login name in an old encoding
    assert seen(guest).view is not None
