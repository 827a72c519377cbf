"""Scenario 3, simulated: induced faults, and figures counted from the log."""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path
from socket import AF_UNIX, socket
from typing import Any
from xml.etree import ElementTree

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.robot import load_robot
from tangy_sim.worlds.injection import KINDS
from tangy_tui.experiments import published, recovering
from tangy_tui.experiments.induced import (
    LATEST,
    NOT_BOTH,
    Induced,
    Planned,
    draw_plan,
    in_proportion,
    kinds_by_recovery,
)
from tangy_tui.experiments.kept_games import keep_games, to_read
from tangy_tui.experiments.matching import AGAIN, NOTHING, RIGHT, WRONG, match_faults
from tangy_tui.experiments.report import report
from tangy_tui.experiments.scenarios import Recovering, recovery
from tangy_tui.experiments.sweep import Where
from tangy_tui.monitoring.fault import Fault
from tangy_tui.text.comparison import compare

pytestmark = pytest.mark.xdist_group("scenario three")  # games are played only once

BOOK = load_faults(load_robot())
PAPER = {row["recovery"]: row["instances"] for row in published.SCENARIO_THREE["faults"]}
GAMES = 6


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    """The document of a few games, played once."""
    return recovery(Recovering("bingo", 4, GAMES, 2), Where(jobs=1))


def fault(code: str, step: int) -> Fault:
    """Return a diagnosis by the shipped rule of its code."""
    rule = BOOK.rule(code)
    return Fault(
        id=f"{code}{step}", game="g", code=code, critical=rule.critical,
        recovery=rule.recovery[0], step=step, seconds=1.0, behaviour="", person=None, called="",
        texts=(), why="", evidence={}, mismatches=(),
    )  # fmt: skip


def test_the_table_of_the_paper_is_complete() -> None:
    table = published.SCENARIO_THREE
    assert sum(row["instances"] for row in table["rows"]) / table["games"] == 49.25
    assert PAPER == {"expert": 21, "continue": 40, "user": 6, "teacher": 20}


@pytest.mark.parametrize("games", [1, 3, 7, 20, 40, 133])
def test_other_numbers_of_games_have_the_same_proportions(games: int) -> None:
    scaled = in_proportion(PAPER, 20, games)
    assert sum(scaled.values()) == int(87 * games / 20 + 0.5)
    assert all(abs(count - PAPER[name] * games / 20) < 1 for name, count in scaled.items())


@pytest.mark.parametrize("seed", range(20))
def test_a_plan_spreads_the_mix_without_repeats_in_a_game(seed: int) -> None:
    plan = draw_plan(PAPER, 20, seed, BOOK)
    of = {name: recovery for recovery, kinds in kinds_by_recovery(BOOK).items() for name in kinds}
    assert Counter(of[one.kind.name] for game in plan for one in game) == PAPER
    for game in plan:
        names = [one.kind.name for one in game]
        assert len(set(names)) == len(names)
        assert not any(set(pair) <= set(names) for pair in NOT_BOTH)
        assert all(1 <= one.step <= LATEST for one in game)
        assert 3 <= len(game) <= 7
    assert plan != draw_plan(PAPER, 20, seed + 1, BOOK)
    assert plan == draw_plan(PAPER, 20, seed, BOOK)


def test_a_diagnosis_is_compared_with_the_faults_present_then() -> None:
    stop = Induced(KINDS["emergency-stop"], 5, 0.0, lifted=5)
    arm = Induced(KINDS["arm-failed"], 9, 0.0)
    unseen = Induced(KINDS["request-withdrawn"], 20, 0.0)
    told = [
        fault("emergency-stop", 5),
        fault("emergency-stop", 6),  # the button was released before
        fault("voice-dead", 9),  # while the arm's fault is not known yet
        fault("arm-failed", 9),
        fault("arm-failed", 12),
        replace(fault("unknown-situation", 13), evidence={"situation.shown": False}),
    ]
    found = match_faults([stop, arm, unseen], told)
    assert [match.verdict for match in found.matches] == [RIGHT, NOTHING, WRONG, RIGHT, AGAIN]
    assert (found.false_alarms, found.missed, found.asked) == (1, [], 1)
    assert match_faults([stop, arm, unseen], told[:1]).missed == [arm]


def test_the_document_has_its_agreed_keys(document: dict[str, Any]) -> None:
    assert document["games"] == GAMES
    assert [(row["criticality"], row["recovery"]) for row in document["faults"]] == [
        ("critical", "expert"),
        ("non-critical", "continue"),
        ("non-critical", "user"),
        ("non-critical", "teacher"),
    ]
    for row in document["faults"]:
        assert row["instances"] == row["induced"] - row["missed"] + row["again"]
        assert 0 <= row["success"] <= 1
    assert document["induced"] + len(document["did_not_come_about"]) == round(87 * GAMES / 20)
    assert {"stage", "request", "user_state", "behaviour", "instances", "success"} == set(
        document["rows"][0]
    )
    assert document["paper"] == dict(published.SCENARIO_THREE)
    assert re.fullmatch("[0-9a-f]{64}", document["code"])
    assert {"python", "tangy"} <= set(document["versions"])


