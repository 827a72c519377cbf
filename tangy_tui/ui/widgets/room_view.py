"""The room as a grid of characters: robot, front, table, and what each person is doing.

It draws line by line and sends only changed cells to the terminal. A robot that drives at ten
frames a second costs some hundred bytes a frame, one that stands none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from textual import events
from textual.geometry import Region
from textual.message import Message
from textual.strip import Strip
from textual.timer import Timer

from tangy_profiles.person import Person
from tangy_profiles.room import Point, Room
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, clock_of
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.room_drawing import draw_room
from tangy_tui.ui.widgets.room_plan import SPRITE_WIDTH, Grid, PlanLine, RoomPlan, plan
from tangy_tui.ui.widgets.rows import Row, draw

FRAME_SECONDS = 0.1
SLOW_FRAME_SECONDS = 1.0
"""The frame intervals of a driving robot, normally and over a slow link."""

Mark = tuple[Point, str, str]
"""A mark on the floor: position, character, and ink."""

EMPTY = Scene(FRONT, (), {}, (), None)


class RoomView(InkedWidget):
    """Robot and people in the activity room, seen from behind the people.

    `show` draws a scene at once; `drive` animates the robot to its destination, and `hold` freezes
    it at its drawn position, whatever scene is shown.
    """

    DEFAULT_CSS = """
    RoomView { width: 1fr; height: 1fr; min-height: 7; }
    """
    HELP = (
        "The room: Tangy and the front above, the people at the table below. ?1 marks who asks "
        "for help and whose turn it is; under each name stands what that person is doing."
    )

    class Arrived(Message):
        """The robot has arrived at a place: the front, or a person's id."""

        def __init__(self, room: RoomView, place: str) -> None:
            super().__init__()
            self.room = room
            self.place = place

        @property
        def control(self) -> RoomView:
            """The room that it arrived in."""
            return self.room

    def __init__(
        self,
        room: Room,
        people: Sequence[Person],
        *,
        robot: str = "Tangy",
        label: Callable[[int], str] = str,
        cards: bool = True,
        clock: Clock | None = None,
        id: str | None = "room",
        classes: str | None = None,
    ) -> None:
        """Create the view.

        Args:
            room: size, front, table and seats, in metres.
            people: the people in the order of their seats.
            robot: the name on the robot.
            label: returns the label of a number (`activity.deck.label`).
            cards: whether people have cards.
            clock: returns seconds (default: the app's clock).
            id: the widget's id.
            classes: the widget's classes.
        """
        super().__init__(id=id, classes=classes)
        self.border_title = "Room"
        self.pace = 1.0
        """The speed-up of the animation."""
        self._room = room
        self._people = tuple(people)
        self._ids = tuple(person.id for person in people)
        self._robot = clean(robot)[:SPRITE_WIDTH]
        self._label = label
        self._cards = cards
        self._clock_given = clock
        self._scene = EMPTY
        self.speech = ""
        self._at = room.stand(FRONT, self._ids)
        self._seen = self._from = self._to = self._at
        self._going: str | None = None
        self._held = False
        self._tracked = False
        self._marks: dict[tuple[int, int], tuple[str, str]] = {}
        self._share = 0.0
        self._seconds = 0.0
        self._last = 0.0
        self._heading = ""
        self.motion: Timer | None = None
        self._plan: RoomPlan = plan(1, 1)
        self._grid: Grid | None = None
        self._base: list[PlanLine] = []
        self._rows: dict[int, Row] = {}
        self._strips: dict[int, Strip] = {}
        self._sprite_at = (0, 0)

    @property
    def scene(self) -> Scene:
        """The scene shown."""
        return self._scene

    @property
    def going(self) -> str | None:
        """The destination that the robot is driving to, None while it stands."""
        return self._going

    @property
    def place_of_robot(self) -> Point:
        """The position at which the robot is drawn, in m."""
        return self._seen

    def show(self, scene: Scene) -> None:
        """Draw a scene. A robot that is driving to the scene's place continues to drive."""
        self._scene = scene
        if self._tracked:
            pass  # its position is tracked
        elif self._held:
            if self._at == self._stand(scene.place):
                self._halt()
            elif self._going != scene.place:
                self._aim(scene.place)  # it drives there once released
        elif self._going != scene.place:
            self._halt()
            self._at = self._stand(scene.place)
        self._draw_again()

    def put(self, place: str) -> None:
        """Put the robot at a place without animation, unless it is tracked."""
        if self._tracked:
            return
        self._halt()
        self._at = self._stand(place)
        self._draw_again()

    def track(self, at: Point, heading: str, marks: Sequence[Mark]) -> None:
        """Draw the robot at its estimated position, and marks on the floor around it.

        Args:
            at: the robot's position, in m.
            heading: an arrow, "" while it stands.
            marks: positions in m with a character and an ink each; later ones overwrite earlier
                ones.
        """
        self._halt()
        self._tracked = True
        self._at, self._heading = at, heading
        self._marks = {}
        if self._grid is not None:
            for point, character, ink in marks:
                if self._grid.on_floor(point):
                    self._marks[self._grid.floor(point)] = (character, ink)
        self._draw_again()

    def say(self, speech: str) -> None:
        """Show the robot's speech; "" shows none."""
        self.speech = clean(speech)
        self._draw_again()

    def drive(self, to: str, seconds: float) -> None:
        """Animate the robot to the front or a person in some s; posts `Arrived` at the end.

        It starts from the drawn position, so that the scene with its destination may be shown
        before or after.
        """
        self._at = self._seen
        self._seconds = max(0.0, seconds)
        self._aim(to)
        if (seconds <= 0 and not self._held) or not self.is_attached:
            self._arrive()
            return
        if self._scene.card is None:
            self._move_sprite(turned=True)
        else:  # the card is shown on arrival
            self._draw_again()
        self._walk()

    def hold(self, held: bool) -> None:
        """Freeze the robot at its drawn position, or let it continue to its destination."""
        if held == self._held:
            return
        self._held = held
        if held:
            self._at = self._seen
            self._stand_still()
        elif self._going is not None:
            self._walk()

    def skip(self) -> None:
        """Move the robot to its destination at once."""
        if self._going is not None:
            self._arrive()

    def tick(self) -> None:
        """Draw the next frame of the animation."""
        if self._going is None or self._held:
            return
        now = self._clock()
        self._share += (now - self._last) * self.pace / (self._seconds or FRAME_SECONDS)
        self._last = now
        if self._share >= 1:
            self._arrive()
        else:
            self._at = self._from.towards(self._to, self._share)
            self._move_sprite()

    def on_resize(self, event: events.Resize) -> None:
        """Lay out again."""
        people = max(1, len(self._people))
        self._plan = plan(max(SPRITE_WIDTH, self.size.width), max(1, self.size.height), people)
        self._grid = Grid(self._room, people, self._plan)
        self._turn()
        self._draw_again()

    def notify_style_update(self) -> None:
        """Redraw in the new colours."""
        super().notify_style_update()
        self._strips.clear()

    def render_line(self, y: int) -> Strip:
        """Return a line, drawn or from the cache."""
        self._seen = self._at
        if y not in self._strips:
            self._rows[y] = self._row(y).row()
            self._strips[y] = draw(self, self._rows[y], self.size.width)
        return self._strips[y]

    def _clock(self) -> float:
        return (self._clock_given or clock_of(self.app))()

    def _stand(self, place: str) -> Point:
        known = place == FRONT or place in self._ids
        return self._room.stand(place if known else FRONT, self._ids)

    def _aim(self, place: str) -> None:
        """Set the destination of the robot from its present position."""
        self._from, self._to = self._at, self._stand(place)
        self._going = place
        self._share = 0.0
        self._turn()

    def _walk(self) -> None:
        self._last = self._clock()
        if self.motion is None and not self._held:
            slow = getattr(self.app, "slow_link", False)
            every = SLOW_FRAME_SECONDS if slow else FRAME_SECONDS
            self.motion = self.set_interval(every, self.tick)

    def _halt(self) -> None:
        self._going = None
        self._heading = ""
        self._stand_still()

    def _stand_still(self) -> None:
        if self.motion is not None:
            self.motion.stop()
            self.motion = None

    def _arrive(self) -> None:
        place = self._going
        self._halt()
        self._at = self._to
        self._move_sprite(turned=True)
        if self._scene.card is not None:
            self._draw_again()
        if place is not None:
            self.post_message(self.Arrived(self, place))

    def _turn(self) -> None:
        """Set the arrow of the direction of travel on the screen."""
        if self._going is None or self._grid is None:
            self._heading = ""
            return
        (x1, y1), (x2, y2) = self._grid.sprite(self._from), self._grid.sprite(self._to)
        if abs(x2 - x1) >= 2 * abs(y2 - y1):
            self._heading = "▸" if x2 > x1 else "◂" if x2 < x1 else ""
        else:
            self._heading = "▾" if y2 > y1 else "▴"

    def _move_sprite(self, *, turned: bool = False) -> None:
        """Redraw the cells that the robot left and those that it covers."""
        if self._grid is None:
            return
        old, new = self._sprite_at, self._grid.sprite(self._at)
        if old == new and not turned:
            return
        self._sprite_at = new
        rows: dict[int, tuple[int, int]] = {}
        for x, y in (old, new):
            for row in range(y, y + self._plan.sprite):
                left, right = rows.get(row, (x, x))
                rows[row] = (min(left, x), max(right, x))
        regions: list[Region] = []
        for row, (left, right) in rows.items():
            self._strips.pop(row, None)
            regions.append(Region(left, row, right - left + SPRITE_WIDTH, 1))
        self.refresh(*regions)

    def _draw_again(self) -> None:
        """Lay out the scene, and redraw the lines that changed."""
        if self._grid is None:
            return
        self._sprite_at = self._grid.sprite(self._at)
        self._base = draw_room(
            self._plan,
            self._grid,
            self._people,
            self._scene,
            speech=self.speech,
            label=self._label,
            robot=self._sprite_at[0] if self._going is None and not self._heading else None,
            cards=self._cards,
        )
        width = self.size.width
        changed: list[Region] = []
        for y in range(self._plan.height):
            row = self._row(y).row()
            if self._rows.get(y) != row:
                self._rows[y] = row
                self._strips.pop(y, None)
                changed.append(Region(0, y, width, 1))
        if changed:
            self.refresh(*changed)

    def _row(self, y: int) -> PlanLine:
        """Return a line of the scene with the robot on it."""
        if y >= len(self._base):
            return PlanLine(self._plan.width)
        line = self._base[y]
        marked = [(x, mark) for (x, row), mark in self._marks.items() if row == y]
        if marked:
            line = line.copy()
            for x, (character, ink) in marked:
                line.mark(x, character, ink)
        x, top = self._sprite_at
        if not top <= y < top + self._plan.sprite:
            return line
        line = line.copy()
        if y == top:
            left = self._heading if self._heading == "◂" else " "
            right = self._heading if self._heading and self._heading != "◂" else " "
            line.put(x, f"{left}[• •]{right}", "robot")
        else:
            line.put(x, self._robot.center(SPRITE_WIDTH), "robot")
        return line
