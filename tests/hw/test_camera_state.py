"""The reported state of a camera, and its delay, on the test's clock."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tangy_hw.drivers.camera_look import Look, measure
from tangy_hw.drivers.camera_state import CameraWatch, State
from tangy_profiles.health import OK, STALE, WARN, Reading
from tangy_profiles.robot import load_robot
from tests.hw.pictures import Image, room, seen

RATE = 10
NAMED = 2.0  # s in which a state must be reported, and its end
FINE = Look(0, 0.0, 0.5, 0.2, 0.5, 0, 640, 480)
ILL: dict[State, Look] = {
    "COVERED": FINE._replace(brightness=0.02, contrast=0.01, sharpness=None),
    "DARK": FINE._replace(brightness=0.05, contrast=0.04),
    "BLURRED": FINE._replace(sharpness=0.1),
}


class Film:
    """Feeds pictures to a watch, ten a second, and records the changes of its state."""

    def __init__(self) -> None:
        self.now = 0.0
        self.watch = CameraWatch(0.0)
        self.states: list[tuple[float, State]] = [(0.0, self.watch.at(0.0).state)]
        self._count = 0

    def show(self, look: Look | None, seconds: float, *, same: bool = False) -> None:
        for _ in range(round(seconds * RATE)):
            self.now += 1 / RATE
            if look is not None:
                self._count += not same
                self.watch.saw(look._replace(stamp=self.now, fingerprint=self._count))
            state = self.watch.at(self.now).state
            if state != self.states[-1][1]:
                self.states.append((self.now, state))

    @property
    def names(self) -> list[State]:
        return [state for _, state in self.states]


class TestStates:
    @pytest.mark.parametrize("state", ILL)
    def test_a_bad_state_begins_and_ends_within_the_time_limit(self, state: State) -> None:
        film = Film()
        film.show(FINE, 3)
        film.show(ILL[state], 3)
        film.show(FINE, 3)
        assert film.names == ["OPENING", "OK", state, "OK"]
        (_, _), (_, _), (named, _), (over, _) = film.states
        assert 3 < named <= 3 + NAMED
        assert 6 < over <= 6 + NAMED

    def test_the_same_picture_again_and_again_is_frozen(self) -> None:
        film = Film()
        film.show(FINE, 3)
        film.show(FINE, 3, same=True)
        film.show(FINE, 1)
        assert film.names == ["OPENING", "OK", "FROZEN", "OK"]
        assert film.states[2][0] <= 3 + NAMED

    def test_a_covered_lens_that_sends_the_same_black_is_covered(self) -> None:
        film = Film()
        film.show(FINE, 3)
        film.show(ILL["COVERED"], 5, same=True)
        assert film.names == ["OPENING", "OK", "COVERED"]
        assert film.watch.at(film.now).unchanged > 1

    def test_a_camera_without_pictures_is_disconnected_with_a_reason(self) -> None:
        film = Film()
        film.show(FINE, 3)
        film.watch.lost("it is unplugged")
        film.show(None, 5)
        assert film.states[-1][1] == "DISCONNECTED"
        assert film.states[-1][0] <= 3 + NAMED
        assert "unplugged" in film.watch.at(film.now).why
        film.show(FINE, 0.1)
        assert film.names[-1] == "OK"
        assert not film.watch.at(film.now).why

    @pytest.mark.parametrize("why", ["", "it is unplugged"])
    def test_a_camera_that_returns_with_its_last_picture_is_not_frozen(self, why: str) -> None:
        film = Film()
        film.show(FINE, 3)
        if why:
            film.watch.lost(why)
        film.show(None, 5)
        film.show(FINE, 0.2, same=True)
        assert film.watch.at(film.now).unchanged < 0.2
        film.show(FINE, 1)
        assert film.names == ["OPENING", "OK", "DISCONNECTED", "OK"]

    def test_a_camera_that_never_gave_a_picture_is_disconnected_in_time(self) -> None:
        film = Film()
        film.show(None, 3)
        assert film.names == ["OPENING", "DISCONNECTED"]
        assert film.states[1][0] <= NAMED

    def test_a_momentary_disturbance_changes_no_state(self) -> None:
        film = Film()
        for look in ILL.values():
            film.show(FINE, 1)
            film.show(look, 0.4)
        film.show(FINE, 0.9, same=True)
        film.show(FINE, 1)
        film.show(None, 1.2)
        film.show(FINE, 1)
        assert film.names == ["OPENING", "OK"]

    def test_a_state_at_its_limit_does_not_flicker(self) -> None:
        film = Film()
        film.show(FINE, 1)
        for number in range(100):
            film.show(FINE._replace(brightness=0.079 if number % 2 else 0.081), 0.1)
        film.show(FINE, 1)
        assert len(film.names) <= 4

    def test_an_ended_camera_stays_ended(self) -> None:
        film = Film()
        film.show(FINE, 1)
        film.watch.ended("That was the last picture.")
        film.show(None, 9)
        assert film.names == ["OPENING", "OK", "ENDED"]

    def test_a_picture_taken_on_demand_is_judged_alone(self) -> None:
        watch = CameraWatch(0.0, each=True)
        for stamp in (1.0, 60.0, 120.0):
            watch.saw(FINE._replace(stamp=stamp))
        assert watch.at(500.0).state == "OK"
        watch.saw(ILL["BLURRED"]._replace(stamp=121.0))
        assert watch.at(121.0).state == "BLURRED"

    def test_a_slow_folder_is_not_disconnected_between_its_pictures(self) -> None:
        watch = CameraWatch(0.0, interval=2.0)
        watch.saw(FINE)
        assert watch.at(3.0).state == "OK"
        assert watch.at(5.5).state == "DISCONNECTED"


class TestReadings:
    """The contract with the diagnosis: the facts of the robot's profile, in their ranges."""

    def test_the_reading_has_the_facts_of_the_profile(self) -> None:
        film = Film()
        film.show(FINE, 2)
        reading = film.watch.at(film.now).reading("camera")
        assert (reading.device, reading.state) == ("camera", OK)
        measures = load_robot().devices["camera"].facts
        assert set(reading.facts) == set(measures)
        assert not any(measures[fact].wrong(value) for fact, value in reading.facts.items())

    def test_the_rate_counts_sequence_numbers_but_not_in_folders(self) -> None:
        watch, folder = CameraWatch(0.0), CameraWatch(0.0, each=True)
        for number in range(16):  # the watch looks at every third, of 15 per second
            for one in (watch, folder):
                one.saw(FINE._replace(seq=3 * number, stamp=number / 5))
        assert watch.at(3.0).reading("camera").rate == pytest.approx(15)
        assert folder.at(3.0).rate is None
        assert watch.at(9.0).rate == 0

    @pytest.mark.parametrize("state", ILL)
    def test_a_bad_camera_state_reads_as_a_warning(self, state: State) -> None:
        film = Film()
        film.show(ILL[state], 2)
        assert film.watch.at(film.now).reading("camera").state == WARN

    def test_silence_is_stale_with_its_age(self) -> None:
        film = Film()
        film.show(FINE, 1)
        film.show(None, 4)
        reading = film.watch.at(film.now).reading("camera")
        assert reading.state == STALE
        assert reading.age == pytest.approx(4.0)

    def test_an_age_of_hours_stays_in_range(self) -> None:
        film = Film()
        film.show(FINE, 1)
        for second in range(2, 3700):
            film.watch.saw(FINE._replace(stamp=float(second), fingerprint=10))
        assert film.watch.at(3699.0).reading("camera").facts["unchanged"] == 3600

    def test_a_reading_before_the_first_picture_has_no_facts(self) -> None:
        assert CameraWatch(0.0).at(0.7).reading("eye") == Reading("eye", 0.7, STALE)


