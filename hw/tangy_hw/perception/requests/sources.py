"""Opens sources of help requests by name.

keyboard              number keys, for a person who watches the table
buttons               a box of buttons; if several: buttons:/dev/input/event5 or buttons:NAME
mqtt://HOST/TOPIC     messages, for example of smart-home buttons
signs:CAMERA          shining triangles before an infrared camera (0, http://..., a video)
"""

from __future__ import annotations

from collections.abc import Sequence

from tangy_hw.perception.requests.buttons import ButtonBox
from tangy_hw.perception.requests.help_request_source import RequestError, RequestSource
from tangy_hw.perception.requests.mqtt import Topic
from tangy_profiles.reading import nearest, plain
from tangy_profiles.room import Room


class Keyboard(RequestSource):
    """The program passes keys in; a seat's number toggles its request."""

    def press(self, key: str) -> bool:
        """Handle a key; return whether it belongs to a seat."""
        seat = int(key) if len(key) == 1 and key in "123456789" else 0
        if not 1 <= seat <= self.seats:
            return False
        if seat in self._asks:
            self._withdraw(seat)
        else:
            self._ask(seat)
        return True


KINDS = ("keyboard", "buttons", "mqtt://HOST/TOPIC", "signs:CAMERA")


def open_requests(
    name: str,
    room: Room,
    people: Sequence[str],
    *,
    corners: Sequence[tuple[float, float]] = (),
    each: bool = False,
) -> RequestSource:
    """Create a source by its name, without starting it. Times are in s.

    Args:
        name: one of those above.
        room: the room, with table and seats.
        people: ids of the people, in the order of their seats.
        corners: corners of the table in the camera's image in pixels, for signs: left near, right
            near, right far, left far.
        each: process every frame of a file or folder, for signs.

    Raises:
        RequestError: the source is unknown, or cannot be used.
        CameraError: there is no such camera.
    """
    kind, _, rest = name.partition(":")
    seats = len(people)
    if name == "keyboard":
        return Keyboard(name, seats, people)
    if kind in ("mqtt", "mqtts"):
        return Topic(name, seats, people)
    if kind == "buttons":
        return ButtonBox(name, rest, seats, people)
    if kind == "signs":
        from tangy_hw.drivers.camera_source import find_camera
        from tangy_hw.perception.requests.signs import SignRequests, TableView

        if not rest:
            raise RequestError("signs: names no camera; give signs:0 or signs:http://...")
        if len(corners) != 4:
            raise RequestError(
                "signs: where the four corners of the table are in the picture must be known: "
                "left near, right near, right far, left far."
            )
        near_left, near_right, far_right, far_left = corners
        view = TableView((near_left, near_right, far_right, far_left), room, seats)
        return SignRequests(find_camera(rest, each=each), view, seats, people)
    raise RequestError(plain(f"{name[:60]!r} is no source of requests: {nearest(name, KINDS)}"))
