"""The bench of typing drives the real program."""

from __future__ import annotations

from time import monotonic

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.experiments import terminal, typing
from tangy_tui.experiments.sweep import Where
from tangy_tui.experiments.terminal import Terminal


@pytest.mark.slow
def test_typed_steps_are_verified_and_stored() -> None:
    begun = monotonic()
    done = typing.run("bingo", [3], Where(), steps=4)
    seconds = monotonic() - begun
    assert done["steps"] == 4
    # Greet, call, and call again twice by the arrow: each with Enter and y.
    greet, call = (len(done["phrases"][name]) for name in ("greeting", "call number"))
    assert done["keys"] >= greet + call + 2 + 4 * 2
    pace = done["pace"]
    least = done["keys"] / pace["keys"] + 4 * (pace["look"] + pace["read"])
    assert least < 60 * done["minutes"] <= seconds
    assert 60 * done["machine_minutes"] == pytest.approx(60 * done["minutes"] - least)
    assert 0 < done["start_seconds"] < seconds
    assert done["ordinary"]["minutes"] > done["minutes"]


@pytest.mark.slow
def test_waiting_for_a_missing_question_times_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with Terminal(["--version"]) as shown:
        shown.until(lambda screen: "tangy" in screen.text, "its version")
    monkeypatch.setattr(terminal, "PATIENCE", 0.5)
    with (
        pytest.raises(TangyError, match="never showed the question"),
        Terminal(["doctor"]) as shown,
    ):
        shown.until(lambda screen: False, "the question")
