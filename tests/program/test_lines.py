"""The program by lines: every output is a line that a screen reader can read."""

from __future__ import annotations

import asyncio
import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from subprocess import CompletedProcess
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.beliefs import Beta
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Response
from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.teaching import TeachingLines
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.interaction.game_events import BeliefUpdated
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import ForestSettings, learn_policy
from tangy_tui.learning.teaching_events import Again
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.text.coach import GUIDED, SAYABLE
from tangy_tui.text.games import belief_lines, game_lines, worked_words
from tangy_tui.text.questions import NO_QUESTION
from tangy_tui.text.remarks import WHICH_ANSWER
from tangy_tui.text.teaching_commands import GUIDED_ALREADY, command_line
from tests.support.staff_lines import play_by_turns

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]
Tangy = Callable[..., CompletedProcess[str]]


def told(
    workspace: Workspace,
    *lines: str,
    teacher: str = "Ada",
    resume: bool = True,
    again: Again | None = None,
) -> list[str]:
    """Run a session in which these lines are typed; return its output."""
    typed = iter(lines)
    said: list[str] = []
    teaching = workspace.teaching(teacher, 1, again=again)
    session = TeachingLines(teaching, lambda: next(typed, None), said.append)
    asyncio.run(session.run(resume=resume))
    return said


def test_a_session_begins_with_instructions_and_the_state(
    workspace: Workspace,
) -> None:
    said = told(workspace)
    assert said[0].startswith("Teaching Bingo. Type what Tangy should do (the first letters are ")
    assert said[1] == "A new demonstration by Ada (game 1)."
    assert "This game is not guided: type guided for one" in said[0]
    assert said[2].startswith(
        "Now: Nobody has been welcomed yet: time to greet everyone. For example: "
    )
    assert len(said) == 3, "looking in leaves nothing to go on from"


def test_a_guided_game_begins_by_a_word_and_keeps_the_other_one(workspace: Workspace) -> None:
    said = told(workspace, "greet everyone", "y", "guided", "guided", "greet everyone", "y")
    assert "Tangy keeps 1 step of this game. Teach goes on from there." in said
    assert GUIDED in said
    assert said.count(GUIDED) == 1
    assert GUIDED_ALREADY in said
    guided, plain_one = read_library(workspace.store, "bingo").demonstrations[::-1]
    assert (guided.guided, len(guided.steps)) == (True, 1)
    assert (plain_one.guided, len(plain_one.steps)) == (False, 1)


def test_the_question_names_the_behaviour_and_only_y_executes_it(workspace: Workspace) -> None:
    said = told(workspace, "greet everyone", "", "yep", "ok", "Y")
    question = "Did you say: greet everyone? Type Y to do it, or N for another command."
    assert said[3] == question
    assert said[4:6] == ["Please answer Y to do it, or N for another command."] * 2
    assert said[6] == "1. the game has not begun -> greet everyone"
    assert said[7].startswith("   Tangy says: Hello")


@pytest.mark.parametrize("yes", ["y", "Y", "yes", "Yes", " YES "])
def test_yes_in_full_is_accepted(workspace: Workspace, yes: str) -> None:
    assert "1. the game has not begun -> greet everyone" in told(workspace, "greet everyone", yes)


def test_help_at_a_question_lists_its_answers(workspace: Workspace) -> None:
    said = told(workspace, "goodbye number", "help", "n", "greet everyone", "?")
    at = said.index("Please answer Y to do it, or N for another command.")
    assert [line.partition(":")[0] for line in said[at + 1 : at + 5]] == [
        "  y", "  n", "  1 to 2", "  quit",
    ]  # fmt: skip
    assert said[-1].startswith("  quit: "), "there are no numbers where there is nothing else"
    assert said[-2].startswith("  n: ")


@pytest.mark.parametrize("answer", ["y", "N", "yes", "no"])
def test_an_answer_without_a_question_is_reported(workspace: Workspace, answer: str) -> None:
    assert told(workspace, answer)[-1] == "There is no question open: give a command."


