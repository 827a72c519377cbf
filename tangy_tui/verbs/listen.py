"""`tangy listen`: recognise recordings one by one, or score a folder of them."""

from __future__ import annotations

import asyncio
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.command_line import WHAT_TO_LISTEN_TO, cut_off, recordings_deleted
from tangy_tui.verbs.common import (
    REGISTERED,
    ActivityName,
    Data,
    Json,
    Seed,
    as_given,
    print_json,
    print_line,
)
from tangy_tui.verbs.opening import open_workspace, say_notices

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.language.commands import Phrasebook
    from tangy_tui.speech.evidence import EvidenceSettings

Tell: TypeAlias = Callable[[dict[str, Any]], str]
"""Explains a row of `listen` in words."""


def listen(
    files: Annotated[
        list[Path] | None, typer.Argument(help="WAV files with one spoken command each.")
    ] = None,
    bench: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Score all WAVs in DIR, named by what is said."),
    ] = None,
    text: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Read sentences instead of sound, one on each line."),
    ] = None,
    mode: Annotated[
        str | None,
        typer.Option(help="tiers, or paper (n-gram and keywords); default: as the activity sets."),
    ] = None,
    mic: Annotated[
        str | None,
        typer.Option(metavar="SOURCE", help="Use the settings found for this microphone."),
    ] = None,
    forget_recordings: Annotated[
        bool,
        typer.Option("--forget-recordings", help="Delete all recordings of `teach --record`."),
    ] = False,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Recognise spoken commands in WAV files.

    With --text it reads the words from a file, as if it had heard them clearly.

    With --bench every WAV below DIR is one whole utterance, and what was said in it is its name
    (call_number-3.wav) or that of its folder (call number/3.wav). Everything that is no command is
    named none, noise or speech, or lies in a folder of that name.
    """
    from tangy_tui.app.microphones import is_checked, settings_for
    from tangy_tui.app.teacher_profile import teacher_name

    if bool(files) + (bench is not None) + (text is not None) + forget_recordings != 1:
        raise TangyError(WHAT_TO_LISTEN_TO)
    with open_workspace(data, activity, REGISTERED, write=forget_recordings) as workspace:
        if forget_recordings:
            _forget(workspace, as_json)
            return
        who = teacher_name(None, workspace.store.folder)
        settings = settings_for(workspace.store, mic, mode or workspace.activity.listening, who)
        if mic is not None and not is_checked(workspace.store, mic):
            check = f"tangy mic check --mic {shlex.quote(mic)}{as_given(data)}"
            say_notices([f"{mic} was never checked, so the usual settings are used: {check}"])
        phrasebook = workspace.phrasebook()
        if bench is not None:
            _bench(bench, phrasebook, settings, as_json)
        elif text is not None:
            _read(text, phrasebook, settings, _told_by(workspace), as_json)
        else:
            _listen(files or [], phrasebook, settings, _told_by(workspace), as_json)


def _told_by(workspace: Workspace) -> Tell:
    """Return a function that explains a row of `listen`."""
    from tangy_tui.text.practice import meaning_words

    behaviours = workspace.activity.behaviours.values()
    questions = {behaviour.name: behaviour.question for behaviour in behaviours}
    return lambda row: meaning_words(row, questions, workspace.names)


def _listen(
    files: list[Path],
    phrasebook: Phrasebook,
    settings: EvidenceSettings,
    tell: Tell,
    as_json: bool,
) -> None:
    from tangy_tui.speech.transcription import listen as hear

    def show(done: int, rows: Sequence[dict[str, Any]]) -> None:
        for row in rows:
            print_line(plain(f"{row['file']}: {row['heard']!r} -> {tell(row)}"))

    if as_json:
        with told_progress() as progress:
            heard = hear(files, phrasebook, settings, lambda done, _: progress(done, len(files)))
        print_json(heard)
    else:
        hear(files, phrasebook, settings, show)
    say_notices([told for told in map(_cut_off, dict.fromkeys(files)) if told])


def _read(
    file: Path,
    phrasebook: Phrasebook,
    settings: EvidenceSettings,
    tell: Tell,
    as_json: bool,
) -> None:
    from tangy_tui.speech.transcription import read_lines

    rows = read_lines(file, phrasebook, settings)
    if as_json:
        print_json(rows)
        return
    for row in rows:
        print_line(plain(f"{row['heard']!r} -> {tell(row)}"))


def _cut_off(file: Path) -> str:
    """Tell how much is missing of a recording that ends too early; "" for others."""
    from tangy_hw.audio.wav import seconds_cut_off

    missing = seconds_cut_off(file)
    return cut_off(file, missing) if missing else ""


def _bench(folder: Path, phrasebook: Phrasebook, settings: EvidenceSettings, as_json: bool) -> None:
    from tangy_tui.language.labels import Labels
    from tangy_tui.language.lexicon import Lexicon
    from tangy_tui.speech.practice import Practice, practise
    from tangy_tui.speech.recogniser import Recogniser
    from tangy_tui.text.practice import practice_lines

    found = Labels(phrasebook).find(folder)
    heard = Lexicon(phrasebook, suggest=lambda word: "").heard()

    async def run(tell: Callable[[int, int], None]) -> Practice:
        recogniser = Recogniser()
        try:
            return await practise(found, phrasebook, settings, recogniser, tell, phrases=heard)
        finally:
            await recogniser.close()

    with told_progress() as tell:
        practice = asyncio.run(run(tell))
    if not practice.rows:
        of = len(found.recordings)
        none = "its one recording cannot" if of == 1 else f"none of its {of} recordings can"
        why = " ".join(practice.left_out[-1])
        raise TangyError(plain(f"{folder}: {none} be heard; {why}."))
    if as_json:
        print_json(practice.document())
        return
    for line in practice_lines(practice):
        print(line)


@contextmanager
def told_progress() -> Iterator[Callable[[int, int], None]]:
    """Show a progress bar if stderr is a terminal."""
    if not sys.stderr.isatty():
        yield lambda done, of: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as progress:
        bar = progress.add_task("Listening", total=None)
        yield lambda done, of: progress.update(bar, completed=done, total=of)


def _forget(workspace: Workspace, as_json: bool) -> None:
    from tangy_tui.speech.recordings import FOLDER, forget_recordings
    from tangy_tui.text.numbers import counted

    count, left = forget_recordings(workspace.store)
    if as_json:
        print_json({"deleted": count, "left": left})
        return
    print(recordings_deleted(count))
    if left:
        there = plain(str(workspace.store.folder / FOLDER))
        files = counted(left, "other file is", "other files are")
        print(f"{files} left in {there}.")
