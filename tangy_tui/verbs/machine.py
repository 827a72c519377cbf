"""`tangy doctor`: what of this machine works."""

from __future__ import annotations

from tangy_tui.verbs.common import Data, Json, Seed, print_json


def doctor(seed: Seed = None, data: Data = None, as_json: Json = False) -> None:
    """Say what of this machine works: terminal, store, speech, voice, microphone, camera."""
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
