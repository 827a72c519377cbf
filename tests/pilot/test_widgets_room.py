"""The room: places, requests and actions of people; and the painting of moves."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from syrupy.assertion import SnapshotAssertion
from textual.app import ComposeResult
from textual.geometry import Region

from tangy_profiles.person import Person
from tangy_profiles.room import Point, load_room
from tangy_profiles.scene import CardView, Scene
from tangy_profiles.state import FRONT
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.widgets.card_lines import LEGEND
from tangy_tui.ui.widgets.room_plan import Grid, plan
from tangy_tui.ui.widgets.room_view import RoomView

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, Sample, StillClock

SMALL = (80, 24)
LARGE = (160, 45)


class RoomScreen(TangyScreen[None]):
    """A room that fills the screen, and its messages."""

    def __init__(self, sample: Sample) -> None:
        super().__init__()
        self.sample = sample
        self.room = RoomView(sample.room, sample.people)
        self.arrived: list[str] = []
        self.painted: list[Region] = []

    def compose(self) -> ComposeResult:
        yield self.room

    def on_room_view_arrived(self, event: RoomView.Arrived) -> None:
        assert event.control is self.room
        self.arrived.append(event.place)

    def watch_painting(self) -> None:
        """Record the room's requests for painting from now on."""
        refresh = self.room.refresh

        def noted(*regions: Region, **options: Any) -> Any:
            self.painted += regions
            return refresh(*regions, **options)

        self.room.refresh = noted  # type: ignore[method-assign]


def robot_at(lines: list[str]) -> tuple[int, int]:
    """Return column and row of the robot's face."""
    for y, line in enumerate(lines):
        if "[• •]" in line:
            return line.index("[• •]"), y
    raise AssertionError("the robot is not seen")


@pytest.mark.slow
@pytest.mark.parametrize("size", [(60, 18), SMALL, (120, 40), LARGE])
@pytest.mark.parametrize("people", [1, 2, 3, 4, 5, 6, 7, 8])
async def test_everybody_is_visible_at_every_size(
    run: Run, sample: Sample, size: tuple[int, int], people: int
) -> None:
    sample = sample.of(people)
    screen = RoomScreen(sample)
    async with run(screen, size) as pilot:
        ids = [p.id for p in sample.people]
        screen.room.show(sample.scene(asking=tuple(reversed(ids))))
        await pilot.pause()
        text = pilot.text()
        for turn, id in enumerate(reversed(ids), 1):
            assert f"?{turn}" in text
            assert sample.names()[id] in text
        assert "[• •]" in text
        assert "3 called: 31" in text
        assert all(len(line) <= size[0] for line in pilot.lines())


@pytest.mark.parametrize("width", [20, 56, 158])
def test_a_plan_never_uses_more_rows_than_exist(width: int) -> None:
    for height in range(1, 60):
        for people in (1, 8):
            rows = plan(width, height, people)
            assert rows.head_row + 2 + rows.doing == max(height, 7)
            assert rows.floor >= rows.sprite


async def test_the_action_of_each_person_is_below_the_name(run: Run, sample: Sample) -> None:
    screen = RoomScreen(sample)
    async with run(screen) as pilot:
        screen.room.show(sample.scene())
        await pilot.pause()
        lines = pilot.lines()
        names = next(n for n, line in enumerate(lines) if "User 1" in line)
        middle = lines[names].index("User 2") + 3
        assert abs(lines[names + 1].index("asks for help") + 6 - middle) <= 1
        assert abs(lines[names - 1].index("?1") - middle) <= 2


async def test_long_names_and_actions_are_cut_with_an_ellipsis(run: Run, sample: Sample) -> None:
    sample.people = tuple(
        type(p)(p.id, "Wilhelmina Konstantinopolous von der Vogelweide") for p in sample.people
    )
    screen = RoomScreen(sample)
    async with run(screen) as pilot:
        doing = dict.fromkeys(sample.names(), "tells a very long story " * 6)
        screen.room.show(Scene(FRONT, (), doing, (), None))
        await pilot.pause()
        text = pilot.text()
        assert text.count("Wilhelmina Konsta") == 4
        assert "…" in text
        assert "Vogelweide" not in text


