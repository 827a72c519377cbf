"""The teaching screen with ears: push-to-talk, three tiers, answers, and spoken stops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from textual.app import App

from tangy_hw.audio.meter import SoundTrouble
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.own_phrases import own_phrases
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech.hearing_notes import HearingNote
from tangy_tui.ui.dialogs.question import ChoicesDialog, QuestionDialog
from tangy_tui.ui.dialogs.remark import RemarkDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.phrases import PhrasesScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.microphone_line import MicrophoneLine
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import Run, StillClock, TangyPilot, screen_text
from tests.pilot.ears import FakeEars
from tests.support.waiting import until_shown

UNSURE = "call a joke number"


def teaching(workspace: Workspace, ears: FakeEars) -> Program:
    """Make the program with ears and the teaching screen open."""

    async def start(started: Program) -> None:
        await started.push_screen(TeachScreen(workspace, workspace.teaching("ann", 1)))

    return Program(workspace, start, clock=StillClock(), ears=ears.ears)


def line_of(pilot: TangyPilot) -> str:
    """Return the text of the microphone's line."""
    return pilot.app.screen_stack[-1].query_one(MicrophoneLine).text


def bar_of(pilot: TangyPilot) -> CommandBar:
    """Return the teaching screen's command bar."""
    return next(s for s in pilot.app.screen_stack if isinstance(s, TeachScreen)).query_one(
        CommandBar
    )


def log_of(pilot: TangyPilot) -> str:
    """Return the text of the teaching screen's log."""
    screen = next(s for s in pilot.app.screen_stack if isinstance(s, TeachScreen))
    return " ".join(screen.query_one(LogView).sentences)


def steps(workspace: Workspace) -> list[str]:
    """Return the behaviours of the last demonstration by the log."""
    shown = read_demonstrations(workspace.store, workspace.activity.name)
    return [s.behaviour for s in shown[-1].steps] if shown else []


async def test_no_microphone_line_and_talk_key_without_ears(run: Run, workspace: Workspace) -> None:
    async def start(started: Program) -> None:
        await started.push_screen(TeachScreen(workspace, workspace.teaching("ann", 1)))

    async with run(app=Program(workspace, start, clock=StillClock())) as pilot:
        assert not pilot.app.screen.query(MicrophoneLine)
        await pilot.press("escape", "t", "ctrl+t")
        assert "talk" not in screen_text(pilot.app)


async def test_t_starts_and_ends_talking(run: Run, workspace: Workspace) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        assert "t talk" in line_of(pilot)
        assert "t talk" in pilot.lines()[-1]  # the bar is idle, and shows it
        await pilot.press("t")
        assert ears.state == "listening"
        assert "listening ..." in line_of(pilot)
        await pilot.press("t")
        assert "thinking ..." in line_of(pilot)


async def test_ctrl_t_talks_in_the_command_bar(run: Run, workspace: Workspace) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        await pilot.press("colon", "t")
        await pilot.pause()
        assert bar_of(pilot).text == "t"
        assert ears.state == "off"
        assert "ctrl+t talk" in line_of(pilot)
        await pilot.press("ctrl+t")
        assert ears.state == "listening"
        assert bar_of(pilot).text == "t"


@pytest.mark.parametrize("ears", [FakeEars(hands_free=True), FakeEars(live=False)])
async def test_the_command_bar_takes_letters_in_hands_free_mode(
    run: Run, workspace: Workspace, ears: FakeEars
) -> None:
    async with run(app=teaching(workspace, ears)) as pilot:
        await pilot.press("t")
        assert bar_of(pilot).text == "t"
        await pilot.press("ctrl+t")
        assert "key is needed" in log_of(pilot)


async def test_certain_words_are_verified_and_become_a_step(run: Run, workspace: Workspace) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert "heard greet everyone" in screen_text(pilot.app)
        assert ears.asks
        await pilot.press("y")
        await pilot.pause()
        assert steps(workspace) == ["greeting"]
        assert not ears.asks


async def test_uncertain_words_offer_choices_that_are_verified(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say(UNSURE, sure=False))
        await pilot.pause()
        assert isinstance(pilot.app.screen, ChoicesDialog)
        assert "Did you mean" in screen_text(pilot.app)
        await pilot.press("y", "enter", "space")  # none of them chooses an answer
        assert isinstance(pilot.app.screen, ChoicesDialog)
        await pilot.press("1")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert steps(workspace) == []
        await pilot.press("y")
        await pilot.pause()
        assert len(steps(workspace)) == 1


