"""Tasks for the tests of sweeps, where processes of joblib can import them."""

from __future__ import annotations

from random import Random
from time import sleep
from typing import Any

from tangy_tui.experiments.sweep import Case, Settings


def draw(settings: Settings, case: Case) -> dict[str, Any]:
    """Draw some numbers; take a moment, and a different one for each case."""
    sleep(settings["seconds"] * (case[0] % 3))
    rng = Random(f"{settings['salt']}/{case[0]}")
    return {"case": list(case), "drawn": [rng.random() for _ in range(3)]}
