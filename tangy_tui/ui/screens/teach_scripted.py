"""The scripted teacher on the teaching screen, at a pace that people can follow."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from textual.screen import Screen

from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import TeachingEvent
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, Reply, Say
from tangy_tui.ui.base import on_top
from tangy_tui.ui.widgets.command_bar import CommandBar


async def follow_script(
    screen: Screen[Any],
    teaching: TeachingSession,
    pace: float,
    tell: Callable[[Sequence[TeachingEvent]], None],
) -> None:
    """Let the scripted teacher type and answer like a person; it waits for dialogs.

    Args:
        screen: the teaching screen.
        teaching: the session.
        pace: in steps a second.
        tell: shows events.
    """
    teacher = ScriptedTeacher(teaching)
    bar = screen.query_one(CommandBar)
    while not teaching.demonstration.finished:
        await on_top(screen)
        command = teacher.command()
        if isinstance(command, Say):
            bar.restore(command.text)
            await asyncio.sleep(0.4 / pace)
        events = teaching.apply(command)
        if events and isinstance(events[0], Asked):
            events = teaching.apply(Reply(yes=True))
        bar.restore("")
        tell(events)
        await asyncio.sleep(0.6 / pace)
    await on_top(screen)
