"""What Tangy does in the console of a game, told while it does it, and not only after the step.

Also that the planned time is over: the game goes on.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from tangy_profiles.declared.speech import with_names
from tangy_profiles.present_moment import as_present
from tangy_tui.app.game_controller import GameController
from tangy_tui.interaction.game_events import Acted
from tangy_tui.text.games import says_line
from tangy_tui.text.planned_time import after_end_words, time_is_up_words
from tangy_tui.text.situations import Name
from tangy_tui.text.staff_view import said_words
from tangy_tui.text.telling import waiting_words


class ProgressLines:
    """Tells where the robot drives, what it says, and its question about a card."""

    def __init__(self, controller: GameController, name: Name) -> None:
        """Tell about the games of a controller; `name` returns a person's name for an id."""
        self._controller, self._name = controller, name
        self._going = ("", "", ("", tuple[str, ...]()))
        self._said = self._early = ""
        self._late: tuple[str, datetime] | None = None  # the game, and the end that was told

    @property
    def asks(self) -> bool:
        """Whether the robot asks staff about a card."""
        return bool(self._going[2][0])

    def news(self) -> list[str]:
        """Return the lines about what is new since the last call."""
        robot, world = self._controller.robot, self._controller.supervision.world
        told = list[str]()
        now = as_present(world)
        if now is not None and now.saying not in ("", self._said):
            self._said = now.saying
            self._early = with_names(now.saying, self._name)
            told.append(says_line(self._early))
        if (going := (robot.going, robot.lets, robot.asks_about)) != self._going:
            self._going = going
            told.append(waiting_words(*going, world.activity.object, self._name))
        told.append(self._time_is_up())
        return [line for line in told if line]

    def _time_is_up(self) -> str:
        """Return once in a game that the planned time is over; "" if there is nothing to tell."""
        game, time = self._controller.supervision, self._controller.time
        left, ends = time.left, time.ends
        if game.over or left is None or ends is None or left > 0:
            return ""
        late = game.game.game, ends
        if late == self._late:
            return ""
        self._late = late
        began_later = left + game.game.log.seconds <= 0
        return (after_end_words if began_later else time_is_up_words)(ends, time.clock())

    def resumed(self) -> list[str]:
        """Return the line about what the chest screen of a resumed game still shows."""
        now = as_present(self._controller.supervision.world)
        said = "" if now is None else with_names(now.said_before, self._name)
        return [said_words(said)] if said else []

    def step(self, acted: Acted, lines: Sequence[str]) -> list[str]:
        """Return the lines about a step without the words that were told while Tangy spoke."""
        now = as_present(self._controller.supervision.world)
        if now is not None and with_names(now.saying, self._name) == acted.speech:
            self._said = now.saying
        told, self._early = self._early == acted.speech, ""
        said = says_line(acted.speech)
        return [line for line in lines if not (told and line.strip() == said)]
