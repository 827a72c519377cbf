"""Practice recordings: labelled by their names, counted, and reported in 80 columns."""

from __future__ import annotations

import wave
from pathlib import Path

import pytest

from tangy_hw.audio.wav import RATE
from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.labels import STOP, Labels, UtteranceLabel
from tangy_tui.speech.evidence import (
    USUAL,
    AcousticEvidence,
    DecoderVocabulary,
    EvidenceSettings,
    Expecting,
)
from tangy_tui.speech.practice import Practice, practise
from tangy_tui.speech.recogniser import SpeechUnavailable
from tangy_tui.text.practice import practice_lines

BROKEN = "broken"


@pytest.fixture
def book(activity: Activity, people: tuple[Person, ...]) -> Phrasebook:
    return Phrasebook(activity, people)


def write(file: Path, number: int = 0) -> Path:
    """Write a WAV whose first sample is a number that identifies it to the recogniser below."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with wave.open(str(file), "wb") as out:
        out.setparams((1, 2, RATE, 0, "NONE", ""))
        out.writeframes(number.to_bytes(2, "little") + bytes(RATE))
    return file


class Hears:
    """A recogniser with a given text for each recording."""

    pid = None

    def __init__(self, words: dict[int, str]) -> None:
        self.words = words
        self.settings: list[EvidenceSettings] = []

    async def start(self, wanted: DecoderVocabulary) -> None:
        self.settings.append(wanted.settings)

    async def decode(self, pcm: bytes, expecting: Expecting = "commands") -> AcousticEvidence:
        words = self.words[int.from_bytes(pcm[:2], "little")]
        if words == BROKEN:
            raise SpeechUnavailable("It died twice.")
        return AcousticEvidence(words, words, 0.5, 1.0, len(pcm) / 2 / RATE)


async def heard(folder: Path, book: Phrasebook, said: dict[str, str]) -> Practice:
    """Practise on recordings by name, with the heard words of each."""
    for number, name in enumerate(said, 1):
        write(folder / name, number)
    hears = Hears(dict(enumerate(said.values(), 1)))
    return await practise(Labels(book).find(folder), book, USUAL, hears)


class TestNames:
    @pytest.mark.parametrize(
        ("name", "said"),
        [
            ("call_number.wav", UtteranceLabel("call number")),
            ("CALL-NUMBER 2.wav", UtteranceLabel("call number")),
            ("Call.Number.rms.003.WAV", UtteranceLabel("call number")),
            ("tell a joke-slt.wav", UtteranceLabel("joke")),
            ("celebrate the winner_kal.wav", UtteranceLabel("celebrate")),
            ("navigate to user-slt.wav", UtteranceLabel("navigate to user")),
            ("navigate_to_user-user2-003.wav", UtteranceLabel("navigate to user", "user2")),
            ("navigate_to_user-003.wav", UtteranceLabel("navigate to user")),
            ("navigate_to_user_2.wav", UtteranceLabel("navigate to user", "user2")),
            ("go to user two-rms-001.wav", UtteranceLabel("navigate to user", "user2")),
            ("navigate_to_user-slt-user3.wav", UtteranceLabel("navigate to user", "user3")),
            ("encourage-user3.wav", UtteranceLabel("encourage")),
            ("stop.wav", UtteranceLabel(STOP)),
            ("stop_now-4.wav", UtteranceLabel(STOP)),
            ("slt/stop.wav", UtteranceLabel(STOP)),
            ("call number/007.wav", UtteranceLabel("call number")),
            ("call number/joke.wav", UtteranceLabel("call number")),
            (
                "navigate-to-user-user2/20260101T101112-1.wav",
                UtteranceLabel("navigate to user", "user2"),
            ),
            ("navigate_to_user/user4-1.wav", UtteranceLabel("navigate to user", "user4")),
            ("navigate_to_user/2.wav", UtteranceLabel("navigate to user")),
            ("call_number/slt/003.wav", UtteranceLabel("call number")),
            ("none/call number.wav", UtteranceLabel(None)),
            ("other speech/7.wav", UtteranceLabel(None)),
            ("far_1/tea.wav", UtteranceLabel(None)),
            ("noise-03.wav", UtteranceLabel(None)),
            ("speech test/call number.wav", UtteranceLabel("call number")),
            ("call nmber.wav", UtteranceLabel(None, named=False)),
            ("017.wav", UtteranceLabel(None, named=False)),
        ],
    )
    def test_the_file_name_gives_the_command(
        self, name: str, said: UtteranceLabel, book: Phrasebook, tmp_path: Path
    ) -> None:
        assert Labels(book).of(tmp_path / name, tmp_path) == said

    def test_the_top_folder_may_name_a_command_but_not_noise(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        labels = Labels(book)
        for folder, name, said in (
            ("joke", "1.wav", UtteranceLabel("joke")),
            ("speech", "call number.wav", UtteranceLabel("call number")),
            ("noise", "1.wav", UtteranceLabel(None, named=False)),
        ):
            assert labels.of(tmp_path / folder / name, tmp_path / folder) == said

    def test_file_names_use_the_phrases_of_the_activity(
        self, lanterns: Activity, people: tuple[Person, ...], tmp_path: Path
    ) -> None:
        labels = Labels(Phrasebook(lanterns, people))
        for behaviour in lanterns.behaviours.values():
            for phrase in (behaviour.name, *behaviour.phrases):
                file = tmp_path / f"{phrase.upper().replace(' ', '_')}-rms-001.wav"
                assert labels.of(file, tmp_path).behaviour == behaviour.name


class TestFolders:
    def test_recordings_are_found_at_any_depth_and_other_files_reported(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        there = write(tmp_path / "a" / "b" / "joke.wav")
        write(tmp_path / ".hidden" / "joke.wav")
        (tmp_path / "again.wav").symlink_to(there)
        (tmp_path / "loop").symlink_to(tmp_path)
        (tmp_path / "notes.txt").write_text("x")
        found = Labels(book).find(tmp_path)
        assert found.recordings == ((Path("a/b/joke.wav"), UtteranceLabel("joke")),)
        assert {str(file): why for file, why in found.left_out} == {
            "again.wav": "is a symbolic link",
            "loop": "is a symbolic link",
            "notes.txt": "is not a WAV file",
        }

    def test_folders_without_recordings_are_refused(self, book: Phrasebook, tmp_path: Path) -> None:
        with pytest.raises(TangyError, match="there are no WAV files"):
            Labels(book).find(tmp_path)
        write(tmp_path / "foo" / "1.wav")
        with pytest.raises(TangyError, match=r"its one recording, foo/1.wav, is not named by what"):
            Labels(book).find(tmp_path)
        write(tmp_path / "foo" / "2.wav")
        with pytest.raises(TangyError, match=r"none of its 2 recordings \(foo/1.wav, ...\) is"):
            Labels(book).find(tmp_path)
        with pytest.raises(TangyError, match="there is no such folder"):
            Labels(book).find(tmp_path / "none")
        with pytest.raises(TangyError, match="is a file; give the folder in which it lies"):
            Labels(book).find(write(tmp_path / "joke.wav"))


class TestCounting:
    SAID = {  # noqa: RUF012
        "call number/1.wav": "call the next number",
        "call number/2.wav": "tell a joke",
        "call number/3.wav": "banana",
        "call number/4.wav": "stop",
        "joke.wav": "tell a joke",
        "navigate_to_user-user2.wav": "go to user two",
        "navigate_to_user-user3.wav": "go to user two",
        "navigate_to_user.wav": "go to user two",
        "stop.wav": "stop",
        "none/1.wav": "i would like a cup of tea",
        "none/2.wav": "tell a joke",
        "none/3.wav": "stop",
        "jke.wav": "tell a joke",
    }

    async def test_every_outcome_is_counted(self, book: Phrasebook, tmp_path: Path) -> None:
        document = (await heard(tmp_path, book, self.SAID)).document()
        assert document["files"] == 12
        assert document["intents"]["call number"] == {
            "said": 4, "right": 1, "offered": 0, "wrong": 2, "nothing": 1
        }  # fmt: skip
        assert document["intents"]["navigate to user user3"]["wrong"] == 1
        assert document["intents"]["navigate to user user2"]["right"] == 1
        assert document["intents"]["navigate to user"]["right"] == 1
        assert document["accuracy"] == round(5 / 9, 4)
        assert document["wrong"] == round(3 / 9, 4)
        assert document["false_accepts"] == {"sure": 2, "offered": 0, "of": 3}
        assert document["confusion"]["call number"] == {
            "call number": 1, "joke": 1, "nothing": 1, "stop": 1
        }  # fmt: skip
        assert document["confusion"]["no command"] == {"joke": 1, "nothing": 1, "stop": 1}
        assert sum(sum(row.values()) for row in document["confusion"].values()) == 12
        assert len(document["rows"]) == 12

    async def test_an_uncertain_command_counts_as_offered_or_wrong(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        unsure = "a joke for the group"
        practice = await heard(
            tmp_path, book, {"joke.wav": unsure, "celebrate.wav": unsure, "none.wav": unsure}
        )
        assert {row.tier for row in practice.rows} == {"unsure"}
        by_file = {row.file: row.outcome for row in practice.rows}
        assert by_file["joke.wav"] == "offered"
        assert by_file["celebrate.wav"] == "wrong"
        assert practice.false_accepts() == (0, 1)
        assert practice.share("right", "offered") == 0.5

    async def test_unreadable_recordings_are_reported_and_skipped(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        (tmp_path / "celebrate.wav").write_bytes(b"no sound at all")
        practice = await heard(tmp_path, book, {"joke-1.wav": "tell a joke", "joke-2.wav": BROKEN})
        assert [row.file for row in practice.rows] == ["joke-1.wav"]
        assert dict(practice.left_out) == {
            "celebrate.wav": "is not a WAV file", "joke-2.wav": "could not be decoded"
        }  # fmt: skip

    async def test_truncated_recordings_are_decoded_and_reported(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        cut = write(tmp_path / "joke-2.wav", 1)
        cut.write_bytes(cut.read_bytes()[:-1_000])
        practice = await heard(tmp_path, book, {"joke-1.wav": "tell a joke"})
        assert [row.outcome for row in practice.rows] == ["right", "right"]
        assert practice.document()["cut_off"] == ["joke-2.wav"]
        assert practice_lines(practice)[-1] == "  joke-2.wav"

    async def test_wrongly_named_recordings_are_excluded_from_the_figures(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        said = {"foo/1.wav": "tell a joke", "foo/2.wav": "stop", "jkoe/1.wav": "tell a joke"}
        practice = await heard(tmp_path, book, {**said, "joke.wav": "tell a joke"})
        document = practice.document()
        assert (document["files"], document["accuracy"]) == (1, 1.0)
        assert document["false_accepts"] == {"sure": 0, "offered": 0, "of": 0}
        assert document["unnamed"] == ["foo/1.wav", "foo/2.wav", "jkoe/1.wav"]
        lines = practice_lines(practice)
        assert lines[0] == "1 recording: 1 of a command, 0 of none."
        assert not any("no command" in line.casefold() for line in lines)
        told = "3 recordings were left out: their names are no intent, and not none:"
        assert lines[lines.index(told) + 1 :] == [f"  {name}" for name in said]
        one = practice_lines(await heard(tmp_path / "set", book, self.SAID))
        assert "1 recording was left out: its name is no intent, and not none:" in one

    async def test_recordings_without_commands_have_no_accuracy(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        practice = await heard(tmp_path, book, {"noise.wav": ""})
        document = practice.document()
        assert (document["accuracy"], document["intents"]) == (None, {})
        assert practice_lines(practice)[0] == "1 recording: 0 of a command, 1 of none."


class TestReport:
    async def test_the_report_fits_into_80_columns(self, book: Phrasebook, tmp_path: Path) -> None:
        said = {}
        for number, phrase in enumerate(book.spoken()):
            said[f"{'x' * 60}/{phrase}-{number:03}.wav"] = phrase
            said[f"\x1b[2J{'y' * 90}{number:03}.wav"] = phrase
        lines = practice_lines(await heard(tmp_path, book, said))
        assert max(map(len, lines)) <= 80
        assert not any("\x1b" in line for line in lines)
        assert "  and " in lines[-1]

    async def test_a_wide_matrix_continues_below_without_empty_rows(
        self, book: Phrasebook, activity: Activity, tmp_path: Path
    ) -> None:
        said = {f"{b.name}/1.wav": b.phrases[0] for b in activity.behaviours.values()}
        said |= {f"navigate_to_user-user{n}.wav": f"go to user {n}" for n in range(1, 5)}
        said |= {"stop.wav": "stop", "none.wav": "i would like a cup of tea"}
        lines = practice_lines(await heard(tmp_path, book, said))
        below = lines[lines.index("The same, further to the right:") + 1 :]
        assert [line.split() for line in below] == [["-"], ["no", "command", "1"]]
        first = lines[: -len(below) - 1]
        assert sum(line[4:].startswith("no command ") for line in first) == 1

    async def test_every_column_of_the_matrix_is_explained(
        self, book: Phrasebook, tmp_path: Path
    ) -> None:
        practice = await heard(tmp_path, book, {"joke.wav": "call number", "none.wav": ""})
        lines = practice_lines(practice)
        assert any(line.split()[:1] == ["a"] and "call number" in line for line in lines)
        assert any(line.strip().startswith("joke") for line in lines)