@pytest.mark.parametrize(
    "words", ["stop the robot", "Emergency stop!", "make it stop", "stop the bingo game"]
)
def test_a_typed_stop_answers_an_open_question_with_no(workspace: Workspace, words: str) -> None:
    stands = "STOP: the simulated robot stands still until your next command."
    assert told(workspace, words)[-1] == stands
    said = told(workspace, "greet everyone", words, "y")
    assert said[-2:] == [stands, "There is no question open: give a command."]
    assert not any(line.startswith("1. ") for line in said)


@pytest.mark.parametrize("words", ["stop teasing her", "stop the music", "don't stop"])
def test_a_mention_of_stopping_is_an_ordinary_command(workspace: Workspace, words: str) -> None:
    assert not any(line.startswith("STOP") for line in told(workspace, words))


@pytest.mark.parametrize("words", ["again", "Again", "again from step", "again N"])
def test_again_needs_a_step(workspace: Workspace, words: str) -> None:
    assert told(workspace, words)[-1] == "Say which step: `again 5` goes back to before step 5."


def test_a_yes_to_a_remark_with_several_answers_lists_them(workspace: Workspace) -> None:
    told(workspace, "greet everyone", "y", "call number", "y", teacher="Bea")
    said = told(workspace, "greet everyone", "y", "tell a joke", "y", "yes")
    at = said.index(WHICH_ANSWER)
    assert said[at + 1].startswith("     1  ") and said[at + 4].startswith("     4  ")
    assert NO_QUESTION not in said


def test_n_returns_the_words(workspace: Workspace) -> None:
    for no in ("n", "N", "no", "No"):
        said = told(workspace, "greet everyone", no)
        assert "Not done: greet everyone. Give a new command." in said
        assert not any(line.startswith("1. ") for line in said)


def test_alternatives_are_chosen_by_number_and_verified(workspace: Workspace) -> None:
    said = told(workspace, "goodbye number", "9", "2", "1")
    asked = [line.partition("?")[0] for line in said if line.startswith("Did you say: ")]
    goodbye, call = "Did you say: say goodbye", "Did you say: call number"
    assert asked == [goodbye, call, goodbye], "nothing is executed unasked"
    assert said[4].startswith("  you typed 'goodbye number', ")
    assert said[4].endswith("% sure")
    assert said[5:8] == [
        "  1 instead: ask to mark numbers", "  2 instead: call number", "There is no choice 9.",
    ]  # fmt: skip
    assert said[10] == "  1 instead: say goodbye"


def test_undo_where_help_and_quit_are_understood(workspace: Workspace) -> None:
    typed = ("undo", "greet everyone", "y", "where", "help", "undo", "quit", "tell a joke")
    said = told(workspace, *typed)
    assert "There is no step to undo." in said
    assert "Step 1 is undone: greet everyone." in said
    assert said.count("Now: a number is due. Tangy is at the front. "
                      "Nobody asks for help.") == 1  # fmt: skip
    now = "Now: Nobody asks for help: time for the next number. For example: "
    assert sum(line.startswith(now) for line in said) == 1
    for behaviour in workspace.activity.behaviours.values():
        assert f"  {behaviour.question}: say {behaviour.phrases[0]!r}" in said
    assert not any("joke?" in line for line in said), "after quit nothing is read"


def test_an_unfinished_session_is_resumed(workspace: Workspace) -> None:
    said = told(workspace, "greet everyone", "y", "next number", "y", "quit")
    assert said[-1] == (
        "You left after 2 steps. What you confirmed is kept. Go on from here with `tangy teach`."
    )
    assert told(workspace)[1] == "Going on with Ada's demonstration of 2 steps (game 1)."
    assert told(workspace, resume=False)[1].startswith("A new demonstration by Ada")


def test_only_logged_steps_are_reported_as_kept(workspace: Workspace) -> None:
    told(workspace, "greet everyone", "y", "next number", "y", "quit")
    kept = told(workspace, "quit")
    assert kept[-1].startswith("You left after 2 steps.")
    first = next(workspace.store.events()).body["demonstration"]
    left = told(workspace, "quit", teacher="Bea", again=Again(first, 1))
    assert left[-1] == "You confirmed nothing, so nothing has changed."
    assert told(workspace, "quit", teacher="Bea")[1].startswith("A new demonstration by Bea")
    gone_on = told(workspace, "next number", "y", "quit", teacher="Bea", again=Again(first, 1))
    assert gone_on[-1].startswith("You left after 2 steps.")


