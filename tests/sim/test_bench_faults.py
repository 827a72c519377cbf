"""Faults on the bench: injected into its devices and people, and repaired."""

from __future__ import annotations

from collections import Counter
from math import hypot

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.state import FRONT
from tangy_sim.device_simulator.drive import RADIUS
from tangy_sim.device_simulator.world import BenchWorld
from tangy_sim.worlds.injection import KINDS
from tests.sim.bench_game import ACTIVITY, ROBOT, bench, drive_to, say

RULES = {rule.code: rule for rule in load_faults(ROBOT).rules}


def opened(seed: int = 1) -> BenchWorld:
    """Make a world after the greeting of a game."""
    world = bench(seed)
    world.begin()
    say(world, "greeting")
    return world


def asks(world: BenchWorld, person: str, marked: int = 0, called: int = 0) -> None:
    """Put a person's sign up, with this card, and the robot beside them."""
    sitter = world.people.sitters[person]
    sitter.asks_since = world.now
    sitter.player.marked, sitter.player.called = marked, called
    assert drive_to(world, person)


def ask_aloud(world: BenchWorld, code: str, name: str = "") -> None:
    """Let the robot ask for help with a fault, to the end of the sentence and some time after."""
    world.say(RULES[code].fill(RULES[code].aloud, name=name, object=ACTIVITY.object))
    world.step(20.0)


class TestAnyKind:
    @pytest.mark.parametrize("kind", KINDS)
    def test_only_the_right_diagnosis_mends_an_injected_fault(self, kind: str) -> None:
        world = opened()
        world.inject(kind)
        (told,) = world.truth()["faults"]
        assert (told["kind"], told["code"]) == (kind, KINDS[kind].code)
        world.step(1.0)
        assert world.mend("some other fault") == []
        assert world.mend(KINDS[kind].code) == [kind]
        assert not world.truth()["faults"] and not world.floor.dropped

    @pytest.mark.parametrize("kind", KINDS)
    def test_the_next_game_begins_without_injected_faults(self, kind: str) -> None:
        world = opened()
        world.inject(kind)
        world.begin()
        assert not world.faults.present and not world.floor.dropped

    @pytest.mark.parametrize(
        ("shows", "silences", "elsewhere"),
        [
            ("base-stuck", "base-failed", "laser-disconnected"),
            ("camera-frozen", "camera-disconnected", "requests-silent"),
            ("laser-occluded", "laser-disconnected", "link-lost"),
        ],
    )
    def test_mending_a_fault_also_mends_the_silence_that_hides_it(
        self, shows: str, silences: str, elsewhere: str
    ) -> None:
        world = bench(1)
        for kind in (shows, silences, elsewhere):
            world.inject(kind)
        assert world.mend(KINDS[shows].code) == [shows, silences]
        assert set(world.faults.present) == {elsewhere}

    def test_restoring_the_link_repairs_no_device(self) -> None:
        world = bench(1)
        for kind in ("link-lost", "requests-silent"):
            world.inject(kind)
        assert world.mend("link-lost") == ["link-lost"]
        assert set(world.faults.present) == {"requests-silent"}

    def test_mending_a_mute_robot_mends_voice_and_screen(self) -> None:
        world = opened()
        world.inject("voice-dead")
        world.inject("screen-dead")
        assert set(world.mend("mute")) == {"voice-dead", "screen-dead"}

    def test_an_unknown_kind_is_refused(self) -> None:
        with pytest.raises(KeyError):
            bench().inject("rain")

    @pytest.mark.parametrize("kind", ["camera-occluded", "laser-occluded", "path-blocked"])
    def test_people_usually_help_when_asked_aloud(self, kind: str) -> None:
        helped = 0
        world = opened()
        for _ in range(40):
            world.inject(kind)
            ask_aloud(world, KINDS[kind].code)
            helped += kind not in world.faults
            world.lift(kind)
        assert 24 <= helped <= 39  # .8 of 40


