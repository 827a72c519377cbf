"""The key that has the last number called again, while Tangy is with somebody."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from tangy_tui.app.game_commands import CallAgain, GameCommand
from tangy_tui.text.control import waits_words
from tangy_tui.ui.screens.live_staff import LiveStaff


def test_it_waits_once_until_tangy_can() -> None:
    done, told = list[GameCommand](), list[str]()
    screen: Any = SimpleNamespace(
        working=1,
        _calls_again=False,
        _refused=lambda: False,
        _do=done.append,
        _tell_now=lambda sentence, kind: told.append(sentence),
        _workspace=SimpleNamespace(name=str),
    )
    for _ in range(2):
        LiveStaff.action_call_again(screen)
    assert done == [CallAgain()]
    words = "One moment: Tangy finishes this, then calls the last number again."
    assert told == [words] == [waits_words(CallAgain(), str)]
