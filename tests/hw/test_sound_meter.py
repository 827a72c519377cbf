"""The sound meter: the level of its bar, and problems of the sound."""

from __future__ import annotations

import numpy as np
import pytest

from tangy_hw.audio.meter import Meter, SoundTrouble
from tangy_hw.audio.wav import RATE
from tests.hw.sounds import pcm, tone


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


class Listening:
    """A meter on a clock that advances with the sound."""

    def __init__(self) -> None:
        self.clock = Clock()
        self.meter = Meter(self.clock)

    def hear(self, seconds: float, sound: bytes) -> None:
        """Feed a sound over and over, 50 ms at a time."""
        size = 2 * RATE // 20
        for number in range(round(seconds * 20)):
            place = number * size % len(sound)
            self.clock.now += 0.05
            self.meter.feed(sound[place : place + size])


def wrong(on: Listening) -> str:
    """Return the kind of trouble that the meter reports; "" for none."""
    trouble = on.meter.trouble()
    return "" if trouble is None else trouble.kind


SILENCE = bytes(2 * RATE)
DITHER = pcm(np.tile([0.0, 1.0, 0.0, -1.0], RATE // 4) / 32_767)
ROOM = pcm(np.random.default_rng(1).normal(0, 20 / 32_768, RATE))
VOICE = pcm(tone(1.0, loud=0.2))


@pytest.fixture
def on() -> Listening:
    return Listening()


def test_the_bar_is_on_a_scale_of_decibels(on: Listening) -> None:
    shown = []
    for loud in (1.0, 0.1, 0.01, 0.001, 0.0):
        on.meter.begin()
        on.hear(0.1, pcm(tone(1.0, loud=loud)))
        shown.append(on.meter.level)
    assert shown == pytest.approx([1.0, 2 / 3, 1 / 3, 0.0, 0.0], abs=0.02)


def test_the_bar_rises_at_once_and_falls_slowly(on: Listening) -> None:
    on.hear(0.05, VOICE)
    loud = on.meter.level
    on.hear(0.1, SILENCE)
    assert loud - 0.2 < on.meter.level < loud
    on.clock.now += 1.0
    assert on.meter.level == 0.0


def test_the_meter_gives_the_recent_maximum(on: Listening) -> None:
    on.hear(0.05, pcm(tone(1.0, loud=1.0)))
    on.hear(1.5, SILENCE)
    assert on.meter.loudest(2.0) == pytest.approx(1.0, abs=0.01)
    assert on.meter.loudest(1.0) == 0.0


def test_a_constant_bias_counts_as_silence(on: Listening) -> None:
    on.hear(1.0, pcm(np.full(RATE, 0.3)))
    assert on.meter.level == 0.0


def test_a_normal_voice_has_no_problem(on: Listening) -> None:
    on.hear(5.0, VOICE)
    assert (on.meter.trouble(), on.meter.clipping) == (None, False)
    assert on.meter.seconds_since_sound == on.meter.seconds_since_data == 0.0


@pytest.mark.parametrize("sound", [SILENCE, DITHER], ids=["zeros", "the last bit"])
def test_a_silent_microphone_is_reported_after_two_seconds(on: Listening, sound: bytes) -> None:
    on.hear(3.0, VOICE)
    on.hear(1.9, sound)
    assert wrong(on) != "no sound"
    on.hear(0.3, sound)
    assert on.meter.trouble() == SoundTrouble("no sound", 2)
    on.hear(3.0, sound)
    assert on.meter.trouble() == SoundTrouble("no sound", 5)
    on.hear(0.1, VOICE)
    assert on.meter.trouble() is None


def test_missing_data_is_distinguished_from_silence(on: Listening) -> None:
    on.hear(1.0, VOICE)
    on.clock.now += 2.1
    assert on.meter.trouble() == SoundTrouble("nothing comes", 2)
    on.hear(2.1, SILENCE)
    assert wrong(on) == "no sound"


def test_clipping_is_reported_as_too_loud_for_half_a_second(on: Listening) -> None:
    on.hear(0.5, pcm(np.clip(tone(1.0, loud=1.3), -1, 1)))
    assert on.meter.clipping
    assert wrong(on) == "too loud"
    on.hear(0.6, VOICE)
    assert not on.meter.clipping
    assert on.meter.trouble() is None


def test_a_single_click_is_not_too_loud(on: Listening) -> None:
    click = np.frombuffer(VOICE, "<i2").copy()
    click[100] = -32_768
    on.hear(0.05, click.tobytes())
    assert not on.meter.clipping


def test_a_quiet_room_is_reported_only_while_a_person_should_speak(on: Listening) -> None:
    on.hear(1.9, ROOM)
    assert on.meter.trouble() is None, "they have only just begun"
    on.hear(0.2, ROOM)
    assert wrong(on) == "very quiet"
    assert on.meter.trouble(speaking=False) is None
    on.meter.begin()
    assert on.meter.trouble() is None


def test_pauses_between_words_are_not_very_quiet(on: Listening) -> None:
    for _ in range(3):
        on.hear(0.5, VOICE)
        on.hear(2.0, ROOM)
        assert on.meter.trouble() is None


def test_the_level_of_a_long_chunk_is_that_of_its_end(on: Listening) -> None:
    on.meter.feed(VOICE * 10 + SILENCE)
    assert on.meter.level == 0.0
    on.meter.feed(b"")
    on.meter.feed(b"\x01")
