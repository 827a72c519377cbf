"""Custom rooms: named on the command line, chosen in the setup, stored, and resumed."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.past_game import PastGame
from tangy_profiles.room import room_for
from tangy_tui.app.choice_file import keep_choice, read_choice
from tangy_tui.app.game_view import GameView
from tangy_tui.app.interruption import take_up
from tangy_tui.app.register import add_person
from tangy_tui.app.rooms import choose_room, find_room, known_rooms
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.watching import room_of
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.learning.policies import load_policy
from tangy_tui.text.rooms import room_words

LOUNGE = """
name = "lounge"
title = "Lounge"
width = 9
depth = 7
front = [4.5, 1.0]
reach = 0.7

[[tables]]
at = [0.5, 4.0, 3.0, 4.8]

[[tables]]
at = [4.0, 4.4, 8.0, 5.2]
"""
SEATS = ((1.0, 5.5), (2.4, 5.5), (4.5, 5.9), (6.0, 5.9), (7.5, 5.9))


def lounge(folder: Path, name: str = "lounge.toml", seats: int = len(SEATS)) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(LOUNGE + "".join(f"\n[[seats]]\nx = {x}\ny = {y}\n" for x, y in SEATS[:seats]))
    return path


def test_people_sit_at_the_tables_of_the_given_room(tmp_path: Path) -> None:
    path = lounge(tmp_path)
    with closing(Workspace(tmp_path / "data", room=str(path))) as workspace:
        assert workspace.room.title == "Lounge"
        assert SetUp.of(workspace).tables == (("user1", "user2"), ("user3", "user4"))
        ids = tuple(workspace.names)
        assert workspace.room.stand("user1", ids).y == pytest.approx(3.3)
        assert workspace.room.stand("user4", ids).y == pytest.approx(3.7)


def test_a_room_in_the_data_folder_is_found_by_name(tmp_path: Path) -> None:
    lounge(tmp_path, "rooms/lounge.toml")
    with closing(Workspace(tmp_path, room="lounge")) as workspace:
        assert workspace.room_source == "lounge"
    with pytest.raises(ProfileError, match="did you mean 'lounge'"):
        Workspace(tmp_path, room="loung")


def test_a_room_that_is_too_small_is_refused(tmp_path: Path) -> None:
    path = lounge(tmp_path, seats=3)
    with pytest.raises(TangyError, match="Lounge has 3 seats, and 4 people take part"):
        Workspace(tmp_path / "data", room=str(path))
    with closing(Workspace(tmp_path / "data", room=str(path), users=3)) as workspace:
        assert len(workspace.room.seated(3)) == 3  # the first was closed again


def test_a_chosen_room_is_stored(tmp_path: Path) -> None:
    lounge(tmp_path, "rooms/lounge.toml")
    (tmp_path / "rooms/wrong.toml").write_text("name = 'wrong'\nwidht = 3\n")
    with closing(Workspace(tmp_path)) as workspace:
        rooms = list(known_rooms(tmp_path, workspace.room))
        assert [one.room.title for one in rooms if one.room] == ["Common room", "Lounge", "Hall"]
        assert [one.problem.partition(":")[0] for one in rooms if one.problem] == ["wrong.toml"]
        told: list[str] = []
        lines = iter(("rooms", "room Lounge", "begin"))
        setup = SetUp.of(workspace)
        setup.move("user4", -3)
        assert SetUpLines(setup, lambda: next(lines), told.append).run()
        assert "Lounge" in " ".join(told)
        assert workspace.room.title == "Lounge"
        assert next(iter(workspace.names)) == "user4"  # seats are kept
    with closing(Workspace(tmp_path)) as workspace:
        assert workspace.room.title == "Lounge"


def test_a_chosen_room_moves_with_its_data_folder_and_may_be_deleted(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    path = lounge(old, "rooms/lounge.toml")
    with closing(Workspace(old)) as workspace:
        choose_room(old, find_room(old, str(path)))
    old.rename(new)
    with closing(Workspace(new)) as workspace:
        assert (workspace.room.title, workspace.room_problem) == ("Lounge", "")
    (new / "rooms/lounge.toml").unlink()
    with closing(Workspace(new)) as workspace:
        assert workspace.room == room_for(4)
        assert "lounge" in workspace.room_problem


def test_too_many_people_get_another_room_with_a_reason(tmp_path: Path) -> None:
    path = lounge(tmp_path, "rooms/lounge.toml")
    with closing(Workspace(tmp_path)) as workspace:
        setup = SetUp.of(workspace)
        setup.choose_room(str(path))
        setup.add("Rosa", guest=False)
        with pytest.raises(TangyError, match="Lounge has 5 seats, and 6 people take part"):
            setup.add("Anna", guest=False)
        add_person(workspace.store)
    with closing(Workspace(tmp_path)) as workspace:
        assert room_words(workspace.room, workspace.chosen_room) == (
            "Common room; Lounge has only 5 seats"
        )


def test_a_game_is_resumed_and_watched_in_its_room(taught: Path, tmp_path: Path) -> None:
    path = lounge(tmp_path)
    with closing(Workspace(taught, room=str(path))) as workspace:
        policy, _ = load_policy(workspace.store, workspace.activity)
        game = workspace.supervision(policy, 1)
        game.begin()
        begun = workspace.store.last(GameBeginning)
        assert begun is not None and begun.record.room == str(path)
        past = PastGame(begun.record, workspace.store.now())
    with closing(Workspace(taught)) as workspace:
        take_up(workspace, past)
        assert workspace.room.title == "Lounge"
        workspace.choose_room(None)
        scene = game.world.scene()
    view = GameView(
        "Rosa", "g", "bingo", "simulated", 1, 0, "idle", "OK", "", scene, room=str(path)
    )
    assert room_of(view, tmp_path).title == "Lounge"
    path.unlink()
    assert room_of(view, tmp_path) == room_for(4)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("y = 5.9", "y = 4.5", "(line 25): must be behind the table"),
        ("x = 2.4", "x = 3.4", "(line 20): must be at one of the tables"),
        ("x = 6.0", "x = 4.2", "(line 28): seats must go from the left"),
        (
            "depth = 7",
            "detph = 7",
            "depth: is missing; it must be a number. Do you mean 'detph' (line 5)?",
        ),
        ('title = "Lounge"', 'title = "Lounge"\nchairs = 5', "chairs = 5 (line 4)"),
    ],
)
def test_a_mistake_is_reported_with_its_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    path = lounge(tmp_path)
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(ProfileError) as caught:
        Workspace(tmp_path / "data", room=str(path))
    assert said in str(caught.value)


def test_an_unstorable_choice_is_refused(tmp_path: Path) -> None:
    keep_choice(tmp_path / "room.toml", "room", 'a "quoted" \\ Käse')
    assert read_choice(tmp_path / "room.toml", "room") == 'a "quoted" \\ Käse'
    for choice in ("del\x7f", "not UTF-8: \udcff"):
        with pytest.raises(TangyError, match="cannot be stored"):
            keep_choice(tmp_path / "room.toml", "room", choice)
