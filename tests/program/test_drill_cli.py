"""`tangy drill` on the command line: by lines, as a document, and the stored scores."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.drill_sheet import AnsweredRound, Sheet
from tangy_profiles.game_records import DrillAnswered
from tangy_profiles.store import Store
from tangy_tui.console import inputs
from tangy_tui.text.drills import KEPT, NOTHING_KEPT

Tangy = Callable[..., CompletedProcess[str]]

KEYS = "0\n1\n"
"""No fault, and let the game go on; a critical round needs one more answer."""


def answers(rounds: int) -> str:
    """Return enough lines for any drill: it repeats its question after an invalid answer."""
    return (KEYS + "n\n") * rounds


@pytest.mark.slow
def test_a_drill_by_lines_is_played_and_stored(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "d")
    asked = ("drill", "--plain", "--rounds", "4", "--seed", "3", "--who", "Ada")
    done = tangy(*asked, *data, stdin=answers(8))
    assert (done.returncode, done.stderr) == (0, "")
    assert "Tangy has learnt nothing yet" in done.stdout
    for words in ("Round 1 of 4", "Round 4 of 4", "What is it?", "What do you do?", "Ada: "):
        assert words in done.stdout
    assert "May Tangy be cleared now?" in done.stdout
    again = tangy(*asked, *data, stdin=answers(8)).stdout
    rounds, rounds_again = (
        re.sub(r", \d+ s\.", "", told.partition("Ada: ")[0]) for told in (done.stdout, again)
    )  # except for the times of the answers
    assert rounds_again.startswith(rounds), "the same seed, the same rounds"
    assert "The last time: " in again
    assert "The last time: " not in done.stdout
    listed = tangy("drill", "--scores", *data)
    assert listed.returncode == 0
    assert listed.stdout.count("Ada") == 2
    with Store.open(tmp_path / "d", write=False) as store:
        kinds = [event.kind for event in store.events()]
        assert kinds == ["drill-round"] * 3 + ["drill"] + ["drill-round"] * 3 + ["drill"]
        assert store.responses() == {}


def test_an_interrupted_drill_is_resumed_or_stored(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "d", "--who", "Ada")
    right = AnsweredRound(1, "", "Nothing was wrong", "continue", (), "", "continue", 2.0)
    sheet = Sheet("Ada", "bingo", 3, 2, (right,))

    def interrupt() -> None:
        with Store.open(tmp_path / "d") as store:
            store.append(DrillAnswered(sheet=sheet))

    assert tangy("drill", "--plain", "--resume", *data).returncode == 2
    interrupt()
    done = tangy("drill", "--plain", *data, stdin=answers(3))
    assert "interrupted after 1 of 2 rounds" in done.stderr and "Round 1" not in done.stdout
    assert "Round 2 of 2" in done.stdout
    interrupt()
    anew = tangy("drill", "--json", "--rounds", "1", *data, stdin=answers(1))
    assert "a new drill begins" in anew.stderr and json.loads(anew.stdout)["rounds"] == 1
    interrupt()
    assert tangy("drill", "--plain", "--discard", *data, stdin="").stderr == ""
    kept = json.loads(tangy("drill", "--scores", "--json", *data).stdout)
    assert [(one["rounds"], len(one["answers"])) for one in kept] == [
        (2, 2),
        (2, 1),
        (1, 1),
        (2, 1),
    ]


def test_json_output_contains_only_the_document(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "d")
    done = tangy("drill", "--json", "--rounds", "2", "--seed", "1", *data, stdin=KEYS)
    assert done.returncode == 0, done.stderr
    sheet = json.loads(done.stdout)
    assert (sheet["seed"], sheet["rounds"], sheet["finished"]) == (1, 2, False)
    for one in sheet["answers"]:
        assert one["points"] == sum(
            (one["named_right"], one["acted_right"], one["cleared_right"] is True)
        )
    listed = json.loads(tangy("drill", "--scores", "--json", *data).stdout)
    kept = [sheet] if sheet["answers"] else []
    assert [{k: v for k, v in one.items() if k != "at"} for one in listed] == kept
    nobody = tangy("drill", "--scores", "--json", "--who", "nobody", *data)
    assert json.loads(nobody.stdout) == []


def test_the_right_answers_of_the_document_get_all_points(tangy: Tangy, tmp_path: Path) -> None:
    """The document of a first run has the right answers; the second run gives them."""
    asked = ("drill", "--json", "--rounds", "1", "--data", tmp_path / "d", "--seed")
    for seed in range(1, 30):
        first = json.loads(tangy(*asked, seed, stdin=KEYS + "n\n").stdout)
        one = first["answers"][0]
        if not one["fault"]:
            assert (first["points"], first["most"], first["again"]) == (2, 2, [])
            return
        assert not one["named_right"]
    raise AssertionError("One round in five has no fault.")


def test_a_drill_without_answers_is_not_stored(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "d")
    sheet = json.loads(tangy("drill", "--json", *data).stdout)
    assert (sheet["answers"], sheet["points"], sheet["median_seconds"]) == ([], 0, None)
    assert tangy("drill", "--scores", *data).stdout == "No drill yet: tangy drill begins one.\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--rounds", "0"), "--rounds"),
        (("--rounds", "51"), "--rounds"),
        (("--rounds", "many"), "--rounds"),
        (("--seed", "x"), "--seed"),
        (("--who", " "), "--who"),
        (("--who", "x" * 41), "--who"),
        (("--users", "25"), "from 1 to 24"),
        (("--activity", "bingoo"), "did you mean 'bingo'?"),
        (("--json",), "'7': choose one of: 0, 1, 2, 3, 4."),
    ],
)
def test_bad_input_is_status_two_and_one_sentence(
    arguments: tuple[str, ...], said: str, tangy: Tangy, tmp_path: Path
) -> None:
    done = tangy("drill", *arguments, "--data", tmp_path / "d", stdin="7\n")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("tangy: ")
    assert done.stderr[:-1].isprintable()
    assert said in done.stderr


def test_a_learnt_policy_needs_no_scripted_teacher(tangy: Tangy, taught: Path) -> None:
    done = tangy("drill", "--plain", "--rounds", "1", "--data", taught, stdin=answers(2))
    assert done.returncode == 0
    assert "for this drill a scripted teacher" not in done.stdout
    with Store.open(taught, write=False) as store:
        assert not list(store.events("fault", "game begun"))
        assert len(list(store.events("drill"))) == 1


def one_round(data: tuple[object, ...], who: str, tangy: Tangy) -> None:
    done = tangy("drill", "--plain", "--rounds", "1", "--who", who, *data, stdin=answers(2))
    assert done.returncode == 0
    assert NOTHING_KEPT not in done.stdout
    assert KEPT not in done.stdout


def test_a_person_without_scores_gets_the_list_of_others(tangy: Tangy, taught: Path) -> None:
    data = ("--data", taught)
    one_round(data, "Ben", tangy)
    one_round(data, "Ada", tangy)
    asked = ("drill", "--scores", *data, "--who")
    assert tangy(*asked, "Rosa").stdout == "No drill of Rosa yet; there are sheets of Ada, Ben.\n"
    found = tangy(*asked, "ada").stdout
    assert ("Ada" in found, "Ben" in found) == (True, False)
    assert tangy("drill", "--scores", *data).stdout.count("1 of 1") == 2


@pytest.mark.parametrize("left", ["quit\n", "", "0\nquit\n", "0\n"])
@pytest.mark.parametrize("form", ["--plain", "--json"])
def test_leaving_before_the_first_answer_reports_that_nothing_is_stored(
    left: str, form: str, tangy: Tangy, taught: Path
) -> None:
    done = tangy("drill", form, "--seed", "3", "--data", taught, stdin=left)
    assert done.returncode == 0
    said = done.stdout if form == "--plain" else done.stderr
    assert said.count(NOTHING_KEPT) == 1
    assert tangy("drill", "--scores", "--data", taught).stdout.startswith("No drill yet")
    if form == "--json":
        assert json.loads(done.stdout)["answers"] == []


@pytest.mark.parametrize("form", ["--plain", "--json"])
@pytest.mark.parametrize("lines", [0, 2])
def test_answers_before_an_interrupt_are_stored_and_reported(
    lines: int, form: str, tangy: Tangy, taught: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = iter(("0", "1")[:lines])

    def read() -> str:
        for line in left:
            return line
        raise KeyboardInterrupt

    monkeypatch.setattr(inputs, "line_reader", lambda _: read)
    done = tangy("drill", form, "--rounds", "4", "--seed", "3", "--data", taught)
    assert done.returncode == 130
    said = done.stdout if form == "--plain" else done.stderr
    assert said.count(KEPT if lines else NOTHING_KEPT) == 1
    kept = json.loads(tangy("drill", "--scores", "--json", "--data", taught).stdout)
    assert [(len(one["answers"]), one["finished"]) for one in kept] == [(1, False)] * bool(lines)


@pytest.mark.slow
def test_a_wrong_line_of_a_script_reports_what_is_stored(tangy: Tangy, taught: Path) -> None:
    asked = ("drill", "--json", "--rounds", "4", "--seed", "3", "--data", taught)
    done = tangy(*asked, stdin="nonsense\n")
    assert (done.returncode, done.stdout, NOTHING_KEPT in done.stderr) == (2, "", True)
    done = tangy(*asked, stdin="0\n1\nn\n0\nnonsense\n")
    assert (done.returncode, done.stdout, KEPT in done.stderr) == (2, "", True)
    (kept,) = json.loads(tangy("drill", "--scores", "--json", "--data", taught).stdout)
    assert (len(kept["answers"]) >= 1, kept["finished"]) == (True, False)
