"""The worlds of games, in words."""

from __future__ import annotations

from tangy_profiles.game_world import BENCH, LIVE, SIMULATED, UNKNOWN, GameWorld

WORLDS: dict[GameWorld, str] = {
    UNKNOWN: "world unknown",
    SIMULATED: "simulated",
    BENCH: "on the bench",
    LIVE: "live, with the robot",
}
"""The worlds of games, on screens and pages."""

WORLDS_IN_REPORTS: dict[GameWorld, str] = {
    UNKNOWN: "from an unknown world",
    SIMULATED: "simulated",
    BENCH: "on the bench, with simulated devices",
    LIVE: "live, with a robot",
}
"""The worlds of games, in reports."""
