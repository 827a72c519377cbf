"""Every shipped declared activity is taught by demonstration, and then played to its end."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_tui.text.activity_template import NewActivity, items_table, without_article
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


@pytest.mark.slow
@pytest.mark.parametrize(
    "answers",
    [
        "Poem circle\npoem\ny\n",
        "Finger rhymes\n\nn\n",
        "!\nJoke hour\njoke\nn\n",
        "Skittles\n\ny\ny\n",
        "Good news\n\ny\nn\n",
    ],
)
def test_a_new_activity_is_valid_and_playable(answers: str, tangy: Tangy, tmp_path: Path) -> None:
    made = tangy("activity", "new", tmp_path / "mine", stdin=answers)
    assert (made.returncode, made.stderr) == (0, "")
    (file,) = (tmp_path / "mine").glob("*.toml")
    checked = json.loads(tangy("activity", "check", "--json", file).stdout)
    assert [(one["mistakes"], one["warnings"]) for one in checked["files"]] == [([], [])]
    assert json.loads(tangy("activity", "try", "--json", file).stdout)["finished"]
    options = ("--activity", file, "--data", tmp_path / "data")
    tangy("teach", "--teacher", "scripted", "--guided", "--games", 1, *options)
    tangy("learn", *options)
    played = tangy("play", "--games", 20, "--headless", "--json", "--seed", 3, *options)
    assert json.loads(played.stdout)["finished"] == 20


def test_an_invalid_answer_of_the_author_is_asked_again(tangy: Tangy, tmp_path: Path) -> None:
    made = tangy("activity", "new", tmp_path, stdin="Bags\ny\n\nperhaps\nyes\nmaybe\ny\n")
    assert made.returncode == 0 and made.stdout.count("Please type y or n.") == 2
    assert "add score" in (tmp_path / "bags.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("said", ["poem", "a poem", "An old poem", "the poem", "a"])
def test_the_article_of_an_item_is_removed(said: str) -> None:
    item = without_article(said)
    assert item in ("poem", "old poem", "a")
    assert f"The first {item}," in items_table(NewActivity("Poems", item, turns=True))


def test_an_existing_file_is_not_overwritten(tangy: Tangy, tmp_path: Path) -> None:
    (tmp_path / "poems.csv").write_text("mine", encoding="utf-8")
    made = tangy("activity", "new", tmp_path, stdin="Poems\npoem\nn\n")
    assert made.returncode == 2
    assert (tmp_path / "poems.csv").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("words", [("drill",), ("cards", "list")])
def test_commands_for_cards_refuse_an_activity_without_cards(
    words: tuple[str, ...], tangy: Tangy, tmp_path: Path
) -> None:
    data = () if words[0] == "cards" else ("--data", tmp_path)
    done = tangy(*words, "--activity", "trivia", *data)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
