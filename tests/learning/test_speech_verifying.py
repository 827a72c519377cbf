"""Verifying spoken commands: offers, questions and answers; and a session by lines."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator, Callable, Iterator, Sequence

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.teaching import TeachingLines
from tangy_tui.language.commands import Command, Phrasebook
from tangy_tui.learning.own_phrases import own_phrases
from tangy_tui.learning.verification import (
    Asked,
    Offered,
    Refused,
    Rejected,
    Reply,
    Say,
    StopCommand,
    Verified,
    Verifier,
)
from tangy_tui.speech.input import Heard
from tangy_tui.text.questions import NO_QUESTION, answer_help
from tangy_tui.text.refusals import WHICH
from tangy_tui.text.remarks import OR_NO
from tangy_tui.text.teaching_commands import STOPPED
from tangy_tui.text.voice import OR_SAY_YES

ACTIVITY = load_activity("bingo")
PEOPLE = load_people(4)
BOOK = Phrasebook(ACTIVITY, PEOPLE)


def command(name: str, **arguments: str) -> Command:
    return Command(name, arguments, 0.5, "go somewhere", ())


CHOICES = (
    command("navigate to user", user="user3"),
    command("navigate to user", user="user2"),
    command("call number"),
)
UNSURE = Say("go to usher three", 0.5, CHOICES, sure=False)


@pytest.fixture
def door() -> Verifier:
    world = SimulatedWorld(ACTIVITY, [person.id for person in PEOPLE], seed=1)
    return Verifier(ACTIVITY, BOOK, world.observe, {"user3": "Rosa", "user2": "Ben"})


class TestTheDoor:
    def test_uncertain_words_are_offered_before_a_question(self, door: Verifier) -> None:
        offered = door.say(UNSURE)
        question = ACTIVITY.behaviour("navigate to user").question
        assert offered == door.question
        assert offered == Offered(
            "go to usher three",
            0.5,
            ("navigate to user", "navigate to user", "call number"),
            (f"{question} (Rosa)", f"{question} (Ben)", "call number"),
        )

    @pytest.mark.parametrize(("number", "user"), [(1, "user3"), (2, "user2"), (3, None)])
    def test_a_chosen_command_is_verified_with_its_person(
        self, door: Verifier, number: int, user: str | None
    ) -> None:
        door.say(UNSURE)
        asked = door.reply(Reply(False, number))
        assert isinstance(asked, Asked)
        assert asked.target == user
        assert len(asked.alternatives) == len(asked.others) == 2
        done = door.reply(Reply(True))
        assert isinstance(done, Verified)
        assert done.behaviour.name == CHOICES[number - 1].behaviour
        assert done.target == user
        assert door.question is None

    def test_every_question_leaves_the_other_choices_open(self, door: Verifier) -> None:
        for first in (1, 2, 3):
            for second in (1, 2):
                door.say(UNSURE)
                one = door.reply(Reply(False, first))
                assert isinstance(one, Asked)
                other = door.reply(Reply(False, second))
                assert isinstance(other, Asked)
                assert other.question == one.others[second - 1]
                assert one.question in other.others

    @pytest.mark.parametrize("reply", [Reply(True), Reply(False, 4), Reply(False, 0)])
    def test_an_answer_that_fits_no_choice_leaves_the_offer_open(
        self, door: Verifier, reply: Reply
    ) -> None:
        offered = door.say(UNSURE)
        assert isinstance(door.reply(reply), Refused)
        assert door.question == offered
        assert isinstance(door.reply(Reply(False, 3)), Asked)

    def test_rejecting_every_choice_returns_the_heard_words(self, door: Verifier) -> None:
        door.say(UNSURE)
        assert door.reply(Reply(False)) == Rejected("go to usher three")
        assert door.question is None

    def test_a_certain_command_is_verified_at_once_with_alternatives(self, door: Verifier) -> None:
        asked = door.say(Say("go to user three", 0.9, CHOICES))
        assert isinstance(asked, Asked)
        assert (asked.target, asked.alternatives) == ("user3", ("navigate to user", "call number"))
        second = door.reply(Reply(False, 1))
        assert isinstance(second, Asked)
        assert second.target == "user2"
        assert second.others[0] == asked.question

    def test_meaningless_speech_asks_no_question(self, door: Verifier) -> None:
        found = door.say(Say("call number", 0.1, ()))
        assert not isinstance(found, Asked | Offered)
        assert door.question is None

    def test_an_impossible_command_returns_the_heard_words(self, door: Verifier) -> None:
        offered = door.say(Say("mark the number", 0.5, (command("mark numbers"),), sure=False))
        assert isinstance(offered, Offered)
        refused = door.reply(Reply(False, 1))
        assert isinstance(refused, Refused)
        assert refused.heard == "go somewhere"
        assert door.question is None

    def test_help_for_an_offer_says_that_a_number_is_wanted(self, door: Verifier) -> None:
        offered = door.say(UNSURE)
        assert isinstance(offered, Offered)
        assert answer_help(offered)[0] == WHICH
        assert not any(line.strip().startswith("y") for line in answer_help(offered))


class ScriptedEars:
    """Ears with scripted utterances."""

    def __init__(self, *, live: bool, answers: bool = False) -> None:
        self.live, self.answers = live, answers
        self.tell: Callable[[str], None] = lambda sentence: None
        self.asked: list[bool] = []
        self.closed = 0
        self._coming: asyncio.Queue[Heard | Exception | None] = asyncio.Queue()

    def hear(self, *heard: Heard | Exception | None) -> None:
        for one in heard:
            self._coming.put_nowait(one)

    def asking(self, asks: bool, choices: Sequence[str] = ()) -> None:
        self.asked.append(asks)

    def follow(self, events: object) -> None:
        """Record nothing."""

    def __aiter__(self) -> AsyncIterator[Heard]:
        return self

    async def __anext__(self) -> Heard:
        heard = await self._coming.get()
        if isinstance(heard, Exception):
            raise heard
        if heard is None:
            raise StopAsyncIteration
        return heard

    async def close(self) -> None:
        self.closed += 1
        self._coming.put_nowait(None)


class BusyEars(ScriptedEars):
    """Ears whose first words arrive together with a typed line, as on a busy machine."""

    def __init__(self, *, live: bool, answers: bool) -> None:
        super().__init__(live=live, answers=answers)
        self._others = set(threading.enumerate())
        self._busy = True

    async def __anext__(self) -> Heard:
        heard = await super().__anext__()
        for reading in set(threading.enumerate()) - self._others if self._busy else ():
            reading.join()
        self._busy = False
        return heard


class Session:
    """A session by lines with a script of typed and spoken input."""

    def __init__(self, workspace: Workspace, ears: ScriptedEars) -> None:
        self.ears = ears
        self.written: list[str] = []
        self.script: list[tuple[str, str | Heard | Exception]] = []
        self.teaching = workspace.teaching("Ada", 1)
        self._typed: Iterator[str] = iter(())

    def run(self, *typed: str, scripted: bool = False) -> list[str]:
        """Type some lines; utterances that wait for a written line follow it."""
        from queue import Queue

        lines: Queue[str | None] = Queue()
        for line in typed:
            lines.put(line)
        if typed:
            lines.put(None)

        def write(line: str) -> None:
            self.written.append(line)
            while self.script and self.script[0][0] in line:
                _, then = self.script.pop(0)
                if isinstance(then, str):
                    lines.put(then)
                else:
                    self.ears.hear(then)

        session = TeachingLines(
            self.teaching,
            lines.get,
            write,
            self.ears,  # type: ignore[arg-type]
            scripted=scripted,
        )
        asyncio.run(asyncio.wait_for(session.run(), 10))
        return self.written


GREET = Say("greet everyone", 0.9, (command("greeting"),))


class TestBySpeech:
    def test_a_spoken_command_is_verified_by_key(self, workspace: Workspace) -> None:
        session = Session(workspace, ScriptedEars(live=True))
        session.script = [
            ("Now: Nobody has been", GREET),
            ("Did you say", "y"),
            ("-> greet everyone", "quit"),
        ]
        written = session.run()
        assert any("-> greet everyone" in line for line in written)
        assert session.ears.closed == 1
        assert session.ears.asked[:2] == [True, False]

    def test_a_choice_is_selected_by_its_number(self, workspace: Workspace) -> None:
        session = Session(workspace, ScriptedEars(live=True))
        offer = Say("greet the group", 0.5, (command("joke"), command("greeting")), sure=False)
        session.script = [
            ("Now: Nobody has been", offer),
            ("Did you mean", "9" * 5_000),
            (WHICH, "y"),
            (WHICH, "7"),
            ("There is no choice 7.", "2"),
            ("Did you say", "y"),
            ("-> greet everyone", "quit"),
        ]
        written = session.run()
        assert session.script == []
        assert any("-> greet everyone" in line for line in written)

    def test_a_stop_answers_an_open_question_with_no(self, workspace: Workspace) -> None:
        session = Session(workspace, ScriptedEars(live=True))
        session.script = [
            ("Now: Nobody has been", GREET),
            ("Did you say", StopCommand("stop")),
            (STOPPED, "y"),
            (NO_QUESTION, "quit"),
        ]
        assert not any("-> greet everyone" in line for line in session.run())

    @pytest.mark.parametrize("yes", [True, False])
    def test_an_answer_can_be_spoken_if_switched_on(self, workspace: Workspace, yes: bool) -> None:
        session = Session(workspace, ScriptedEars(live=True, answers=True))
        session.script = [
            ("Now: Nobody has been", GREET),
            (OR_SAY_YES, Reply(yes)),
            ("-> greet everyone" if yes else "Not done", "quit"),
        ]
        session.run()
        assert session.script == []

    @pytest.mark.parametrize("answers", [True, False])
    @pytest.mark.parametrize(
        ("said", "refused"),
        [(Reply(True), "There is no question"), (Say("number one", 0.2, ()), "I do not know")],
    )
    def test_a_remark_is_answered_by_voice_if_answers_are_switched_on(
        self, workspace: Workspace, answers: bool, said: Heard, refused: str
    ) -> None:
        session = Session(workspace, ScriptedEars(live=True, answers=answers))
        session.script = [
            ("Now: Nobody has been", Say("let it all begin", 0.2, ())),
            ("let it all begin", "greet everyone"),
            ("Did you say", "y"),
            (OR_NO, said),
            ("From now on" if answers else refused, "quit"),
        ]
        session.run()
        assert session.script == []
        kept = own_phrases(workspace.store, workspace.activity.name, "Ada")
        assert kept == ({"let it all begin": "greeting"} if answers else {})

    def test_a_yes_before_a_question_does_not_answer_it(self, workspace: Workspace) -> None:
        session = Session(workspace, BusyEars(live=True, answers=True))
        session.ears.hear(Reply(True))
        session.script = [
            ("Now: Nobody has been", "greet everyone"),
            (OR_SAY_YES, Reply(False)),
            ("Not done", "quit"),
        ]
        session.run()
        assert session.script == []

    def test_a_command_spoken_during_a_question_waits_for_the_answer(
        self, workspace: Workspace
    ) -> None:
        session = Session(workspace, ScriptedEars(live=True))
        later = Say("call number", 0.9, (command("call number"),))
        session.ears.hear(GREET, later)
        session.script = [
            ("Did you say: greet", "y"),
            ("-> greet everyone", "#"),
            ("Did you say: call", "n"),
            ("Not done", "quit"),
        ]
        session.run()
        assert session.script == []

    def test_the_keys_still_work_after_the_microphone_fails(self, workspace: Workspace) -> None:
        session = Session(workspace, ScriptedEars(live=True))
        session.ears.hear(TangyError("The cable is out."))
        session.script = [("The cable is out.", "greet everyone"), ("Did you say", "quit")]
        session.run()
        assert session.script == []

    def test_an_undecodable_recording_ends_a_script(self, workspace: Workspace) -> None:
        session = Session(workspace, ScriptedEars(live=False))
        session.ears.hear(TangyError("Speech needs the package pocketsphinx."))
        with pytest.raises(TangyError, match="pocketsphinx"):
            session.run("quit")
        assert session.ears.closed == 1

    def test_a_script_answers_a_recording(self, workspace: Workspace) -> None:
        session = Session(workspace, ScriptedEars(live=False))
        session.ears.hear(GREET, StopCommand("stop"), None)
        written = session.run("y", "where")
        assert any("-> greet everyone" in line for line in written)
        assert STOPPED in written

    @pytest.mark.parametrize("live", [True, False])
    def test_the_ears_close_with_the_session(self, workspace: Workspace, live: bool) -> None:
        session = Session(workspace, ScriptedEars(live=live))
        if not live:
            session.ears.hear(None)
        session.run("quit")
        assert session.ears.closed == 1
