"""Remarks on oversights of a teacher: reported at once, only once, answered or deferred."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

from tangy_profiles.activity import shipped_activities
from tangy_profiles.state import ActivityState, Outcome, Progress
from tangy_profiles.teaching_records import DemonstrationsEdited, Settlement
from tangy_tui.app.teaching_grammar import read_settling
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.after_teaching import AfterTeaching
from tangy_tui.console.teaching import TeachingLines
from tangy_tui.learning.effects import progress
from tangy_tui.learning.library import read_library
from tangy_tui.learning.remarks import answers_to
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import (
    Contradicted,
    EndedEarly,
    Finish,
    NothingChanged,
    Overlooked,
    Redo,
    Remark,
    Settle,
    Settled,
    StepUndone,
    TeachingEvent,
    Undo,
    WrongPerson,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Refused, Reply, Say
from tangy_tui.monitoring.games import read_games
from tangy_tui.text.endings import ending_words
from tangy_tui.text.games import ended_words
from tangy_tui.text.refusals import refused_words
from tangy_tui.text.teaching import complete_words
from tests.support.games import ended, play

DECLARED = sorted(set(shipped_activities()) - {"bingo"})


@pytest.fixture
def workspace(tmp_path: Path) -> Iterator[Workspace]:
    """A data folder without a game in it."""
    opened = Workspace(tmp_path)
    yield opened
    opened.close()


def session(workspace: Workspace, teacher: str = "Ada", seed: int = 1) -> TeachingSession:
    teaching = workspace.teaching(teacher, seed)
    teaching.begin(resume=False)
    return teaching


def show(teaching: TeachingSession, phrase: str) -> list[TeachingEvent]:
    """Give a command, and say yes."""
    teaching.apply(Say(phrase))
    return teaching.apply(Reply(yes=True))


def remarks(events: list[TeachingEvent]) -> list[Remark]:
    return [event for event in events if isinstance(event, Remark)]


def do(teaching: TeachingSession, *phrases: str) -> list[Remark]:
    """Give commands, and return the remarks on them."""
    return [remark for phrase in phrases for remark in remarks(show(teaching, phrase))]


def same(told: Remark, later: list[Remark]) -> list[Remark]:
    """Return the remarks in the same situation."""
    return [r for r in later if r.step.state.situation == told.step.state.situation]


def until(teaching: TeachingSession, stage: str) -> None:
    """Teach the expected behaviours up to a stage."""
    script = ScriptedTeacher(teaching)
    while teaching.world.observe().stage != stage:
        command = script.command()
        assert isinstance(command, Say)
        assert not do(teaching, command.text)


def unasked(teaching: TeachingSession) -> str:
    """Return the phrase for a person who does not ask."""
    users = teaching.world.observe().users
    number = next(n for n, user in enumerate(users, 1) if user.request == "ANR")
    return f"go to user {number}"


# ------------------------------------------------------------------- six kinds of wrong teaching


def test_a_skipped_stage_is_reported_once_with_its_behaviour(workspace: Workspace) -> None:
    teaching = session(workspace)
    until(teaching, "socialize")
    (remark,) = do(teaching, "call number")
    assert isinstance(remark, Overlooked)
    assert remark.due == "joke"
    assert same(remark, do(teaching, *["call number"] * 3)) == []


@pytest.mark.parametrize("wrong", ["encourage", "call number"])
def test_a_winner_who_is_sent_away_or_left_is_reported_with_the_right_behaviour(
    workspace: Workspace, wrong: str
) -> None:
    teaching = session(workspace)
    script = ScriptedTeacher(teaching)
    while teaching.world.observe().situation.user_state != "bingo":
        command = script.command()
        assert isinstance(command, Say)
        assert not do(teaching, command.text)
    (remark,) = do(teaching, wrong)
    assert isinstance(remark, Overlooked)
    assert remark.due == "celebrate"
    if wrong == "encourage":
        (refused,) = (e for e in teaching.apply(Say("celebrate")) if isinstance(e, Refused))
        assert refused.why == "request ended"
        assert "ended" in refused_words(refused)
    teaching.apply(Undo())
    assert not do(teaching, "celebrate")


def test_a_contradiction_to_an_own_step_is_reported_once(workspace: Workspace) -> None:
    teaching = session(workspace)
    (remark,) = do(teaching, "greet everyone", "call number", "tell a joke")
    assert isinstance(remark, Contradicted)
    assert remark.own
    assert same(remark, do(teaching, "call number", "tell a joke")) == []
    another = session(workspace, seed=2)
    assert same(remark, do(another, "greet everyone", "tell a joke", "call number")) == []


def test_a_contradiction_to_another_teacher_is_reported_once_to_each(workspace: Workspace) -> None:
    do(session(workspace, "Ada"), "greet everyone", "call number")
    (remark,) = do(session(workspace, "Bea"), "greet everyone", "tell a joke")
    assert isinstance(remark, Contradicted)
    assert remark.earlier.teacher == "Ada"
    bea = session(workspace, "Bea", 2)
    assert same(remark, do(bea, "greet everyone", "tell a joke")) == []
    (back,) = do(session(workspace, "Ada", 3), "greet everyone", "call number")
    assert isinstance(back, Contradicted)
    assert back.earlier.teacher == "Bea"


def test_a_visit_without_a_request_is_reported_once(workspace: Workspace) -> None:
    teaching = session(workspace)
    until(teaching, "navigate")
    waiting = teaching.world.observe().attended
    assert waiting is not None
    (remark,) = do(teaching, unasked(teaching))
    assert isinstance(remark, WrongPerson)
    assert remark.waiting == waiting
    assert remarks(show(teaching, unasked(teaching))) == []


def test_a_game_that_ends_early_is_reported_with_the_missing_behaviour(
    workspace: Workspace,
) -> None:
    teaching = session(workspace)
    do(teaching, "greet everyone")
    (remark,) = do(teaching, "say goodbye")
    assert isinstance(remark, EndedEarly)
    assert remark.lacks == "celebrate"
    assert [type(event) for event in teaching.apply(Settle("undo"))] == [StepUndone]
    assert not teaching.demonstration.finished


def test_an_end_that_is_redone_is_reported_again(workspace: Workspace) -> None:
    teaching = session(workspace)
    do(teaching, "greet everyone")
    (first,) = do(teaching, "say goodbye")
    for _ in range(2):
        teaching.apply(Undo())
        events = teaching.apply(Redo())
        assert remarks(events) == [first]
        assert teaching.remark == first
    assert [type(event) for event in teaching.apply(Settle("undo"))] == [StepUndone]


def test_an_early_end_is_reported_before_a_contradiction(workspace: Workspace) -> None:
    teaching = session(workspace)
    do(teaching, "greet everyone", "call number")
    situation = teaching.demonstration.steps[-1].state.situation
    assert teaching.world.observe().situation == situation
    (remark,) = do(teaching, "say goodbye")
    assert isinstance(remark, EndedEarly)


def test_an_early_goodbye_is_told_in_teaching_and_in_the_games_that_follow(
    silent: Workspace,
) -> None:
    teaching = session(silent)
    do(teaching, "welcome everyone")
    (remark,) = do(teaching, "close quiz")
    assert isinstance(remark, EndedEarly)
    assert remark.lacks == "ask question"
    told = complete_words(teaching)
    assert "ended early" in told and "“ask question”" in told
    policy = learn(silent)
    over = ended(play(silent.supervision(policy, 3)))
    assert (over.due, over.rounds_left) == ("ask question", 6)
    assert ended_words(over).endswith("“ask question” was still to come. 6 rounds were left.")
    (game,) = read_games(silent.store)
    assert ending_words(game) == "ended early: “ask question” was still to come"
    assert not game.smooth


def test_a_goodbye_that_is_due_is_not_early(silent: Workspace) -> None:
    teaching = session(silent)
    script = ScriptedTeacher(teaching)
    while not teaching.world.over:
        command = script.command()
        assert isinstance(command, Say)
        assert not [one for one in do(teaching, command.text) if isinstance(one, EndedEarly)]
    assert "The game is complete" in complete_words(teaching)


def test_a_guided_game_reports_an_early_goodbye_though_it_goes_on(silent: Workspace) -> None:
    teaching = silent.teaching("Ada", 1, guided=True)
    teaching.begin(resume=False)
    (remark,) = do(teaching, "welcome everyone", "ask question", "close quiz")
    assert isinstance(remark, EndedEarly)
    assert remark.lacks == "allow time"
    assert not teaching.world.over, "it goes on from an earlier moment"


def test_a_step_that_changes_nothing_is_reported_once(workspace: Workspace) -> None:
    teaching = session(workspace)
    until(teaching, "end")
    (remark,) = do(teaching, "celebrate")
    assert isinstance(remark, NothingChanged)
    assert not remark.back
    assert do(teaching, *["celebrate"] * 9) == []


@pytest.fixture
def silent(tmp_path: Path) -> Iterator[Workspace]:
    """A data folder, and trivia with people who never answer or ask."""
    shipped = next(path for path in shipped_activities().values() if path.stem == "trivia")
    shutil.copy(shipped.with_suffix(".csv"), tmp_path)
    text = re.sub(r"chance = [0-9.]+", "chance = 0.0", shipped.read_text("utf-8"))
    (tmp_path / "trivia.toml").write_text(text, "utf-8")
    opened = Workspace(tmp_path / "data", activity=str(tmp_path / "trivia.toml"))
    yield opened
    opened.close()


def clock(teaching: TeachingSession) -> str:
    return dict(teaching.world.observe().facts)["clock"]


def test_waiting_for_a_timer_is_no_useless_step_but_waiting_for_nothing_is(
    silent: Workspace,
) -> None:
    teaching = session(silent)
    assert do(teaching, "welcome everyone", "ask question") == []
    while clock(teaching) == "<20":
        assert do(teaching, "allow time") == []
    (remark,) = do(teaching, "allow time")
    assert isinstance(remark, NothingChanged)
    assert not remark.back
    assert do(teaching, *["allow time"] * 3) == []


def test_steps_that_lead_back_to_where_the_game_was_are_reported(silent: Workspace) -> None:
    teaching = session(silent)
    do(teaching, "welcome everyone", "ask question", "give hint")
    while clock(teaching) == "<20":
        do(teaching, "allow time")
    (remark,) = do(teaching, "give hint")
    assert isinstance(remark, NothingChanged)
    assert remark.back, "the timer starts anew, and all is as after the first hint"


def test_a_useless_step_that_is_right_is_not_reported_again(silent: Workspace) -> None:
    teaching = session(silent)
    (remark,) = do(teaching, "welcome everyone", "ask question", "welcome everyone")[-1:]
    assert isinstance(remark, NothingChanged)
    teaching.apply(Settle("this"))
    (said,) = read_library(silent.store, "trivia").resolutions
    assert said.right == ("welcome everyone",)
    another = session(silent, "Bea", 2)
    assert do(another, "welcome everyone", "ask question", "welcome everyone") == []


WAITING = """
name = "sowing"
title = "Sowing"
summary = "1 to 6 people, 15 minutes; you need trays, soil and seeds"
flags = ["shown"]
stages = [
  { name = "start", words = "nobody knows how", when = ["shown is no"] },
  { name = "done", words = "all have sown", when = ["sown is all"] },
  { name = "sowing", words = "people sow" },
]
expected = [["start", "show steps"], ["sowing", "watch quietly"], ["done", "say goodbye"]]
[facts]
sows = { kind = "flag", per = "player", from = ["staff"] }
[facts.sown]
steps = { none = [], all = ["every sows is yes"] }
[people]
sows = { while = ["shown is yes"], chance = 0.15, yes = 1, no = 0 }
[behaviours."show steps"]
does = ["set shown yes"]
says = ["First the soil, then the seeds."]
[behaviours."watch quietly"]
does = []
says = ["Take your time."]
[behaviours."say goodbye"]
does = ["finish"]
says = ["Goodbye, and water them!"]
"""


def test_waiting_for_people_as_the_file_of_the_activity_says_is_no_useless_step(
    tmp_path: Path,
) -> None:
    (tmp_path / "sowing.toml").write_text(WAITING, "utf-8")
    opened = Workspace(tmp_path / "data", activity=str(tmp_path / "sowing.toml"))
    teaching = session(opened)
    assert do(teaching, "show steps", *["watch quietly"] * 3) == []
    assert teaching.world.observe().situation.stage == "sowing"
    opened.close()


@pytest.mark.slow
@pytest.mark.parametrize("name", DECLARED)
@pytest.mark.parametrize("guided", [False, True])
def test_a_faultless_teacher_of_a_shipped_activity_gets_no_remark(
    tmp_path: Path, name: str, guided: bool
) -> None:
    led: list[Progress] = []  # also where the file itself expects the step

    def judged(before: ActivityState, outcome: Outcome, after: ActivityState) -> Progress:
        led.append("on" if outcome.response else progress(before, outcome, after))
        return led[-1]

    for seed in (1, 2, 3):
        teaching = Workspace(tmp_path / str(seed), activity=name).teaching("A", seed, guided=guided)
        teaching.begin(resume=False)
        with patch("tangy_tui.learning.remarks.progress", judged):
            told = list(ScriptedTeacher(teaching).demonstrate())
        assert teaching.demonstration.finished
        assert remarks(told) == []
    assert len(led) > 20 and set(led) <= {"on", "waits"}


@pytest.mark.parametrize("seed", range(1, 9))
@pytest.mark.parametrize("guided", [False, True])
def test_a_faultless_teacher_gets_no_remark(workspace: Workspace, seed: int, guided: bool) -> None:
    teaching = workspace.teaching("Ada", seed, guided=guided)
    teaching.begin(resume=False)
    told = list(ScriptedTeacher(teaching).demonstrate())
    assert teaching.demonstration.finished
    assert remarks(told) == []


def test_a_faultless_teacher_of_another_activity_gets_no_remark(tmp_path: Path) -> None:
    for name in ("trivia", str(Path(__file__).parents[1] / "lanterns.toml")):
        opened = Workspace(tmp_path / Path(name).stem, activity=name)
        teaching = opened.teaching("Ada", 3)
        teaching.begin()
        told = list(ScriptedTeacher(teaching).demonstrate())
        opened.close()
        assert teaching.demonstration.finished
        assert remarks(told) == []


# ------------------------------------------------------------------------------- the answers


def contradict(workspace: Workspace) -> TeachingSession:
    """Let Bea show another behaviour than Ada did."""
    do(session(workspace, "Ada"), "greet everyone", "call number")
    teaching = session(workspace, "Bea", 2)
    assert do(teaching, "greet everyone", "tell a joke")
    return teaching


@pytest.mark.parametrize(
    ("answer", "right"),
    [
        ("this", {"joke"}),
        ("earlier", {"call number"}),
        ("both", {"joke", "call number"}),
    ],
)
def test_the_answer_is_logged_as_a_resolved_conflict(
    workspace: Workspace, answer: str, right: set[str]
) -> None:
    teaching = contradict(workspace)
    assert read_library(workspace.store, "bingo").all_conflicts
    settle = read_settling(answer, teaching.remark) if teaching.remark else None
    assert settle is not None
    (settled,) = teaching.apply(settle)
    assert isinstance(settled, Settled)
    assert set(settled.right) == right
    (event,) = workspace.store.events(DemonstrationsEdited)
    assert isinstance(event.record.edit, Settlement)
    assert set(event.record.edit.resolution.right) == right
    assert not read_library(workspace.store, "bingo").all_conflicts
    assert same(settled.remark, do(teaching, "call number", "tell a joke")) == []


def test_teaching_continues_after_the_first_step_was_rejected(
    workspace: Workspace,
) -> None:
    teaching = session(workspace)
    do(teaching, "call number", "greet everyone")
    assert teaching.remark is not None
    settle = read_settling("this", teaching.remark)
    assert settle is not None
    (settled,) = teaching.apply(settle)
    assert isinstance(settled, Settled) and set(settled.right) == {"greeting"}
    another = session(workspace, seed=2)
    assert do(another, "greet everyone") == []
    assert do(session(workspace, seed=3), "call number")


def test_a_deferred_remark_stays_a_conflict(workspace: Workspace) -> None:
    teaching = contradict(workspace)
    (settled,) = teaching.apply(Settle("later"))
    assert isinstance(settled, Settled)
    assert settled.right == ()
    assert read_library(workspace.store, "bingo").all_conflicts
    assert same(settled.remark, do(teaching, "tell a joke")) == []


def test_the_next_command_defers_a_remark(workspace: Workspace) -> None:
    teaching = contradict(workspace)
    teaching.apply(Say("call number"))
    assert teaching.remark is None


def test_undoing_the_step_removes_its_resolution(workspace: Workspace) -> None:
    teaching = contradict(workspace)
    teaching.apply(Settle("this"))
    teaching.apply(Undo())
    library = read_library(workspace.store, "bingo")
    assert not library.resolutions
    assert len(do(teaching, "tell a joke")) == 1


def test_a_skipped_stage_can_be_accepted(workspace: Workspace) -> None:
    teaching = session(workspace)
    until(teaching, "socialize")
    do(teaching, "call number")
    teaching.apply(Settle("this"))
    (said,) = read_library(workspace.store, "bingo").resolutions
    assert said.right == ("call number",)
    assert said.wrong == frozenset()


def test_numbers_and_words_answer_a_remark(workspace: Workspace) -> None:
    remark = contradict(workspace).remark
    assert remark is not None
    read = [read_settling(text, remark) for text in ("1", "2", "3", "4", "5", "later", "hello")]
    answers = [None if settle is None else settle.answer for settle in read]
    assert answers == [*answers_to(remark), None, "later", None]


async def test_a_remark_is_answered_by_lines(workspace: Workspace) -> None:
    do(session(workspace, "Ada"), "greet everyone", "call number")
    lines = iter(["greet everyone", "y", "tell a joke", "y", "2"])
    said: list[str] = []
    teaching = workspace.teaching("Bea", 2)
    await TeachingLines(teaching, lambda: next(lines, None), said.append).run()
    (conflict,) = read_library(workspace.store, "bingo").resolutions
    assert conflict.right == ("call number",)
    assert not teaching.remark, "it is asked once"


async def test_a_remark_left_open_by_lines_comes_back_once_before_learning(
    workspace: Workspace,
) -> None:
    before = session(workspace, "Bea")
    until(before, "navigate")
    wrong = unasked(before)
    ends = ["finish the demonstration", "y", "learn", "learn"]
    lines = iter([wrong, "y", "go to front", "y", *ends])
    said: list[str] = []
    teaching = workspace.teaching("Bea", 1)
    after = AfterTeaching(learn=lambda: ["Learnt."], check=lambda: None)
    await TeachingLines(teaching, lambda: next(lines, None), said.append, after=after).run()
    number = len(before.demonstration.steps) + 1
    (told,) = [line for line in said if line.startswith(f"Step {number}: ")]
    assert "did not ask for help" in told
    assert f"again {number}" in told
    assert said.index(told) < said.index("Learnt.")
    assert "tangy learn" not in said[-1]  # Tangy has learnt from it


async def test_a_remark_on_a_step_that_was_undone_does_not_come_back(workspace: Workspace) -> None:
    teaching = session(workspace)
    until(teaching, "navigate")
    do(teaching, unasked(teaching))
    teaching.apply(Settle("later"))
    teaching.apply(Undo())
    teaching.apply(Finish())
    assert teaching.deferred() == []
