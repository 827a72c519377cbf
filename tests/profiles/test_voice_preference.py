"""Voice preferences of people are validated when they are set."""

from __future__ import annotations

from typing import Any

import pytest

from tangy_profiles.errors import ProfileError
from tangy_profiles.voice import VoicePreference


@pytest.mark.parametrize("voice", ["en", "en-us", "en-gb+f3", "cmn-Latn-pinyin", "de+Mr_2", None])
@pytest.mark.parametrize("rate", [80, 260, None])
def test_a_valid_preference_is_accepted(rate: int | None, voice: str | None) -> None:
    assert VoicePreference(rate, voice) == VoicePreference(rate=rate, voice=voice)


@pytest.mark.parametrize("rate", [79, 261, 0, -140, True, 140.0, "140"])
def test_an_invalid_rate_is_refused(rate: Any) -> None:
    with pytest.raises(ProfileError, match=r"from 80 to 260 words a minute\.$"):
        VoicePreference(rate)


@pytest.mark.parametrize("voice", ["", "-v", "en us", "en+", "+f3", "a\x1b[2Jb", "../x", "e" * 99])
def test_an_invalid_voice_name_is_refused(voice: str) -> None:
    with pytest.raises(ProfileError, match="such as en-us") as refused:
        VoicePreference(None, voice)
    assert str(refused.value).isprintable()


def test_unset_preferences_take_the_default() -> None:
    usual = VoicePreference(140, "en-us")
    assert VoicePreference().over(usual) == usual
    assert VoicePreference(100).over(usual) == VoicePreference(100, "en-us")
    assert VoicePreference(None, "de").over(usual) == VoicePreference(140, "de")
