"""`tangy people`: the strategies of each person, in words and as JSON, and feedback by staff."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import pytest

from tangy_profiles.beliefs import Beta
from tangy_profiles.people_records import ResponseAwaited
from tangy_profiles.store import Store
from tangy_tui.text.times import ago
from tests.support.append_body import append_body

Tangy = Callable[..., CompletedProcess[str]]

LANTERNS = Path(__file__).parent.parent / "lanterns.toml"


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A data folder: Rosa played three weeks ago, and one request waits for an answer."""
    then = datetime.now(UTC) - timedelta(days=23)
    with Store.open(tmp_path / "mine", now=lambda: then) as store:
        store.rename("user1", "Rosa")
        begun = {"game": "g", "people": ["user1", "user2"], "world": "simulated"}
        append_body(store, "game begun", begun)
        told = [("praise", n < 7) for n in range(9)] + [("neutral", False)] * 3
        told += [("suggestion", False)] * 2
        for strategy, complied in [*told, ("scarcity", False), ("scarcity", False)]:
            body = {"game": "g", "followed": True, "seconds": 5.0}
            append_body(
                store, "response", body, person="user1", strategy=strategy, complied=complied
            )
        append_body(store, ResponseAwaited, {"game": "g"}, person="user1", strategy="suggestion")
    return tmp_path / "mine"


@pytest.fixture
def people(tangy: Tangy, data: Path) -> Callable[..., CompletedProcess[str]]:
    """Run `tangy people` on it."""

    def run(*arguments: object) -> CompletedProcess[str]:
        return tangy("people", *arguments, "--data", data)

    return run


def document(done: CompletedProcess[str]) -> Any:
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return json.loads(done.stdout)


def counts(done: CompletedProcess[str], strategy: str) -> tuple[int, int]:
    belief = document(done)["beliefs"][strategy]
    return belief["complied"], belief["trials"]


# ----------------------------------------------------------------------------------- reports


def test_a_person_is_shown_with_every_posterior(people: Tangy) -> None:
    shown = document(people("show", "rosa", "--json"))
    assert (shown["id"], shown["name"]) == ("user1", "Rosa")
    praise = shown["beliefs"]["praise"]
    assert (praise["alpha"], praise["beta"], praise["complied"], praise["trials"]) == (8, 3, 7, 9)
    assert praise["interval"] == pytest.approx(Beta(8, 3).interval())
    assert praise["p_best"] >= 0.9
    assert praise["prior"] == [1, 1]
    assert sum(belief["p_best"] for belief in shown["beliefs"].values()) == pytest.approx(1)
    assert shown["settled"] == "praise"
    assert shown["method"]["method"] == "thompson"
    assert shown["method"]["own"] is False
    assert shown["sentence"] == "praise works with Rosa: 7 of 9, last seen 3 weeks ago"
    (game,) = shown["games"]
    assert [entry["number"] for entry in game["responses"]] == list(range(1, 18))


def test_the_list_describes_people_in_words(people: Tangy) -> None:
    told = people("list").stdout
    assert "user1: praise works with Rosa: 7 of 9, last seen 3 weeks ago" in told
    assert "user2: nothing is known of User 2 yet, last seen 3 weeks ago" in told
    assert "user3: nothing is known of User 3 yet\n" in told
    shown = people("show", "Rosa").stdout
    for words in ("0.49 to 0.91", "settled", "Thompson sampling (as the activity sets)"):
        assert words in shown
    assert "no response yet" in people("history", "Rosa").stdout


def test_the_list_is_the_default_verb(people: Tangy) -> None:
    assert people().stdout == people("list").stdout
    assert document(people("--json")) == document(people("list", "--json"))


def test_the_columns_are_explained_below_the_tables(people: Tangy) -> None:
    best = "Chance to be best: of the ways of asking that are on. "
    assert f"\n{best}*: the most likely one.\nuser1: " in people("list").stdout
    assert f"\n{best}settled: at least 0.9.\npraise works " in people("show", "Rosa").stdout


def test_the_star_marks_a_single_leading_strategy(people: Tangy) -> None:
    rows = {line.split()[0]: line for line in people("list").stdout.splitlines() if "/" in line}
    assert "7/9 (0.9" in rows["Rosa"]
    assert rows["Rosa"].count("*") == 1
    assert "*" not in rows["User"], "of whom nothing is known"


def test_a_custom_activity_has_its_own_strategies(people: Tangy) -> None:
    shown = document(people("show", "user1", "--activity", LANTERNS, "--json"))
    assert set(shown["beliefs"]) == {"quiet", "merry"}
    switched = people("switch", "user1", "merry", "off", "--activity", LANTERNS, "--json")
    assert document(switched)["beliefs"]["merry"]["on"] is False