def test_every_induced_fault_is_noticed_and_recovered(document: dict[str, Any]) -> None:
    assert (document["missed"], document["false_alarms"]) == (0, 0)
    assert [row["success"] for row in document["faults"]] == [1.0] * 4
    assert document["ended"] == {"to its end": GAMES}
    expert, goes_on, user, teacher = (row["seconds_to_recover"] for row in document["faults"])
    assert expert["median"] >= 300 > user["median"] >= 25 > goes_on["median"] >= teacher["median"]


@pytest.mark.slow
def test_success_is_measured_by_the_diagnoses(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    blind = replace(BOOK, rules=tuple(r for r in BOOK.rules if r.code != "arm-failed"))
    wrong = replace(
        BOOK.rule("laser-disconnected"), recovery=("teacher",), criticality="non-critical"
    )
    rules = tuple(wrong if r.code == wrong.code else r for r in blind.rules)
    monkeypatch.setattr(
        "tangy_tui.experiments.supervised.load_faults", lambda _: replace(blind, rules=rules)
    )
    plan = [[Planned(KINDS[name], 3)] for name in ("arm-failed", "laser-disconnected")]
    monkeypatch.setattr(recovering, "plan_of", lambda games, seed: plan)
    monkeypatch.setattr(recovering, "recovery_of", lambda kind, _: BOOK.rule(kind.code).recovery[0])
    told = recovering.run("bingo", 4, 2, 1, Where(jobs=1))
    expert, goes_on, *_ = told["faults"]
    assert (expert["induced"], expert["success"]) == (1, 0.0)
    assert (goes_on["induced"], goes_on["missed"], goes_on["instances"]) == (1, 1, 0)
    assert goes_on["success"] is None
    assert told["missed"] == 1


@pytest.mark.slow
def test_results_are_reproducible_and_stored_in_pieces(
    document: dict[str, Any], tmp_path: Path
) -> None:
    again = recovery(Recovering("bingo", 4, GAMES, 2), Where(folder=tmp_path, jobs=1))
    assert again == document
    kept = list((tmp_path / "experiments").glob("recovering-*.jsonl"))
    assert len(kept) == 1
    from_disk = recovery(Recovering("bingo", 4, GAMES, 2), Where(folder=tmp_path, jobs=1))
    assert from_disk == document


@pytest.mark.slow
def test_the_page_shows_the_papers_figures_beside_the_document(
    document: dict[str, Any],
) -> None:
    page = report(document)
    root = ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page
    assert len(root.findall(".//svg")) == 2
    assert not re.search(r"https?:|src=|@import|url\((?!#)|<link|<script", page)
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(set(ids)) == len(ids)
    text = "".join(root.itertext())
    for row in compare(document):
        assert all(words in text for words in (row.what, row.paper, row.here, row.words))
    for row in published.SCENARIO_THREE["rows"]:
        assert row["behaviour"] in text
    assert report(json.loads(json.dumps(document))) == page


@pytest.mark.slow
def test_the_words_follow_the_numbers(document: dict[str, Any]) -> None:
    row = {**document["faults"][0], "missed": 2, "again": 1, "escalated": 3}
    told = compare({**document, "faults": [row, *document["faults"][1:]]})[0].words
    assert "2 missed" in told and "1 of them diagnosed once more" in told
    assert "3 needed more than the first recovery" in told
    stopped = {"to its end": 4, "Tangy was halted.": 2}
    assert compare({**document, "ended": stopped})[-1].here == "4 of 6"
    page = report({**document, "ended": stopped, "did_not_come_about": ["never-complies"]})
    assert "Stopped before the end, 2 games: Tangy was halted." in page
    assert "did not come about before its games ended: never-complies" in page


def test_figures_from_chosen_settings_are_no_predictions(document: dict[str, Any]) -> None:
    sources = [row.source for row in compare(document)]
    assert sources == ["chosen"] * 4 + ["predicted", "fitted", "chosen"]


@pytest.mark.slow
def test_the_page_says_whether_devices_were_simulated(document: dict[str, Any]) -> None:
    assert "in simulation" in report(document) and "proves the rules" in report(document)
    benched = {**document, "simulated": False}
    assert "on a bench of devices" in report(benched)
    assert "through the drivers" in report(benched)
    assert "what they report is not" in " ".join(row.words for row in compare(benched))


def test_games_with_errors_are_kept_for_review(document: dict[str, Any], tmp_path: Path) -> None:
    fine = next(game for game in document["each_game"] if not to_read(game))
    induced, diagnosed = fine["induced"][0], fine["faults"][0]
    missed = {**fine, "induced": [{**induced, "missed": True}]}
    assert to_read(missed)
    assert to_read({**fine, "faults": [{**diagnosed, "verdict": NOTHING}]})
    assert to_read({**fine, "faults": [{**diagnosed, "verdict": WRONG}]})
    assert not to_read({**fine, "faults": [{**diagnosed, "verdict": AGAIN}]})
    assert to_read({**fine, "ended": "The robot was switched off."})

    data, kept = tmp_path / "data", tmp_path / "logs" / "seed-2-games-1-to-5"
    data.mkdir()
    (data / "robot.log").write_text("what the robot process wrote")
    door = socket(AF_UNIX)
    door.bind(str(data / "tangy.sock"))  # a killed program leaves it
    door.close()
    for _ in range(2):  # the second run replaces the first
        keep_games(data, kept, [missed])
    assert (kept / "robot.log").read_text() == "what the robot process wrote"
    assert json.loads((kept / "faults.json").read_text()) == [missed]
    assert not (kept / "tangy.sock").exists()