class TestDriving:
    @pytest.mark.parametrize("kind", ["emergency-stop", "base-failed", "base-stuck"])
    def test_a_base_fault_stops_the_robot_until_it_is_mended(self, kind: str) -> None:
        world = opened()
        world.inject(kind)
        assert not drive_to(world, "user1", 5.0) and world.people.place == FRONT
        world.mend(KINDS[kind].code)
        assert drive_to(world, "user1")

    def test_an_emergency_stop_ends_the_drive(self) -> None:
        world = opened()
        for _ in range(20):
            world.drive(0.5, 0.0)
            world.step(0.05)
        there = world.wheels.pose
        world.inject("emergency-stop")
        world.drive(0.5, 0.0)
        world.step(0.5)
        assert world.wheels.pose == there and world.wheels.forward == 0.0

    def test_slipping_wheels_turn_without_moving_the_robot(self) -> None:
        world = opened()
        there = world.wheels.pose
        world.inject("wheels-slip")
        for _ in range(60):
            world.drive(0.5, 0.0)
            world.step(0.05)
        gone = hypot(world.wheels.pose.x - there.x, world.wheels.pose.y - there.y)
        assert gone < 0.15 and world.wheels.odometry.x > 1.0

    def test_chairs_block_every_path(self) -> None:
        world = opened()
        start = world.wheels.pose
        world.inject("path-blocked")
        for way in range(12):
            assert any(hypot(c.x - start.x, c.y - start.y) < 1.3 for c in world.floor.dropped)
            world.wheels.pose = start._replace(heading=way * 0.5236 - 3.14)
            for _ in range(80):
                world.drive(1.0, 0.0)
                world.step(0.05)
            assert hypot(world.wheels.pose.x - start.x, world.wheels.pose.y - start.y) < 1.3
        world.lift("path-blocked")
        assert not world.floor.dropped

    def test_a_detour_fault_puts_a_chair_into_the_path_of_a_moving_robot(self) -> None:
        world = opened()
        world.inject("path-detour")
        world.step(5.0)
        assert not world.floor.dropped  # it stands still
        assert not drive_to(world, "user2", 12.0)  # it drives straight, and bumps
        (chair,) = world.floor.dropped
        assert world.truth()["faults"][0]["shown"] and world.wheels.bumped
        for side in (-1, 1):
            assert world.floor.clear(chair.x + side * 0.7, chair.y, RADIUS)
        world.lift("path-detour")
        assert drive_to(world, "user2")

    def test_a_kidnapped_robot_moves_without_a_change_of_odometry(self) -> None:
        for seed in range(8):
            world = bench(seed)
            there, counted = world.wheels.pose, world.wheels.odometry
            world.inject("carried-off")
            pose = world.wheels.pose
            assert hypot(pose.x - there.x, pose.y - there.y) > 2.0
            assert world.wheels.odometry == counted
            assert world.floor.clear(pose.x, pose.y, RADIUS) and pose.y < world.room.table[1]
            world.step(1.0)
            assert "carried-off" in world.faults
        assert drive_to(world, "user2") and "carried-off" not in world.faults  # it found its way


class TestSensing:
    def test_a_covered_laser_sees_its_cover(self) -> None:
        world = opened()
        world.inject("laser-occluded")
        assert (world.ranges() < 0.15).mean() > 0.6
        world.lift("laser-occluded")
        assert (world.ranges() < 0.15).mean() == 0

    @pytest.mark.parametrize(("kind", "scene"), [("camera-occluded", "dark"),
                                                 ("camera-frozen", "frozen")])  # fmt: skip
    def test_a_camera_fault_changes_the_scene(self, kind: str, scene: str) -> None:
        world = opened()
        assert world.head_scene().kind == "room"
        world.inject(kind)
        assert world.head_scene().kind == scene

    def test_a_broken_arm_does_not_stop_the_head(self) -> None:
        world = opened()
        world.inject("arm-failed")
        world.joints.move(["left_arm/elbow", "head/neck nod"], [1.0, -0.3], 0.5)
        world.step(2.0)
        assert world.joints.angle("left_arm/elbow") == 0
        assert world.joints.angle("head/neck nod") < -15