def test_reading_commands_write_nothing(tangy: Tangy, tmp_path: Path) -> None:
    for verb in (("list",), ("show", "user1"), ("history", "user1")):
        assert tangy("people", *verb, "--data", tmp_path / "none").returncode == 0
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    "words", [("--data", "DATA", "people", "list"), ("people", "--data", "DATA", "list")]
)
def test_options_before_a_verb_apply_to_the_verb(
    tangy: Tangy, data: Path, words: tuple[str, ...]
) -> None:
    after = tangy("people", "list", "--data", data)
    before = tangy(*(data if word == "DATA" else word for word in words))
    assert before.stdout == after.stdout and "Rosa" in after.stdout


def test_an_option_after_a_verb_overrides_one_before_it(
    tangy: Tangy, data: Path, tmp_path: Path
) -> None:
    after = tangy("people", "--data", tmp_path / "none", "list", "--data", data)
    assert "Rosa" in after.stdout


# ----------------------------------------------------------------------------------- changes


@pytest.mark.slow
def test_a_response_is_voided_by_number_and_restored_by_undo(people: Tangy) -> None:
    assert counts(people("void", "Rosa", 1, "--why", "she slept", "--json"), "praise") == (6, 8)
    history = document(people("history", "Rosa", "--json"))
    assert (history[0]["void"], history[0]["why"]) == (True, "she slept")
    assert counts(people("void", "Rosa", "--json"), "scarcity") == (0, 1)
    assert counts(people("undo", "Rosa", "--json"), "scarcity") == (0, 2)
    assert counts(people("undo", "Rosa", "--json"), "praise") == (7, 9)


def test_void_prints_the_response_and_the_reason(people: Tangy) -> None:
    last, first = people("void", "Rosa").stdout, people("void", "Rosa", 1).stdout
    when = r"\d+ \w+ \d{4} \d\d:\d\d"
    assert re.match(rf"Void: number 16, scarcity, {when}, did it a little late\.\nNow: ", last)
    assert re.match(rf"Void: number 1, praise, {when}, did it\.\nNow: ", first)
    said = people("feedback", "Rosa", "suggestion", "yes").stdout
    assert re.match(rf"Said: number 18, suggestion, {when}, did it, said later\.\nNow: ", said)


def test_a_reason_with_undecodable_bytes_is_stored_and_shown(people: Tangy) -> None:
    assert people("void", "Rosa", 1, "--why", "sl\udcffept").returncode == 0
    history = document(people("history", "Rosa", "--json"))
    assert history[0]["why"] == "sl\N{REPLACEMENT CHARACTER}ept"


def test_the_help_of_undo_lists_what_it_reverts(people: Tangy) -> None:
    told = " ".join(people("undo", "--help").stdout.split())
    assert "Undo the last void, feedback, switch or method." in told
    assert "A new name is not undone: rename the person again." in told


def test_undecodable_bytes_are_replaced_in_stored_names(tangy: Tangy, taught: Path) -> None:
    learnt = tangy("learn", "--name", "a\udcffb", "--data", taught)
    assert (learnt.returncode, learnt.stderr) == (0, "")
    shown = tangy("policy", "--data", taught, "--json")
    assert document(shown)["name"] == "a\N{REPLACEMENT CHARACTER}b"


def test_a_pending_request_is_answered_once(people: Tangy) -> None:
    answered = people("feedback", "Rosa", "suggestion", "yes", "--json")
    assert counts(answered, "suggestion") == (1, 3)
    again = people("feedback", "Rosa", "suggestion", "no")
    assert again.returncode == 2
    assert "void a wrong answer first" in again.stderr
    numbered = people("feedback", "Rosa", "praise", "no", "--of", 1)
    assert numbered.returncode == 2
    assert "has its answer already, and none counts twice" in numbered.stderr


def test_feedback_without_a_request_needs_the_option_seen(people: Tangy) -> None:
    assert people("feedback", "Rosa", "praise", "yes").returncode == 2
    seen = people("feedback", "Rosa", "praise", "yes", "--seen", "--json")
    assert counts(seen, "praise") == (8, 10)
    assert document(seen)["games"][-1]["game"] is None


def test_a_strategy_is_switched_off_and_on(people: Tangy) -> None:
    shown = document(people("switch", "Rosa", "praise", "off", "--json"))
    assert shown["beliefs"]["praise"]["on"] is False
    assert shown["beliefs"]["praise"]["p_best"] == 0
    assert shown["settled"] is None
    assert "Switched off: praise." in people("switch", "Rosa", "neutral", "off").stdout.replace(
        "neutral, ", ""
    )
    assert document(people("undo", "Rosa", "--json"))["beliefs"]["neutral"]["on"] is True
    assert document(people("switch", "Rosa", "praise", "on", "--json"))["settled"] == "praise"


