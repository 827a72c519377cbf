"""`tangy people pronounce` and `voice`, `tangy activity phrases` and `hear`."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.store import Store
from tangy_profiles.voice import VoicePreference
from tangy_tui.app import aloud
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.verification import Asked
from tangy_tui.learning.verification import Say as Words

Tangy = Callable[..., CompletedProcess[str]]

LANTERNS = Path(__file__).parent.parent / "lanterns.toml"


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A data folder with the people Rosa and Xanthippus."""
    with Store.open(tmp_path / "mine") as store:
        store.rename("user1", "Rosa")
        store.rename("user2", "Xanthippus Lee")
    return tmp_path / "mine"


@pytest.fixture
def spoken(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, VoicePreference | None]]:
    """The spoken lines, and the voice settings of each."""
    said: list[tuple[str, VoicePreference | None]] = []

    async def hear(
        phones: str, preference: VoicePreference | None = None, sink: str = "auto"
    ) -> None:
        said.append((phones, preference))

    monkeypatch.setattr(aloud, "hear", hear)
    return said


class TestNames:
    def test_a_name_in_the_dictionary_is_recognised_at_once(self, tangy: Tangy, data: Path) -> None:
        done = tangy("people", "pronounce", "Rosa", "--data", data)
        assert done.stdout == "Rosa is said R OW Z AH, as in the dictionary.\n"

    @pytest.mark.slow
    def test_a_new_pronunciation_is_accepted_played_or_changed(
        self, tangy: Tangy, data: Path, spoken: list[tuple[str, VoicePreference | None]]
    ) -> None:
        shown = tangy("people", "rename", "user3", "Xanthippus", "--data", data).stdout
        assert "user3 is now called Xanthippus." in shown
        assert "can be typed, but not yet heard" in shown
        accept = f"tangy people pronounce user3 --data {data} --accept"
        assert accept in shown
        assert shown.count(f"tangy people pronounce user3 --data {data} ") == 3
        asked = ("people", "pronounce", "user3")
        suggested = json.loads(tangy(*asked, "--json", "--data", data).stdout)
        assert (suggested["source"], suggested["heard"]) == ("suggested", False)
        assert tangy(*asked, "--hear", "--data", data).returncode == 0
        assert spoken == [(suggested["pronunciation"], VoicePreference())]
        assert accept in tangy(*asked, "--data", data).stdout
        taken = json.loads(tangy(*accept.split()[1:], "--json").stdout)
        assert taken["pronunciation"] == suggested["pronunciation"]
        assert (taken["source"], taken["heard"]) == ("person", True)
        changed = tangy(*asked, "z AE1 n", "--data", data)
        assert changed.stdout == "Xanthippus is said Z AE N.\n"
        assert tangy(*asked, "--forget", "--json", "--data", data).stdout.count("suggested") == 1

    @pytest.mark.slow
    def test_the_suggested_command_repeats_the_given_options(
        self, tangy: Tangy, tmp_path: Path
    ) -> None:
        folder = tmp_path / "two words"
        rename = ("people", "rename", "user6", "Xanthippus", "--users", "6", "--data", folder)
        shown = tangy(*rename).stdout
        (accept,) = [line for line in shown.splitlines() if line.endswith("--accept")]
        _, *arguments = shlex.split(accept.partition(":")[2])
        assert json.loads(tangy(*arguments, "--json").stdout)["source"] == "person"

    @pytest.mark.parametrize(
        ("arguments", "told"),
        [
            (("Rosa", "R OH"), "there is no phone 'OH'; did you mean 'OW'?"),
            (("user2", "Z AE N"), "has 2 words"),
            (("user2", "Z AE N, L IY, L IY"), "has 2 words"),
            (("Rosa", ""), "from 1 to 40 phones"),
            (("Rosa", "R OW", "--accept"), "Choose one"),
            (("nobody",), "There is nobody called"),
        ],
    )
    def test_an_invalid_pronunciation_changes_nothing(
        self, tangy: Tangy, data: Path, arguments: tuple[str, ...], told: str
    ) -> None:
        done = tangy("people", "pronounce", *arguments, "--data", data)
        assert (done.returncode, done.stdout) == (2, "")
        assert told in done.stderr
        assert len(done.stderr.splitlines()) == 1
        with Store.open(data, write=False) as store:
            assert store.pronunciations() == {}

    def test_a_pronunciation_is_stored_apart_and_forgotten_with_the_name(
        self, tangy: Tangy, data: Path
    ) -> None:
        tangy("people", "pronounce", "user2", "Z AE N TH OY, L IY", "--data", data)
        with Store.open(data) as store:
            assert store.pronunciations() == {"user2": "Z AE N TH OY, L IY"}
            assert "TH OY" not in json.dumps([event.body for event in store.events()])
            store.rename("user2", "Xanthippus Lee")  # a longer name counts as the same
            assert store.pronunciations()
            store.rename("user2", "Ann")
            assert store.pronunciations() == {}
        for path in data.iterdir():
            assert b"TH OY" not in path.read_bytes()

    def test_showing_a_pronunciation_writes_nothing(self, tangy: Tangy, data: Path) -> None:
        before = (data / "tangy.db").read_bytes()
        tangy("people", "pronounce", "Rosa", "--data", data)
        tangy("people", "voice", "Rosa", "--data", data)
        assert (data / "tangy.db").read_bytes() == before


