"""The options for speech input that commands share, and the recogniser that they open."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.verbs.common import as_given

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.language.commands import Phrasebook
    from tangy_tui.speech.input import SpeechInput
    from tangy_tui.speech.recordings import Recorder

Mic = Annotated[
    str | None,
    typer.Option(
        metavar="SOURCE",
        help="Listen to arecord (a local microphone; arecord:DEVICE for one of several), "
        "socket (a laptop's, see `tangy mic`), FILE.wav or - (standard input).",
    ),
]
HandsFree = Annotated[
    bool, typer.Option("--hands-free", help="Listen all the time, not only after t.")
]
SpokenAnswers = Annotated[
    bool, typer.Option("--spoken-answers", help="Also take yes, no and people's answers by voice.")
]
Mode = Annotated[
    str | None,
    typer.Option(help="How spoken words are matched: tiers, or paper (n-gram and keywords)."),
]
Record = Annotated[
    bool, typer.Option("--record", help="Keep what you say, if you agree, to practise on.")
]
WithVoice = Annotated[bool, typer.Option("--voice", help="Let Tangy speak (on the screen).")]


@dataclass(frozen=True, slots=True)
class Listening:
    """The options for speech input."""

    mic: str | None
    hands_free: bool = False
    answers: bool = False
    mode: str | None = None
    record: bool = False

    def check(self) -> None:
        """Check that the options name a microphone.

        Raises:
            TangyError: there are other options, but no microphone.
        """
        if self.mic is None and (self.hands_free or self.answers or self.mode or self.record):
            raise TangyError("There is nothing to listen to: name a microphone with --mic.")

    def ears(
        self,
        workspace: Workspace,
        phrasebook: Phrasebook,
        who: str,
        *,
        sound: int,
        spoken: bool = False,
    ) -> SpeechInput | None:
        """Open the recogniser, if one is wanted.

        Args:
            workspace: its settings and recordings are used.
            phrasebook: the phrases to recognise.
            who: the teacher who speaks.
            sound: the file descriptor for `-`.
            spoken: treat a recording as live speech.

        Raises:
            TangyError: the microphone cannot be used, or there is no terminal to ask for consent.
        """
        if self.mic is None:
            return None
        from tangy_tui.app.microphones import settings_for
        from tangy_tui.speech.input import SpeechInput

        return SpeechInput(
            self.mic,
            phrasebook,
            settings=settings_for(
                workspace.store, self.mic, self.mode or workspace.activity.listening, who
            ),
            recorder=recorder_for(workspace, who) if self.record else None,
            hands_free=self.hands_free,
            answers=self.answers,
            spoken=spoken,
            stdin=sound,
            folder=workspace.store.folder,
        )


def recorder_for(workspace: Workspace, teacher: str) -> Recorder | None:
    """Return a recorder for a teacher who consents; None without consent.

    Raises:
        TangyError: consent has to be asked for, and there is no terminal.
    """
    from tangy_tui.speech.recordings import FOLDER, Recorder, consent, consented
    from tangy_tui.text.hearing import consent_question

    if not consented(workspace.store, teacher):
        if not sys.stdin.isatty():
            raise TangyError(
                "--record: say yes to it once on a terminal; nothing is recorded before."
            )
        question = consent_question(workspace.store.folder / FOLDER, _options(workspace))
        yes = typer.confirm(plain(question), default=False, err=True)
        consent(workspace.store, teacher, yes)
        if not yes:
            return None
    return Recorder(workspace.store.folder, teacher)


def _options(workspace: Workspace) -> str:
    """Return the options with which another command uses the same data folder."""
    from tangy_tui.app.workspace import data_folder

    folder = workspace.store.folder
    return as_given(None if folder == data_folder(None) else folder)
