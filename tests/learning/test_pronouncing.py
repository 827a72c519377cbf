"""Pronunciations: looked up, guessed, converted from espeak-ng; and names of people."""
# ruff: noqa: RUF001 - some letters are IPA

from __future__ import annotations

import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity
from tangy_profiles.errors import ProfileError
from tangy_profiles.person import Person
from tangy_profiles.phones import PHONES, read_name_phones, read_phones
from tangy_tui.language import espeak_phones, spelling
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.espeak_phones import FROM_IPA, TO_ESPEAK, from_ipa
from tangy_tui.language.lexicon import Lexicon, phones_of
from tangy_tui.language.name_pronunciation import how_said
from tangy_tui.language.pronunciation import (
    check_name,
    pronounce,
    suggest,
    suggest_name,
    to_espeak,
    unknown_words,
)
from tangy_tui.speech.hearing_notes import HearingNote, not_heard

phones = st.lists(st.sampled_from(sorted(PHONES)), min_size=1, max_size=12)


def nowhere(program: str) -> None:
    """Report every program as missing."""


class TestPhones:
    def test_each_of_the_39_phones_converts_to_espeak_and_back(self) -> None:
        assert len(PHONES) == 39
        assert set(TO_ESPEAK) == PHONES
        assert {phone for said in FROM_IPA.values() for phone in said.split()} == PHONES

    @given(phones, st.data())
    def test_stress_case_and_spaces_are_ignored(self, said: list[str], data: st.DataObject) -> None:
        marked = [
            phone.lower() if data.draw(st.booleans()) else phone + data.draw(st.sampled_from("012"))
            for phone in said
        ]
        assert read_phones("  ".join(marked)) == " ".join(said)

    @given(st.lists(phones, min_size=1, max_size=3))
    def test_a_name_has_commas_between_words(self, words: list[list[str]]) -> None:
        text = ", ".join(map(" ".join, words))
        assert read_name_phones(text.replace(", ", ",")) == text
        assert to_espeak(text).count("[[") == len(words)

    @given(st.text(max_size=30))
    def test_any_other_text_is_refused_in_one_sentence(self, text: str) -> None:
        try:
            assert set(read_phones(text).split()) <= PHONES
        except ProfileError as error:
            assert str(error).isprintable()
            assert "\n" not in str(error)

    @pytest.mark.parametrize(("wrong", "right"), [("H", "HH"), ("J", "JH"), ("OH", "OW")])
    def test_the_nearest_right_phone_is_named(self, wrong: str, right: str) -> None:
        with pytest.raises(ProfileError, match=f"'{wrong}'; did you mean '{right}'"):
            read_phones(f"B {wrong} T")

    def test_a_name_needs_phones_for_each_of_its_words(self) -> None:
        assert check_name("r ow z ah, l iy", "Rosa Lee") == "R OW Z AH, L IY"
        with pytest.raises(ProfileError, match="has 2 words"):
            check_name("R OW Z AH", "Rosa Lee")
        with pytest.raises(ProfileError, match="has 1 word, and these are phones of 2"):
            check_name("R OW Z AH, L IY", "Rosa")

    @given(phones)
    def test_espeak_is_given_one_stress_and_every_phone(self, said: list[str]) -> None:
        text = to_espeak(" ".join(said))
        assert text.startswith("[[")
        assert text.endswith("]]")
        assert len(text[2:-2].split("|")) == len(said)
        assert text.count("'") <= 1


class TestLookingUp:
    def test_the_usual_pronunciation_comes_first(self) -> None:
        assert pronounce("number") == ("N AH M B ER",)
        assert pronounce("The")[0] == "DH AH"
        assert len(pronounce("the")) == 2

    @pytest.mark.parametrize("word", ["xanthippus", "", " ", "a b", "the(2)", "\n", "李", "B", "%"])
    def test_an_unknown_word_has_no_pronunciation(self, word: str) -> None:
        if word != "B":
            assert pronounce(word) == ()
        else:
            assert pronounce(word) == pronounce("b")

    @given(st.text(max_size=12))
    def test_any_text_is_looked_up_without_failing(self, text: str) -> None:
        for way in pronounce(text):
            assert set(way.split()) <= PHONES

    def test_looking_up_a_word_does_not_load_the_decoder(self) -> None:
        code = (
            "import sys; from tangy_tui.language.pronunciation import pronounce, suggest\n"
            "assert pronounce('joke'); sys.exit('pocketsphinx' in sys.modules)"
        )
        subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603 - our own interpreter


