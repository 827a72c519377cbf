"""Recordings of teaching: stored only with consent, labelled by verified commands, deletable."""

from __future__ import annotations

import stat
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest

from tangy_hw.audio.wav import read_wav
from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.labels import Labels
from tangy_tui.learning.teaching_events import Begun, StepUndone, TeachingEvent
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Refused,
    Rejected,
    Reply,
    Say,
    StopCommand,
)
from tangy_tui.speech.recordings import (
    FOLDER,
    Recorder,
    consent,
    consented,
    forget_recordings,
)
from tangy_tui.text.hearing import consent_question

SOUND = b"\1\0" * 8000
NOON = datetime(2026, 1, 2, 12, 0, 0, tzinfo=UTC)


@pytest.fixture
def book(activity: Activity, people: tuple[Person, ...]) -> Phrasebook:
    return Phrasebook(activity, people)


@pytest.fixture
def spoken(book: Phrasebook) -> Callable[[str], Say]:
    """A text as recognised by the ears."""
    return lambda text: Say(text, 0.9, book.choices(text))


@pytest.fixture
def recorder(tmp_path: Path) -> Recorder:
    (tmp_path / "data").mkdir(exist_ok=True)
    return Recorder(tmp_path / "data", "rosa", now=lambda: NOON)


@pytest.fixture
def teaching(activity: Activity, people: tuple[Person, ...], store: Store) -> TeachingSession:
    """A session that has begun."""
    made = TeachingSession(
        activity,
        people,
        store,
        lambda shown: SimulatedWorld(
            activity, shown.people, seed=shown.seed, users=load_users().teaching()
        ),
        teacher="rosa",
        seed=1,
    )
    made.begin()
    return made


def kept(recorder: Recorder) -> list[str]:
    if not recorder.folder.exists():
        return []
    files = (file for file in recorder.folder.rglob("*") if file.is_file())
    return sorted(file.relative_to(recorder.folder).as_posix() for file in files)


class TestConsent:
    def test_consent_is_per_teacher_and_can_be_withdrawn(self, store: Store) -> None:
        assert not consented(store, "rosa")
        consent(store, "rosa", True)
        assert consented(store, "rosa")
        assert not consented(store, "ben")
        consent(store, "rosa", False)
        assert not consented(store, "rosa")

    def test_forgetting_recordings_withdraws_every_consent(self, store: Store) -> None:
        for teacher in ("rosa", "ben"):
            consent(store, teacher, True)
        forget_recordings(store)
        assert not consented(store, "rosa")
        assert not consented(store, "ben")
        consent(store, "ben", True)
        assert consented(store, "ben")

    def test_the_question_names_the_folder_and_the_command_to_delete(self, store: Store) -> None:
        question = consent_question(store.folder / FOLDER)
        assert str(store.folder / FOLDER) in question
        assert "tangy listen --forget-recordings" in question
        assert question.count("?") == 1
        there = consent_question(store.folder / FOLDER, " --data /mine")
        assert "`tangy listen --forget-recordings --data /mine` deletes" in there