@pytest.mark.slow
@pytest.mark.parametrize("key", ["n", "escape"])
async def test_rejecting_all_choices_does_nothing(run: Run, workspace: Workspace, key: str) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say(UNSURE, sure=False))
        await pilot.pause()
        await pilot.press(key)
        await pilot.pause()
        assert bar_of(pilot).text == ""
        await pilot.press("t")  # it is still a key
        assert ears.state == "listening"
        assert steps(workspace) == []


async def test_keys_typed_before_the_choices_appear_choose_nothing(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars()
    app = teaching(workspace, ears)
    app.clock = StillClock(1e9)
    async with run(app=app) as pilot:
        ears.hear(ears.say(UNSURE, sure=False))
        await pilot.pause()
        await pilot.press("1", "n", "escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ChoicesDialog)


async def test_unknown_speech_is_reported_and_leaves_the_line_empty(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say("the weather"))
        await pilot.pause()
        assert "I do not know what 'the weather' means" in log_of(pilot)
        assert bar_of(pilot).text == ""


async def test_speech_does_not_overwrite_typed_text(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        await pilot.press(*"call")
        ears.hear(ears.say("the weather"))
        await pilot.pause()
        assert bar_of(pilot).text == "call"
        assert "'the weather'" in log_of(pilot)


async def test_a_spoken_stop_acts_during_a_question(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(StopCommand("stop tangy"))
        await pilot.pause()
        assert "STOP: the simulated robot stands still" in log_of(pilot)
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        ears.hear(StopCommand("stop"))
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        assert "Heard: stop." in log_of(pilot)
        assert steps(workspace) == []
        assert pilot.app.screen.query_one(RoomView).going is None


@pytest.mark.slow
async def test_spoken_yes_and_no_work_if_switched_on(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        assert "Or say yes or no." in screen_text(pilot.app)
        ears.hear(Reply(False))
        await pilot.pause()
        assert (steps(workspace), bar_of(pilot).text) == ([], "")
        assert "Heard: no." in log_of(pilot)
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        ears.hear(Reply(True))
        await pilot.pause()
        assert steps(workspace) == ["greeting"]
        assert "Heard: yes." in log_of(pilot)


@pytest.mark.slow
async def test_a_yes_chooses_nothing_and_a_no_rejects_all_choices(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say(UNSURE, sure=False))
        await pilot.pause()
        ears.hear(Reply(True))
        await pilot.pause()
        assert isinstance(pilot.app.screen, ChoicesDialog)
        assert "say which" in log_of(pilot)
        ears.hear(Reply(False))
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)


def dialog_text(pilot: TangyPilot) -> str:
    """Return the question's text, as one line."""
    box = pilot.app.screen.query_one(".box").region
    rows = pilot.lines()[box.y : box.bottom]
    return " ".join(" ".join(row[box.x : box.right] for row in rows).split())


@pytest.mark.slow
@pytest.mark.parametrize("size", [(60, 18), (80, 24), (120, 40)])
async def test_notes_on_hearing_appear_inside_an_open_question(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears), size=size) as pilot:
        ears.hear(ears.say(UNSURE, sure=False))
        await pilot.pause()
        nothing, which = (
            "I heard something, but no yes, no or stop.",
            "Heard: yes. Please say which: its number, or N for a new command.",
        )
        ears.tell(HearingNote("no answer"))
        await pilot.pause()
        assert nothing in dialog_text(pilot)
        ears.be("speaking")
        await pilot.pause()
        assert nothing not in dialog_text(pilot)
        ears.hear(Reply(True))
        await pilot.pause()
        assert which in dialog_text(pilot)
        ears.be("listening")  # the usual state: nobody has begun to speak
        await pilot.pause()
        assert which in dialog_text(pilot)
        assert nothing in log_of(pilot)
        assert which in log_of(pilot)


async def test_the_talk_key_clears_the_last_note(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        ears.tell(HearingNote("no answer"))
        await pilot.pause()
        assert "I heard something" in dialog_text(pilot)
        await pilot.press("ctrl+t")
        await pilot.pause()
        assert ears.state == "listening"
        assert "I heard something" not in dialog_text(pilot)


@pytest.mark.slow
async def test_a_choice_lists_its_spoken_answers(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        several = ears.say(UNSURE, sure=False)
        assert several.commands is not None
        ears.hear(several)
        await pilot.pause()
        assert "Or say the number of one, or no: none of these." in dialog_text(pilot)
        ears.hear(Reply(False))
        await pilot.pause()
        ears.hear(replace(several, commands=several.commands[:1]))
        await pilot.pause()
        assert isinstance(pilot.app.screen, ChoicesDialog)
        assert "Or say yes or no." in dialog_text(pilot)
        ears.hear(Reply(True))
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)  # the question is still open
        assert steps(workspace) == []


@pytest.mark.slow
async def test_a_yes_without_a_question_does_nothing(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(Reply(True))
        await pilot.press("f1")
        ears.hear(Reply(True))
        await pilot.pause()
        assert isinstance(pilot.app.screen, HelpScreen)
        assert steps(workspace) == []


@pytest.mark.slow
async def test_spoken_commands_work_while_the_page_of_phrases_is_open(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(Say("what can i say", 1.0, None))
        await pilot.pause()
        assert isinstance(pilot.app.screen, PhrasesScreen)
        ears.hear(Say("what a lovely day", 0.1, ()))
        await pilot.pause()
        assert isinstance(pilot.app.screen, PhrasesScreen)  # that was no command
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        ears.hear(Reply(True))
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        assert steps(workspace) == ["greeting"]


@pytest.mark.slow
async def test_only_a_spoken_answer_is_reported_without_a_question(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.tell(HearingNote("no answer"))
        await pilot.pause()
        assert "no yes, no or stop" not in screen_text(pilot.app)
        ears.hear(Reply(False))
        await pilot.pause()
        assert "I heard yes or no, but there is no question." in screen_text(pilot.app)


@pytest.mark.slow
async def test_a_remark_on_a_spoken_step_is_answered_by_voice(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(Say("let it all begin", 0.2, ()))
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        ears.hear(Reply(True))
        await pilot.pause()
        assert isinstance(pilot.app.screen, RemarkDialog)
        assert "Or say yes or no." in screen_text(pilot.app)
        ears.hear(Reply(yes=False, alternative=2))  # there is only one answer
        await pilot.pause()
        assert "Please say the number of an answer, or no." in screen_text(pilot.app)
        ears.hear(Reply(True))
        await pilot.pause()
        await pilot.pause()  # the answer counts once the dialog is closed
        assert isinstance(pilot.app.screen, TeachScreen)
        kept = own_phrases(workspace.store, workspace.activity.name, "ann")
        assert kept == {"let it all begin": "greeting"}


@pytest.mark.slow
async def test_a_spoken_command_puts_off_a_remark_that_no_voice_can_answer(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(Say("let it all begin", 0.2, ()))
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
        assert isinstance(pilot.app.screen, RemarkDialog)
        assert not ears.asks  # commands are heard
        ears.hear(ears.say("call number"))
        await pilot.pause()
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert pilot.app.screen.behaviour == "call number"
        assert own_phrases(workspace.store, workspace.activity.name, "ann") == {}


@pytest.mark.slow
async def test_an_answer_begun_before_its_question_does_not_count(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.be("speaking")  # when there is no question
        await pilot.press(*"greet everyone", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        ears.hear(Reply(True))
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog) and steps(workspace) == []
        assert "before the question was on the screen" in screen_text(pilot.app)
        ears.be("listening")
        ears.hear(Reply(True))
        await pilot.pause()
        assert steps(workspace) == ["greeting"]


@pytest.mark.slow
async def test_speech_during_a_question_is_handled_next(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say("greet everyone"), ears.say("call number"))
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert pilot.app.screen.behaviour == "call number"
        await pilot.press("y")
        await pilot.pause()
        assert steps(workspace) == ["greeting", "call number"]


@pytest.mark.slow
async def test_a_recording_is_read_only_when_a_command_is_due(
    run: Run, workspace: Workspace
) -> None:
    ears = FakeEars(live=False)
    async with run(app=teaching(workspace, ears)) as pilot:
        ears.hear(ears.say("greet everyone"), ears.say("call number"))
        while not isinstance(pilot.app.screen, QuestionDialog):
            await pilot.pause(0.02)
        pulled = ears.pulled
        for _ in range(4):
            await pilot.pause(0.03)
        assert ears.pulled == pulled
        await pilot.press("y")
        while ears.pulled == pulled or not isinstance(pilot.app.screen, QuestionDialog):
            await pilot.pause(0.02)
        assert ears.pulled == pulled + 1
        ears.end()
        await pilot.press("n")
        while "over" not in line_of(pilot) if pilot.app.screen.query(MicrophoneLine) else True:
            await pilot.pause(0.02)
        assert "the recording is over" in line_of(pilot)


async def test_the_line_shows_level_words_and_problems(run: Run, workspace: Workspace) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        line = pilot.app.screen.query_one(MicrophoneLine)
        ears.be("speaking", "call a", 0.5)
        line.tick()
        assert "■■■■■■······" in line.text
        assert line.text.endswith("call a")
        ears.be("listening", trouble=SoundTrouble("no sound", 2))
        line.ticks = 0
        line.tick()
        assert "! No sound for 2 s" in line.text
        ears.be("shut")
        assert line.text.strip("○ ") == "shut while Tangy speaks"


async def test_the_line_is_drawn_only_on_changes(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        line = pilot.app.screen.query_one(MicrophoneLine)
        drawn: list[int] = []
        monkeypatch.setattr(line, "refresh", lambda *regions, **more: drawn.append(1))
        assert line.timer is not None
        assert not line.timer._active.is_set()  # no work while it is off
        ears.be("speaking", "call", 0.5)
        assert line.timer._active.is_set()
        assert len(drawn) == 1
        for words in ("call a", "call a num", "call a number"):
            ears.be("speaking", words, 0.5)
        assert len(drawn) == 1  # until the next tenth of a second
        for _ in range(10):
            line.tick()
        assert len(drawn) == 2


@pytest.mark.slow
async def test_changed_names_are_recognised_at_once(run: Run, workspace: Workspace) -> None:
    ears = FakeEars()
    async with run(app=teaching(workspace, ears)) as pilot:
        await pilot.press("colon", *"phrases", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, PhrasesScreen)
        workspace.pronounce(workspace.people[0], "Y UW Z ER, W AH N")
        before = len(ears.books)
        for worker in [one for one in pilot.app.workers if one.group == "read"]:
            await worker.wait()
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        assert len(ears.books) == before + 1
        assert ears.books[-1].pronunciations() != ears.books[before - 1].pronunciations()


@pytest.mark.slow
async def test_the_help_explains_talking_and_opens_the_phrases(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=teaching(workspace, FakeEars())) as pilot:
        await pilot.press("question_mark")
        await pilot.pause()
        assert "To talk, press" in " ".join(screen_text(pilot.app).replace("│", " ").split())
        await pilot.press("A")
        await pilot.pause()
        assert isinstance(pilot.app.screen, PhrasesScreen)


@pytest.mark.slow
async def test_the_ears_live_as_long_as_the_program(run: Run, workspace: Workspace) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=teaching(workspace, ears)) as pilot:
        await pilot.press("escape", "escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        await pilot.press("t", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        ears.hear(ears.say("greet everyone"))
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert not ears.closed
    assert ears.closed


@pytest.mark.slow
async def test_a_failing_microphone_is_reported_and_typing_still_works(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tangy_profiles.errors import TangyError

    ears = FakeEars()

    async def fail(self: FakeEars) -> None:
        raise TangyError("The microphone is in use.")

    monkeypatch.setattr(FakeEars, "__anext__", fail)
    async with run(app=teaching(workspace, ears)) as pilot:
        assert "The microphone is in use." in log_of(pilot)
        await pilot.press("colon", *"greet everyone", "enter")
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
        assert pilot.app.screen.query_one(Transcript).count == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shows", "size"),
    [
        ("words", (80, 24)),
        ("words", (120, 40)),
        ("trouble", (80, 24)),
        ("choices", (80, 24)),
        ("others", (80, 24)),
        ("no answer", (80, 24)),
    ],
    ids=["words", "words-large", "trouble", "choices", "others", "no-answer"],
)
async def test_the_microphone_line_matches_its_snapshot(
    run: Run,
    workspace: Workspace,
    size: tuple[int, int],
    shows: str,
    looks: Callable[[App[None]], None],
) -> None:
    ears = FakeEars(answers=shows == "no answer")
    async with run(app=teaching(workspace, ears), size=size) as pilot:
        line = pilot.app.screen.query_one(MicrophoneLine)
        if shows == "words":
            ears.be("speaking", "call the next", 0.6)
        elif shows == "trouble":
            ears.be("listening", trouble=SoundTrouble("no sound", 2))
        else:
            ears.hear(
                ears.say(
                    "go to user two please" if shows == "others" else UNSURE, sure=shows == "others"
                )
            )
        line.ticks = 0
        line.tick()
        await pilot.pause()
        if shows == "no answer":
            ears.tell(HearingNote("no answer"))
            await until_shown(
                pilot, lambda: screen_text(pilot.app).count("no yes, no or stop") == 2
            )
        looks(pilot.app)