class TestMeasures:
    def test_blur_is_measured_in_dim_and_noisy_pictures_too(self) -> None:
        rng = np.random.default_rng(3)
        for seed in range(40, 44):
            image = room(seed, 640, 360)
            for light, noise in ((1.0, 2.0), (0.4, 5.0)):
                sharp = measure(seen(image, rng, light=light, noise=noise), 0, 0.0).sharpness
                soft = measure(seen(image, rng, light=light, noise=noise, blur=4), 0, 0.0).sharpness
                assert sharp is not None and sharp > 0.19
                assert soft is None or soft < 0.19

    @pytest.mark.parametrize("shape", [(1, 1, 3), (1, 900, 3), (40, 2, 3), (480, 640)])
    def test_any_shape_can_be_measured(self, shape: tuple[int, ...]) -> None:
        look = measure(np.full(shape, 255, np.uint8), 5, 1.0)
        assert (look.seq, look.contrast, look.sharpness) == (5, 0.0, None)
        assert look.brightness == pytest.approx(1.0)

    def test_only_identical_pictures_share_a_fingerprint(self) -> None:
        image = room(1, 64, 48)
        again = image.copy()
        assert measure(image, 0, 0.0).fingerprint == measure(again, 1, 1.0).fingerprint
        again[20, 20, 0] ^= 1
        assert measure(image, 0, 0.0).fingerprint != measure(again, 1, 1.0).fingerprint


def film_of(seed: int) -> Iterator[tuple[str, Image]]:
    """Film a pan, a still room, and lights that are dimmed: half a minute in place of ten."""
    rng = np.random.default_rng(seed)
    wide = np.hstack([room(seed, 320, 180), room(seed + 1, 320, 180)])
    for number in range(8 * RATE):
        left = round(320 * number / (8 * RATE))
        yield "pan", seen(np.ascontiguousarray(wide[:, left : left + 320]), rng, noise=2)
    for _ in range(8 * RATE):
        yield "still", seen(wide[:, :320], rng, noise=2)
    for number in range(8 * RATE):
        light = 0.65 + 0.35 * np.cos(2 * np.pi * number / (8 * RATE))
        yield "dimmed", seen(wide[:, 320:], rng, light=float(light), noise=2)


@pytest.mark.slow
def test_live_video_raises_no_false_alarm() -> None:
    watch, told = CameraWatch(0.0), set()
    for count, (kind, image) in enumerate(film_of(900)):
        watch.saw(measure(image, count, count / RATE))
        told.add((kind, watch.at(count / RATE + 0.05).state))
    assert told == {("pan", "OK"), ("still", "OK"), ("dimmed", "OK")}
