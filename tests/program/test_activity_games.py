"""Every declared activity that ships is taught by demonstration, and then played to its end."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tests.support.declared import DECLARED

Tangy = Callable[..., CompletedProcess[str]]


@pytest.mark.parametrize("name", DECLARED)
def test_it_is_taught_by_demonstration_and_plays_100_games_to_their_end(
    name: str, tangy: Tangy, tmp_path: Path
) -> None:
    options = ("--activity", name, "--data", tmp_path)
    taught = tangy(
        "teach", "--teacher", "scripted", "--guided", "--games", 2, "--seed", 1, *options
    )
    assert (taught.returncode, taught.stderr) == (0, "")
    assert tangy("learn", *options).returncode == 0
    played = tangy("play", "--games", 100, "--headless", "--json", "--seed", 7, *options)
    document = json.loads(played.stdout)
    assert (document["finished"], document["stopped"], document["asked"]) == (100, [], 0)
    assert document["faults"] == []
    assert all(row["success"] in (None, 1.0) for row in document["rows"])
