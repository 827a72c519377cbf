"""People join in the set-up by lines as in a game, and devices get time to become ready."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_tui.app.readiness import Check
from tangy_tui.app.register import guest_ids
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines

BEFORE = ["user1", "user2", "user3", "user4"]


def typed(workspace: Workspace, *lines: str) -> tuple[SetUp, list[str]]:
    """Return the set-up after lines, of which the last leaves it, and the names of people."""
    setup, said = SetUp.of(workspace), list[str]()
    read = iter((*lines, "end"))
    SetUpLines(setup, lambda: next(read, None), said.append).run()
    return setup, [workspace.name(person) for person in setup.seats]


@pytest.mark.parametrize(
    ("line", "seat"),
    [
        ("add Berta on seat 3", 3),
        ("add Berta to seat 3", 3),
        ("Berta joins on seat 1", 1),
        ("guest Berta, at seat 5", 5),
        ("add Berta", 5),
        ("add Berta at table 1", 5),
    ],
)
def test_a_person_is_added_on_the_seat_that_staff_name(
    workspace: Workspace, line: str, seat: int
) -> None:
    setup, names = typed(workspace, line)
    assert names.index("Berta") == seat - 1 and len(names) == 5
    assert [person for person in setup.seats if person in BEFORE] == BEFORE
    assert list(workspace.names) == setup.seats  # the seats are those of the game
    assert (setup.seats[seat - 1] in guest_ids(workspace.store)) is line.startswith("guest")


def test_everybody_else_stays_at_their_table_if_a_person_is_added(data_folder: Path) -> None:
    workspace = Workspace(data_folder, users=13)
    setup = SetUp.of(workspace)
    before = setup.tables
    setup.add("Anna", guest=True)
    assert [len(table) for table in before] == [5, 4, 4]
    assert [len(table) for table in setup.tables] == [5, 5, 4]
    assert all(set(old) <= set(new) for old, new in zip(before, setup.tables, strict=True))
    assert list(workspace.names) == setup.seats
    workspace.close()


def test_a_line_can_say_of_several_people_that_they_left(workspace: Workspace) -> None:
    setup, _ = typed(workspace, "left User 1, User 2 and User 4", "here User 2 and User 1")
    assert setup.away == {"user4"}


@pytest.mark.parametrize(
    "line", ["add Berta on seat 6", "add Berta at table 2", "add", "add User 2", "add user"]
)
def test_nobody_is_added_without_a_name_or_seat_of_their_own(
    workspace: Workspace, line: str
) -> None:
    setup, _ = typed(workspace, line)
    assert setup.seats == BEFORE == list(workspace.names)


@pytest.mark.parametrize("ready_after", [2, 1000])
def test_newly_started_devices_get_time_to_become_ready(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch, ready_after: int
) -> None:
    setup, now = SetUp.of(workspace), [0.0]
    waits = list[float]()

    def sleep(seconds: float) -> None:
        waits.append(seconds)
        now[0] += seconds

    def checks() -> list[Check]:
        return [Check("tablet", "ready" if len(waits) >= ready_after else "not ready", "page")]

    monkeypatch.setattr("tangy_tui.console.set_up.sleep", sleep)
    monkeypatch.setattr("tangy_tui.app.readiness.monotonic", lambda: now[0])
    monkeypatch.setattr(setup, "checks", checks)
    asked = list[None]()

    def read() -> str | None:
        asked.append(None)
        return None

    lines = SetUpLines(setup, read, lambda line: None)
    assert lines.begins_anyway() is (ready_after == 2)
    assert len(asked) == (0 if ready_after == 2 else 1)