class TestGuessing:
    DICTIONARY = "\ncat K AE T\nhat HH AE T\nmat M AE T\ncats K AE T S\nthin TH IH N\n"

    @pytest.mark.parametrize(
        ("word", "said"),
        [("hats", "HH AE T S"), ("mats", "M AE T S"), ("in", "IH N"), ("", "")],
    )
    def test_a_guess_follows_words_of_similar_spelling(self, word: str, said: str) -> None:
        assert spelling.guess(word, self.DICTIONARY) == said

    @pytest.mark.parametrize(
        ("word", "said", "parts"),
        [
            ("through", "TH R UW", ("TH", "", "R", "", "UW", "", "")),
            ("box", "B AA K S", ("B", "AA", "K S")),
            ("butter", "B AH T ER", ("B", "AH", "", "T", "", "ER")),
        ],
    )
    def test_phones_are_aligned_with_letters(
        self, word: str, said: str, parts: tuple[str, ...]
    ) -> None:
        assert spelling.align(word, tuple(said.split())) == parts

    def test_a_guess_needs_no_dictionary(self) -> None:
        assert spelling.guess("rosa", "") == "R AA S AE"

    @pytest.mark.parametrize(
        ("ipa", "said"),
        [
            ("ɹ_ˈoʊ_s_ə", "R OW S AH"),
            ("dʒ_ˈɔːɹ_dʒ", "JH AO R JH"),
            ("b_ˈʌ_ɾ_ɚ", "B AH T ER"),
            ("b_ˈɜː_d", "B ER D"),
            ("m_ˈɑːɹ_ɡ_ɹ_ə_t", "M AA R G R AH T"),
            ("", ""),
            ("?_\x00_漢", ""),
        ],
    )
    def test_the_ipa_of_espeak_is_read(self, ipa: str, said: str) -> None:
        assert from_ipa(ipa) == said

    def test_the_guess_uses_the_spelling_without_espeak(self) -> None:
        assert espeak_phones.espeak_phones("rosa", nowhere) == ""
        guessed = suggest("xanthippe", nowhere)
        assert "N TH IH P" in guessed
        assert set(guessed.split()) <= PHONES

    def test_words_in_another_script_get_no_guess(self) -> None:
        assert suggest("李雷") == suggest("42") == ""
        assert suggest_name("李雷") == ""
        assert how_said(Person("user1", "李雷")).source == ""

    def test_names_are_looked_up_word_by_word(self) -> None:
        assert suggest_name("Mary-Rose") == "M EH R IY, R OW Z"
        assert unknown_words("Mary Xanthippus") == ("xanthippus",)

    def test_words_and_phones_can_be_heard(self, activity: Activity) -> None:
        assert phones_of("call number", activity) == "K AO L, N AH M B ER"
        assert phones_of("B IH1 NG G OW", activity) == "B IH NG G OW"
        assert phones_of("valediction", activity) == activity.pronunciations["valediction"][0]
        for wrong in ("B IH Q", "", "李"):
            with pytest.raises(ProfileError):
                phones_of(wrong, activity)


class TestInThePhrasebook:
    def test_pronunciations_come_from_the_activity_and_from_people(
        self, activity: Activity
    ) -> None:
        people = [
            Person("user1", "Rosa Lee", "R OW S AH, L EY"),
            Person("user2", "Ada"),
            Person("user3", "Bob", "B AA, B"),  # not as many words as in the name
        ]
        book = Phrasebook(activity, people)
        said = book.pronunciations()
        assert (said["rosa"], said["lee"]) == (("R OW S AH",), ("L EY",))
        assert said.keys() == {"rosa", "lee", *activity.pronunciations}

    def test_a_name_that_is_a_phrase_word_keeps_its_pronunciation(self, activity: Activity) -> None:
        book = Phrasebook(activity, [Person("user1", "Mark", "M AA K")])
        assert book.pronunciations()["mark"] == (*pronounce("mark"), "M AA K")

    @pytest.mark.parametrize(
        ("phones", "source", "heard"), [(None, "suggested", False), ("Z AA Q", "", False)]
    )
    def test_a_name_without_pronunciation_is_left_out(
        self, activity: Activity, phones: str | None, source: str, heard: bool
    ) -> None:
        person = Person("user1", "Xanthippus")
        lexicon = Lexicon(
            Phrasebook(activity, [person]), suggest=lambda word: "Z" if source else ""
        )
        assert lexicon.words["xanthippus"].source == source
        assert lexicon.words["xanthippus"].heard is heard
        out = lexicon.left_out()
        (notice,) = not_heard(lexicon)
        assert notice == HearingNote("name not heard", "xanthippus", "user1")
        assert "go to xanthippus" in out
        assert "go to xanthippus" not in lexicon.heard()
        assert set(out) | set(lexicon.heard()) == set(Phrasebook(activity, [person]).spoken())

    def test_a_name_with_given_phones_is_recognised(self, activity: Activity) -> None:
        book = Phrasebook(activity, [Person("user1", "Xanthippus", "Z AE N TH IH P AH S")])
        lexicon = Lexicon(book)
        assert lexicon.words["xanthippus"].source == "person"
        assert "go to xanthippus" in lexicon.heard()
        assert lexicon.heard() == book.spoken()

    def test_two_names_that_sound_alike_cannot_both_be_heard(self, activity: Activity) -> None:
        people = [Person("user1", "Catherine"), Person("user2", "Katherine")]
        lexicon = Lexicon(Phrasebook(activity, people))
        assert "go to catherine" in lexicon.heard()
        assert lexicon.left_out()["go to katherine"] == "sounds like 'go to catherine'"
        assert len(not_heard(lexicon)) == len(lexicon.alike)
        assert {note.kind for note in not_heard(lexicon)} == {"phrase not heard"}
        assert all(note.about.endswith("katherine") for note in not_heard(lexicon))
