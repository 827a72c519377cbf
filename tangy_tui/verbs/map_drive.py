"""`tangy map --drive`: record a drive by the keys to draw a map from."""

from __future__ import annotations

from pathlib import Path

import typer

from tangy_profiles.defaults import REGISTERED
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text import maps
from tangy_tui.text.command_line import SWITCHING_ON
from tangy_tui.verbs.opening import full_screen, open_workspace


def drive_for_map(
    yaml: Path | None, *, robot: str, bench: bool, seed: int, data: Path | None, ascii_only: bool
) -> Path:
    """Let staff drive, and return the log of scans, which is beside the file of the map.

    Raises:
        TangyError: there is no terminal, the log exists already, or the robot cannot be reached.
        Exit: staff left without a map.
    """
    if yaml is None:
        raise TangyError(maps.DRIVE_NEEDS_YAML)
    if not full_screen():
        raise TangyError(maps.DRIVE_NEEDS_SCREEN)
    record = yaml.with_name(f"{yaml.stem}-scans.log")
    if record.exists():
        raise TangyError(plain(maps.drive_is_there(str(record), str(yaml))))
    from tangy_tui.app.map_drive import opening_for_map
    from tangy_tui.app.switching_on import switched_on
    from tangy_tui.ui.run import run_map_drive

    with open_workspace(data, "", REGISTERED, write=False, robot=robot) as workspace:
        opening = opening_for_map(workspace, record.resolve(), bench=bench, seed=seed)
        typer.echo(SWITCHING_ON, err=True)
        with switched_on(opening, stepped=False) as link:
            done, status = run_map_drive(workspace, link, record, ascii_only=ascii_only)
    if status or not done:
        if record.exists() and record.stat().st_size:
            typer.echo(maps.kept_words(str(record)), err=True)
        raise typer.Exit(status)
    return record
