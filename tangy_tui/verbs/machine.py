"""`tangy listen` and `tangy doctor`: what of this machine works, and what it hears."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tangy_profiles.reading import plain
from tangy_tui.verbs.common import ActivityName, Data, Json, Seed, print_json


def listen(
    files: Annotated[list[Path], typer.Argument(help="WAV files with one spoken command each.")],
    activity: ActivityName = "bingo",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Hear spoken commands in WAV files, and say what was understood."""
    from tangy_profiles.activity import load_activity
    from tangy_profiles.person import load_people
    from tangy_tui.learning.commands import Phrasebook
    from tangy_tui.learning.speech.listening import listen as hear

    heard = hear(files, Phrasebook(load_activity(activity), load_people(4)))
    if as_json:
        print_json(heard)
        return
    for one in heard:
        meaning = one["behaviour"] or "not understood"
        print(plain(f"{one['file']}: {one['heard']!r} -> {meaning} ({one['confidence']:.0%})"))


def doctor(seed: Seed = None, data: Data = None, as_json: Json = False) -> None:
    """Say what of this machine works: terminal, store, speech, voice, microphone."""
    from tangy_tui.doctor import examine
    from tangy_tui.house import data_folder

    findings = examine(data_folder(data))
    if as_json:
        print_json(
            [{"part": f.part, "ok": f.ok, "state": f.state, "text": f.text} for f in findings]
        )
        return
    for finding in findings:
        print(f"{finding.state:<7}  {finding.part}: {finding.text}")
