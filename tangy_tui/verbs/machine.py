"""`tangy doctor`: check which parts of this machine work."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tangy_profiles.reading import plain
from tangy_tui.text.command_line import log_hints
from tangy_tui.verbs.common import ActivityName, Data, Json, Seed, print_json


def _print_logs(folder: Path, *, as_json: bool) -> None:
    """Print the paths of the logs of a data folder, and how to follow one command through them."""
    from tangy_profiles.process_log import LEVEL, LOGS

    rows = [
        {
            "file": str(folder / name),
            "of": of,
            "bytes": (folder / name).stat().st_size if (folder / name).is_file() else None,
        }
        for name, of in LOGS.items()
    ]
    if as_json:
        print_json(rows)
        return
    for row in rows:
        size = "not yet" if row["bytes"] is None else f"{row['bytes']:,} bytes"
        print(plain(f"{row['file']}: {row['of']} ({size})"))
    print(*log_hints(LEVEL), sep="\n")


def doctor(
    robot: Annotated[
        str | None, typer.Option(help="Try this robot's devices, too: its name, or its TOML.")
    ] = None,
    logs: Annotated[bool, typer.Option("--logs", help="Show where each process logs.")] = False,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Check this machine, and a robot with --robot.

    It checks the terminal, data folder, speech, voice, microphone and camera.

    With --robot it also tries each driver in the robot's file, without moving anything, sends each
    contact in that file a test message, and draws the robot's body. The exit status is 1 if the
    data folder, a device of that robot, or a call does not work.
    """
    from tangy_tui.app.workspace import data_folder

    if logs:
        _print_logs(data_folder(data), as_json=as_json)
        return
    from tangy_tui.doctor import examine, examine_contacts, examine_robot

    findings = examine(data_folder(data))
    wanted = {"data folder"}  # parts that were asked for; Tangy can do without the others
    drawing: list[str] = []
    if robot is not None:
        from tangy_hw.perception.camera_hub import camera_sources
        from tangy_profiles.activity import load_activity
        from tangy_profiles.robot import load_robot
        from tangy_tui.app.chosen_activity import chosen_activity
        from tangy_tui.text.body import assumed_words, draw_body

        body = load_robot(robot)
        game = load_activity(activity or chosen_activity(data_folder(data)))
        cameras = camera_sources(body)
        tried = examine_robot(body, game, cameras, folder=data_folder(data))
        tried += examine_contacts(body)
        drawing = draw_body(body.body)
        drawing += assumed_words(body.body) if body.drivers else []
        wanted |= {finding.part for finding in tried}
        findings += tried
    if as_json:
        print_json(
            [{"part": f.part, "ok": f.ok, "state": f.state, "text": f.text} for f in findings]
        )
    else:
        for finding in findings:
            print(f"{finding.state:<7}  {finding.part}: {finding.text}")
        if drawing:
            print("", *drawing, sep="\n")
    if any(finding.broken and finding.part in wanted for finding in findings):
        raise typer.Exit(1)
