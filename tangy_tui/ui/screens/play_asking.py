"""Asking in a game, as the playing screen sees it: it waits for the answer, and learns it."""

from __future__ import annotations

from contextlib import suppress

from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.learning.verification import Verified
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.ui.game_voice import GameVoice
from tangy_tui.ui.screens.play_keys import NOT_ACCEPTABLE
from tangy_tui.ui.screens.play_panels import PlayPanels
from tangy_tui.ui.screens.question_panel import AskingPanel, Instead, learn_answer


class PlayAsking(PlayPanels):
    """Puts what Tangy asks in a game to the teacher, who may type the answer or say it."""

    def __init__(self, workspace: Workspace, supervision: Supervision, teacher: str) -> None:
        """Make the panels; `teacher` answers."""
        super().__init__(workspace, supervision, teacher)
        self._teacher = teacher
        self._voice = GameVoice(workspace)
        self._stopped = False
        self._learning = False

    def _show_status(self) -> None:
        """Show how things stand."""
        raise NotImplementedError

    async def _ask(self, question: Unsure, *, wanted: bool = False) -> None:
        """Wait for the teacher's answer, learn it beside the screen, and go on.

        Where it was `wanted` to be asked it can also be left, and Tangy goes on by itself.
        """
        self.minimize()
        self.app.clear_notifications()  # they would lie over the question
        learnt, self._picture.lesson = self._picture.lesson, ""
        asking = AskingPanel(self._workspace, self._supervision, question, learnt, wanted=wanted)
        self.add_class("-asking")
        await self.mount(asking, before="#microphone" if self.query("#microphone") else "#keys")
        if self._stopped:
            asking.hold(True)
        self._show_status()
        try:
            answer = await asking.answer()
        finally:
            self.remove_class("-asking")
            with suppress(Exception):  # the screen may be going as well
                await asking.remove()
        match answer:
            case Instead.WITHDRAWN:
                pass
            case Instead.GIVE_UP:
                self._tell(self._supervision.give_up(), True)
            case Instead.ACCEPT:
                self._tell(self._supervision.accept(self._teacher))
            case Verified():
                self._tell(await self._learn(answer))

    async def _learn(self, answer: Verified) -> list[Event]:
        """Act on an answer and learn from it; nothing else is done or looked at meanwhile."""
        self._learning = self._faults.busy = True
        self._show_status()
        try:
            return await learn_answer(self, self._supervision, answer, self._teacher)
        finally:
            self._learning = self._faults.busy = False

    def action_accept(self) -> None:
        """Say that what Tangy asks about is all right."""
        if (asking := self._asking) is None or not asking.accept():
            self._tell_now(NOT_ACCEPTABLE, "dim")
