"""`tangy requests`: signs in pictures, and refusals."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import cv2
import pytest

from tests.hw.signs import CORNERS, sequence

Tangy = Callable[..., CompletedProcess[str]]
TABLE = ",".join(f"{x:g},{y:g}" for x, y in CORNERS)


@pytest.mark.slow
def test_signs_in_pictures_are_listed_with_their_people(tangy: Tangy, tmp_path: Path) -> None:
    seed = next(seed for seed in range(9_000, 9_100) if len(next(sequence(seed, 1)).asking) == 1)
    scenes = list(sequence(seed, 8))
    for number, scene in enumerate(scenes):
        cv2.imwrite(str(tmp_path / f"{number}.png"), scene.image)
    done = tangy("requests", f"signs:{tmp_path}", "--table", TABLE, "--json")
    found = json.loads(done.stdout)
    assert (done.returncode, found["works"]) == (0, True)
    (seat,) = scenes[0].asking
    assert [ask["seat"] for ask in found["changes"][0]["asking"]] == [seat + 1]
    assert found["changes"][0]["asking"][0]["person"] == f"user{seat + 1}"


@pytest.mark.parametrize(
    "options",
    [
        ("keyboard",),
        ("levers",),
        ("mqtt://host",),
        ("signs:0",),
        ("signs:none.avi", "--table", TABLE),
        ("signs:0", "--table", "1,2,3"),
        ("signs:0", "--table", "1,2,3,4,5,6,7,nan"),
        ("signs:0", "--table", "0,0,1,1,2,2,3,3"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(options: list[str], tangy: Tangy) -> None:
    done = tangy("requests", *options)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)


def test_a_missing_broker_fails(tangy: Tangy) -> None:
    done = tangy("requests", "mqtt://127.0.0.1:9/t", "--seconds", 0.5)
    assert done.returncode == 1
    assert "nobody answers there" in done.stderr
    assert done.stdout == "Nobody asked.\n"
