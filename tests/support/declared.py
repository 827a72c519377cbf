"""The shipped activities that are declared by facts."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import pytest

from tangy_profiles.activity import load_activity, shipped_activities
from tangy_profiles.declared.activity import DeclaredActivity


@cache
def declared(name: str) -> DeclaredActivity:
    """Return a shipped declared activity by its name."""
    activity = load_activity(name)
    assert isinstance(activity, DeclaredActivity)
    return activity


DECLARED = [
    name for name in shipped_activities() if isinstance(load_activity(name), DeclaredActivity)
]


def each_of_first(names: Sequence[str]) -> list[Any]:
    """Return the parameters of a long test: all of them, or the first for fast runs."""
    return [names[0], *(pytest.param(name, marks=pytest.mark.slow) for name in names[1:])]
