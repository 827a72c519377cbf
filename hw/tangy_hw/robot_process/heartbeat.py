"""Heartbeat of the robot process: the robot's state as JSON, parsed as a `RobotState`."""

from __future__ import annotations

import time
from typing import Any

from tangy_hw.perception.card_and_face_perception import CardSeen
from tangy_hw.robot_process.controller import LiveRobot
from tangy_profiles.health import Health

MOST_PARTICLES = 60  # in a heartbeat


def beat_of(robot: LiveRobot, number: int) -> dict[str, Any]:
    """Return the current state of a robot: lengths in m, times in s of its own clock."""
    navigator = robot.navigator
    path = () if navigator.path is None else navigator.path.points
    return {
        "number": number,
        "time": robot.passing.clock.now(),
        "health": _health(robot.health()),
        "pose": [round(value, 3) for value in robot.pose],
        "going": robot.going,
        "path": [[round(x, 2), round(y, 2)] for x, y in path],
        "particles": _thinned(navigator.particles),
        "obstacles": [[round(x, 2), round(y, 2)] for x, y in navigator.obstacles],
        "asks": [[ask.seat, ask.since] for ask in robot.asking],
        "shows": [[s.seat, s.letter, s.since, round(s.sure, 2)] for s in robot.showing],
        "hazard": robot.hazard,
        "stopped": robot.stopped,
        "failed": robot.failed,
        "frozen": round(robot.watch.frozen, 1),
        "held": robot.hand.held,
        "waits": robot.pauses.why,
        "pauses": [robot.pauses.count, round(robot.pauses.seconds, 2)],
        "lets": navigator.yields_to,
        "answered": list(robot.body.calls_answered),
    }


def aged(seen: tuple[CardSeen, float] | None) -> dict[str, Any] | None:
    """Return a card reading with its age in s."""
    return None if seen is None else {**seen[0].to_json(), "age": time.monotonic() - seen[1]}


def _health(health: Health) -> list[list[Any]]:
    def rounded(rate: float | None) -> float | None:
        return None if rate is None else round(rate, 2)

    return [[r.device, min(r.age, 1e6), r.state, dict(r.facts), rounded(r.rate)] for r in health]


def _thinned(particles: Any) -> list[list[float]]:
    apart = max(1, len(particles) // MOST_PARTICLES)
    return [[round(float(x), 2), round(float(y), 2)] for x, y, *_ in particles[::apart]]
