"""Every shipped declared activity is taught by demonstration, and then played to its end."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tests.support.declared import DECLARED, each_of_first

Tangy = Callable[..., CompletedProcess[str]]


@pytest.mark.slow
@pytest.mark.parametrize("name", each_of_first(DECLARED))
def test_each_shipped_activity_is_taught_and_plays_100_games(
    name: str, tangy: Tangy, tmp_path: Path
) -> None:
    options = ("--activity", name, "--data", tmp_path)
    taught = tangy(
        "teach", "--teacher", "scripted", "--guided", "--games", 2, "--seed", 1, *options
    )
    assert (taught.returncode, taught.stderr) == (0, "")
    assert tangy("learn", *options).returncode == 0
    learnt = json.loads(tangy("policy", "--json", *options).stdout)
    assert (learnt["searched"]["whole"], learnt["searched"]["asks"]) == (True, [])
    assert all(one["states"] > 0 for one in learnt["searched"]["sizes"])
    said = " ".join(tangy("policy", *options).stdout.split())  # lines wrap at the terminal's width
    assert "each was shown" in said
    played = tangy("play", "--games", 100, "--headless", "--json", "--seed", 7, *options)
    document = json.loads(played.stdout)
    assert (document["finished"], document["stopped"], document["asked"]) == (100, [], 0)
    assert document["faults"] == []
    assert all(row["success"] in (None, 1.0) for row in document["rows"])


@pytest.mark.parametrize("words", [("drill",), ("cards", "list")])
def test_commands_for_cards_refuse_an_activity_without_cards(
    words: tuple[str, ...], tangy: Tangy, tmp_path: Path
) -> None:
    data = () if words[0] == "cards" else ("--data", tmp_path)
    done = tangy(*words, "--activity", "trivia", *data)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
