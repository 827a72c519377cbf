"""Where requests for help come from, by name.

keyboard              number keys, for whoever watches the table
buttons               a box of buttons; of several buttons:/dev/input/event5 or buttons:NAME
mqtt://HOST/TOPIC     messages, as from the buttons of a smart home
signs:CAMERA          triangles that shine, seen by an infrared camera (0, http://..., a video)
"""

from __future__ import annotations

from collections.abc import Sequence

from tangy_hw.perception.requests.buttons import ButtonBox
from tangy_hw.perception.requests.help_request_source import RequestError, RequestSource
from tangy_hw.perception.requests.keyboard import Keyboard
from tangy_hw.perception.requests.mqtt import Topic
from tangy_profiles.reading import nearest, plain
from tangy_profiles.room import Room

KINDS = ("keyboard", "buttons", "mqtt://HOST/TOPIC", "signs:CAMERA")


def open_requests(
    name: str,
    room: Room,
    people: Sequence[str],
    *,
    corners: Sequence[tuple[float, float]] = (),
    each: bool = False,
) -> RequestSource:
    """Open a source by its name; it is not started yet. Times are in s.

    Args:
        name: one of those above.
        room: where table and seats are.
        people: the ids of those who sit there, in the order of the seats.
        corners: of the table in the camera's picture, for signs: left near, right near, right far,
            left far, in pixels.
        each: look at every picture of a file or folder, for signs.

    Raises:
        RequestError: it is not known, or cannot be used.
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
        from tangy_hw.perception.requests.signs import Signs, TableView

        if not rest:
            raise RequestError("signs: names no camera; give signs:0 or signs:http://...")
        if len(corners) != 4:
            raise RequestError(
                "signs: where the four corners of the table are in the picture must be known: "
                "left near, right near, right far, left far."
            )
        near_left, near_right, far_right, far_left = corners
        view = TableView((near_left, near_right, far_right, far_left), room, seats)
        return Signs(find_camera(rest, each=each), view, seats, people)
    raise RequestError(plain(f"{name[:60]!r} is no source of requests: {nearest(name, KINDS)}"))