class TestNamesThatSoundAlike:
    @pytest.mark.slow
    def test_a_pronunciation_of_another_person_is_refused(self, tangy: Tangy, data: Path) -> None:
        tangy("people", "rename", "user2", "Xanthippe", "--data", data)
        tangy("people", "rename", "user4", "Xantippe", "--data", data)
        accepted = tangy("people", "pronounce", "user4", "--accept", "--json", "--data", data)
        phones = json.loads(accepted.stdout)["pronunciation"]
        done = tangy("people", "pronounce", "user2", phones, "--data", data)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == (
            f"tangy: Said {phones}, Xanthippe sounds like Xantippe (user4), and could not be told "
            "from it: give another pronunciation, or another name.\n"
        )
        with Store.open(data, write=False) as store:
            assert store.pronunciations() == {"user4": phones}
        assert tangy("people", "pronounce", "user2", f"{phones} AH", "--data", data).returncode == 0

    def test_a_pronunciation_that_is_a_phrase_is_refused(self, tangy: Tangy, data: Path) -> None:
        done = tangy("people", "pronounce", "Rosa", "S T AA P", "--data", data)
        assert done.returncode == 2
        assert "Rosa sounds like 'stop'" in done.stderr

    @pytest.mark.slow
    def test_a_new_name_that_sounds_like_another_is_accepted_with_a_warning(
        self, tangy: Tangy, data: Path
    ) -> None:
        tangy("people", "rename", "user3", "Ann", "--data", data)
        done = tangy("people", "rename", "user4", "Anne", "--data", data)
        assert done.returncode == 0
        told = done.stdout.splitlines()
        assert told[:2] == [
            "user4 is now called Anne.",
            "Anne sounds like Ann (user3): Anne can be typed, but not heard.",
        ]
        assert f"tangy people pronounce user4 --data {data}" in told[2]
        tangy("people", "rename", "user4", "Bob", "--data", data)
        first = tangy("people", "rename", "user1", "Anne", "--data", data).stdout
        assert "Anne sounds like Ann (user3): Ann can be typed, but not heard." in first
        again = tangy("people", "rename", "user1", "Anne", "--json", "--data", data)
        assert json.loads(again.stdout)["sounds_like"] == "Ann (user3)"

    @pytest.mark.slow
    def test_a_suggested_pronunciation_of_another_person_is_not_offered(
        self, tangy: Tangy, data: Path
    ) -> None:
        suggested = tangy("people", "rename", "user3", "Xanthippe", "--json", "--data", data)
        phones = json.loads(suggested.stdout)["pronunciation"]
        tangy("people", "rename", "user4", "Bob", "--data", data)
        tangy("people", "pronounce", "user4", phones, "--data", data)
        for done in (
            tangy("people", "rename", "user3", "Xanthippe", "--data", data),
            tangy("people", "pronounce", "user3", "--data", data),
        ):
            assert f"it may be said {phones}, and that sounds like Bob (user4)." in done.stdout
            assert "--accept" not in done.stdout
        refused = tangy("people", "pronounce", "user3", "--accept", "--data", data)
        assert refused.returncode == 2

    @pytest.mark.parametrize(
        ("name", "why"),
        [
            ("Stop", "stops the robot"),
            ("Stop now!", "stops the robot"),
            ("Yes", "is an answer"),
            ("No", "is an answer"),
            ("Call Number", "is a command (call number)"),
            ("the call number", "is a command (call number)"),
            ("Xanthíppus Lee", "is what user2 is called"),
            ("Seat 3", "is where user3 sits"),
            ("User 2", "is another way to call user2"),
        ],
    )
    def test_a_name_with_another_meaning_is_refused(
        self, name: str, why: str, tangy: Tangy, data: Path
    ) -> None:
        done = tangy("people", "rename", "user1", name, "--data", data)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith(f"tangy: {name!r} {why}")
        assert done.stderr.endswith(": choose another name.\n")
        with Store.open(data, write=False) as store:
            assert store.names()["user1"] == "Rosa"

    @pytest.mark.parametrize("name", ["Rosa", "User 1", "Noemi", "Joe King", "李雷", "Callum"])
    def test_other_names_are_accepted(self, name: str, tangy: Tangy, data: Path) -> None:
        assert tangy("people", "rename", "user1", name, "--data", data).returncode == 0


