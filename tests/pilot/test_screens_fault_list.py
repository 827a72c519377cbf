"""Banner, list and timeline of faults, and fault injection; driven with keys."""

from __future__ import annotations

import pytest

from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import BORNE
from tangy_tui.text.faults import status_words
from tangy_tui.text.games import NO_UNSEEN_FAULT
from tangy_tui.ui.dialogs.critical import CriticalDialog
from tangy_tui.ui.dialogs.fault import FaultDialog
from tangy_tui.ui.dialogs.inject import InjectDialog
from tangy_tui.ui.round_trip import ReplyParser
from tangy_tui.ui.widgets.fault_banner import FaultBanner
from tangy_tui.ui.widgets.fault_list import SHORTEST_LAST, FaultList, columns_for
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import SMALL, Run, type_at_once
from tests.pilot.faults import (
    MIDDLE,
    TINY,
    game_of,
    halting,
    kinds_of,
    playing,
    seen,
    sentences,
    sure,
)
from tests.support.waiting import until_shown


@pytest.mark.slow
async def test_a_tolerated_fault_stays_in_the_banner_until_it_is_seen(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, speed=1000)) as pilot:
        screen, game, world = game_of(pilot)
        banner = screen.query_one(FaultBanner)
        assert not banner.display
        world.inject("arm-failed")
        await until_shown(pilot, lambda: game.faults and game.faults[0].status == BORNE)
        await pilot.press("p")
        await pilot.pause()
        line = pilot.lines()[1]
        assert line.strip().startswith("! FAULT non-critical: An arm does not work")
        assert "going on without" in line
        assert line.endswith("[a] seen")
        assert "robot WARN: An arm does not work" in pilot.lines()[0]
        await sure(pilot, "a")
        await pilot.pause()
        assert not banner.display
        assert game.faults[0].acknowledged
        assert "robot WARN" in pilot.lines()[0]
        await pilot.press("a")
        await pilot.pause()
        assert pilot.app.screen is screen
        assert screen.query_one(LogView).sentences[-1] == NO_UNSEEN_FAULT


