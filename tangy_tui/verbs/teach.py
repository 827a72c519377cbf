"""`tangy teach`: demonstrate an activity on a screen, in the console, by script or by voice."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.learnt import NOTHING_SHOWN, coverage_so_far, situations_shown
from tangy_tui.verbs import common
from tangy_tui.verbs.hearing import (
    HandsFree,
    Listening,
    Mic,
    Mode,
    Record,
    SpokenAnswers,
    WithVoice,
)
from tangy_tui.verbs.opening import full_screen, open_workspace

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.teaching_events import Again
    from tangy_tui.learning.teaching_session import TeachingSession
    from tangy_tui.speech.input import SpeechInput


def teach(
    activity: common.ActivityName = "",
    script: Annotated[Path | None, typer.Option(help="Read the lines from a file.")] = None,
    mic: Mic = None,
    hands_free: HandsFree = False,
    spoken_answers: SpokenAnswers = False,
    mode: Mode = None,
    plain_lines: Annotated[
        bool, typer.Option("--plain", help="Use lines instead of a screen, on any terminal.")
    ] = False,
    record: Record = False,
    voice: WithVoice = False,
    teacher: Annotated[
        str | None, typer.Option(help="Who teaches; 'scripted' for the built-in teacher.")
    ] = None,
    games: common.Games = 1,
    speed: Annotated[
        float | None,
        typer.Option(min=0.1, max=1000, help="Watch the scripted teacher, at x times real speed."),
    ] = None,
    users: common.Users = common.REGISTERED,
    guided: Annotated[
        bool, typer.Option("--guided", help="A game in which every situation occurs.")
    ] = False,
    again: Annotated[
        str | None,
        typer.Option(metavar="N@STEP", help="Show demonstration N again from a step on."),
    ] = None,
    new: Annotated[bool, typer.Option("--new", help="Leave an unfinished game as it is.")] = False,
    seed: common.Seed = None,
    data: common.Data = None,
    as_json: common.Json = False,
    ascii_only: common.Ascii = False,
) -> None:
    """Demonstrate an activity to Tangy.

    Say or type what it should do, and confirm each command with Y.
    """
    from tangy_tui.app.teacher_profile import teacher_name
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.console.inputs import is_typed, keys_from_terminal, line_reader
    from tangy_tui.console.who import ask_who

    who = teacher_name(teacher, data_folder(data))
    if who == "scripted" and script is not None:
        raise TangyError("--teacher scripted gives its own lines: leave out --script.")

    listening = Listening(mic, hands_free, spoken_answers, mode, record)
    listening.check()
    sound = keys_from_terminal(script) if mic == "-" else 0  # before checking for a screen
    screen = not (plain_lines or script or as_json) and full_screen()
    if not screen:
        listening = replace(listening, hands_free=True)  # there is no key for push-to-talk
    with open_workspace(data, activity, users) as workspace:
        teaching = workspace.teaching(who, seed, guided=guided, again=_again(again))
        teaching.check()
        ears = listening.ears(workspace, teaching.phrasebook, who, sound=sound)
        if who == "scripted" and (speed is None or not full_screen()):
            _teach_by_script(workspace, teaching, games, as_json)
        elif screen:
            from tangy_tui.ui.run import run_teaching

            status = run_teaching(
                workspace, teaching, ears=ears, resume=not new, games=games, speed=speed,
                ascii_only=ascii_only, voice=voice, asks_name=teacher is None,
            )  # fmt: skip
            raise typer.Exit(status)
        else:
            new_teacher = False
            if teacher is None and is_typed(script) and not as_json:
                read = line_reader(None)
                who, new_teacher = ask_who(workspace.store.folder, read, common.print_line)
                teaching.teach_as(who)
            _teach_by_lines(
                workspace, teaching, script, ears, as_json, resume=not new, tour=new_teacher
            )


def _again(wanted: str | None) -> Again | None:
    """Parse N@STEP: a demonstration, and the first step to repeat."""
    if wanted is None:
        return None
    from tangy_tui.learning.teaching_events import Again

    demonstration, at, step = wanted.rpartition("@")
    if not at or not demonstration or not step.isdecimal() or step == "0":
        raise TangyError(plain(f"--again {wanted}: write it as N@STEP, for example 2@15."))
    return Again(demonstration, int(step) - 1)


def _teach_by_script(
    workspace: Workspace, teaching: TeachingSession, games: int, as_json: bool
) -> None:
    from tangy_tui.learning.coverage import coverage
    from tangy_tui.learning.library import read_library
    from tangy_tui.learning.scripted_teacher import ScriptedTeacher
    from tangy_tui.learning.teaching_events import Finished, Next
    from tangy_tui.text.documents import demonstration_document

    scripted = ScriptedTeacher(teaching)
    teaching.begin()
    done = []
    for number in range(games):
        if number:
            teaching.apply(Next())
        for event in scripted.demonstrate():
            if isinstance(event, Finished):
                done.append(event.demonstration)
                if not as_json:
                    library = read_library(workspace.store, workspace.activity.name)
                    found = coverage(workspace.activity, library.finished)
                    game, steps = event.demonstration.seed, len(event.demonstration.steps)
                    at = [*library.entries].index(event.demonstration.id) + 1
                    known = len(found.seen), len(found.times)
                    print(coverage_so_far(at, game, steps, *known))
    if as_json:
        common.print_json({"demonstrations": [demonstration_document(d) for d in done]})


def _teach_by_lines(
    workspace: Workspace,
    teaching: TeachingSession,
    script: Path | None,
    ears: SpeechInput | None,
    as_json: bool,
    *,
    resume: bool,
    tour: bool,
) -> None:
    from tangy_tui.app.teacher_profile import change_name
    from tangy_tui.console.after_teaching import AfterTeaching
    from tangy_tui.console.inputs import is_typed, line_reader
    from tangy_tui.console.teaching import TeachingLines
    from tangy_tui.console.typed_yes import TypedYes
    from tangy_tui.learning.policies import need_policy
    from tangy_tui.text.documents import demonstration_document
    from tangy_tui.text.teaching_commands import command_line

    folder = workspace.store.folder
    options = workspace.call_options
    who = None if teaching.teacher == workspace.teacher else teaching.teacher
    write: Callable[[str], None] = (lambda _: None) if as_json else common.print_line
    read = line_reader(script)
    asks = is_typed(script) and not (ears is not None and ears.live)  # else lines are read beside
    lines = TeachingLines(
        teaching,
        read,
        write,
        ears,
        scripted=script is not None,
        seen=lambda: _seen(workspace, teaching),
        why=lambda: _why(workspace, teaching),
        resume=command_line("teach", teacher=who, **options),
        learn=command_line("learn", **options),
        yes=TypedYes(terminal=is_typed(script), setting=workspace.settings.question),
        rename=partial(change_name, folder),
        after=AfterTeaching(
            learn=lambda: _learn(workspace, read if asks else None),
            check=lambda: need_policy(workspace.store, workspace.activity),
        ),
        tour=tour,
    )
    asyncio.run(lines.run(resume=resume))
    if as_json:
        common.print_json({"demonstrations": [demonstration_document(teaching.demonstration)]})
    elif lines.plays:
        _play(workspace, teaching.teacher)


def _learn(workspace: Workspace, read: Callable[[], str | None] | None) -> list[str]:
    """Learn from the finished demonstrations, and describe the result.

    If there is a reader of lines, the teacher is first asked about each conflict.
    """
    from tangy_tui.app.training import learn
    from tangy_tui.console.conflicts import settle_conflicts
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.follow_up import follow_up
    from tangy_tui.text.learnt import NOT_SHOWN, learnt_lines

    if read is not None:
        settle_conflicts(workspace, read, common.print_line)
    policy = learn(workspace)
    library = read_library(workspace.store, workspace.activity.name)
    steps = sum(len(shown.steps) for shown in library.finished)
    lines = learnt_lines(workspace.activity, policy, steps, 0, NOT_SHOWN)
    return [follow_up(line, **workspace.call_options) for line in lines]


def _play(workspace: Workspace, teacher: str) -> None:
    """Let Tangy run a game with the last policy, with the same input."""
    from tangy_tui.verbs.play import SPEED
    from tangy_tui.verbs.playing import play_with_staff, recall

    supervision = workspace.supervision(recall(workspace, "", quiet=False), None, asks=True)
    play_with_staff(workspace, supervision, 1, teacher, speed=SPEED)


def _seen(workspace: Workspace, teaching: TeachingSession) -> list[str]:
    """Tell which situations the finished and the present demonstrations cover."""
    from tangy_tui.learning.coverage import coverage, missing_words, standing
    from tangy_tui.learning.library import read_library

    present = standing(teaching.demonstration, teaching.remark)
    library = read_library(workspace.store, workspace.activity.name)
    shown = [d for d in library.finished if d.id != present.id]
    found = coverage(workspace.activity, [*shown, present])
    lines = [situations_shown(len(found.seen), len(found.times))]
    return lines + [f"  {words}" for words in missing_words(workspace.activity, found)]


def _why(workspace: Workspace, teaching: TeachingSession) -> list[str]:
    """Explain what Tangy would do now after the demonstrations so far."""
    from tangy_tui.learning.explanation import explain, foresee
    from tangy_tui.learning.library import read_library
    from tangy_tui.learning.policy import NothingToLearnFrom
    from tangy_tui.text.decisions import why_words

    present = teaching.demonstration
    try:
        policy = foresee(workspace.store, workspace.activity, present)
    except NothingToLearnFrom:
        return [NOTHING_SHOWN]
    library = read_library(workspace.store, workspace.activity.name)
    shown = [d for d in library.demonstrations if d.id != present.id]
    why = explain(policy, [*shown, present], teaching.world.observe().situation)
    return why_words(workspace.activity, why)
