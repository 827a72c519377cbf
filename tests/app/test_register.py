"""The register: people are added, archived and restored, and everybody gets a seat."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.person import MOST_PEOPLE
from tangy_profiles.room import load_room, room_for
from tangy_tui.app.joining import let_join
from tangy_tui.app.readiness import Check
from tangy_tui.app.register import add_person, archive_person, guest_ids, participants, registered
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.text import set_up as text
from tangy_tui.text import set_up_lines as by_lines
from tangy_tui.text.register import with_guests


def ids(workspace: Workspace) -> list[str]:
    return [person.id for person in registered(workspace.store)]


def test_people_are_added_archived_and_restored(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    assert ids(workspace) == ["user1", "user2", "user3", "user4"]
    assert add_person(workspace.store) == "user5"
    archive_person(workspace.store, "user2")
    assert ids(workspace) == ["user1", "user3", "user4", "user5"]
    assert [p.id for p in participants(workspace.store, 5)][-1] == "user6"
    workspace.close()
    workspace = Workspace(data_folder)
    assert list(workspace.names) == ["user1", "user3", "user4", "user5"]
    archive_person(workspace.store, "user2", on=False)
    assert "user2" in ids(workspace)
    workspace.close()


def test_a_guest_is_not_in_the_register(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    assert [add_person(workspace.store, guest=True) for _ in range(2)] == ["guest1", "guest2"]
    assert len(ids(workspace)) == 4
    workspace.close()


def test_the_register_has_between_1_and_24_people(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    while len(ids(workspace)) < MOST_PEOPLE:
        add_person(workspace.store)
    with pytest.raises(TangyError, match="archive somebody first"):
        add_person(workspace.store)
    for person in ids(workspace)[1:]:
        archive_person(workspace.store, person)
    with pytest.raises(TangyError, match="add another person"):
        archive_person(workspace.store, "user1")
    workspace.close()


@pytest.mark.parametrize("count", [1, 4, 8, 9, 12, MOST_PEOPLE])
def test_everybody_has_a_separate_seat_in_the_room(count: int) -> None:
    room = room_for(count)
    seats = room.seated(count)
    assert len(set(seats)) == count
    assert all(0 < seat.x < room.width and seat.y < room.depth for seat in seats)
    if count > 8:
        assert min(a.distance(b) for a in seats for b in seats if a != b) > 0.8


@pytest.mark.parametrize(
    ("count", "each"), [(9, [3, 3, 3]), (12, [4, 4, 4]), (13, [5, 4, 4]), (24, [8, 8, 8])]
)
def test_people_in_a_hall_share_the_tables(count: int, each: list[int]) -> None:
    hall = load_room("hall")
    assert [len(sitting) for sitting in hall.at_tables(count)] == each
    for sitting, (left, _, right, _) in zip(hall.at_tables(count), hall.tables, strict=True):
        assert all(left <= hall.seated(count)[place].x <= right for place in sitting)


def test_the_tables_of_a_hall_are_in_a_row() -> None:
    hall = load_room("hall")
    assert len(hall.tables) == 3
    assert hall.table == (hall.tables[0][0], hall.tables[0][1], hall.tables[2][2], 5.8)


def test_a_game_is_set_up_by_lines(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    setup, said = SetUp.of(workspace), list[str]()
    lines = iter(
        ["left User 3", "seat User 1 4", "play for line, x", "pace 20", "several winners",
         "words gentle", "time 40", "seat Nobody 2", "what", "begin", "never read"]
    )  # fmt: skip
    assert SetUpLines(setup, lambda: next(lines, None), said.append).run()
    assert setup.seats == ["user4", "user2", "user3", "user1"] == list(workspace.names)
    assert setup.plan.patterns == ("line", "x") and setup.plan.absent == ("user3",)
    assert (setup.pace, setup.several, setup.strength, setup.minutes) == (20, True, "gentle", 40)
    assert next(lines) == "never read"
    assert not SetUpLines(setup, lambda: "end", said.append).run()
    workspace.close()


def test_a_change_prints_only_its_own_lines(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    setup, said = SetUp.of(workspace), list[str]()
    everything = len(text.lines_of(setup)) + 1  # and one line of help
    told, lines = list[list[str]](), iter(("left User 3", "left User 3", "show", "begin"))

    def read() -> str:
        told.append([*said])
        said.clear()
        return next(lines)

    assert SetUpLines(setup, read, said.append).run()
    assert [len(answer) for answer in told] == [everything, 2, 1, everything - 1]
    assert all("User 3" in line or "3 of 4" in line for line in told[1])
    assert told[2] == [by_lines.UNCHANGED]
    workspace.close()


@pytest.mark.parametrize(("typed", "begins"), [("begin", True), ("end", False), (None, False)])
def test_a_misspelt_answer_about_what_is_not_ready_is_asked_again(
    data_folder: Path, monkeypatch: pytest.MonkeyPatch, typed: str | None, begins: bool
) -> None:
    workspace = Workspace(data_folder)
    setup, said = SetUp.of(workspace), list[str]()
    monkeypatch.setattr(SetUp, "checks", lambda self: [Check("tablet", "not ready")])
    lines = iter(["slwoer", typed])
    assert SetUpLines(setup, lambda: next(lines), said.append).begins_anyway() == begins
    assert said[-1] == by_lines.begin_or_end("slwoer")
    workspace.close()


def test_a_refused_activity_changes_nobody(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    setup = SetUp.of(workspace)
    setup.add("Anna", guest=True)
    setup.move("user1", 1)
    before = text.lines_of(setup)
    with pytest.raises(TangyError):
        setup.play("trivia")  # nobody has taught it
    assert text.lines_of(setup) == before
    assert [person.id for person in workspace.people] == setup.seats
    workspace.close()


@pytest.mark.slow
def test_people_and_the_activity_are_set_up_by_lines(taught: Path) -> None:
    workspace = Workspace(taught)
    setup, said = SetUp.of(workspace), list[str]()
    lines = iter(
        ["guest Anna", "add Bert", "rename user 3 to Clara", "rename Nobody to Dora",
         "seat Anna 1", "guest Bert", "activities", "activity no such thing", "activity Trivia",
         "activity BINGO", "end"]
    )  # fmt: skip
    assert not SetUpLines(setup, lambda: next(lines, None), said.append).run()
    names = [workspace.name(person) for person in setup.seats]
    assert names == ["Anna", "User 2", "Clara", "User 4", "User 1", "Bert"]
    assert setup.seats[0] == "guest1" and ids(workspace)[-1] == setup.seats[-1]
    assert any(all(title in line for title in setup.activities().values()) for line in said)
    assert workspace.profile == "bingo" and any("not learnt Trivia" in line for line in said)
    workspace.close()


def test_teams_cannot_be_changed_in_the_setup(data_folder: Path) -> None:
    workspace = Workspace(data_folder, activity="team-trivia")
    setup, said = SetUp.of(workspace), list[str]()
    lines = iter(["guest Anna", "words gentle", "time 20", "begin"])
    assert SetUpLines(setup, lambda: next(lines, None), said.append).run()
    assert text.TEAMS_PLAY in said and guest_ids(workspace.store) == []
    assert tuple(setup.seats) == workspace.activity.teams and setup.minutes == 20
    workspace.close()


def test_a_team_is_called_by_its_number_and_no_seat(data_folder: Path) -> None:
    workspace = Workspace(data_folder, activity="team-trivia")
    assert [team.seats for team in workspace.people] == [("team 1",), ("team 2",)]
    begun = workspace.teaching("Ada", 1).phrasebook.complete("give a hint to ")
    assert "give a hint to team 1" in begun
    assert not any("seat" in phrase for phrase in begun)
    workspace.close()


def test_a_guest_is_forgotten_after_the_day(data_folder: Path) -> None:
    now = [datetime(2026, 5, 1, 10, tzinfo=UTC)]
    workspace = Workspace(data_folder, now=lambda: now[0])
    guest = let_join(workspace, "Anna", guest=True)
    assert list(workspace.names)[-1] == guest and workspace.name(guest) == "Anna"
    assert text.lines_of(SetUp.of(workspace))[5].strip() == "5. Anna (guest): here"
    assert with_guests(workspace.store.names(), guest_ids(workspace.store))[guest] == "Anna (guest)"
    workspace.close()

    again = Workspace(data_folder, now=lambda: now[0])
    assert list(again.names)[-1] == guest  # an interrupted game needs them
    again.close()

    now[0] += timedelta(days=1)
    tomorrow = Workspace(data_folder, now=lambda: now[0])
    assert guest not in tomorrow.names and guest not in tomorrow.store.names()
    assert with_guests(tomorrow.store.names(), guest_ids(tomorrow.store))[guest] == "Guest 1"
    assert let_join(tomorrow, "Anna", guest=True) != guest
    tomorrow.close()


def test_a_person_with_a_used_name_is_refused(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    let_join(workspace, "Anna")
    before = ids(workspace)
    with pytest.raises(TangyError, match="choose another name"):
        let_join(workspace, "anna")
    assert ids(workspace) == before
    workspace.close()


def test_the_question_whether_to_begin_names_what_is_not_ready() -> None:
    failed = [Check("tablet", "not ready", "http://here/"), Check("sound", "not ready")]
    told = by_lines.lines_anyway(failed)
    assert text.NAMES["tablet"].lower() in told and text.NAMES["sound"].lower() in told
    assert text.NAMES["battery"].lower() not in told


def test_a_first_name_finds_the_only_person_who_has_it(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    workspace.rename(workspace.find_person("user1"), "Zoé Miller")
    assert workspace.find_person("zoe").id == "user1"
    with pytest.raises(TangyError, match="More than one person is called 'user'"):
        workspace.find_person("user")
    workspace.close()