@pytest.mark.slow
async def test_a_request_for_help_is_shown_and_spoken(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, "camera-occluded@2")) as pilot:
        screen, game, _ = game_of(pilot)
        await pilot.press("p")
        while not any("asked" in kinds_of(fault) for fault in game.faults):
            await pilot.press("full_stop")
            await pilot.pause()
        said = "Something covers my eyes. Could somebody please take it away?"
        assert said in screen.query_one(LogView).sentences
        assert screen.query_one(RoomView).speech == said
        number = screen.query_one(Transcript).count
        assert number == len(screen.picture.grounds) == game.steps


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL, MIDDLE], ids=["tiny", "small", "middle"])
async def test_a_recovery_attempt_is_shown_before_its_result(
    run: Run, workspace: Workspace, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        screen, game, world = game_of(pilot)
        room = screen.query_one(RoomView)
        height = room.size.height
        world.inject("camera-occluded")
        # no key ends a step's time
        await until_shown(pilot, lambda: screen.query_one(FaultBanner).said)
        text = seen(pilot)
        assert "Head camera covered" in pilot.lines()[1]
        assert "asks (1 of 2)" in pilot.lines()[1]
        assert "“Something covers my eyes. Could somebody please take it away?”" in text
        assert "robot WARN: Head camera covered" in pilot.lines()[0]
        assert room.size.height == height or size == MIDDLE  # where the list appears, too
        assert not any("recovered" in said for said in sentences(screen))
        await sure(pilot, "a")
        await pilot.pause()
        assert not screen.query_one(FaultBanner).display
        assert NO_UNSEEN_FAULT not in sentences(screen)
        await sure(pilot, "E")
        await until_shown(pilot, lambda: game.over)
        assert any("camera covered: recovered" in said for said in sentences(screen))


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, MIDDLE], ids=["tiny", "middle"])
async def test_the_list_filters_by_words_and_opens_a_fault(
    run: Run, workspace: Workspace, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(workspace, policy, speed=1000), size=size) as pilot:
        screen, game, world = game_of(pilot)
        for kind in ("arm-failed", "requests-silent"):
            world.inject(kind)
        await until_shown(pilot, lambda: [f.status for f in game.faults] == [BORNE, BORNE])
        await pilot.press("p", "6")
        await pilot.pause()
        faults = screen.query_one(FaultList)
        assert faults.has_focus
        assert "An arm does" in pilot.text()
        assert "Request sensor" in pilot.text()
        await pilot.press("slash", *"sensor p")
        await pilot.pause()
        assert faults.shown_keys == []
        await pilot.press("backspace", "backspace", "enter")
        await pilot.pause()
        assert [f.id for f in game.faults if f.code == "requests-silent"] == faults.shown_keys
        await pilot.press("enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        assert "Tangy cannot see who asks" in seen(pilot)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        assert pilot.app.screen is screen
        assert len(faults.shown_keys) == 2


@pytest.mark.slow
async def test_the_list_can_fill_the_screen(run: Run, workspace: Workspace, policy: Policy) -> None:
    async with run(app=playing(workspace, policy, speed=1000)) as pilot:
        screen, game, world = game_of(pilot)
        world.inject("arm-failed")
        await until_shown(pilot, lambda: game.faults and game.faults[0].status == BORNE)
        await pilot.press("p", "6", "plus")
        await pilot.pause()
        assert screen.query_one(FaultList).size.height > SMALL[1] - 7
        assert "! FAULT" in pilot.text()  # the banner stays


@pytest.mark.parametrize("width", [56, 57, 76, 100])
def test_the_list_shows_the_last_action_at_every_width(width: int) -> None:
    columns = columns_for(width, 24)
    assert columns.last >= SHORTEST_LAST
    assert columns.name == 24
    wider = columns_for(width + 20, 24)
    assert (wider.time, wider.step, wider.state) >= (columns.time, columns.step, columns.state)


@pytest.mark.slow
async def test_the_timeline_has_times_evidence_and_steps_for_staff(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=MIDDLE) as pilot:
        await halting(pilot)
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: not isinstance(pilot.app.screen, CriticalDialog))
        await pilot.press("6", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        text = seen(pilot)
        for words in (
            "0:31 noticed",
            "0:31 halted",
            "0:31 ann saw whom to call",
            "5:31 was cleared by ann",
            "emergency stop, pressed: yes",
            "expected: no",
            "What should I do?",
            "2. Ask who pressed it, and why.",
        ):
            assert words in text


def test_a_silent_device_is_worded_differently_from_a_failed_one() -> None:
    assert status_words(("STALE", "head camera")) == "STALE: no data from the head camera"
    assert status_words(("ERROR", "head camera")) == "ERROR: the head camera failed"
    assert status_words(("OK", "")) == "OK"


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_a_fault_is_injected_and_lifted_by_keys(
    run: Run, workspace: Workspace, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        screen, game, world = game_of(pilot)
        await pilot.press("p", "f")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        pilot.type(*"servo")
        await pilot.pause()
        assert "arm-failed" in pilot.text()
        assert "voice-dead" not in pilot.text()
        await pilot.press("enter")
        await until_shown(pilot, lambda: game.faults)
        assert list(world.present) == ["arm-failed"]
        await pilot.press("f")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        assert "there: enter lifts it" in pilot.text()
        await pilot.press("1")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert not world.present
        await pilot.press("f")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        await pilot.press("escape")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert not world.present


@pytest.mark.slow
async def test_a_pending_injection_can_be_lifted(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen, _, world = game_of(pilot)
        await pilot.press("p", "f")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        pilot.type(*"never-complies", "enter")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        told = sentences(screen)[-1]
        assert "comes as soon as it can show: a person says no to every request." in told
        await pilot.press("f")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        assert "to come: enter lifts it" in pilot.text()
        await pilot.press("enter")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert not world.pending_injections


async def test_every_kind_of_fault_can_be_injected(run: Run) -> None:
    dialog = InjectDialog((), (), dict.fromkeys(KINDS, "") | {"camera-occluded": "Camera covered"})
    async with run(size=SMALL) as pilot:
        pilot.app.push_screen(dialog)
        await pilot.pause()
        assert [kind.name for kind in dialog.kinds] == list(KINDS)
        pilot.type(*"covered")  # the console's name of the fault, not the kind's name
        await until_shown(pilot, lambda: [k.name for k in dialog.kinds] == ["camera-occluded"])


async def test_letters_that_arrive_together_filter_the_kinds_and_their_digits_choose_none(
    run: Run,
) -> None:
    dialog = InjectDialog((), (), dict.fromkeys(KINDS, ""))
    async with run(size=SMALL) as pilot:
        pilot.app.push_screen(dialog)
        await pilot.pause()
        for message in ReplyParser().feed("camera 2"):
            pilot.app.post_message(message)
        await until_shown(pilot, lambda: "camera 2_" in pilot.text())
        assert pilot.app.screen is dialog and not dialog.kinds
        await pilot.press("backspace")
        await until_shown(pilot, lambda: {k.name for k in dialog.kinds} >= {"camera-occluded"})
        assert "emergency-stop" not in {k.name for k in dialog.kinds}


@pytest.mark.parametrize(
    ("keys", "answer"),
    [
        (("enter",), "camera-occluded"), (("2",), "emergency-stop"),
        ((*"laser-o", "enter"), "laser-occluded"), ((*"laser-o", "9", "enter"), "laser-occluded"),
        ((*"laser", "2"), "laser-occluded"), ((*"xyz", "escape", "enter"), "camera-occluded"),
        (("escape",), ""), ((*"xyz", "enter", "escape", "escape"), ""),
        (("down", "down", "enter"), "link-lost"),
    ],
)  # fmt: skip
async def test_a_kind_is_taken_by_number_or_enter_and_none_by_escape(
    keys: tuple[str, ...], answer: str, run: Run
) -> None:
    answers = list[str | None]()
    dialog = InjectDialog(("camera-occluded",), (), dict.fromkeys(KINDS, ""))
    async with run(size=SMALL) as pilot:
        pilot.app.push_screen(dialog, answers.append)
        await until_shown(pilot, lambda: dialog.focused is not None)
        await pilot.pause()
        pilot.type(*keys)
        await until_shown(pilot, lambda: answers == [answer or None])


@pytest.mark.slow
async def test_letters_typed_right_after_the_key_of_faults_go_to_their_list(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(MIDDLE, app=playing(workspace, policy)) as pilot:
        screen, game, _ = game_of(pilot)
        assert screen.control.going
        type_at_once(pilot.app, "f", "p", "u")  # p alone would pause the game
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, InjectDialog))
        await until_shown(pilot, lambda: "pu_" in pilot.text())
        assert screen.control.going and not game.faults
