"""Faults in the full-screen program: told, seen, cleared, listed, brought about; with keys."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_sim.faulty import FaultyWorld
from tangy_sim.injection import KINDS
from tangy_tui.house import House
from tangy_tui.learning.policy import ForestSettings, Policy
from tangy_tui.monitoring.fault import BORNE, OVER, Diagnosed, Fault, read_faults
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.critical import CriticalDialog
from tangy_tui.ui.dialogs.fault import FaultDialog
from tangy_tui.ui.dialogs.inject import InjectDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.fault_words import status_words
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.asking import AskingPanel
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.fault_banner import FaultBanner
from tangy_tui.ui.widgets.fault_list import FaultList
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.interaction.gaps import learnt
from tests.pilot.conftest import SMALL, Run, StillClock, TangyPilot

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]
FEW = ForestSettings(trees=5)
TINY = (60, 18)
MIDDLE = (120, 40)


@pytest.fixture
def house(tmp_path: Path) -> Iterator[House]:
    """A house with a data folder of its own."""
    opened = House(tmp_path / "data")
    yield opened
    opened.close()


@pytest.fixture
def policy(house: House, cover: Cover) -> Policy:
    """A policy that knows all that comes about."""
    return learnt(house.store, house.activity, cover("bingo", 1, 4), FEW)


def playing(
    house: House,
    policy: Policy,
    *injections: str,
    speed: float = 1,
    leave_after: float | None = None,
) -> Program:
    """Make the program with the playing screen open; at speed 1 only keys move the game."""

    async def start(program: Program) -> None:
        supervision = house.supervision(policy, 5, asks=True, injections=injections)
        screen = PlayScreen(house, supervision, speed=speed, leave_after=leave_after, teacher="ann")
        await program.push_screen(screen)

    return Program(house, start, clock=StillClock())


def game_of(pilot: TangyPilot) -> tuple[PlayScreen, Supervision, FaultyWorld]:
    """Return the playing screen, what supervises its games, and their world."""
    screen = next(s for s in pilot.app.screen_stack if isinstance(s, PlayScreen))
    world = screen._supervision.world
    assert isinstance(world, FaultyWorld)
    return screen, screen._supervision, world


async def until(pilot: TangyPilot, so: Callable[[], object]) -> None:
    """Wait until something is so."""
    while not so():
        await pilot.pause(0.02)
    await pilot.pause()


async def halted(pilot: TangyPilot) -> CriticalDialog:
    """Wait until the dialog of a critical fault takes keys."""
    await until(pilot, lambda: isinstance(pilot.app.screen, CriticalDialog))
    dialog = pilot.app.screen
    assert isinstance(dialog, CriticalDialog)
    await until(pilot, lambda: dialog._keys._from is not None)
    return dialog


async def halting(pilot: TangyPilot, kind: str = "emergency-stop") -> CriticalDialog:
    """Pause the game, bring about a critical fault, and wait for its dialog."""
    await pilot.press("p")
    game_of(pilot)[2].inject(kind)
    return await halted(pilot)


async def asked(pilot: TangyPilot) -> AskingPanel:
    """Wait until Tangy asks and a command can be typed."""
    screen = game_of(pilot)[0]
    await until(pilot, lambda: screen.query(AskingPanel))
    await until(pilot, lambda: not screen.query_one(CommandBar).closed)
    return screen.query_one(AskingPanel)


def kinds_of(fault: Fault) -> list[str]:
    """Return what was done about a fault, in order."""
    return [move.kind for move in fault.moves]


def seen(pilot: TangyPilot) -> str:
    """Return what can be read, on one line."""
    return " ".join(pilot.text().split())


# ------------------------------------------------------------------------------ looking


@pytest.mark.parametrize("at", ["playing", "paused"])
async def test_a_fault_is_told_at_the_next_look(
    run: Run, house: House, policy: Policy, at: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        _, game, world = game_of(pilot)
        if at == "paused":
            await pilot.press("p")
        looks: list[list[Event]] = []
        look = game.look

        def counted() -> list[Event]:
            looks.append(look())
            return looks[-1]

        monkeypatch.setattr(game, "look", counted)
        world.inject("laser-disconnected")
        await until(pilot, lambda: looks)
        assert any(isinstance(event, Diagnosed) for event in looks[0])
        assert game.halted is not None
        await halted(pilot)
        assert "Laser scanner silent" in pilot.text()


async def test_nothing_is_written_while_nothing_changes(
    run: Run, house: House, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        screen = game_of(pilot)[0]
        await pilot.press("p")
        told: list[Any] = []
        monkeypatch.setattr(screen._faults, "_tell", lambda *told_now: told.append(told_now))
        ticks = screen._faults.ticks
        await until(pilot, lambda: screen._faults.ticks > ticks + 2)
        assert not told


async def test_a_log_that_cannot_be_written_while_looking_stands_still_and_is_tried_again(
    run: Run, house: House, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    append = house.store.append

    def refuse(kind: str, *rest: object, **more: object) -> int:
        if kind == "fault":
            raise TangyError("The log cannot be written: the disk is full.")
        return append(kind, *rest, **more)  # type: ignore[arg-type]

    async with run(app=playing(house, policy)) as pilot:
        screen, _, world = game_of(pilot)
        with monkeypatch.context() as broken:
            broken.setattr(house.store, "append", refuse)
            world.inject("emergency-stop")
            await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
            count = screen.query_one(Transcript).count
            assert "the disk is full" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("p")
        await halted(pilot)
        assert screen.query_one(Transcript).count == count


# ------------------------------------------------------------------------------ standing still


@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_a_critical_fault_is_cleared_step_by_step_and_the_game_goes_on(
    run: Run, house: House, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(house, policy, speed=1000), size=size) as pilot:
        screen, game, _ = game_of(pilot)
        dialog = await halting(pilot)
        fault = dialog.fault
        count = screen.query_one(Transcript).count
        assert "! robot HALTED: Emergency stop press" in seen(pilot)
        assert "Somebody pressed the emergency stop." in seen(pilot)
        await pilot.press("c")
        await pilot.pause()
        assert "Press a first" in seen(pilot)
        await pilot.press("a", "c")
        await pilot.pause()
        assert "It is still there." in seen(pilot)
        assert game.halted is fault
        assert "g give up" in seen(pilot)
        await pilot.press("e", "c")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert kinds_of(fault) == [
            "halted",
            "acknowledged",
            "still there",
            "expert called",
            "cleared",
        ]
        assert screen.query_one(Transcript).count == count
        await pilot.press("p")
        await until(pilot, lambda: screen.query_one(Transcript).count > count)
        assert "robot OK" in seen(pilot)
    kept = read_faults(house.store)
    assert [kinds_of(fault) for fault in kept] == [kinds_of(fault)]
    assert {move.by for move in kept[0].moves} == {"", "ann"}


async def test_the_dialog_says_what_was_expected_and_observed_and_when(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy), size=MIDDLE) as pilot:
        await halting(pilot, "laser-disconnected")
        text = seen(pilot)
        assert "laser scanner: STALE: nothing comes from it" in text
        assert "to be expected: OK" in text
        assert "laser scanner, newest data: 2 s old" in text
        assert "at most 0.25 s old" in text
        assert "1. Do not push or pull the robot." in text
        assert "Call the expert for the robot with e." in text
        assert "0:31 halted" in text


async def test_keys_typed_before_the_dialog_could_be_seen_do_nothing(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        dialog = await halting(pilot)
        pilot.type("a", "e", "c", "g", "escape", at=0.0)
        await pilot.pause()
        assert kinds_of(dialog.fault) == ["halted"]
        assert pilot.app.screen is dialog


@pytest.mark.parametrize("key", ["g", "escape"])
async def test_giving_up_is_asked_about_and_esc_does_not_hide_it(
    run: Run, house: House, policy: Policy, key: str
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        screen, game, _ = game_of(pilot)
        dialog = await halting(pilot)
        await pilot.press(key)
        await until(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.pause()
        assert "not mended" in pilot.text()
        await pilot.press("escape")
        await pilot.pause()
        assert pilot.app.screen is dialog
        await pilot.press(key)
        await until(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.press("y")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert game.over
        assert kinds_of(dialog.fault)[-1] == "given up"
        assert "robot HALTED" in seen(pilot)
        ended = house.store.last("game ended")
        assert ended is not None
        assert "Emergency stop pressed" in str(ended.body["stopped"])


async def test_stop_works_inside_and_leaves_the_dialog(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, speed=1000)) as pilot:
        screen, _, world = game_of(pilot)
        world.inject("emergency-stop")
        dialog = await halted(pilot)
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert pilot.app.screen is dialog
        assert "STOPPED, HALTED" in seen(pilot)
        assert "p lets Tangy go on" in seen(pilot)
        count = screen.query_one(Transcript).count
        await pilot.press("g")
        await until(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert pilot.app.screen is dialog
        await pilot.press("e", "c")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert "STOPPED" in seen(pilot)
        for _ in range(3):
            await pilot.pause(0.02)
        assert screen.query_one(Transcript).count == count
        await pilot.press("p")
        await until(pilot, lambda: screen.query_one(Transcript).count > count)


async def test_two_critical_faults_are_cleared_one_after_the_other(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy), size=MIDDLE) as pilot:
        screen, game, world = game_of(pilot)
        first = await halting(pilot)
        world.inject("camera-disconnected")
        await until(pilot, lambda: len(game.faults) == 2)
        assert "Also wrong" in seen(pilot)
        await pilot.press("e", "c")
        await until(pilot, lambda: pilot.app.screen is not first)
        second = await halted(pilot)
        assert second.fault.code == "camera-disconnected"
        await pilot.press("e", "c")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert game.halted is None
        assert [fault.status for fault in game.faults] == [OVER, OVER]


async def test_a_critical_fault_comes_over_help_and_stays_when_that_goes(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        screen, _, world = game_of(pilot)
        await pilot.press("p", "question_mark")
        await pilot.pause()
        world.inject("emergency-stop")
        await halted(pilot)
        await pilot.press("e", "c")
        await until(pilot, lambda: isinstance(pilot.app.screen, HelpScreen))
        await pilot.press("escape")
        await pilot.pause()
        assert pilot.app.screen is screen


async def test_leaving_the_program_while_it_is_halted_ends_the_game_in_the_log(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        await halting(pilot)
        await pilot.press("ctrl+q")
    ended = house.store.last("game ended")
    assert ended is not None
    assert ended.body["stopped"] == "It was left before its end."


async def test_skipping_stops_where_tangy_stands_still(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, "base-stuck")) as pilot:
        screen = game_of(pilot)[0]
        await pilot.press("e")
        dialog = await halted(pilot)
        assert dialog.fault.code == "base-stuck"
        assert screen.query_one(RoomView).going is None
        count = screen.query_one(Transcript).count
        await pilot.press("e", "c")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert screen.query_one(Transcript).count - count <= 1
        await pilot.press("e")
        await until(pilot, lambda: screen._supervision.over)
        assert "The game is over" in screen.query_one(LogView).sentences[-1]


# ------------------------------------------------------------------------------------ asking


async def test_a_question_is_withdrawn_and_asked_again_after_clearing(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, "no-effect", speed=1000)) as pilot:
        screen, _, world = game_of(pilot)
        first = await asked(pilot)
        pilot.type(*"call number", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, QuestionDialog))
        world.inject("emergency-stop")
        await halted(pilot)
        await until(pilot, lambda: not screen.query(AskingPanel))
        assert not any(isinstance(s, QuestionDialog) for s in pilot.app.screen_stack)
        await pilot.press("e", "c")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert await asked(pilot) is not first
        assert "This was not to be expected" in seen(pilot)


async def test_what_was_not_expected_is_accepted_by_word(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, "no-effect", speed=1000)) as pilot:
        screen, game, _ = game_of(pilot)
        await asked(pilot)
        assert "If all is well, type: all right" in seen(pilot)
        pilot.type(*"all right", "enter")
        await until(pilot, lambda: kinds_of(game.faults[0])[-1] == "accepted")
        await pilot.press("e")
        await until(pilot, lambda: not screen.query(AskingPanel))
    accepted = house.store.last("effect accepted")
    assert accepted is not None
    assert accepted.body["by"] == "ann"


async def test_what_was_not_expected_is_accepted_by_key_but_not_after_a_stop(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, "no-effect", speed=1000)) as pilot:
        screen, game, _ = game_of(pilot)
        await asked(pilot)
        await pilot.press("escape")
        await pilot.pause()
        assert "r all right" in pilot.text()
        await pilot.press("ctrl+x", "r")
        await pilot.pause()
        assert game.question is not None
        assert "press p to go on first" in seen(pilot)
        await pilot.press("p", "escape", "w")
        await until(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        assert "If all is well, say so" in seen(pilot)
        await pilot.press("escape", "r")
        await until(pilot, lambda: game.faults[0].status == OVER)
        assert kinds_of(game.faults[0])[-1] == "accepted"
        await until(pilot, lambda: not screen.query(AskingPanel))


# -------------------------------------------------------------------------- banner and list


async def test_a_borne_fault_stays_in_the_banner_until_it_is_seen(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, speed=1000)) as pilot:
        screen, game, world = game_of(pilot)
        banner = screen.query_one(FaultBanner)
        assert not banner.display
        world.inject("arm-failed")
        await until(pilot, lambda: game.faults and game.faults[0].status == BORNE)
        await pilot.press("p")
        await pilot.pause()
        line = pilot.lines()[1]
        assert line.strip().startswith("! FAULT non-critical: An arm does not work")
        assert "going on without" in line
        assert line.endswith("[a] seen")
        assert "robot WARN: An arm does not work" in pilot.lines()[0]
        await pilot.press("a")
        await pilot.pause()
        assert not banner.display
        assert game.faults[0].acknowledged
        assert "robot WARN" in pilot.lines()[0]
        await pilot.press("a")
        await pilot.pause()
        assert screen.query_one(LogView).sentences[-1] == "No fault that nobody has seen."


async def test_what_tangy_says_when_it_asks_for_help_is_seen_and_heard(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, "camera-occluded@2")) as pilot:
        screen, game, _ = game_of(pilot)
        await pilot.press("p")
        while not any("asked" in kinds_of(fault) for fault in game.faults):
            await pilot.press("n")
            await pilot.pause()
        said = "Something covers my eyes. Could somebody please take it away?"
        assert said in screen.query_one(LogView).sentences
        assert screen.query_one(RoomView)._speech == said
        number = screen.query_one(Transcript).count
        assert number == len(screen._picture.grounds) == game.steps


async def test_a_try_is_seen_before_what_came_of_it(run: Run, house: House, policy: Policy) -> None:
    async with run(app=playing(house, policy), size=MIDDLE) as pilot:
        screen, game, world = game_of(pilot)
        world.inject("camera-occluded")
        await until(pilot, lambda: screen.query_one(FaultBanner).display)
        await pilot.press("full_stop")  # the step's time is over
        await until(pilot, lambda: "asked" in kinds_of(game.faults[0]))
        assert "asking those at the table, try 1 of 2" in screen.query_one(FaultBanner).words
        assert not any("recovered" in said for said in screen.query_one(LogView).sentences)
        await pilot.press("e")
        await until(pilot, lambda: game.over)
        assert any("camera covered: recovered" in said for said in _log(screen))


def _log(screen: PlayScreen) -> list[str]:
    return list(screen.query_one(LogView).sentences)


@pytest.mark.parametrize("size", [TINY, MIDDLE], ids=["tiny", "middle"])
async def test_the_list_is_filtered_by_words_and_tells_of_a_fault(
    run: Run, house: House, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(house, policy, speed=1000), size=size) as pilot:
        screen, game, world = game_of(pilot)
        for kind in ("arm-failed", "requests-silent"):
            world.inject(kind)
        await until(pilot, lambda: [f.status for f in game.faults] == [BORNE, BORNE])
        await pilot.press("p", "6")
        await pilot.pause()
        faults = screen.query_one(FaultList)
        assert faults.has_focus
        assert "An arm does" in pilot.text()
        assert "Request sensor" in pilot.text()
        await pilot.press("slash", *"sensor p")
        await pilot.pause()
        assert faults._keys == []
        await pilot.press("backspace", "backspace", "enter")
        await pilot.pause()
        assert [f.id for f in game.faults if f.code == "requests-silent"] == faults._keys
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        assert "Tangy cannot see who asks" in seen(pilot)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        assert pilot.app.screen is screen
        assert len(faults._keys) == 2


async def test_the_timeline_has_times_evidence_and_steps_for_staff(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy), size=MIDDLE) as pilot:
        await halting(pilot)
        await pilot.press("e", "c")
        await until(pilot, lambda: not isinstance(pilot.app.screen, CriticalDialog))
        await pilot.press("6", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        text = seen(pilot)
        for words in (
            "0:31 noticed",
            "0:31 halted",
            "0:31 the expert was called, by ann",
            "5:31 was cleared, by ann",
            "emergency stop, pressed: yes",
            "to be expected: no",
            "What should I do?",
            "2. Ask who pressed it, and why.",
        ):
            assert words in text


def test_nothing_heard_is_worded_otherwise_than_an_error() -> None:
    assert status_words(("STALE", "head camera")) == "STALE: nothing is heard from the head camera"
    assert status_words(("ERROR", "head camera")) == "ERROR: the head camera reports a failure"
    assert status_words(("OK", "")) == "OK"


# ------------------------------------------------------------------------ bringing faults about


@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_a_fault_is_brought_about_by_keys_and_lifted_again(
    run: Run, house: House, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(house, policy), size=size) as pilot:
        screen, game, world = game_of(pilot)
        await pilot.press("p", "f")
        await until(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        pilot.type(*"servo")
        await pilot.pause()
        assert "arm-failed" in pilot.text()
        assert "voice-dead" not in pilot.text()
        await pilot.press("enter")
        await until(pilot, lambda: game.faults)
        assert list(world.present) == ["arm-failed"]
        await pilot.press("f")
        await until(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        assert "there: enter lifts it" in pilot.text()
        await pilot.press("1")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert not world.present
        await pilot.press("f")
        await until(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert not world.present


async def test_what_is_still_to_come_can_be_lifted(run: Run, house: House, policy: Policy) -> None:
    async with run(app=playing(house, policy)) as pilot:
        screen, _, world = game_of(pilot)
        await pilot.press("p", "f")
        await until(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        pilot.type(*"never-complies", "enter")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert "comes as soon as it can show" in _log(screen)[-1]
        await pilot.press("f")
        await until(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        assert "to come: enter lifts it" in pilot.text()
        await pilot.press("enter")
        await until(pilot, lambda: pilot.app.screen is screen)
        assert not world._to_come


async def test_all_kinds_can_be_chosen(run: Run) -> None:
    dialog = InjectDialog((), ())
    async with run(size=SMALL) as pilot:
        pilot.app.push_screen(dialog)
        await pilot.pause()
        assert [kind.name for kind in dialog._kinds] == list(KINDS)


async def test_no_fault_can_be_brought_about_in_the_demo(
    run: Run, house: House, policy: Policy
) -> None:
    async with run(app=playing(house, policy, leave_after=1000)) as pilot:
        screen = game_of(pilot)[0]
        await pilot.press("f")
        await pilot.pause()
        assert pilot.app.screen is screen
        assert "nothing goes wrong" in _log(screen)[-1]


# ------------------------------------------------------------------------------------ pictures


@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_how_standing_still_looks(
    run: Run,
    house: House,
    policy: Policy,
    size: tuple[int, int],
    picture: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(house, policy), size=size) as pilot:
        await halting(pilot, "laser-disconnected")
        await pilot.press("a")
        await pilot.pause()
        picture(pilot.app)


@pytest.mark.parametrize("size", [SMALL, MIDDLE], ids=["small", "middle"])
async def test_how_banner_and_list_look(
    run: Run,
    house: House,
    policy: Policy,
    size: tuple[int, int],
    picture: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(house, policy), size=size) as pilot:
        game, world = game_of(pilot)[1:]
        await pilot.press("p")
        for kind in ("requests-silent", "arm-failed"):
            world.inject(kind)
            await until(pilot, lambda: len(game.faults) == len(world.present))
        while [fault.status for fault in game.faults] != [BORNE, BORNE]:
            await pilot.press("n")
            await pilot.pause()
        await pilot.press("6")
        await pilot.pause()
        picture(pilot.app)