class TestKeeping:
    def test_a_verified_utterance_is_stored_under_its_behaviour(
        self, recorder: Recorder, spoken: Callable[[str], Say], book: Phrasebook
    ) -> None:
        for text, behaviour, target in (
            ("call the next number", "call number", None),
            ("call number", "call number", None),
            ("go to user two", "navigate to user", "user2"),
            ("go to user", "navigate to user", "user3"),
            ("encourage the player", "encourage", "user3"),
        ):
            recorder.heard(SOUND, spoken(text))
            recorder.heard(b"", Reply(yes=True))
            recorder.verified(behaviour, target)
        assert kept(recorder) == [
            "call-number/20260102T120000-1.wav",
            "call-number/20260102T120000-2.wav",
            "encourage/20260102T120000-1.wav",
            "navigate-to-user-user2/20260102T120000-1.wav",
            "navigate-to-user/20260102T120000-1.wav",
        ]
        found = Labels(book).find(recorder.folder)
        assert [(label.behaviour, label.user) for _, label in found.recordings] == [
            ("call number", None),
            ("call number", None),
            ("encourage", None),
            ("navigate to user", None),
            ("navigate to user", "user2"),
        ]
        assert recorder.kept == 5

    def test_a_recording_is_the_heard_sound_and_private(
        self, recorder: Recorder, spoken: Callable[[str], Say]
    ) -> None:
        recorder.heard(SOUND, spoken("tell a joke"))
        recorder.verified("joke", None)
        file = recorder.folder / kept(recorder)[0]
        assert read_wav(file) == SOUND
        assert stat.S_IMODE(file.stat().st_mode) == 0o600
        for folder in (file.parent, recorder.folder):
            assert stat.S_IMODE(folder.stat().st_mode) == 0o700

    def test_a_readable_folder_is_made_private_before_recording(
        self, tmp_path: Path, spoken: Callable[[str], Say]
    ) -> None:
        there = tmp_path / "data" / FOLDER
        of_jokes = there / "joke"
        of_jokes.mkdir(parents=True)
        for folder in (there, of_jokes):
            folder.chmod(0o755)
        recorder = Recorder(tmp_path / "data", "rosa")
        assert stat.S_IMODE(there.stat().st_mode) == 0o700
        recorder.heard(SOUND, spoken("tell a joke"))
        recorder.verified("joke", None)
        assert stat.S_IMODE(of_jokes.stat().st_mode) == 0o700

    def test_an_unverified_utterance_is_not_stored(
        self, recorder: Recorder, spoken: Callable[[str], Say]
    ) -> None:
        recorder.heard(SOUND, spoken("tell a joke"))
        recorder.follow([Rejected("tell a joke")])
        recorder.verified("joke", None)
        recorder.heard(SOUND, Say("banana", 0.0, ()))
        recorder.heard(SOUND, StopCommand("stop"))
        recorder.verified("joke", None)
        assert not recorder.folder.exists()
        recorder.heard(SOUND, spoken("tell a joke"))
        recorder.heard(SOUND, spoken("call number"))  # nobody answered about the one before
        recorder.verified("call number", None)
        recorder.verified("call number", None)
        assert kept(recorder) == ["call-number/20260102T120000-1.wav"]

    def test_a_typed_command_never_labels_an_earlier_utterance(
        self, recorder: Recorder, spoken: Callable[[str], Say]
    ) -> None:
        recorder.heard(SOUND, Say("banana", 0.0, ()))
        recorder.heard(b"", Say("tell a joke"))
        recorder.verified("joke", None)
        recorder.heard(SOUND, spoken("call number"))
        recorder.verified("joke", None)  # typed, and nobody told the recorder
        recorder.heard(SOUND, spoken("tell a joke"))
        typed = Asked("joke", "joke", "joke please", 0.9, (), None)
        recorder.follow([typed])
        recorder.verified("joke", None)
        assert kept(recorder) == []

    @pytest.mark.parametrize("again", [Begun, StepUndone, NotUnderstood, Refused])
    def test_an_event_that_closes_the_question_drops_the_utterance(
        self,
        again: type,
        recorder: Recorder,
        spoken: Callable[[str], Say],
        demonstrate: Callable[[str, int, int], Demonstration],
    ) -> None:
        game = demonstrate("bingo", 1, 4)
        events: dict[type, TeachingEvent] = {
            Begun: Begun(game, resumed=False),
            StepUndone: StepUndone(1, game.steps[0]),
            NotUnderstood: NotUnderstood("banana", ()),
            Refused: Refused("nobody asks", "tell a joke"),
        }
        recorder.heard(SOUND, spoken("tell a joke"))
        recorder.follow([events[again]])
        recorder.verified("joke", None)
        assert kept(recorder) == []

    def test_a_refused_answer_keeps_the_utterance(
        self, recorder: Recorder, book: Phrasebook, teaching: TeachingSession
    ) -> None:
        commands = (*book.choices("tell a joke"), *book.choices("greet everyone"))
        for command in (
            Say("tell a greeting", 0.5, commands, sure=False),
            Reply(yes=True),  # it names no offered choice
            Reply(yes=True, alternative=7),  # this choice does not exist
            Reply(yes=True, alternative=2),
            Reply(yes=True),
        ):
            recorder.heard(SOUND, command)
            recorder.follow(teaching.apply(command))
        assert [name.partition("/")[0] for name in kept(recorder)] == ["greeting"]

    def test_a_full_disk_is_reported_once_and_teaching_continues(
        self, tmp_path: Path, spoken: Callable[[str], Say]
    ) -> None:
        told: list[str] = []
        recorder = Recorder(tmp_path / "data", "rosa")
        recorder.tell = told.append
        recorder.folder.parent.mkdir()
        recorder.folder.write_text("in the way")
        for _ in range(2):
            recorder.heard(SOUND, spoken("tell a joke"))
            recorder.verified("joke", None)
        assert len(told) == 1
        assert told[0].startswith(str(recorder.folder))
        assert recorder.kept == 0

    def test_the_recorder_follows_a_teaching_session(
        self,
        recorder: Recorder,
        spoken: Callable[[str], Say],
        teaching: TeachingSession,
    ) -> None:
        for pcm, command in (
            (SOUND, spoken("greet everyone")),
            (b"", Reply(yes=True)),
            (SOUND, spoken("tell a joke")),
            (b"", Reply(yes=False)),
            (SOUND, Say("banana", 0.0, ())),
            (b"", Say("call number")),
            (b"", Reply(yes=True)),
        ):
            recorder.heard(pcm, command)
            recorder.follow(teaching.apply(command))
        assert [name.partition("/")[0] for name in kept(recorder)] == ["greeting"]

    @pytest.mark.parametrize("link", [FOLDER, f"{FOLDER}/joke"])
    def test_nothing_is_recorded_through_a_symbolic_link(
        self, link: str, recorder: Recorder, spoken: Callable[[str], Say], tmp_path: Path
    ) -> None:
        elsewhere = tmp_path / "elsewhere"
        elsewhere.mkdir()
        place = recorder.folder.parent / link
        place.parent.mkdir(exist_ok=True)
        place.symlink_to(elsewhere)
        recorder.heard(SOUND, spoken("tell a joke"))
        recorder.verified("joke", None)
        assert (recorder.kept, list(elsewhere.iterdir())) == (0, [])
        if link == FOLDER:
            with pytest.raises(TangyError, match=r"is a symbolic link; make it a folder"):
                Recorder(recorder.folder.parent, "rosa")


