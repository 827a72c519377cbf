"""Transcription of recordings: the words in each, and their commands."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tangy_hw.audio.wav import HEADER, read_header, read_wav
from tangy_profiles.given_file import read_given_text
from tangy_profiles.reading import plain
from tangy_tui.language.commands import Command, Phrasebook
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.learning.verification import Say, StopCommand
from tangy_tui.speech.evidence import LONGEST, RATE, USUAL, EvidenceSettings
from tangy_tui.speech.recogniser import Recogniser
from tangy_tui.speech.understanding import clearly_heard, understand, wanted

LARGEST_TEXT = 10_000_000  # bytes of a file with sentences
Row = dict[str, Any]


def listen(
    files: Sequence[Path],
    phrasebook: Phrasebook,
    settings: EvidenceSettings = USUAL,
    tell: Callable[[int, Sequence[Row]], None] = lambda done, rows: None,
) -> list[Row]:
    """Decode WAV files: one row for each command in them, in order.

    A row has file, heard, tier (sure, unsure, nothing, stop), behaviour (if sure), arguments,
    confidence, and choices, likeliest first. A file is decoded as one command; if the result is not
    sure, or the file too long, it is split at its pauses.

    Args:
        files: the files; all are checked first.
        phrasebook: the phrases.
        settings: the recognition settings.
        tell: called after each file with the number done, and its rows.

    Raises:
        SoundError: a file is missing or is no sound file; the message names it.
        SpeechUnavailable: the worker cannot run here.
    """
    for file in files:
        _look_at(file)
    return asyncio.run(_listen(files, phrasebook, settings, tell)) if files else []


def read_lines(file: Path, phrasebook: Phrasebook, settings: EvidenceSettings = USUAL) -> list[Row]:
    """Understand each line of a file as if it had been spoken; one row (see `listen`) per line.

    Raises:
        TangyError: the file is missing, too large, or not text; the message names it.
    """
    lines = read_given_text(file, LARGEST_TEXT).split("\n")
    if lines[-1] == "":  # after the final line break
        lines.pop()
    said = (understand(clearly_heard(line), phrasebook, settings) for line in lines)
    return [_row(file, one) for one in said]


def _look_at(file: Path) -> None:
    """Reject a file that is no WAV file, before decoding any."""
    if not file.is_file() or not os.access(file, os.R_OK):
        read_wav(file)  # raises the error
    with file.open("rb") as opened:
        read_header(opened.read(HEADER), plain(str(file)))


async def _listen(
    files: Sequence[Path],
    phrasebook: Phrasebook,
    settings: EvidenceSettings,
    tell: Callable[[int, Sequence[Row]], None],
) -> list[Row]:
    recogniser = Recogniser()
    rows: list[Row] = []
    try:
        lexicon = Lexicon(phrasebook, suggest=lambda word: "")
        await recogniser.start(wanted(phrasebook, settings, lexicon.heard()))
        for done, file in enumerate(files, 1):
            pcm = read_wav(file)
            said = understand(await recogniser.decode(pcm), phrasebook, settings)
            settled = tier_of(said) in ("sure", "stop") and len(pcm) <= 2 * RATE * LONGEST
            pieces = [] if settled else await recogniser.pieces(pcm)
            found = [_row(file, said)]
            if len(pieces) > 1:
                found = [
                    _row(file, understand(await recogniser.decode(piece), phrasebook, settings))
                    for piece in pieces
                ]
            rows += found
            tell(done, found)
    finally:
        await recogniser.close()
    return rows


def tier_of(said: Say | StopCommand) -> str:
    """Return the tier of a result: sure, unsure, nothing or stop."""
    if isinstance(said, StopCommand):
        return "stop"
    return "nothing" if not said.commands else "sure" if said.sure else "unsure"


def _row(file: Path, said: Say | StopCommand) -> Row:
    tier = tier_of(said)
    commands = said.commands or () if isinstance(said, Say) else ()
    first = commands[0] if tier == "sure" else None
    return {
        "file": os.fspath(file),
        "heard": said.text,
        "tier": tier,
        "behaviour": first.behaviour if first else None,
        "arguments": dict(first.arguments) if first else {},
        "confidence": round(said.confidence, 3) if isinstance(said, Say) else 1.0,
        "choices": [_choice(command) for command in commands],
    }


def _choice(command: Command) -> dict[str, Any]:
    return {"behaviour": command.behaviour, "arguments": dict(command.arguments)}
