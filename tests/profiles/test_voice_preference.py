"""How a person likes to be spoken to is checked where it is written down."""

from __future__ import annotations

from typing import Any

import pytest

from tangy_profiles.errors import ProfileError
from tangy_profiles.voice import VoicePreference


@pytest.mark.parametrize("voice", ["en", "en-us", "en-gb+f3", "cmn-Latn-pinyin", "de+Mr_2", None])
@pytest.mark.parametrize("rate", [80, 260, None])
def test_what_can_be_spoken_is_taken(rate: int | None, voice: str | None) -> None:
    assert VoicePreference(rate, voice) == VoicePreference(rate=rate, voice=voice)


@pytest.mark.parametrize("rate", [79, 261, 0, -140, True, 140.0, "140"])
def test_a_rate_that_cannot_be_spoken_is_refused(rate: Any) -> None:
    with pytest.raises(ProfileError, match=r"from 80 to 260 words a minute\.$"):
        VoicePreference(rate)


@pytest.mark.parametrize("voice", ["", "-v", "en us", "en+", "+f3", "a\x1b[2Jb", "../x", "e" * 99])
def test_what_is_no_name_of_a_voice_is_refused(voice: str) -> None:
    with pytest.raises(ProfileError, match="such as en-us") as refused:
        VoicePreference(None, voice)
    assert str(refused.value).isprintable()


def test_what_a_person_does_not_say_is_as_for_everybody() -> None:
    usual = VoicePreference(140, "en-us")
    assert VoicePreference().over(usual) == usual
    assert VoicePreference(100).over(usual) == VoicePreference(100, "en-us")
    assert VoicePreference(None, "de").over(usual) == VoicePreference(140, "de")
