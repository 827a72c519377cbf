"""Cards, faces and sound, tried by lines before a live game, once the robot is on."""

from __future__ import annotations

from collections.abc import Callable

from tangy_tui.app.game_commands import GameCommand, HasCard
from tangy_tui.app.readiness import CheckName
from tangy_tui.app.set_up import SetUp
from tangy_tui.text import set_up as text

_CARD = ("card", "cards", "read card", "read a card")
_FACE = ("face", "faces", "who is there", "look")
_SOUND = ("sound", "speak", "say something")
_HEARD = ("heard", "i heard it", "heard it")


class TryingDevices:
    """Carries out the lines that let the robot read a card, recognise a face, or speak."""

    def __init__(self, setup: SetUp, write: Callable[[str], None]) -> None:
        """Try the robot of a set-up, which is on."""
        self._setup, self._write = setup, write

    def take(self, line: str, command: GameCommand | None, *, stopped: bool) -> bool:
        """Carry out a line; return whether it was one of these.

        Args:
            line: the line.
            command: the command of games that it means, if it means one.
            stopped: whether the robot was stopped: then it tries nothing.
        """
        words = " ".join(line.split()).strip(" .!?").casefold()
        tries = words in (*_CARD, *_FACE, *_SOUND)
        if not tries and words not in _HEARD and not isinstance(command, HasCard):
            return False
        if isinstance(command, HasCard):
            self._has(command.person, command.card)
        elif words in _HEARD:
            self._setup.heard = True
            self._write(text.line_of(self._setup.check("sound")))
        elif stopped:
            self._write(text.STOPPED)
        elif words in _CARD:
            self._look_at_card()
        elif words in _FACE:
            self._look_at_face()
        else:
            self._speak()
        return True

    def _can(self, name: CheckName) -> bool:
        """Return whether the robot has what it needs; otherwise tell that it has not."""
        check = self._setup.check(name)
        if check.state == "not told":
            self._write(text.line_of(check))
        return check.state != "not told"

    def _look_at_card(self) -> None:
        setup = self._setup
        if not self._can("cards"):
            return
        self._write(text.LOOKS)
        card = setup.look_at_card()
        if not card:
            self._write(text.BENCH_CARD if setup.on_bench else text.NO_CARD)
        elif holder := setup.holder(int(card)):
            self._has(holder, int(card))
        else:
            self._write(text.whose_line(card))

    def _has(self, person: str, card: int) -> None:
        self._setup.comes_with(card, person)
        self._write(text.card_seen_words(str(card), self._setup.workspace.name(person)))

    def _look_at_face(self) -> None:
        setup = self._setup
        if not self._can("faces"):
            return
        self._write(text.LOOKS)
        seen = setup.look_at_face()
        nobody = text.BENCH_FACE if setup.on_bench else text.NO_FACE_BY_LINES
        self._write(text.face_seen_words(setup.workspace.name(seen)) if seen else nobody)

    def _speak(self) -> None:
        if self._can("sound"):
            said = self._setup.speak(text.SOUND)
            self._write(text.SAID_BY_LINES if said else text.NO_SOUND)
