"""What the paper published of its three scenarios, to be put beside what comes out here."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

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
"""Section V-A, results of Scenario 1. Every teacher's policy was the same."""

SCENARIO_TWO: Mapping[str, float] = MappingProxyType(
    {
        "users": 4,
        "suboptimal_before_convergence": 10.75,
        "interactions_per_user_game": 1.13,
    }
)
"""Section V-A, results of Scenario 2. Fig. 5 is a drawing; its values are not in the text."""

USERS = 4
"""How many people took part in every scenario of the paper."""