def test_missing_situations_have_a_heading(workspace: Workspace) -> None:
    def seen(*lines: str) -> list[str]:
        said: list[str] = []
        typed = iter(["seen"])
        session = TeachingLines(
            workspace.teaching("Ada", 1),
            lambda: next(typed, None),
            said.append,
            seen=lambda: list(lines),
        )
        asyncio.run(session.run())
        return said[3:]

    assert seen("1 of 2 was shown.", "  that") == [
        "1 of 2 was shown.", "Not shown to Tangy yet:", "  that",
    ]  # fmt: skip
    assert seen("2 of 2 were shown.") == ["2 of 2 were shown."]


def test_the_command_to_resume_names_unusual_options() -> None:
    assert command_line("teach", teacher=None, data=None) == "tangy teach"
    said = command_line("teach", teacher="Ada Lovelace", data="some where")
    assert said == "tangy teach --teacher 'Ada Lovelace' --data 'some where'"
    assert command_line("learn", data="ab").isprintable()


def test_the_printed_command_resumes_the_session(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("USER", "me")
    at = ("--data", tmp_path / "d")
    for who, name in ((("--teacher", "Ada Lovelace"), " --teacher 'Ada Lovelace'"), ((), "")):
        left = tangy("teach", "--plain", *who, *at, stdin="greet everyone\ny\nquit\n").stdout
        command = f"tangy teach{name} --data {tmp_path / 'd'}"
        assert left.endswith(f"is kept. Go on from here with `{command}`.\n")
        again = tangy(*shlex.split(command)[1:], stdin="quit\n").stdout
        assert "Going on with " in again


def test_unknown_words_are_returned_with_suggestions(
    workspace: Workspace,
) -> None:
    said = told(workspace, "qwertz \x1b[2J")
    assert said[3].startswith("I do not know what ")
    assert said[3].isprintable()
    near = told(workspace, "sing and call")
    assert any("You can say" in line or "Did you say" in line for line in near[3:])


def test_a_whole_game_can_be_taught_by_lines_before_the_next(workspace: Workspace) -> None:
    teaching = workspace.teaching("Ada", 1)
    said: list[str] = []
    answers: list[str] = []

    def read() -> str | None:
        if answers:
            return answers.pop()
        if teaching.demonstration.finished:
            answers.extend(["quit", "where", "next", "tell a joke"])
            return answers.pop()
        if teaching.question is not None:
            return "y"
        expected = workspace.activity.expected[teaching.world.observe().situation]
        return workspace.activity.behaviours[expected].phrases[0]

    session = TeachingLines(
        teaching,
        read,
        said.append,
        seen=lambda: ["9 of 11 situations were shown.", "  the rest"],
        learn="tangy learn --data d",
    )
    asyncio.run(session.run())
    over = next(line for line in said if line.startswith("The game is complete: "))
    assert over.endswith(" steps.")
    after = said[said.index(over) + 1 :]
    assert after[:2] == [
        "9 of 11 situations were shown.",
        "Type next for another game, learn to let Tangy learn from this one, play to see Tangy "
        "run a game, or quit.",
    ]
    assert after[2].startswith("This game is over.")
    assert after[3] == "A new demonstration by Ada (game 2)."
    assert after[-1] == "Let Tangy learn from it with `tangy learn --data d`."
    assert not any(line.startswith("You left after") for line in after)


@pytest.mark.parametrize("terminal", [True, False], ids=["terminal", "pipe"])
def test_an_empty_line_lists_the_possible_commands(workspace: Workspace, terminal: bool) -> None:
    typed, said = iter(["\n", "quit"]), list[str]()
    teaching = workspace.teaching("Ada", 1)
    yes = TypedYes(terminal=terminal, setting="y", flush=lambda: None)
    session = TeachingLines(teaching, lambda: next(typed, None), said.append, yes=yes)
    asyncio.run(session.run())
    assert teaching.sayable and all(phrase in said[-1] for phrase in teaching.sayable)


def test_an_empty_line_of_a_script_prints_nothing(workspace: Workspace) -> None:
    typed, said = iter(["\n", "\n", "quit"]), list[str]()
    teaching = workspace.teaching("Ada", 1)
    session = TeachingLines(teaching, lambda: next(typed, None), said.append, scripted=True)
    asyncio.run(session.run())
    assert not any(SAYABLE in line for line in said)


def test_learn_and_play_work_by_lines(tangy: Tangy) -> None:
    whole = tangy("teach", "--teacher", "scripted", "--seed", "1")
    assert whole.returncode == 0
    session = tangy("teach", "--plain", "--teacher", "Ada", stdin="play\nlearn\nplay\nend\ny\n")
    assert session.returncode in (0, 1)
    said = session.stdout
    assert said.index("tangy learn") < said.index("Learnt 'bingo-1'") < said.index("Game 1 begins")


@pytest.mark.slow
@given(st.lists(st.text(max_size=20) | st.sampled_from(["y", "n", "1", "undo", "next number"])))
def test_any_input_is_answered_in_printable_lines(lines: list[str]) -> None:
    with TemporaryDirectory() as folder:
        workspace = Workspace(Path(folder))
        with workspace.store.transaction():
            said = told(workspace, *lines)
        workspace.close()
    assert all(line.isprintable() for line in said)


def test_games_are_printed_step_by_step_with_responses_and_posteriors(
    workspace: Workspace, cover: Cover
) -> None:
    policy = learn_policy(
        workspace.activity, cover("bingo", 1, 4), settings=ForestSettings(trees=5)
    )
    supervision = workspace.supervision(policy, 3)
    said = play_by_turns(supervision, games=3, name=workspace.name, scripted=True)
    assert said[0] == "Game 1 begins."
    assert said[1] == "1. Greet everyone, because the game has not begun."
    assert sum(line.startswith("The game is over after ") for line in said) == 3
    late = " did what Tangy asked, but too late to count. "
    learnt = [line for line in said if " did it. " in line or late in line]
    assert any(late in line for line in learnt)
    assert any(" Best so far: " in line for line in learnt)
    assert said[-4:] == belief_lines(supervision, workspace.name)
    assert [line.partition(":")[0] for line in said[-4:]] == [f"User {n}" for n in range(1, 5)]
    assert all(line.isprintable() for line in said)


def test_responses_of_people_are_worded_kindly(workspace: Workspace, cover: Cover) -> None:
    policy = learn_policy(
        workspace.activity, cover("bingo", 1, 4), settings=ForestSettings(trees=5)
    )
    supervision = workspace.supervision(policy, 3)

    def line(*, followed: bool, complied: bool) -> str:
        response = Response("user2", "praise", followed, complied, 12.0)
        return game_lines(BeliefUpdated(response, Beta(2, 3)), supervision, workspace.name)[0]

    assert line(followed=True, complied=True).startswith("   User 2 did it. With praise it ")
    late = "   User 2 did what Tangy asked, but too late to count. With praise it "
    assert line(followed=True, complied=False).startswith(late)
    never = "   User 2 would rather not just now. With praise it "
    assert line(followed=False, complied=False).startswith(never)
    assert worked_words("scarcity", Beta(2, 1)) == "Tangy asked with scarcity for the first time."
    assert worked_words("praise", Beta(8, 3)) == "With praise it has worked 7 of 9 times so far."


def test_a_stopped_game_gives_its_reason(workspace: Workspace, cover: Cover) -> None:
    shown = [demonstration.without_last() for demonstration in cover("bingo", 1, 4)]
    policy = learn_policy(workspace.activity, shown, settings=ForestSettings(trees=5))
    said = play_by_turns(workspace.supervision(policy, 3), scripted=True)
    stopped = next(line for line in said if line.startswith("The game stopped"))
    assert "Nobody has shown Tangy what to do here yet: somebody has won." in stopped


def asked(workspace: Workspace, *lines: str, knows: bool = True) -> list[str]:
    """Play a game by a policy without its first situation; return the output."""
    teaching = workspace.teaching("Ada", 1)
    teaching.begin(resume=False)
    for phrase in ("greet everyone", "next number"):
        teaching.apply(Say(phrase))
        teaching.apply(Reply(yes=True))
    present = teaching.demonstration
    shown = [replace(present, steps=present.steps[1:])]
    policy = learn_policy(workspace.activity, shown, settings=ForestSettings(trees=5))
    said = play_by_turns(
        workspace.supervision(policy, 3, asks=True),
        *lines,
        name=workspace.name,
        teacher="Cleo",
        demonstrations=(lambda: shown) if knows else None,
    )
    assert said[1].startswith("Tangy asks. Nobody has shown Tangy what to do here yet: the game")
    stopped = next(n for n, line in enumerate(said) if line.startswith("The game stopped"))
    return said[2:stopped]


def test_a_typed_stop_at_a_question_executes_nothing(
    workspace: Workspace,
) -> None:
    stands = "STOP: Tangy stands still. Type: go on."
    assert asked(workspace, "stop the robot") == [stands]
    *_, said, last = asked(workspace, "greet everyone", "stop the bingo", "y")
    assert (said, last) == (stands, "There is no question open: give a command.")


def test_why_and_where_work_at_a_question(workspace: Workspace) -> None:
    unknown = "Nobody has shown Tangy what to do here yet: the game has not begun."
    why, details, *others = asked(workspace, "why", "Where")
    assert why == f"Tangy waits for your answer. {unknown}"
    assert details == "How Tangy decides:"
    assert "  Situation: the game has not begun." in others
    assert "  Nobody has shown Tangy what to do here. It asks instead of acting." in others
    assert "  How sure Tangy is: call number 100%." in others
    assert (
        others[-1]
        == "Now: the game has not begun. Tangy is at the front. Nobody asks for help. (asking)"
    )


def test_why_without_demonstrations_prints_the_votes(workspace: Workspace) -> None:
    unknown = "Nobody has shown Tangy what to do here yet: the game has not begun."
    assert asked(workspace, "why", knows=False) == [
        f"Tangy waits for your answer. {unknown}",
        "How Tangy decides:",
        f"  {unknown}",
        "  How sure Tangy is: call number 100%.",
    ]


def test_help_at_a_question_explains_every_word(workspace: Workspace) -> None:
    answer = "Say in words what Tangy should do, or type: where, why, help, end."
    said = asked(workspace, "help")
    assert said[0] == answer
    for behaviour in workspace.activity.behaviours.values():
        assert f"  {behaviour.question}: say {behaviour.phrases[0]!r}" in said
    assert "  where, why: says what Tangy sees; what it does now, why, and who waits" in said
    assert asked(workspace, "qwertz")[-1] == answer
    assert asked(workspace, "yes") == ["There is no question open: give a command."]


@pytest.mark.parametrize("word", ["undo", "redo"])
def test_undo_is_refused_at_a_question(workspace: Workspace, word: str) -> None:
    assert asked(workspace, word) == [f"You cannot {word} in a game."]


def test_the_verification_of_an_answer_accepts_yes_in_full(workspace: Workspace) -> None:
    said = asked(workspace, "greet everyone", "perhaps", "help", "YES", "quit")
    assert said[0].startswith("Did you say: greet everyone?")
    assert said[1] == said[2] == "Please answer Y to do it, or N for another command."
    assert said[3].startswith("  y: ")
    assert "1. Greet everyone, as Cleo said." in said, "not by votes for another"
    left = asked(workspace, "greet everyone", "quit", "greet everyone", "y")
    assert left[1:] == ["You ended the game. Tangy stands still."], "after quit nothing is read"


def test_a_session_by_lines_is_logged(workspace: Workspace) -> None:
    told(workspace, "greet everyone", "y")
    workspace.close()
    with Store.open(workspace.store.folder, write=False) as store:
        assert [e.kind for e in store.events()] == ["demonstration begun", "demonstration step"]
