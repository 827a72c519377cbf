"""Tangy's voice on the screens: on and off, muted ears, real time, and silence after STOP."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.voice import VoicePreference
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.ui import speaking
from tangy_tui.ui.listing import listed
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.speaking import opening_lines
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import Run, StillClock, TangyPilot, screen_text
from tests.pilot.ears import FakeEars, FakeVoice
from tests.support.waiting import until_shown

SILENT = "espeak-ng is not installed; until it is, what Tangy says is shown as text."


@pytest.fixture
def voices(monkeypatch: pytest.MonkeyPatch) -> list[FakeVoice]:
    """The created voices, the newest last."""
    made: list[FakeVoice] = []

    def make_voice(
        activity: Activity,
        begin: Callable[[], None],
        end: Callable[[], None],
        tell: Callable[[str], None],
    ) -> FakeVoice:
        made.append(FakeVoice(begin, end))
        return made[-1]

    monkeypatch.setattr(speaking.Speaker.__init__, "__defaults__", (make_voice,))
    monkeypatch.setattr(speaking, "GAP", 0.0)
    return made


def teaching(workspace: Workspace, *, voice: bool = True, ears: FakeEars | None = None) -> Program:
    """Make the program with a voice and the teaching screen open."""

    async def start(started: Program) -> None:
        await started.push_screen(TeachScreen(workspace, workspace.teaching("ann", 1)))

    real = None if ears is None else ears.ears
    return Program(workspace, start, clock=StillClock(), voice=voice, ears=real)


def playing(workspace: Workspace, policy: Policy, speed: float) -> Program:
    """Make the program with a voice and the playing screen open."""

    async def start(started: Program) -> None:
        supervision = workspace.supervision(policy, 5)
        await started.push_screen(PlayScreen(workspace, supervision, speed=speed))

    return Program(workspace, start, clock=StillClock(), voice=True)


async def do(pilot: TangyPilot, words: str) -> None:
    """Type a command and confirm it."""
    await pilot.press(*words, "enter")
    await pilot.pause()
    await pilot.press("y")
    await pilot.pause()


@pytest.mark.slow
async def test_speech_of_behaviours_is_spoken_while_teaching(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    workspace.prefer_voice(workspace.people[2], VoicePreference(100, "en-gb"))
    async with run(app=teaching(workspace)) as pilot:
        await do(pilot, "greet everyone")
        assert len(voices) == 1
        assert voices[0].lines[0].startswith("Hello, everybody")
        assert voices[0].preferences == [VoicePreference()]
        voices[0].heard()
        await do(pilot, "go to user 3")
        assert voices[0].preferences[-1] == VoicePreference(100, "en-gb")
        voices[0].heard()
        await pilot.press("ctrl+z")
        await pilot.pause()
    assert voices[0].closed


@pytest.mark.slow
async def test_a_new_step_cuts_the_speech_of_the_last(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    async with run(app=teaching(workspace)) as pilot:
        await do(pilot, "greet everyone")
        await do(pilot, "call number")
        await until_shown(pilot, lambda: len(voices[0].lines) == 2)
        assert "number is" in voices[0].lines[-1]


async def test_only_the_last_of_several_quick_lines_is_spoken(
    run: Run, workspace: Workspace, voices: list[FakeVoice], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(speaking, "GAP", 0.05)
    async with run(app=teaching(workspace)) as pilot:
        assert isinstance(pilot.app, Program)
        for line in ("one", "two", "three", "four"):
            pilot.app.speaker.interject(line, VoicePreference())
        await until_shown(pilot, lambda: len(voices[0].lines) == 2)
        assert voices[0].lines == ["one", "four"]


@pytest.mark.slow
async def test_no_voice_is_created_before_it_is_switched_on(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    async with run(app=teaching(workspace, voice=False), notifications=True) as pilot:
        await do(pilot, "greet everyone")
        assert voices == []
        await pilot.press(*"voice", "enter")
        await pilot.pause()
        assert "Tangy speaks now" in screen_text(pilot.app)
        await do(pilot, "call number")
        assert len(voices[0].lines) == 1
        await pilot.press(*"voice", "enter")
        await pilot.pause()
        assert not voices[0].speaking
        await do(pilot, "call number")
        assert len(voices[0].lines) == 1


async def test_the_palette_switches_the_voice(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    async with run(app=teaching(workspace, voice=False)) as pilot:
        titles = [one.name for one in listed(pilot.app.screen)]
        assert titles.count("Voice on or off") == 1


@pytest.mark.slow
async def test_a_missing_voice_is_reported_once(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    def silent(
        activity: Activity,
        begin: Callable[[], None],
        end: Callable[[], None],
        tell: Callable[[str], None],
    ) -> FakeVoice:
        return FakeVoice(begin, end, SILENT)

    monkeypatch.setattr(speaking.Speaker.__init__, "__defaults__", (silent,))
    async with run(app=teaching(workspace), notifications=True) as pilot:
        assert screen_text(pilot.app).count("espeak-ng is not") == 1
        await do(pilot, "greet everyone")
        assert "Hello, everybody" in screen_text(pilot.app)
        assert isinstance(pilot.app, Program)
        assert not pilot.app.speaker.on


@pytest.mark.slow
async def test_the_microphone_is_muted_during_speech_and_t_ends_the_speech(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears=ears)) as pilot:
        await pilot.press("colon")
        await do(pilot, "greet everyone")
        assert ears.state == "shut"
        assert "shut while Tangy speaks" in screen_text(pilot.app)
        voices[0].heard()
        assert ears.state == "off"
        await do(pilot, "call number")
        assert ears.state == "shut"
        await pilot.press("escape", "t")
        await pilot.pause()
        assert ears.state == "listening"
        assert not voices[0].speaking


@pytest.mark.slow
async def test_tangy_does_not_speak_while_a_person_talks_to_it(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears=ears)) as pilot:
        await pilot.press("colon", "ctrl+t")
        await do(pilot, "greet everyone")
        assert voices[0].lines == []
        assert ears.state == "listening"


@pytest.mark.slow
async def test_stop_and_leaving_end_the_speech(
    run: Run, workspace: Workspace, voices: list[FakeVoice]
) -> None:
    async with run(app=teaching(workspace)) as pilot:
        await do(pilot, "greet everyone")
        assert voices[0].speaking
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert not voices[0].speaking
        await do(pilot, "call number")
        await until_shown(pilot, lambda: voices[0].speaking)
        await pilot.press("escape", "escape")
        await pilot.pause()
        assert not voices[0].speaking


async def test_a_step_in_real_time_waits_for_the_speech(
    run: Run, workspace: Workspace, policy: Policy, voices: list[FakeVoice]
) -> None:
    async with run(app=playing(workspace, policy, 1)) as pilot:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        assert voices[0].prepared == opening_lines(workspace.activity)
        assert len(voices[0].prepared) > len(workspace.activity.deck.numbers)
        steps = screen.query_one(Transcript)
        await until_shown(pilot, lambda: steps.count == 1)
        screen.nudge.set()  # the step's time is over
        for _ in range(5):
            await pilot.pause(0.01)
        assert steps.count == 1
        voices[0].heard()
        screen.nudge.set()
        await until_shown(pilot, lambda: steps.count == 2)
        assert len(voices[0].lines) == 2
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert not voices[0].speaking
        assert steps.count == 2


@pytest.mark.slow
async def test_manual_steps_and_faster_games_do_not_wait_for_speech(
    run: Run, workspace: Workspace, policy: Policy, voices: list[FakeVoice]
) -> None:
    async with run(app=playing(workspace, policy, 1)) as pilot:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        steps = screen.query_one(Transcript)
        await until_shown(pilot, lambda: steps.count == 1)
        await pilot.press("p", "full_stop")
        await until_shown(pilot, lambda: steps.count == 2)
        await pilot.press("full_stop")
        await until_shown(pilot, lambda: steps.count == 3)
        said = [s for s in screen.query_one(LogView).sentences if " did it" not in s]
        await until_shown(pilot, lambda: voices[0].lines[-1] in said[-1])
        assert voices[0].hushed >= 2


@pytest.mark.slow
async def test_skipping_to_the_end_is_silent(
    run: Run, workspace: Workspace, policy: Policy, voices: list[FakeVoice]
) -> None:
    async with run(app=playing(workspace, policy, 1)) as pilot:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until_shown(pilot, lambda: bool(voices[0].lines))
        await pilot.press("E", "y")
        await until_shown(pilot, lambda: screen.control.supervision.over)
        assert len(voices[0].lines) <= 2
        assert not voices[0].speaking


def test_prerendered_lines_name_nobody(workspace: Workspace) -> None:
    lines = opening_lines(workspace.activity)
    assert all("{" not in line and line for line in lines)
    label = workspace.activity.deck.label
    assert all(any(label(n) in line for line in lines) for n in workspace.activity.deck.numbers)


async def test_the_program_does_not_wait_for_prerendering(run: Run, workspace: Workspace) -> None:
    async with run(app=teaching(workspace, voice=False)) as pilot:
        assert isinstance(pilot.app, Program)
        pilot.app.speaker.prepare(("a", "b"))
        await asyncio.sleep(0)
        assert not pilot.app.speaker.speaking