class TestVoices:
    def test_rate_and_voice_are_set_and_reset_separately(
        self, tangy: Tangy, data: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("PATH", "")  # so that espeak-ng cannot list its voices
        asked = ("people", "voice", "Rosa", "--data", data)
        assert tangy(*asked).stdout == "Tangy speaks to Rosa as to everybody else.\n"
        tangy(*asked, "--rate", "110")
        said = tangy(*asked, "--voice", "en-gb").stdout
        assert said == "Tangy speaks to Rosa at 110 words a minute in the voice en-gb.\n"
        shown = json.loads(tangy(*asked, "--json").stdout)
        assert (shown["rate"], shown["voice"]) == (110, "en-gb")
        with Store.open(data, write=False) as store:
            assert store.voices() == {"user1": VoicePreference(110, "en-gb")}
            assert "en-gb" not in json.dumps([event.body for event in store.events()])
        assert "everybody else" in tangy(*asked, "--usual").stdout

    @pytest.mark.parametrize(
        ("options", "told"),
        [
            (("--rate", "5"), "80 to 260"),
            (("--voice", "; rm"), "cannot be a voice"),
            (("--rate", "100", "--usual"), "Choose one"),
        ],
    )
    def test_an_invalid_voice_preference_is_refused(
        self, tangy: Tangy, data: Path, options: tuple[str, ...], told: str
    ) -> None:
        done = tangy("people", "voice", "Rosa", *options, "--data", data)
        assert done.returncode == 2
        assert told in done.stderr


class TestTheWorkspace:
    def test_teaching_uses_seats_and_pronounced_names(self, data: Path) -> None:
        workspace = Workspace(data)
        workspace.pronounce(workspace.find_person("user2"), "Z AE N, L IY")
        teaching = workspace.teaching("somebody", 1)
        teaching.begin()
        book = teaching.phrasebook
        assert "go to seat two" in book.spoken()
        assert book.pronunciations()["xanthippus"] == ("Z AE N",)
        (asked,) = teaching.apply(Words("go to seat two"))
        workspace.close()
        assert isinstance(asked, Asked)
        assert asked.target == "user2"


class TestThePhrasebook:
    def test_the_page_lists_phrases_people_and_words(self, tangy: Tangy, data: Path) -> None:
        text = tangy("activity", "phrases", "--data", data).stdout
        for words in ("greet everyone", "user 1, rosa, seat 1", "R OW Z AH", "Cannot be heard"):
            assert words in text
        document = json.loads(tangy("activity", "phrases", "--json", "--data", data).stdout)
        assert [person["name"] for person in document["people"]][:2] == ["Rosa", "Xanthippus Lee"]
        assert "go to xanthippus lee" in document["left_out"]
        (own,) = [word for word in document["words"] if word["source"] == "activity"]
        assert own["phones"]

    def test_another_activity_has_its_own_page(self, tangy: Tangy, data: Path) -> None:
        text = tangy("activity", "phrases", LANTERNS, "--data", data).stdout
        assert "sing them in" in text
        assert "greet" not in text

    def test_words_and_phones_are_played_and_printed(
        self, tangy: Tangy, spoken: list[tuple[str, VoicePreference | None]]
    ) -> None:
        assert tangy("activity", "hear", "bingo").stdout == "B IH NG G OW\n"
        assert tangy("activity", "hear", "JH OW1 K").stdout == "JH OW K\n"
        document = json.loads(tangy("activity", "hear", "a joke", "--json").stdout)
        assert document["phones"].endswith("JH OW K")
        assert [phones for phones, _ in spoken][:2] == ["B IH NG G OW", "JH OW K"]
        done = tangy("activity", "hear", "JH Q")
        assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)

    def test_a_missing_voice_prints_the_phones_and_the_reason(
        self, tangy: Tangy, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("PATH", "")
        done = tangy("activity", "hear", "bingo")
        assert (done.returncode, done.stdout) == (2, "B IH NG G OW\n")
        assert "espeak-ng is not installed" in done.stderr
