"""At the lines, staff go on without a device that blocks, or leave."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager

import pytest

from tangy_hw.device_protocols import DeviceFailed
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.leaving_out import leaves_out, on_or_without


def switched_on(
    workspace: Workspace, device: str, answer: str | None, told: list[str]
) -> AbstractContextManager[str]:
    """Switch a robot on of which one device blocks; staff answer once."""

    @contextmanager
    def switch_on() -> Iterator[str]:
        if device in workspace.robot.devices:
            raise DeviceFailed(device, f"{device}: its driver has not started within 27 s.")
        yield "on"

    return on_or_without(
        switch_on, lambda error: leaves_out(workspace, error, lambda: answer, told.append)
    )


@pytest.mark.parametrize("answer", ["y", "Yes", "yes please"])
def test_staff_at_the_lines_go_on_without_a_device_that_blocks(
    workspace: Workspace, answer: str
) -> None:
    told: list[str] = []
    with switched_on(workspace, "arms", answer, told) as robot:
        assert robot == "on"
    assert [device.name for device in workspace.robot.undriven] == ["arms"]
    assert "has not started within 27 s" in told[0] and "Tangy makes no gestures" in told[0]
    assert told[1] == "Go on without the arms? (y/n)"


@pytest.mark.parametrize("answer", ["n", "no", "", "what", None])
def test_without_a_yes_the_robot_stays_off(workspace: Workspace, answer: str | None) -> None:
    with pytest.raises(DeviceFailed), switched_on(workspace, "arms", answer, []):
        pass
    assert "arms" in workspace.robot.devices


@pytest.mark.parametrize("device", ["laser", "stop_button"])
def test_staff_are_not_asked_about_a_device_that_is_needed(
    workspace: Workspace, device: str
) -> None:
    told: list[str] = []
    with pytest.raises(DeviceFailed), switched_on(workspace, device, "yes", told):
        pass
    assert told == []