def test_a_method_for_a_person_is_chosen_in_words(people: Tangy) -> None:
    chosen = document(people("method", "user2", "bayes-ucb", "people", "0.98", "--json"))
    assert chosen["method"] == {
        "method": "bayes-ucb", "prior": "people", "forgetting": 0.98,
        "forgetting_per": "interaction", "own": True,
        "words": "Bayes-UCB from earlier people, forgetting 2% an interaction",
    }  # fmt: skip
    alpha, beta = chosen["beliefs"]["praise"]["prior"]
    assert 2 < alpha + beta <= 3, "one earlier person is worth one response"
    assert "starts from what worked with earlier people" in people("show", "user2").stdout
    assert document(people("method", "user2", "default", "--json"))["method"]["own"] is False


@pytest.mark.slow
def test_unnamed_parts_of_a_method_stay_unchanged(people: Tangy) -> None:
    people("method", "Rosa", "bayes-ucb")
    told = people("method", "Rosa", "0.98", "day").stdout
    assert "Method: Bayes-UCB, forgetting 2% a day (for this person)." in told
    told = people("method", "Rosa", "people", "0.9").stdout
    assert "Method: Bayes-UCB from earlier people, forgetting 10% a day (for this" in told
    told = people("method", "Rosa", "default").stdout
    assert "Method: Thompson sampling (as the activity sets)." in told
    assert "stay as they are" in people("method", "--help").stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("show", "Rosie"), "There is nobody called 'Rosie': did you mean 'Rosa'?"),
        (("show", "Hugo"), "There is nobody called 'Hugo'.\n"),
        (("--users", 3, "archive", "Rosa"), "`tangy people archive` has no option --users"),
        (("switch", "Rosa", "prays", "off"), "no strategy 'prays': did you mean 'praise'?"),
        (("switch", "Rosa", "praise", "of"), "There is no state 'of': did you mean 'off'?"),
        (("switch", "Rosa", "praise", "on"), "praise is switched on already."),
        (("feedback", "Rosa", "praise", "yse"), "There is no answer 'yse': did you mean 'yes'?"),
        (("feedback", "Rosa", "praise", "yes", "--of", 99), "Rosa has no response number 99"),
        (("void", "Rosa", 99), "Rosa has no response number 99: there are 1 to 17."),
        (("void", "Rosa", 17), "That request has no response yet that could be void."),
        (("void", "user3"), "User 3 has no response that counts."),
        (("method", "Rosa", "bayes"), "There is no method 'bayes': did you mean 'bayes-ucb'?"),
        (("method", "Rosa", "0.1"), "must be from 0.5 to 1"),
        (("undo", "Rosa"), "There is nothing to take back."),
        (("show", "Rosa", "--activity", "bingoo"), "did you mean 'bingo'?"),
    ],
)
def test_bad_input_is_refused_in_one_sentence_with_a_suggestion(
    arguments: tuple[object, ...], said: str, people: Tangy
) -> None:
    done = people(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.slow
def test_games_use_the_method_of_each_person(tangy: Tangy, taught: Path) -> None:
    about = ("--data", taught, "--json")
    for strategy in ("praise", "scarcity", "suggestion"):
        tangy("people", "switch", "user2", strategy, "off", "--data", taught)
    tangy("people", "method", "user1", "bayes-ucb", "0.9", "--data", taught)
    played = document(tangy("play", "--games", 10, "--seed", 4, *about))
    used = {s for s, (alpha, beta) in played["beliefs"]["user2"].items() if alpha + beta > 2}
    assert used == {"neutral"}
    shown = document(tangy("people", "show", "user1", *about))
    assert shown["method"]["method"] == "bayes-ucb"
    for strategy, (alpha, beta) in played["beliefs"]["user1"].items():
        belief = shown["beliefs"][strategy]
        assert (belief["alpha"], belief["beta"]) == pytest.approx((alpha, beta))
        assert belief["trials"] >= alpha + beta - 2 - 1e-9


def test_past_times_are_worded() -> None:
    now = datetime(2026, 5, 22, 12, tzinfo=UTC)
    said = {
        0: "today", 1: "yesterday", 2: "2 days ago", 13: "13 days ago", 14: "2 weeks ago",
        21: "3 weeks ago", 59: "8 weeks ago", 60: "8 weeks ago", 61: "2 months ago",
        400: "13 months ago", 800: "2 years ago",
    }  # fmt: skip
    assert {days: ago(now - timedelta(days=days), now) for days in said} == said
    assert ago(now + timedelta(hours=3), now) == "today", "a clock may have been set back"


def test_several_names_at_once_are_refused_with_what_to_type(
    people: Callable[..., CompletedProcess[str]],
) -> None:
    before = document(people("list", "--json"))
    done = people("add", "Anna", "Bert")
    assert done.returncode == 2
    assert "tangy people add Anna" in done.stderr and '"Anna Bert"' in done.stderr
    assert document(people("list", "--json")) == before
    assert document(people("add", "Anna Bert", "--json"))["name"] == "Anna Bert"
