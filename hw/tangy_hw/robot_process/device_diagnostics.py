"""Readings of each device of a robot, combined with evidence from driving."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from tangy_hw.device_protocols import Device
from tangy_hw.perception.card_and_face_perception import CardAndFacePerception
from tangy_hw.perception.requests.help_request_source import RequestSource
from tangy_hw.robot_process.body import Body
from tangy_hw.robot_process.drive_monitor import DriveMonitor
from tangy_hw.robot_process.driver_checks import safe_reading
from tangy_hw.robot_process.pause_watch import PauseWatch
from tangy_hw.watchdogs import Report
from tangy_profiles.health import ERROR, OK, STALE, STATES, WARN, Reading, state_of
from tangy_profiles.liveness import SELDOM
from tangy_profiles.robot import FROZEN, LINK, LOST, PAUSES, Robot

FILMED_PATIENCE = 4.0
"""Factor on the permitted age of frames on a stepped bench, whose cameras run in real time."""


def device_diagnostics(
    robot: Robot,
    body: Body,
    evidence: DriveMonitor,
    ticked: Callable[[], float],
    rate: Callable[[], float | None] = lambda: None,
    *,
    report: Callable[[Device], Reading] = safe_reading,
    failed: Callable[[], str] = str,
    frozen: Callable[[], float] = float,
    pauses: Callable[[], PauseWatch | None] = lambda: None,
    senses: CardAndFacePerception | None = None,
    requests: RequestSource | None = None,
    stepped: bool = False,
) -> dict[str, Report]:
    """Return a report for each device, by its name.

    Args:
        robot: the profile, which defines how old data may be.
        body: the devices.
        evidence: symptoms of drives.
        ticked: returns the age of the last tick in s.
        rate: returns the ticks per second.
        report: returns the reading of a device.
        failed: returns a failure of its control, "" if there is none.
        frozen: returns for how many s its control was frozen, until staff acknowledge it.
        pauses: returns the watch over late data.
        senses: readers of images, if there are any.
        requests: source of requests, if there is one.
        stepped: whether time stands still while no caller waits; cameras run in real time.
    """
    base = body.base
    named: dict[str, list[Device]] = {}
    for device in body.all:
        if getattr(device, "drives", True):  # other links are reported by the devices behind them
            named.setdefault(device.name, []).append(device)
    reports: dict[str, Report] = {
        name: partial(_worst, robot, devices, report) for name, devices in named.items()
    }
    reports["base"] = lambda: evidence.base(report(base))

    def of_ticks(reading: Reading) -> Reading:
        return reading._replace(rate=rate()) if reading.rate is None else reading

    reports["localisation"] = lambda: of_ticks(evidence.localisation(ticked()))

    def navigator() -> Reading:
        reading = of_ticks(evidence.navigator(ticked()))
        return reading._replace(state=ERROR) if failed() else reading

    reports["navigator"] = navigator

    linked = reports.get(LINK, lambda: Reading(LINK))

    def link() -> Reading:
        reading, seconds, watch = linked(), frozen(), pauses()
        if watch is not None and (level := watch.level) != SELDOM:
            told = {PAUSES: level, LOST: round(watch.lost, 3)}
            reading = reading._replace(facts={**reading.facts, **told})
        if not seconds:
            return reading
        return reading._replace(state=ERROR, facts={**reading.facts, FROZEN: seconds})

    reports[LINK] = link

    def filmed(reading: Reading) -> Reading:
        if not stepped:
            return reading
        late = reading.age / FILMED_PATIENCE
        device = robot.devices.get(reading.device)
        fresh = device is None or late <= device.stale_after
        return reading._replace(
            age=late, state=OK if reading.state == STALE and fresh else reading.state
        )

    def camera(senses: CardAndFacePerception, name: str) -> Reading:
        readings = senses.sensors.health()
        return filmed(next((r for r in readings if r.device == name), Reading(name, state=WARN)))

    if requests is not None:
        reports["requests"] = lambda: filmed(requests.reading())
    if senses is not None:
        for name in senses.sensors.cameras:
            reports[name] = partial(camera, senses, name)
    return reports


def _worst(robot: Robot, devices: Sequence[Device], report: Callable[[Device], Reading]) -> Reading:
    """Return the worst reading of several devices with the same name."""

    def badness(reading: Reading) -> tuple[int, float]:
        return STATES.index(state_of(robot.devices.get(reading.device), reading)), reading.age

    return max(map(report, devices), key=badness)
