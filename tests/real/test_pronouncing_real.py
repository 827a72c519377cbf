"""Pronunciations through the real espeak-ng: its phones are read, and given phones spoken."""

from __future__ import annotations

import asyncio
import shutil
import subprocess

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles.phones import PHONES
from tangy_tui.app.aloud import hear
from tangy_tui.language.espeak_phones import PROGRAM, espeak_phones, from_ipa, to_espeak
from tangy_tui.language.pronunciation import pronounce, suggest

pytestmark = pytest.mark.skipif(
    shutil.which(PROGRAM) is None, reason="espeak-ng is not installed: nobody to say a name"
)

WORDS = ("rosa", "margaret", "judge", "thing", "measure", "boy", "cow", "bird", "yellow", "hello")


def test_guesses_of_common_words_match_the_dictionary() -> None:
    right = [word for word in WORDS if espeak_phones(word) in pronounce(word)]
    assert len(right) >= len(WORDS) - 2


def said(text: str) -> str:
    """Return espeak-ng's reading of its own phones, as Tangy's phones."""
    command = [PROGRAM, "-q", "--ipa", "--sep=_", "-v", "en-us", "--stdin"]
    done = subprocess.run(command, input=text.encode(), capture_output=True, check=True)  # noqa: S603
    return from_ipa(done.stdout.decode())


@pytest.mark.slow
@settings(max_examples=15)
@given(st.sampled_from(sorted(PHONES - {"AA", "AH", "ER", "R"})))
def test_espeak_speaks_each_phone_as_written(phone: str) -> None:
    phones = f"M {phone} M" if phone[0] in "AEIOU" else f"{phone} EY M"
    assert said(to_espeak(phones)) == phones


def test_a_name_is_spoken_by_its_phones_and_not_by_its_spelling() -> None:
    assert said(to_espeak("SH IH V AO N")) == "SH IH V AO N"
    asyncio.run(hear("SH IH V AO N", sink="null"))


@pytest.mark.parametrize("word", ["-v", "--help", "[[r]]", "<b>", "a" * 200, "'"])
def test_odd_words_are_not_parsed_as_options(word: str) -> None:
    assert set(suggest(word).split()) <= PHONES
