"""`tangy say`: speak a text as Tangy does in a game."""

from __future__ import annotations

import asyncio
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.command_line import throats
from tangy_tui.verbs.common import ActivityName, Data, Json, Seed, print_json

if TYPE_CHECKING:
    from tangy_hw.audio.synthesis import Synthesiser

SINKS = "auto, aplay, pw-play, paplay, afplay or null (silence that takes as long)"


def say(
    text: Annotated[str | None, typer.Argument(help="What to say, in quotes.")] = None,
    rate: Annotated[int | None, typer.Option(help="Words a minute, 80 to 260.")] = None,
    voice: Annotated[str | None, typer.Option(help="A voice, such as en-us or en-gb+f3.")] = None,
    sink: Annotated[str, typer.Option(help=f"Where it is heard: {SINKS}.")] = "auto",
    out: Annotated[
        Path | None, typer.Option(help="Write this WAV file instead of playing.")
    ] = None,
    voices: Annotated[bool, typer.Option("--voices", help="List the voices.")] = False,
    forget: Annotated[bool, typer.Option("--forget", help="Delete the cached speech.")] = False,
    activity: ActivityName = DEFAULT_ACTIVITY,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Speak a text as in a game, and print it.

    Where nothing can speak (no espeak-ng, no sound card), the text is printed, the reason goes to
    stderr, and the status is 0, as a game would go on as well. It is 1 where --out, --voices or a
    --sink other than auto asked for what cannot be had.
    """
    from tangy_hw.audio.number_reader import as_called, in_words, marked_up
    from tangy_hw.audio.player import SINKS
    from tangy_hw.audio.synthesis import (
        USUAL,
        NoSuchVoice,
        Synthesiser,
        VoiceError,
    )
    from tangy_profiles.activity import load_activity
    from tangy_profiles.reading import nearest
    from tangy_profiles.voice import VoicePreference
    from tangy_profiles.wav_length import wav_seconds

    synthesiser = Synthesiser()
    if forget:
        _forget(synthesiser, as_json)
        return
    if voices:
        _list(synthesiser, as_json)
        return
    wanted = VoicePreference(rate, voice).over(USUAL)
    if sink not in SINKS:
        raise TangyError(plain(f"--sink {sink[:40]!r} is not known; {nearest(sink, SINKS)}"))
    pieces = as_called(text or "", load_activity(activity).deck)
    if text is None or not pieces:
        raise TangyError("There is nothing to say: give a text, in quotes.")
    used, problem, seconds = "", "", 0.0
    try:
        wav = synthesiser.render(marked_up(pieces), wanted)
    except NoSuchVoice:
        raise
    except VoiceError as error:
        wav, problem = None, str(error)
    if wav is not None and out is not None:
        _write(wav, out)
    if not as_json:
        print(plain(text), flush=True)
    if wav is not None:
        seconds = wav_seconds(wav)
        if out is None:
            used, problem = asyncio.run(_play(wav, sink))
    if as_json:
        print_json(
            {
                "text": text,
                "said": in_words(pieces),
                "voice": wanted.voice,
                "rate": wanted.rate,
                "seconds": round(seconds, 3),
                "sink": used or None,
                "out": str(out) if out is not None and wav is not None else None,
                "problem": problem or None,
            }
        )
    if problem:
        print(f"tangy: {problem}", file=sys.stderr)
        if out is not None or sink != "auto":
            raise typer.Exit(1)


def _forget(synthesiser: Synthesiser, as_json: bool) -> None:
    """Empty the cache of speech, and print the number of lines deleted."""
    from tangy_tui.text.numbers import counted

    count = synthesiser.clear()
    if as_json:
        print_json({"deleted": count})
        return
    print(f"{counted(count, 'spoken line')} deleted.")


def _list(synthesiser: Synthesiser, as_json: bool) -> None:
    """Print the available voices and their variants."""
    from tangy_hw.audio.synthesis import VoiceError

    try:
        voices, variants = synthesiser.voices, sorted(synthesiser.variants)
    except VoiceError as error:
        print(f"tangy: {error}", file=sys.stderr)
        raise typer.Exit(1) from None
    if as_json:
        named = [{"voice": name, "title": title} for name, title in sorted(voices.items())]
        print_json({"voices": named, "variants": variants})
        return
    for name, title in sorted(voices.items()):
        print(f"{name:<20}  {title}")
    print(throats(variants))


def _write(wav: Path, out: Path) -> None:
    try:
        shutil.copyfile(wav, out)
    except OSError as error:
        raise TangyError(plain(f"{out}: cannot be written ({error.strerror}).")) from None


async def _play(wav: Path, sink: str) -> tuple[str, str]:
    """Play a WAV; return the name of the sink, and the problem, if any."""
    from tangy_hw.audio.player import PlayerError, open_player

    try:
        player = open_player(sink)
        await player.play(wav)
    except PlayerError as error:
        return "", str(error)
    return player.name, ""