async def test_the_robot_moves_from_its_drawn_place_to_the_goal(
    run: Run, sample: Sample, clock: StillClock
) -> None:
    screen = RoomScreen(sample)
    async with run(screen, clock=clock) as pilot:
        screen.room.show(sample.scene())
        await pilot.pause()
        start = robot_at(pilot.lines())
        screen.room.show(sample.scene("user4"))  # the world is ahead of the picture
        screen.room.drive("user4", 4.0)
        await pilot.pause()
        assert robot_at(pilot.lines()) == start
        assert "[• •]▸" in pilot.text()
        seen = [start]
        for _ in range(4):
            clock.advance(1.0)
            screen.room.tick()
            await pilot.pause()
            seen.append(robot_at(pilot.lines()))
        columns = [x for x, _ in seen]
        rows = [y for _, y in seen]
        assert columns == sorted(set(columns))
        assert rows == sorted(rows)
        assert rows[-1] > rows[0]
        assert screen.arrived == ["user4"]
        assert screen.room.going is None
        assert "▸" not in pilot.text()


async def test_pace_speeds_the_robot_up_and_skip_ends_the_walk(
    run: Run, sample: Sample, clock: StillClock
) -> None:
    screen = RoomScreen(sample)
    async with run(screen, clock=clock) as pilot:
        screen.room.pace = 10
        screen.room.drive("user1", 40.0)
        clock.advance(4.0)
        screen.room.tick()
        await pilot.pause()
        assert screen.arrived == ["user1"]
        screen.room.drive(FRONT, 40.0)
        screen.room.skip()
        await pilot.pause()
        assert screen.arrived == ["user1", FRONT]
        screen.room.drive("user2", 0.0)
        await pilot.pause()
        assert screen.arrived[-1] == "user2"


async def test_the_robot_faces_its_direction(run: Run, sample: Sample, clock: StillClock) -> None:
    screen = RoomScreen(sample.of(1))
    async with run(screen, (120, 40), clock=clock) as pilot:
        for place, mark in (("user1", "▾"), (FRONT, "▴")):
            screen.room.drive(place, 4.0)
            await pilot.pause()
            assert f"[• •]{mark}" in pilot.text()
            screen.room.skip()
            await pilot.pause()
    screen = RoomScreen(sample)
    async with run(screen, clock=clock) as pilot:
        screen.room.put("user4")
        await pilot.pause()
        screen.room.drive("user1", 4.0)
        await pilot.pause()
        assert "◂[• •]" in pilot.text()


async def test_a_frame_paints_only_the_cells_of_the_robot(
    run: Run, sample: Sample, clock: StillClock
) -> None:
    screen = RoomScreen(sample)
    async with run(screen, (120, 40), clock=clock) as pilot:
        screen.room.show(sample.scene())
        await pilot.pause()
        screen.room.drive("user4", 5.0)
        await pilot.pause()
        screen.watch_painting()
        for _ in range(10):
            clock.advance(0.1)
            screen.room.tick()
            assert len(screen.painted) <= 3
            assert all(r.height == 1 and r.width <= 12 for r in screen.painted)
            screen.painted.clear()
            await pilot.pause()


async def test_an_unchanged_scene_paints_nothing(run: Run, sample: Sample) -> None:
    screen = RoomScreen(sample)
    async with run(screen) as pilot:
        screen.room.show(sample.scene())
        await pilot.pause()
        screen.watch_painting()
        screen.room.show(sample.scene())
        assert screen.painted == []
        screen.room.show(sample.scene(asking=()))
        assert {r.height for r in screen.painted} == {1}
        assert len(screen.painted) == 2  # heads and names


