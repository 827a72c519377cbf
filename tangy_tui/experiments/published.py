"""The published results of the paper's three scenarios, for comparison."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from importlib.resources import files
from types import MappingProxyType
from typing import Any

SCENARIO_ONE: Mapping[str, float] = MappingProxyType(
    {
        "demonstrations": 3,
        "demonstrations_all_shown": 1,
        "behaviours_per_demonstration": 62,
        "minutes_to_teach": 9.6,
        "minutes_to_play": 30,
        "teachers": 5,
    }
)
"""Section V-A, results of Scenario 1; every teacher's policy was the same."""

SCENARIO_TWO: Mapping[str, float] = MappingProxyType(
    {
        "users": 4,
        "suboptimal_before_convergence": 10.75,
        "interactions_per_user_game": 1.13,
    }
)
"""Section V-A, results of Scenario 2; the values of Fig. 5 are not in the text."""

USERS = 4
"""The number of people in every scenario of the paper."""

SCENARIO_THREE: Mapping[str, Any] = MappingProxyType(
    tomllib.loads(
        files("tangy_tui.experiments").joinpath("table_two.toml").read_text(encoding="utf-8")
    )
)
"""Table II, results of Scenario 3: rows of behaviours, and faults by the right recovery.

It is read from a file, because it contains words of an activity.
"""
