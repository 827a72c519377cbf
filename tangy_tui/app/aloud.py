"""Playback of a pronunciation, so that people can check it."""

from __future__ import annotations

import asyncio
from pathlib import Path
from tempfile import TemporaryDirectory

from tangy_profiles.voice import VoicePreference
from tangy_tui.language.pronunciation import to_espeak


async def hear(phones: str, preference: VoicePreference | None = None, sink: str = "auto") -> None:
    """Speak phones (a comma between words), and return when they have been played.

    The sound file is in a temporary folder, so that the sound of a name is stored nowhere.

    Raises:
        TangyError: espeak-ng is not installed, or there is no sound output; one sentence.
    """
    from tangy_hw.audio.player import open_player
    from tangy_hw.audio.synthesis import USUAL, Synthesiser

    with TemporaryDirectory(prefix="tangy-") as folder:
        synthesiser = Synthesiser(Path(folder))
        marked_up = f"<speak>{to_espeak(phones)}</speak>"
        wanted = (preference or USUAL).over(USUAL)
        wav = await asyncio.to_thread(synthesiser.render, marked_up, wanted)
        await open_player(sink).play(wav)