async def test_a_walk_survives_a_resize(run: Run, sample: Sample, clock: StillClock) -> None:
    screen = RoomScreen(sample)
    async with run(screen, LARGE, clock=clock) as pilot:
        screen.room.drive("user4", 4.0)
        for size in ((60, 18), (40, 10), (200, 60), SMALL):
            await pilot.resize_terminal(*size)
            clock.advance(0.5)
            screen.room.tick()
            await pilot.pause()
        clock.advance(4.0)
        screen.room.tick()
        await pilot.pause()
        assert screen.arrived == ["user4"]
        robot_at(pilot.lines())


async def test_speech_is_cut_to_the_available_rows(run: Run, sample: Sample) -> None:
    screen = RoomScreen(sample)
    async with run(screen) as pilot:
        screen.room.say("The number is B 7. " * 40)
        await pilot.pause()
        lines = [line for line in pilot.lines() if "The number" in line]
        assert 1 <= len(lines) <= 2
        assert lines[-1].rstrip().endswith("”")
        screen.room.say("")
        await pilot.pause()
        assert "The number" not in pilot.text()


async def test_the_card_is_drawn_after_the_robot_arrives(
    run: Run, sample: Sample, clock: StillClock
) -> None:
    screen = RoomScreen(sample)
    marked, called = 0b0011, 0b0101  # right, wrong, missed, neither
    card = CardView("user4", (11, 22, 33, 44), marked, called)
    async with run(screen, (120, 40), clock=clock) as pilot:
        scene = sample.scene("user4")
        ahead = Scene(scene.place, scene.requests, scene.doing, (), card)
        screen.room.show(ahead)
        screen.room.drive("user4", 4.0)
        await pilot.pause()
        assert "The card of" not in pilot.text()
        screen.room.show(ahead)
        await pilot.pause()
        assert "The card of" not in pilot.text()
        screen.room.skip()
        await pilot.pause()
        text = pilot.text()
        assert "The card of User 4" in text
        assert " [11] !22!" in text
        assert " ?33?  44" in text
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert "The card of" in pilot.text()
        await pilot.resize_terminal(60, 18)
        screen.room.show(Scene(scene.place, (), {}, (), CardView("user4", tuple(range(25)), 0, 0)))
        await pilot.pause()
        assert "[• •]" in pilot.text()


async def test_an_unknown_person_causes_no_error(run: Run, sample: Sample) -> None:
    screen = RoomScreen(sample)
    async with run(screen) as pilot:
        card = CardView("nobody", (1,), 0, 0)
        screen.room.show(Scene("nobody", ("nobody",), {"nobody": "waves"}, (), card))
        await pilot.pause()
        assert "waves" not in pilot.text()


@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
async def test_the_room_matches_its_snapshot(
    run: Run, sample: Sample, snapshot: SnapshotAssertion, size: tuple[int, int]
) -> None:
    screen = RoomScreen(sample)
    async with run(screen, size) as pilot:
        card = CardView("user2", tuple(range(1, 26)), 0, 0)
        scene = sample.scene("user2", ("user2", "user4"))
        screen.room.show(Scene(scene.place, scene.requests, scene.doing, scene.called, card))
        screen.room.say("Please take off: B-3.")
        await pilot.pause()
        assert pilot.text() == snapshot


async def test_a_held_robot_stays_in_place_until_its_release(
    run: Run, sample: Sample, clock: StillClock
) -> None:
    screen = RoomScreen(sample)
    async with run(screen, clock=clock) as pilot:
        room = screen.room
        room.drive("user4", 4.0)
        room.show(sample.scene("user4"))
        clock.advance(2.0)
        room.tick()
        await pilot.pause()
        caught = room.place_of_robot
        room.hold(True)
        clock.advance(9.0)
        room.tick()
        room.show(sample.scene("user4", asking=()))
        await pilot.pause()
        assert room.place_of_robot == caught
        assert not screen.arrived
        room.hold(False)
        clock.advance(1.0)
        room.tick()
        await pilot.pause()
        assert room.place_of_robot != caught
        assert not screen.arrived
        clock.advance(1.0)
        room.tick()
        await pilot.pause()
        assert screen.arrived == ["user4"]


