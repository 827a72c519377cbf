"""`tangy doctor`: what of this machine works."""

from __future__ import annotations

from typing import Annotated

import typer

from tangy_tui.verbs.common import ActivityName, Data, Json, Seed, print_json


def doctor(
    robot: Annotated[
        str | None, typer.Option(help="Try this robot's devices, too: its name, or its TOML.")
    ] = None,
    activity: ActivityName = "bingo",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Say what of this machine works: terminal, store, speech, voice, microphone, camera.

    With --robot each driver that the robot's profile names is tried, too; nothing is moved.
    """
    from tangy_tui.doctor import examine, examine_robot
    from tangy_tui.house import data_folder

    findings = examine(data_folder(data))
    if robot is not None:
        from tangy_hw.sensors import camera_sources
        from tangy_profiles.activity import load_activity
        from tangy_profiles.robot import load_robot

        body = load_robot(robot)
        findings += examine_robot(body, load_activity(activity), camera_sources(body))
    if as_json:
        print_json(
            [{"part": f.part, "ok": f.ok, "state": f.state, "text": f.text} for f in findings]
        )
        return
    for finding in findings:
        print(f"{finding.state:<7}  {finding.part}: {finding.text}")
