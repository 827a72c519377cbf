"""The command line: teaching, learning and playing, in words and as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import pytest
import typer

from tangy_tui.verbs.catalogue import VERBS
from tangy_tui.verbs.program import app

Tangy = Callable[..., CompletedProcess[str]]

STRATEGIES = {"praise", "suggestion", "scarcity", "neutral"}
FITTED = {
    "greeting": 20, "joke": 29.3, "call number": 714, "celebrate": 20, "remove markers": 24.6,
    "mark numbers": 22.3, "encourage": 17.5, "move card closer": 22.3, "navigate to user": 69.2,
    "navigate to front": 37.0, "valediction": 20,
}  # fmt: skip
"""Instances per 20 games of the fitted user model."""


def document(done: CompletedProcess[str]) -> Any:
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return json.loads(done.stdout)


# --------------------------------------------------------------------------------- the story


@pytest.mark.slow
def test_a_taught_policy_plays_300_games(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "mine")
    assert tangy("teach", "--teacher", "scripted", "--games", 3, *data).returncode == 0
    assert tangy("learn", *data).returncode == 0
    played = document(
        tangy("play", "--games", 300, "--headless", "--json", "--seed", 271828, *data)
    )
    assert list(played) == [
        "games", "steps", "behaviours", "rows", "interactions_per_user_game", "beliefs", "faults",
        "finished", "stopped", "asked", "pauses",
    ]  # fmt: skip
    assert (played["games"], played["faults"]) == (300, [])
    assert (played["finished"], played["stopped"], played["asked"]) == (300, [], 0)
    assert 33 <= played["behaviours"]["call number"] / 300 <= 38
    assert 47 <= played["steps"] / 300 <= 53
    assert {row["behaviour"] for row in played["rows"]} == set(FITTED)
    for row in played["rows"]:
        assert list(row) == [
            "stage", "request", "user_state", "behaviour", "instances", "success",
        ]  # fmt: skip
        assert row["success"] == 1.0
        assert row["instances"] / 15 == pytest.approx(FITTED[row["behaviour"]], rel=0.15)
        assert row["instances"] == played["behaviours"][row["behaviour"]]
    assert played["interactions_per_user_game"] == pytest.approx(1.1, rel=0.1)
    for number in range(1, 5):
        beliefs = played["beliefs"][f"user{number}"]
        assert set(beliefs) == STRATEGIES
        liked = max(beliefs, key=lambda s: beliefs[s][0] + beliefs[s][1])
        alpha, beta = beliefs[liked]
        assert alpha / (alpha + beta) == pytest.approx(0.9, abs=0.05), "the hidden preference"


def test_the_policy_is_shown_exact_over_all_242_joint_states(tangy: Tangy, taught: Path) -> None:
    shown = document(tangy("policy", "--json", "--data", taught))
    assert shown["exact"]
    assert shown["joint_states"] == {"people": 4, "reachable": 242, "as_expected": 242}
    assert len(shown["rows"]) == len(shown["effects"]) == 11
    assert all(row["share"] == 1.0 and row["seen"] for row in shown["rows"])
    text = tangy("policy", "--data", taught)
    assert text.returncode == 0
    assert "ask to move the card closer" in text.stdout


@pytest.mark.slow
def test_the_same_seed_plays_the_same_games(tangy: Tangy, taught: Path, tmp_path: Path) -> None:
    import shutil

    played = []
    for name in ("a", "b", "c"):
        copy = shutil.copytree(taught, tmp_path / name)
        seed = 8 if name == "c" else 7
        played.append(
            document(tangy("play", "--games", 5, "--json", "--seed", seed, "--data", copy))
        )
    assert played[0] == played[1] != played[2]


@pytest.mark.slow
def test_runs_without_a_seed_differ(tangy: Tangy, taught: Path) -> None:
    for verb in (("play", "--games", 4), ("teach", "--teacher", "scripted")):
        told = [document(tangy(*verb, "--json", "--data", taught)) for _ in range(2)]
        said = [json.dumps(one.get("demonstrations") or one["rows"]) for one in told]
        assert said[0] != said[1]
    seeds = [demonstration["seed"] for one in told for demonstration in one["demonstrations"]]
    assert seeds == [4, 5], "games count on from the three demonstrations there are"


@pytest.mark.slow
def test_posteriors_grow_from_game_to_game(tangy: Tangy, taught: Path) -> None:
    trials = []
    for _ in range(2):
        played = document(tangy("play", "--games", 20, "--json", "--data", taught))
        trials.append(sum(a + b - 2 for p in played["beliefs"].values() for a, b in p.values()))
    assert 0 < trials[0] < trials[1]
    people = document(tangy("people", "list", "--json", "--data", taught))
    kept = sum(b["alpha"] + b["beta"] - 2 for p in people for b in p["beliefs"].values())
    assert kept == trials[1]


@pytest.mark.slow
def test_one_to_eight_people_can_be_played_with(tangy: Tangy, taught: Path) -> None:
    for users in range(1, 9):
        played = document(tangy("play", "--games", 3, "--users", users, "--json", "--data", taught))
        assert len(played["beliefs"]) == users
        assert {row["success"] for row in played["rows"]} == {1.0}


@pytest.mark.slow
def test_the_forest_of_the_paper_is_an_option(tangy: Tangy, taught: Path) -> None:
    learnt = document(tangy("learn", "--forest", "paper", "--json", "--data", taught))
    assert learnt["forest"]["bootstrap"] is True
    assert learnt["exact"]
    assert document(tangy("policy", "--json", "--data", taught))["digest"] == learnt["digest"]


# -------------------------------------------------------------------------------- teaching


def test_a_session_by_lines_can_be_left_and_resumed(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "mine", "--teacher", "Ada", "--plain")
    first = tangy("teach", *data, stdin="greet everyone\ny\nnext number\ny\ntell a joke\nn\n")
    assert first.returncode == 0
    assert "2. a number is due" in first.stdout
    assert "You left after 2 steps" in first.stdout
    second = tangy("teach", *data, stdin="undo\nundo\nquit\n")
    assert "Going on with Ada's demonstration of 2 steps" in second.stdout
    assert "Step 1 is undone: greet everyone." in second.stdout


def test_a_script_is_taught_from_a_file(tangy: Tangy, tmp_path: Path) -> None:
    script = tmp_path / "script.txt"
    script.write_text("# a comment\n\ngreet everyone\ny\nnext number\nY\n", encoding="utf-8")
    taught = document(tangy("teach", "--script", script, "--json", "--data", tmp_path / "mine"))
    (demonstration,) = taught["demonstrations"]
    assert [step["behaviour"] for step in demonstration["trajectory"]] == [
        "greeting", "call number",
    ]  # fmt: skip
    assert demonstration["finished"] is False
    learnt = document(tangy("learn", "--unfinished", "--json", "--data", tmp_path / "mine"))
    assert learnt["steps"] == 2
    assert not learnt["exact"]


@pytest.mark.slow
def test_a_made_up_activity_is_taught_learnt_and_played(tangy: Tangy, tmp_path: Path) -> None:
    lanterns = Path(__file__).parent.parent / "lanterns.toml"
    about = ("--activity", lanterns, "--data", tmp_path / "mine", "--json")
    given = document(tangy("teach", "--teacher", "scripted", "--games", 5, "--seed", 21, *about))
    assert len(given["demonstrations"]) == 5
    assert document(tangy("learn", *about))["exact"]
    played = document(tangy("play", "--games", 20, *about))
    assert played["faults"] == []
    assert played["behaviours"]["draw lantern"] == 400
    assert set(played["beliefs"]["user1"]) == {"quiet", "merry"}


# -------------------------------------------------------------------------- every verb's JSON


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [
        ("teach", "--teacher", "scripted"),
        ("learn",),
        ("policy",),
        ("play", "--headless"),
        ("demo",),
        ("people", "list"),
        ("people", "show", "User 2"),
        ("people", "rename", "user2", "Rosa"),
        ("doctor",),
    ],
)
def test_json_is_one_document_and_nothing_else(
    arguments: tuple[str, ...], tangy: Tangy, taught: Path
) -> None:
    assert document(tangy(*arguments, "--json", "--data", taught, "--seed", 3))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("learn",), "Learnt 'bingo-3' from 3 demonstrations"),
        (("play",), "The game is over"),
        (("play", "--headless"), "1 game, "),
        (("demo", "--plain"), "Teach it yourself"),
        (("people", "list"), "User 4"),
        (("people", "show", "user4"), "User 4 (user4)"),
        (("people", "rename", "user2", "Rosa"), "user2 is now called Rosa."),
        (("doctor",), "is sound"),
    ],
)
def test_every_verb_describes_its_result_in_words(
    arguments: tuple[str, ...], said: str, tangy: Tangy, taught: Path
) -> None:
    done = tangy(*arguments, "--data", taught)
    assert done.returncode == 0, done.stderr
    assert said in done.stdout


def helps(command: Any, name: str) -> Iterator[str]:
    """Yield the help of a command and of its subcommands, as in a window of 80 columns."""
    context = command.make_context(name, [], resilient_parsing=True, max_content_width=80)
    yield command.get_help(context)
    for below, subcommand in getattr(command, "commands", {}).items():
        yield from helps(subcommand, f"{name} {below}")


@pytest.mark.slow
def test_no_list_of_commands_cuts_a_sentence() -> None:
    pages = list(helps(typer.main.get_command(app), "tangy"))
    pages += [page for name, verb in VERBS.items() for page in helps(verb.load(name), name)]
    lines = [line for page in pages for line in page.splitlines() if not line.startswith("Usage")]
    assert [line for line in lines if line.endswith("...")] == []


@pytest.mark.parametrize(
    "verb", ["", "teach", "learn", "policy", "play", "demo", "listen", "people", "doctor"]
)
def test_every_verb_has_help(verb: str, tangy: Tangy) -> None:
    done = tangy(*verb.split(), "--help")
    assert done.returncode == 0
    assert "Usage: " in done.stdout


@pytest.mark.slow
def test_a_used_name_is_refused(tangy: Tangy, taught: Path) -> None:
    tangy("people", "rename", "user1", "Rosa", "--data", taught)
    for taken, why in (("rosa", "is what user1 is called"), ("front", "is a place")):
        done = tangy("people", "rename", "user2", taken, "--data", taught)
        assert done.returncode == 2
        assert done.stderr == f"tangy: '{taken}' {why}: choose another name.\n"
    assert tangy("people", "rename", "user1", "Rosa", "--data", taught).returncode == 0


@pytest.mark.slow
def test_a_new_name_is_used_everywhere_and_keeps_the_id(tangy: Tangy, taught: Path) -> None:
    tangy("people", "rename", "User 1", "Josè [/] {call}", "--data", taught)
    shown = document(tangy("people", "show", "Josè [/] {call}", "--json", "--data", taught))
    assert (shown["id"], shown["name"]) == ("user1", "Josè [/] {call}")
    told = tangy("play", "--games", 3, "--data", taught)
    assert "Josè [/] {call}, " in told.stdout
    assert "Josè [/] {call}" in tangy("people", "list", "--data", taught).stdout