async def test_a_robot_moved_during_a_hold_walks_there_afterwards(
    run: Run, sample: Sample, clock: StillClock
) -> None:
    screen = RoomScreen(sample)
    async with run(screen, clock=clock) as pilot:
        room = screen.room
        room.hold(True)
        room.show(sample.scene("user1"))
        await pilot.pause()
        assert room.place_of_robot == sample.room.stand(FRONT, ())
        room.hold(False)
        clock.advance(1.0)
        room.tick()
        await pilot.pause()
        assert screen.arrived == ["user1"]


@pytest.mark.parametrize("people", [9, 12, 20, 24])
@pytest.mark.parametrize("width", [80, 118, 160])
async def test_each_table_of_a_hall_is_drawn_to_both_ends(
    run: Run, sample: Sample, people: int, width: int
) -> None:
    seated = tuple(Person(f"p{number}", f"P{number}") for number in range(people))
    hall = RoomScreen(replace(sample, room=load_room("hall"), people=seated))
    async with run(hall, (width, 24)) as pilot:
        hall.room.show(Scene(FRONT, (), {}, (), None))
        await pilot.pause()
        rows = pilot.text().splitlines()
    cards = next(row for row in rows if "[▦]" in row)
    tables = [table.strip() for table in re.findall("│([^│]*)│", cards)]
    assert len(tables) == 3 and sum(table.count("[▦]") for table in tables) == people
    assert "".join(tables).replace("[▦]", "").strip() == ""


@pytest.mark.parametrize("width", [20, 56, 76])
def test_cards_keep_their_order_where_tables_have_no_room_for_ends(width: int) -> None:
    grid = Grid(load_room("hall"), 24, plan(width, 8, 24))
    assert grid.centres == sorted(grid.centres)
    assert grid.centres[0] >= 0 and grid.centres[-1] < width


async def test_names_in_a_full_hall_are_complete_and_absences_marked(
    run: Run, sample: Sample
) -> None:
    names = [f"Person{chr(65 + number)}" for number in range(12)]
    people = [Person(name, name) for name in names]
    hall = RoomScreen(replace(sample, room=load_room("hall"), people=tuple(people)))
    async with run(hall, SMALL) as pilot:
        doing = dict.fromkeys(names, "watches")
        hall.room.show(Scene(FRONT, (), doing, (), None, frozenset(names[4:6])))
        await pilot.pause()
        text = pilot.text()
    assert [name for name in names if name not in text] == []
    assert (text.count("●"), text.count("○")) == (10, 2)


async def test_marks_neither_cover_the_card_nor_lie_behind_the_table(
    run: Run, sample: Sample
) -> None:
    screen = RoomScreen(sample)
    room = sample.room
    async with run(screen, SMALL) as pilot:
        card = CardView("user2", tuple(range(1, 26)), 0, 0)
        screen.room.show(Scene("user2", (), {}, (), card))
        at = room.stand("user2", [person.id for person in sample.people])
        screen.room.track(at, "", ())
        await pilot.pause()
        without = pilot.text()
        everywhere = [Point(x / 5, y / 5) for x in range(50) for y in range(40)]
        behind = [point for point in everywhere if point.y > room.table[1]]
        screen.room.track(at, "", [(point, "*", "warn") for point in behind])
        await pilot.pause()
        assert pilot.text() == without
        screen.room.track(at, "", [(point, "*", "warn") for point in everywhere])
        await pilot.pause()
        marked = pilot.text()
    legend = "".join(words for words, _ in LEGEND)
    assert "*" in marked
    assert "The card of User 2" in marked
    assert legend.strip() in marked