class TestForgetting:
    def test_forgetting_deletes_only_recordings(
        self, store: Store, spoken: Callable[[str], Say]
    ) -> None:
        recorder = Recorder(store.folder, "rosa", now=lambda: NOON)
        for text, behaviour in (("tell a joke", "joke"), ("call number", "call number")):
            recorder.heard(SOUND, spoken(text))
            recorder.verified(behaviour, None)
        own = recorder.folder / "joke" / "mine.wav"
        own.write_bytes(b"RIFF")
        assert forget_recordings(store) == (2, 1)
        assert kept(recorder) == ["joke/mine.wav"]
        own.unlink()
        assert forget_recordings(store) == (0, 0)
        assert not recorder.folder.exists()

    def test_forgetting_follows_no_symbolic_link(self, store: Store, tmp_path: Path) -> None:
        elsewhere = tmp_path / "elsewhere" / "joke"
        elsewhere.mkdir(parents=True)
        (elsewhere / "20260102T120000-1.wav").write_bytes(b"x")
        (store.folder / FOLDER).symlink_to(elsewhere.parent)
        assert forget_recordings(store) == (0, 1)
        (store.folder / FOLDER).unlink()
        (store.folder / FOLDER).mkdir()
        (store.folder / FOLDER / "joke").symlink_to(elsewhere)
        assert forget_recordings(store) == (0, 1)
        assert list(elsewhere.iterdir())
