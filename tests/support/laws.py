"""The number of a law's examples: few in the fast tests, its own number in the slow ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

import pytest
from hypothesis import settings

AT_LENGTH = "at-length"
"""The Hypothesis profile with which `tests/program/test_laws_at_length.py` tries every law."""

FEW = 30
"""Examples of a law in the fast tests, which must stay under five minutes."""

Test = TypeVar("Test", bound=Callable[..., None])


def tried(examples: int) -> Callable[[Test], Test]:
    """Try a law with this many examples in slow tests, and with `FEW` of them in fast tests."""
    at_length = settings.get_current_profile_name() != "tangy"
    count = examples if at_length else min(FEW, examples)

    def law(test: Test) -> Test:
        return cast(Test, pytest.mark.law(settings(max_examples=count)(test)))

    return law
