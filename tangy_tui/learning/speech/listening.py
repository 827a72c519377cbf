"""Recordings that are listened to: what was said in each, and what it commands."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tangy_hw.sound.wav import read_wav
from tangy_tui.learning.commands import Command, Phrasebook
from tangy_tui.learning.lexicon import Lexicon
from tangy_tui.learning.speech.evidence import LONGEST, RATE, USUAL, Settings
from tangy_tui.learning.speech.recogniser import Recogniser
from tangy_tui.learning.speech.understanding import understand, wanted
from tangy_tui.learning.verifying import Say, Stop


def listen(
    files: Sequence[Path], phrasebook: Phrasebook, settings: Settings = USUAL
) -> list[dict[str, Any]]:
    """Decode WAV files: one row for each command in them, in order.

    A row has file, heard, tier (sure, unsure, nothing, stop), behaviour (only of a sure one),
    arguments, confidence, and choices, which may be meant, the likeliest first. A file is heard as
    one command; if it is none for sure, or too long, and has pauses, what is between them.

    Raises:
        SoundError: a file is missing or cannot be read as sound; it is named.
        SpeechUnavailable: the worker cannot run here.
    """
    sounds = [(file, read_wav(file)) for file in files]
    return asyncio.run(_listen(sounds, phrasebook, settings)) if sounds else []


async def _listen(
    sounds: Sequence[tuple[Path, bytes]], phrasebook: Phrasebook, settings: Settings
) -> list[dict[str, Any]]:
    recogniser = Recogniser()
    rows: list[dict[str, Any]] = []
    try:
        lexicon = Lexicon(phrasebook, suggest=lambda word: "")
        await recogniser.start(wanted(phrasebook, settings, lexicon.heard()))
        for file, pcm in sounds:
            whole = understand(await recogniser.decode(pcm), phrasebook, settings)
            settled = tier_of(whole) in ("sure", "stop") and len(pcm) <= 2 * RATE * LONGEST
            pieces = [] if settled else await recogniser.pieces(pcm)
            if len(pieces) < 2:
                rows.append(_row(file, whole))
                continue
            for piece in pieces:
                said = understand(await recogniser.decode(piece), phrasebook, settings)
                rows.append(_row(file, said))
    finally:
        await recogniser.close()
    return rows


def tier_of(said: Say | Stop) -> str:
    """Return in one word what follows from an utterance: sure, unsure, nothing or stop."""
    if isinstance(said, Stop):
        return "stop"
    return "nothing" if not said.commands else "sure" if said.sure else "unsure"


def _row(file: Path, said: Say | Stop) -> dict[str, Any]:
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
