"""The command line for teaching, conflicts, explanations, comparisons, and games with questions."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import pytest

Tangy = Callable[..., "CompletedProcess[str]"]
WRONG = ["help", "AR", "incorrectly marked"]


def document(done: CompletedProcess[str]) -> Any:
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def refusal(done: CompletedProcess[str]) -> str:
    assert done.returncode == 2
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    return line


@pytest.fixture
def disagreeing(tangy: Tangy, tmp_path: Path) -> Path:
    """Data in which Bea's game begins with a joke before the greeting, and Ada's does not."""
    folder = tmp_path / "two"
    lines = ["greet everyone", "y", "quit"]
    script = tmp_path / "ada"
    script.write_text("\n".join(lines) + "\n")
    document(tangy("teach", "--json", "--teacher", "Ada", "--script", script, "--data", folder))
    script.write_text("\n".join(["tell a joke", "y", *lines]) + "\n")
    document(tangy("teach", "--json", "--teacher", "Bea", "--script", script, "--data", folder))
    return folder


def test_a_guided_game_shows_every_situation(tangy: Tangy, tmp_path: Path) -> None:
    at = ("--data", tmp_path / "d")
    taught = document(tangy("teach", "--teacher", "scripted", "--guided", "--json", *at))
    assert taught["demonstrations"][0]["guided"]
    learnt = document(tangy("learn", "--json", *at))
    assert learnt["exact"]
    assert learnt["coverage"] == {"seen": 11, "situations": 11, "missing": []}
    assert learnt["conflicts"] == []


def test_missing_situations_are_listed_in_words(tangy: Tangy, disagreeing: Path) -> None:
    done = tangy("learn", "--unfinished", "--data", disagreeing)
    assert "helping: wrong marks" in done.stdout
    assert "Demonstrations disagree about 1 situation" in done.stdout
    assert "the game has not begun: greet everyone or tell a joke" in done.stdout


@pytest.mark.slow
def test_a_conflict_is_shown_resolved_and_reopened(tangy: Tangy, disagreeing: Path) -> None:
    at = ("--unfinished", "--data", disagreeing)
    (conflict,) = document(tangy("demonstrations", "conflicts", "--json", *at))
    assert conflict["situation"] == ["start", "ANR", "occluded"]
    told = {a["behaviour"]: [s["teacher"] for s in a["steps"]] for a in conflict["answers"]}
    assert told == {"greeting": ["Ada", "Bea"], "joke": ["Bea"]}
    learnt = document(tangy("learn", "--json", *at))
    (row,) = [r for r in learnt["rows"] if r["stage"] == "start"]
    assert (row["contested"], row["sure"]) == (True, False)

    resolve = ("demonstrations", "resolve", "1", *at)
    assert "choose greet everyone or tell a joke" in refusal(
        tangy(*resolve, "--right", "celebrate")
    )
    assert "did you mean 'celebrate'" in refusal(tangy(*resolve, "--instead", "celebrat"))
    assert "Say which answer is right" in refusal(tangy(*resolve))
    assert "there is 1" in refusal(tangy("demonstrations", "resolve", "2", "--both", *at))
    by_words = ("demonstrations", "resolve", "start", *at, "--right", "greeting")
    assert "greet everyone is right" in tangy(*by_words).stdout
    learnt = document(tangy("learn", "--json", *at))
    (row,) = [r for r in learnt["rows"] if r["stage"] == "start"]
    assert (row["behaviour"], row["contested"], row["sure"]) == ("greeting", False, True)
    assert "Taken back" in tangy("demonstrations", "undo", "--data", disagreeing).stdout
    assert len(document(tangy("demonstrations", "conflicts", "--json", *at))) == 1
    assert "Done again" in tangy("demonstrations", "redo", "--data", disagreeing).stdout
    assert document(tangy("demonstrations", "conflicts", "--json", *at)) == []


@pytest.mark.slow
def test_demonstrations_are_listed_and_edited(tangy: Tangy, taught: Path) -> None:
    at = ("--data", taught)

    def listed() -> list[dict[str, Any]]:
        return list(document(tangy("demonstrations", "list", "--json", *at)))

    assert [(r["number"], r["teacher"], r["state"]) for r in listed()] == [
        (n, "scripted", "in use") for n in (1, 2, 3)
    ]
    assert all(r["coverage"]["situations"] == 11 for r in listed())
    edit = document(tangy("demonstrations", "delete", "2", "--json", *at))
    assert edit["what"] == "delete"
    assert [r["state"] for r in listed()] == ["in use", "deleted", "in use"]
    assert len(document(tangy("learn", "--json", *at))["demonstrations"]) == 2
    document(tangy("demonstrations", "restore", "2", "--json", *at))
    merged = document(tangy("demonstrations", "merge", "1", "3", "--json", *at))
    steps = [r["steps"] for r in listed()]
    assert listed()[3]["id"] == merged["made"][0]
    assert steps[3] == steps[0] + steps[2]
    document(tangy("demonstrations", "split", "4", str(steps[0]), "--json", *at))
    assert [r["steps"] for r in listed()][4:] == [steps[0], steps[2]]
    for _ in range(4):
        document(tangy("demonstrations", "undo", "--json", *at))
    assert [r["state"] for r in listed()][:3] == ["in use"] * 3
    assert "no change" in refusal(tangy("demonstrations", "undo", *at))
    assert "1 to" in refusal(tangy("demonstrations", "split", "1", "999", *at))
    shown = document(tangy("demonstrations", "show", "1", "--json", *at))
    assert (shown["steps"], shown["state"]) == (steps[0], "in use")
    assert tangy("demonstrations", "show", "1", *at).stdout.count("->") == steps[0]


@pytest.mark.slow
def test_policies_have_names_and_are_compared(tangy: Tangy, taught: Path) -> None:
    at = ("--data", taught)
    document(tangy("learn", "--name", "all three", "--json", *at))
    document(tangy("demonstrations", "delete", "2", "3", "--json", *at))
    document(tangy("learn", "--name", "only one", "--json", *at))
    names = [p["name"] for p in document(tangy("policy", "--list", "--json", *at))]
    assert names == ["bingo-3", "all three", "only one"]
    found = document(tangy("policy", "--compare", "all three", "only one", "--json", *at))
    assert (found["a"]["name"], found["b"]["name"]) == ("all three", "only one")
    assert len(found["a"]["demonstrations"]) == 3
    assert found["different"] == sum(not row["same"] for row in found["rows"])
    same = document(tangy("policy", "--compare", "last~1", "all three", "--json", *at))
    assert same["same"]
    assert document(tangy("policy", "--name", "all three", "--json", *at))["name"] == "all three"
    assert "choose one of" in refusal(tangy("policy", "--compare", "all three", "xyz", *at))
    lines = tangy("policy", "--compare", "all three", "only one", *at).stdout
    assert f"{found['different']} of 11 rows differ" in lines


def test_why_accepts_numbers_and_words_and_prints_json(tangy: Tangy, taught: Path) -> None:
    at = ("--data", taught)
    words = tangy("policy", "--why", "wrong marks", *at).stdout
    assert "'ask to remove markers' was shown here" in words
    assert "by a ready-made example" in words
    situations = [r["user_state"] for r in document(tangy("policy", "--json", *at))["rows"]]
    number = situations.index("incorrectly marked") + 1
    why = document(tangy("policy", "--why", str(number), "--json", *at))
    assert why == document(tangy("policy", "--why", "/".join(WRONG), "--json", *at))
    assert why["situation"] == WRONG
    assert len(why["rests_on"]) == why["seen"] > 0
    assert {s["behaviour"] for s in why["rests_on"]} == {"remove markers"}
    assert "did you mean" in refusal(tangy("policy", "--why", "helping: wrnog marks", *at))


# ------------------------------------------------------------------------------------- asking


@pytest.fixture
def untaught(tangy: Tangy, disagreeing: Path) -> Path:
    """Data with a policy for the opening of a game only, and that is contested."""
    document(tangy("learn", "--unfinished", "--json", "--data", disagreeing))
    return disagreeing


def test_a_game_without_a_teacher_stops_at_an_unsure_decision(tangy: Tangy, untaught: Path) -> None:
    done = tangy("play", "--headless", "--json", "--seed", 3, "--data", untaught)
    assert done.returncode == 1, "the game did not come to its end"
    played = json.loads(done.stdout)
    assert (played["games"], played["finished"]) == (1, 0)
    assert [stop["game"] for stop in played["stopped"]] == [1]
    assert played["stopped"][0]["reason"] == played["faults"][0]["reason"]
    (fault,) = played["faults"]
    assert "Demonstrations disagree about what to do here: the game" in fault["reason"]
    assert "tangy demonstrations resolve" in fault["reason"]
    assert played["steps"] == 0


@pytest.mark.slow
def test_answers_of_a_scripted_teacher_end_the_questions(tangy: Tangy, untaught: Path) -> None:
    at = ("--headless", "--json", "--data", untaught)
    played = document(tangy("play", "--teacher", "scripted", "--games", 6, "--seed", 3, *at))
    assert played["faults"] == []
    assert all(row["success"] == 1 for row in played["rows"])
    answered = [
        row
        for row in document(tangy("demonstrations", "list", "--json", "--data", untaught))
        if row["teacher"] == "scripted"
    ]
    shown = {tuple(r[k] for k in ("stage", "request", "user_state")) for r in played["rows"]}
    assert len(answered) == len(shown)  # each situation once, and the contested one
    again = document(tangy("play", "--games", 1, "--seed", 3, *at))
    assert again["faults"] == []


@pytest.mark.slow
def test_a_teacher_answers_by_lines_and_each_answer_is_verified(
    tangy: Tangy, untaught: Path
) -> None:
    wavering = ["mumble", "greet everyone", "n", "greet everyone", "maybe", "y"]
    answers = "\n".join([*wavering, "help", "call number", "y"])
    done = tangy("play", "--teacher", "Ada", "--seed", 3, "--data", untaught, stdin=answers)
    assert done.returncode == 0
    told = done.stdout
    assert "Tangy asks. Demonstrations disagree" in told
    assert "I do not know what 'mumble' means" in told
    assert "Did you say: greet everyone?" in told
    assert "Not done: greet everyone" in told
    assert "Please answer Y" in told
    assert "Tangy has learnt that from Ada" in told
    assert "nothing else changed. One earlier step said otherwise, and is set aside." in told
    assert told.count("Tangy has learnt that from Ada") == 2
    assert "The game stopped" in told  # the input ended
    rows = document(tangy("demonstrations", "list", "--json", "--data", untaught))
    assert [r["teacher"] for r in rows] == ["Ada", "Bea", "Ada", "Ada"]
    assert document(tangy("demonstrations", "conflicts", "--json", "--data", untaught)) == []


@pytest.mark.slow
def test_an_older_policy_can_be_played_by_name(tangy: Tangy, taught: Path, tmp_path: Path) -> None:
    at = ("--data", taught)
    assert "There is no policy" in refusal(tangy("play", "--policy", "nope", "--headless", *at))
    document(tangy("learn", "--name", "mine", "--json", *at))
    document(tangy("learn", "--json", *at))
    played = document(tangy("play", "--policy", "mine", "--headless", "--json", *at))
    assert played["games"] == 1


# ------------------------------------------------------------------------------- showing again


@pytest.mark.slow
def test_a_demonstration_is_shown_again_from_a_step(tangy: Tangy, disagreeing: Path) -> None:
    at = ("--data", disagreeing)
    again = ("teach", "--teacher", "Cleo", "--json", "--again")
    taught = document(tangy(*again, "2@1", *at, stdin="greet everyone\ny\n"))
    (made,) = taught["demonstrations"]
    assert (made["origin"], made["teacher"]) == ("again", "Cleo")
    assert [s["behaviour"] for s in made["trajectory"]] == ["greeting"]
    for wrong in ("2", "2@0", "@3", "2@x", "9@1", "1@99"):
        assert refusal(tangy("teach", "--again", wrong, *at))


def test_undo_redo_seen_and_why_work_by_lines(tangy: Tangy, tmp_path: Path) -> None:
    lines = "greet everyone\ny\nundo\nredo\nseen\nwhy\nagain 1\nredo\nhelp\nquit\n"
    told = tangy("teach", "--plain", "--data", tmp_path / "d", stdin=lines).stdout
    assert told.count("1. the game has not begun -> greet everyone") == 3
    assert told.count("Step 1 is undone") == 2
    assert "1 of 11 situations were shown." in told
    assert "Nobody has shown Tangy what to do here" in told
    assert "redo: redo the step" in told


def test_a_script_for_the_scripted_teacher_is_refused(tangy: Tangy, tmp_path: Path) -> None:
    script = tmp_path / "lines"
    script.write_text("greet everyone\ny\n")
    done = tangy("teach", "--teacher", "scripted", "--script", script, "--data", tmp_path / "d")
    assert "leave out --script" in refusal(done)


@pytest.mark.slow
def test_learning_lists_changed_decisions(tangy: Tangy, disagreeing: Path) -> None:
    at = ("--data", disagreeing)
    told = refusal(tangy("learn", *at))
    assert "3 steps are kept" in told
    assert "--unfinished" in told
    document(tangy("learn", "--unfinished", "--json", *at))
    document(tangy("play", "--headless", "--json", "--teacher", "scripted", "--seed", 3, *at))
    document(tangy("learn", "--json", *at))
    document(tangy("demonstrations", "delete", "3", "--json", *at))  # the answer to the opening
    fewer = tangy("learn", *at).stdout
    assert "the game has not begun: was greet everyone, is now to ask" in fewer
    again = tangy("learn", *at).stdout
    assert "It does the same as" in again


@pytest.mark.slow
def test_answers_of_a_scripted_teacher_are_printed(tangy: Tangy, untaught: Path) -> None:
    at = ("--headless", "--teacher", "scripted", "--seed", 3, "--data", untaught)
    told = tangy("play", *at).stdout
    assert "Learnt from scripted: the game has not begun -> greet everyone." in told
    played = document(tangy("play", "--json", "--games", 9, *at))
    assert all(set(a) >= {"situation", "behaviour", "words"} for a in played.get("answers", []))


@pytest.mark.slow
def test_a_policy_cannot_take_a_reserved_name(tangy: Tangy, taught: Path) -> None:
    for name in ("last", "last~1", "teacher:Ada"):
        assert "choose another name" in refusal(tangy("learn", "--name", name, "--data", taught))
    document(tangy("demonstrations", "delete", "1", "--json", "--data", taught))
    document(tangy("learn", "--json", "--data", taught))
    document(tangy("demonstrations", "undo", "--json", "--data", taught))
    document(tangy("demonstrations", "delete", "2", "--json", "--data", taught))
    assert document(tangy("learn", "--json", "--data", taught))["name"] == "bingo-2.2"


def test_a_step_resolved_as_wrong_is_marked_in_its_demonstration(
    tangy: Tangy, disagreeing: Path
) -> None:
    at = ("--data", disagreeing)
    document(
        tangy(
            "demonstrations", "resolve", "1", "--right", "greeting", "--unfinished", "--json", *at
        )
    )
    lines = tangy("demonstrations", "show", "2", *at).stdout.splitlines()
    assert [("called it wrong" in line) for line in lines] == [False, True, False]


def test_ambiguous_words_for_a_situation_are_refused(tangy: Tangy, taught: Path) -> None:
    told = refusal(tangy("policy", "--why", "somebody", "--data", taught))
    assert "fits several situations" in told


@pytest.mark.slow
def test_the_comparison_of_teachers_ignores_resolutions(tangy: Tangy, disagreeing: Path) -> None:
    at = ("--data", disagreeing)
    settle = ("demonstrations", "resolve", "1", "--unfinished", "--both", "--json")
    document(tangy(*settle, *at))
    lines = "greet everyone\ny\nsay goodbye\ny\nquit\n"
    for teacher in ("Cleo", "Dan"):
        tangy("teach", "--plain", "--teacher", teacher, *at, stdin=lines)
        lines = "tell a joke\ny\nsay goodbye\ny\nquit\n"
    found = document(tangy("policy", "--compare", "Cleo", "Dan", "--json", *at))
    assert not found["same"]


@pytest.mark.slow
def test_faults_are_reported_in_one_document(tangy: Tangy, taught: Path) -> None:
    at = ("play", "--headless", "--seed", 3, "--data", taught)
    asked = ("--inject", "laser-disconnected@4", "--inject", "base-stuck@999")
    halted = tangy(*at, "--json", *asked)
    assert halted.returncode == 1, "nobody cleared it, so that the game did not come to its end"
    played = json.loads(halted.stdout)
    (fault,) = played["faults"]
    assert fault["code"] == "laser-disconnected"
    assert fault["criticality"] == "critical"
    assert fault["moves"][-1]["kind"] == "given up"
    assert played["did_not_come_about"] == {"base-stuck@999": 1}
    assert played["injected"] == [
        {"game": 1, "fault": "laser-disconnected", "step": 4},
        {"game": 1, "fault": "base-stuck@999", "step": None},
    ]
    cleared = document(tangy(*at, "--json", "--expert", "scripted", *asked))
    assert [fault["status"] for fault in cleared["faults"]] == ["over"]
    assert (cleared["finished"], cleared["stopped"]) == (1, [])
    assert "did_not_come_about" not in document(tangy(*at, "--json"))
    said = tangy(*at, "--expert", "scripted", *asked).stdout
    assert "base-stuck@999 did not come about in 1 of 1 game." in said
    assert "1 fault, 1 of them critical" in said


def test_injections_are_listed_without_a_game(tangy: Tangy, tmp_path: Path) -> None:
    listed = document(tangy("play", "--inject", "help", "--json", "--data", tmp_path))
    said = tangy("live", "--bench", "--inject", "help", "--data", tmp_path).stdout
    assert len(listed) > 20
    for one in listed:
        assert set(one) == {"fault", "what", "shows"}
        assert one["fault"] in said
        assert one["what"] in said


@pytest.mark.slow
def test_a_policy_that_asks_is_not_called_as_expected(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path)
    tangy("teach", "--plain", *data, stdin="greet everyone\ny\ncall number\ny\nquit\n")
    tangy("learn", "--unfinished", *data)
    asks = document(tangy("policy", "--json", *data))["asks"]
    assert asks
    assert "matches the reference" not in tangy("policy", *data).stdout
    tangy("teach", "--guided", "--teacher", "scripted", "--new", *data)
    tangy("learn", *data)
    assert document(tangy("policy", "--json", *data))["asks"] == []
    assert "matches the reference" in tangy("policy", *data).stdout
