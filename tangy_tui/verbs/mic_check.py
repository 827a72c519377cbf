"""`tangy mic check`: find the best settings for a microphone in its room."""

from __future__ import annotations

import asyncio
import sys
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.reading import plain
from tangy_tui.text.mic_check import (
    checked_document,
    checked_lines,
    news_words,
    numbered,
    reason_words,
)
from tangy_tui.verbs.common import REGISTERED, ActivityName, Data, Json, print_json, print_line
from tangy_tui.verbs.opening import open_workspace

if TYPE_CHECKING:
    from tangy_hw.audio.source import Source
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.language.commands import Phrasebook
    from tangy_tui.language.lexicon import Lexicon
    from tangy_tui.speech.calibration import CalibrationPrompt
    from tangy_tui.speech.microphone_check import CheckNews, CheckResult

ALONE = 3.0  # s without sound, after which an unattended check is given up


def check(
    mic: Annotated[
        str,
        typer.Option(metavar="SOURCE", help="arecord, socket, - (standard input) or FILE.wav."),
    ] = "arecord",
    forget: Annotated[
        bool, typer.Option("--forget", help="Use the usual settings again with this microphone.")
    ] = False,
    listed: Annotated[
        bool, typer.Option("--list", help="Print what to say, and check nothing.")
    ] = False,
    teacher: Annotated[
        str | None, typer.Option(help="Who speaks, so that Tangy knows their voice.")
    ] = None,
    activity: ActivityName = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Check a microphone, and adapt Tangy to it and to your voice.

    It takes a minute. Tangy keeps the settings for this microphone and room, and how your voice
    differs from those that it knows. It uses that whenever you teach or are on duty.

    Be quiet for 3 seconds, then say what is shown: six commands, three other sentences. Tangy keeps
    no sound. A WAV is taken for what you say: record 3 seconds of quiet,
    then what --list prints, in that order, with a second of quiet after each.

    The exit status is 1 if too little was understood, so that nothing is stored, and 2 if the
    microphone or the file gives no voice.
    """
    from tangy_hw.audio.sources import open_source
    from tangy_tui.app.microphones import forget as forget_check
    from tangy_tui.app.microphones import keep
    from tangy_tui.app.teacher_profile import teacher_name

    with open_workspace(data, activity, REGISTERED, write=not listed) as workspace:
        if listed:
            _list(workspace, as_json)
            return
        if forget:
            dropped = forget_check(workspace.store, mic)
            if as_json:
                print_json({"source": mic, "forgotten": dropped})
            else:
                print(plain(f"{mic}: {'forgotten' if dropped else 'nothing was stored'}."))
            return
        source = open_source(mic, folder=workspace.store.folder)
        checked = asyncio.run(_run(workspace, source, as_json))
        stored = checked.parted
        if stored:
            who = teacher_name(teacher, workspace.store.folder)
            keep(workspace.store, mic, checked.chosen, who)
        if as_json:
            print_json({"source": mic, "stored": stored, **checked_document(checked)})
        else:
            for line in checked_lines(checked, mic):
                print(plain(line))
        if not stored:
            print(f"tangy: {reason_words(checked)}", file=sys.stderr)
            raise typer.Exit(1)


def _list(workspace: Workspace, as_json: bool) -> None:
    """Print the sentences to say."""
    _, _, asked = _asked(workspace)
    if as_json:
        print_json([{"say": one.text, "command": one.meant is not None} for one in asked])
        return
    for line in numbered(asked):
        print(plain(line))


def _asked(workspace: Workspace) -> tuple[Phrasebook, Lexicon, list[CalibrationPrompt]]:
    """Return the phrasebook, its lexicon, and the sentences to say."""
    from tangy_tui.language.lexicon import Lexicon
    from tangy_tui.speech.microphone_check import to_say

    phrasebook = workspace.phrasebook()
    lexicon = Lexicon(phrasebook, suggest=lambda word: "")
    return phrasebook, lexicon, to_say(phrasebook, lexicon)


async def _run(workspace: Workspace, source: Source, as_json: bool) -> CheckResult:
    from tangy_tui.speech.microphone_check import MicrophoneCheck
    from tangy_tui.speech.recogniser import Recogniser

    def on_stderr(news: CheckNews) -> None:
        print(plain(news_words(news)), file=sys.stderr, flush=True)

    def on_stdout(news: CheckNews) -> None:
        print_line(plain(news_words(news)))

    phrasebook, lexicon, asked = _asked(workspace)
    tell = on_stderr if as_json else on_stdout
    recogniser = Recogniser()
    try:
        return await MicrophoneCheck(
            source,
            phrasebook,
            recogniser,
            asked,
            tell,
            lexicon.heard(),
            patience=patience(source.name),
        ).run()
    finally:
        await recogniser.close()


def patience(mic: str) -> float:
    """Return the time in seconds to plug in a microphone, or to start sending."""
    from tangy_tui.speech.microphone_check import PATIENCE

    from_elsewhere = mic.partition(":")[0] == "socket"
    return PATIENCE if sys.stderr.isatty() or from_elsewhere else ALONE
