"""Recordings of teaching, stored with consent: a labelled data set for practice.

Each utterance is in the folder of its verified command, DATA/recordings/INTENT/TIME-N.wav, which
`tangy listen --bench DATA/recordings` reads. The label is the command that the teacher confirmed.
Nothing else is stored, as it may be the speech of people who never agreed.
"""

from __future__ import annotations

import errno
import os
import re
import wave
from collections.abc import Callable, Iterable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

from tangy_hw.audio.wav import RATE
from tangy_profiles.errors import TangyError
from tangy_profiles.people_records import RecordingConsent, RecordingsForgotten
from tangy_profiles.reading import plain
from tangy_profiles.store import Store
from tangy_tui.learning.teaching_events import (
    Begun,
    Executed,
    RuleUndone,
    StepUndone,
    TeachingEvent,
)
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Rejected,
    Reply,
    Say,
    StopCommand,
)

FOLDER = "recordings"  # in the data folder
_OURS = re.compile(r"\d{8}T\d{6}-\d+\.wav")


def consented(store: Store, teacher: str) -> bool:
    """Return whether a teacher's consent to recording is in force."""
    agreed = False
    for event in store.events(RecordingConsent, RecordingsForgotten):
        match event.record:
            case RecordingsForgotten():
                agreed = False
            case RecordingConsent(who=who, yes=yes) if who == teacher:
                agreed = yes
    return agreed


def consent(store: Store, teacher: str, yes: bool) -> None:
    """Log whether a teacher agreed to be recorded."""
    store.append(RecordingConsent(who=teacher, yes=yes))


def forget_recordings(store: Store) -> tuple[int, int]:
    """Delete every recording, and withdraw all consent.

    Returns:
        The number of deleted recordings, and of other files and links that were left.

    Raises:
        StoreError: the log cannot be written.
        OSError: a recording cannot be deleted.
    """
    top = store.folder / FOLDER
    deleted = left = 0
    store.append(RecordingsForgotten())
    if top.is_symlink() or not top.is_dir():
        return 0, int(top.is_symlink() or top.exists())
    for folder in top.iterdir():
        if folder.is_symlink() or not folder.is_dir():
            left += 1
            continue
        for file in folder.iterdir():
            if _OURS.fullmatch(file.name.removeprefix(".")) and not file.is_symlink():
                file.unlink()
                deleted += 1
            else:
                left += 1
        with suppress(OSError):
            folder.rmdir()  # unless other files are in it
    with suppress(OSError):
        top.rmdir()
    return deleted, left


class Recorder:
    """Stores verified utterances only. Ask for consent first.

    Pass every spoken command to `heard`, then the following events to `follow`.
    """

    def __init__(
        self,
        folder: Path,
        teacher: str,
        *,
        now: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        """Record into a data folder.

        Args:
            folder: the data folder.
            teacher: the speaker, who is not stored with the recordings.
            now: the clock for file names.

        Raises:
            TangyError: the folder of recordings is a symbolic link, or cannot be made private.
        """
        self.folder = folder / FOLDER
        self.teacher = teacher
        self.kept = 0
        """How many recordings were stored."""
        self.tell: Callable[[str], None] = lambda why: None
        """Called with the folder and the reason when recording fails."""
        self._now = now
        self._pcm = b""  # of the command that is not verified yet
        self._texts: frozenset[str] = frozenset()  # possible texts in its question
        self._named: frozenset[tuple[str, str | None]] = frozenset()  # possible meanings
        self._works = True
        if self.folder.is_symlink():  # a linked folder would not be deleted
            raise TangyError(
                plain(f"{self.folder}: is a symbolic link; make it a folder to record into.")
            )
        if self.folder.is_dir():
            try:
                self.folder.chmod(0o700)
            except OSError as error:
                why = f"others may read it, and that cannot be changed ({error.strerror})"
                raise TangyError(plain(f"{self.folder}: {why}; move it away to record.")) from None

    def heard(self, pcm: bytes, command: Say | StopCommand | Reply) -> None:
        """Remember a command with its sound (16 kHz mono s16le; b"" if it was typed)."""
        if isinstance(command, Reply):
            return  # the answered question is still about the earlier utterance
        self._pcm = b""
        if isinstance(command, Say) and command.commands:
            self._pcm = pcm
            self._texts = frozenset((command.text, *(c.heard for c in command.commands)))
            self._named = frozenset(
                (c.behaviour, c.arguments.get("user")) for c in command.commands
            )

    def follow(self, events: Iterable[TeachingEvent]) -> None:
        """Label the last utterance with the executed behaviour."""
        for event in events:
            match event:
                case Executed(step=step):
                    self.verified(step.behaviour, step.target)
                case Rejected() | NotUnderstood() | Begun() | StepUndone() | RuleUndone():
                    self._pcm = b""
                case Refused(heard=text) if text:  # without a text the question stays open
                    self._pcm = b""
                case (Asked() | Offered()) as question if question.heard not in self._texts:
                    self._pcm = b""  # it is about other, typed text
                case _:
                    pass

    def verified(self, behaviour: str, target: str | None) -> None:
        """Store the last utterance labelled by a behaviour, and by the person if it named one.

        Most behaviours are for the person Tangy is with, who was not named. A behaviour that the
        utterance cannot mean was requested in another way.
        """
        pcm, self._pcm = self._pcm, b""
        if not pcm or not self._works or behaviour not in {meant for meant, _ in self._named}:
            return
        named = target if (behaviour, target) in self._named else None
        label = " ".join(filter(None, (behaviour, named)))
        try:
            self._write(pcm, self.folder / re.sub(r"\W+", "-", label))
            self.kept += 1
        except OSError as error:
            self._works = False
            self.tell(f"{self.folder} ({error.strerror})")

    def _write(self, pcm: bytes, folder: Path) -> None:
        """Write a file atomically, readable by its owner only."""
        for place in (folder.parent, folder):
            if place.is_symlink():
                raise OSError(errno.ELOOP, "it is, or holds, a symbolic link")
            place.mkdir(mode=0o700, exist_ok=True)
            place.chmod(0o700)  # it may have existed before
        time = self._now().astimezone(UTC).strftime("%Y%m%dT%H%M%S")
        number = 1
        while (file := folder / f"{time}-{number}.wav").exists():
            number += 1
        begun = folder / f".{file.name}"
        descriptor = os.open(begun, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        with os.fdopen(descriptor, "wb") as raw, wave.open(raw, "wb") as written:
            written.setparams((1, 2, RATE, 0, "NONE", ""))
            written.writeframes(pcm)
        begun.rename(file)
