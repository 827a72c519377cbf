"""Reads the source of requests from a robot's file, and the table's corners in its images."""

from __future__ import annotations

import math
from pathlib import Path

from tangy_hw.perception.requests.help_request_source import DEVICE, RequestError
from tangy_profiles.reading import nearest, plain
from tangy_profiles.robot import Robot

Corners = tuple[tuple[float, float], ...]
"""Corners of the table in pixels; empty if not needed."""

KINDS = ("buttons", "mqtt", "signs")


def read_corners(text: str, what: str = "--table") -> Corners:
    """Parse the corners of the table, X,Y four times; "" for none.

    Raises:
        RequestError: the text is invalid; the message names `what`.
    """
    try:
        numbers = [float(word) for word in text.split(",")] if text else []
    except ValueError:
        numbers = [math.nan]
    if len(numbers) not in (0, 8) or not all(abs(number) <= 1e5 for number in numbers):
        raise RequestError(f"{what} must be eight numbers with commas: x,y of four corners.")
    return tuple(zip(numbers[::2], numbers[1::2], strict=True))


def requests_named(robot: Robot) -> tuple[str, Corners]:
    """Return the source of requests in a robot's file, as `open_requests` takes it.

    The file has `requests = { kind = "signs", at = "/dev/video2", table = "X,Y,..." }` under
    [drivers], or the kind buttons (`at`: the box, if there are several) or mqtt (`at`:
    mqtt://HOST/TOPIC). Returns "" if it names none.

    Raises:
        RequestError: the entry is invalid.
    """
    driver = robot.drivers.get(DEVICE)
    if driver is None:
        return "", ()
    where = f"{robot.file.name}: drivers.{DEVICE}"
    if driver.kind not in KINDS:
        wrong = f"{driver.kind!r} tells no requests; {nearest(driver.kind, KINDS)}"
        raise RequestError(plain(f"{where}: {wrong}"))
    where = f"{where} ({driver.kind})"
    given = {
        key: f"{value:g}" if isinstance(value, float) else str(value)  # number of a camera
        for key, value in driver.settings.items()
    }
    for key in given:
        if key != "at" and (key, driver.kind) != ("table", "signs"):
            raise RequestError(plain(f"{where}: there is no setting '{key}'."))
    at, table = given.get("at", ""), given.get("table", "")
    if not at and driver.kind != "buttons":
        raise RequestError(f"{where}: at is missing.")
    if driver.kind == "mqtt":
        if not at.startswith(("mqtt://", "mqtts://")):
            raise RequestError(plain(f"{where}: at = {at!r} must be mqtt://HOST/TOPIC."))
        return at, ()
    if driver.kind == "signs":
        if "://" not in at and not at.isdecimal():
            at = str(Path(robot.file.parent, at))
        return f"signs:{at}", read_corners(table, f"{where}: table")
    at = at.removeprefix("buttons:")
    return f"buttons:{at}" if at else "buttons", ()