class TestPeople:
    def test_a_card_stays_out_of_sight_until_its_owner_is_asked(self) -> None:
        world = opened()
        asks(world, "user2")
        world.people.sitters["user2"].hides = ""
        world.inject("card-out-of-sight")
        assert world.people.sitters["user2"].hides
        say(world, "move card closer", "User 2")
        world.step(25.0)
        assert world.people.sitters["user2"].hides  # the card was moved, but is still hidden
        while world.people.sitters["user2"].hides:
            ask_aloud(world, "card-out-of-sight", "User 2")
        assert "card-out-of-sight" not in world.faults

    def test_a_stuck_sign_stays_up_until_the_robot_asks(self) -> None:
        world = opened()
        world.inject("request-stuck")
        asks(world, "user3")
        say(world, "encourage", "User 3")
        world.step(25.0)
        assert world.asking == ("user3",) and world.truth()["faults"][0]["person"] == "user3"
        while world.asking:
            ask_aloud(world, "request-stuck", "User 3")
        assert "request-stuck" not in world.faults

    def test_a_withdrawn_request_is_never_that_of_the_visited_person(self) -> None:
        world = opened()
        world.inject("request-withdrawn")
        asks(world, "user3")
        world.step(5.0)
        assert world.asking == ("user3",) and "request-withdrawn" in world.faults
        world.people.sitters["user1"].asks_since = world.now
        world.step(1.0)
        assert world.asking == ("user3",) and "request-withdrawn" not in world.faults

    def test_a_person_who_never_complies_finally_takes_the_sign_down(self) -> None:
        world = opened()
        world.inject("never-complies")
        asks(world, "user4", marked=0b11)
        player = world.people.sitters["user4"].player
        for _ in range(3):
            say(world, "remove markers", "User 4", *player.cells(0b11))
            assert world.asking == ("user4",)
            world.step(2 * ACTIVITY.patience)
        assert player.marked == 0b11 and not world.asking
        assert [r.followed for r in world.people.game.responses] == [False] * 3

    def test_a_correction_without_effect_is_undone_once(self) -> None:
        world = opened()
        world.inject("no-effect")
        asks(world, "user4", marked=0b11)
        player = world.people.sitters["user4"].player
        say(world, "remove markers", "User 4", *player.cells(0b11))
        world.step(25.0)
        left = player.marked
        assert not left & 0b11 and left.bit_count() == 1 and not left & player.called
        assert world.people.judged("user4") == "incorrectly marked" and world.asking == ("user4",)
        assert world.people.game.responses[-1].followed and "no-effect" not in world.faults
        say(world, "remove markers", "User 4", *player.cells(left))
        world.step(25.0)
        assert player.marked == 0

    def test_a_correction_without_effect_completes_no_line(self) -> None:
        world = opened()
        world.inject("no-effect")
        deck = ACTIVITY.deck
        line = next(line for line in deck.lines if not line & deck.free)
        last = line & -line
        asks(world, "user4", called=line, marked=line & ~last)
        assert world.people.judged("user4") == "missing numbers"
        player = world.people.sitters["user4"].player
        say(world, "mark numbers", "User 4", *player.cells(last))
        world.step(25.0)
        assert player.marked & last and player.marked != line
        assert world.people.judged("user4") == "missing numbers"
        assert "no-effect" not in world.faults

    def test_an_impossible_no_effect_fault_stays_pending(self) -> None:
        world = opened()
        world.inject("no-effect")
        asks(world, "user4", called=0b1, marked=0)
        player = world.people.sitters["user4"].player
        say(world, "mark numbers", "User 4", *player.cells(0b1))
        world.step(25.0)
        assert player.marked == 0b1 and "no-effect" in world.faults

    @pytest.mark.slow
    def test_a_dead_voice_is_silent_and_may_recover_by_a_restart(self) -> None:
        came = Counter[bool]()
        for seed in range(30):
            world = bench(seed)
            world.inject("voice-dead")
            world.say("Hello, everybody. I am Tangy, and today we play Bingo.")
            world.step(10.0)
            assert not world.said and not world.people.game.opened
            came[world.restart("voice")] += 1
        assert 6 <= came[True] <= 24

    def test_people_ask_aloud_for_help_while_signs_cannot_be_seen(self) -> None:
        world = opened()
        world.people.sitters["user1"].asks_since = world.now
        world.inject("requests-silent")
        assert not world.truth()["spoken"]
        ask_aloud(world, "requests-silent")
        assert world.truth()["spoken"] == ["user1"]
