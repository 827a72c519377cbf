"""Plays WAV files, with a program in a process of its own, or not at all (`null`)."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
import wave
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import Protocol

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_profiles.wav_length import wav_seconds

PROGRAMS = {
    "aplay": ("aplay", "-q"),
    "pw-play": ("pw-play",),
    "paplay": ("paplay",),
    "afplay": ("afplay",),
}
"""Programs that play a WAV, with their options; the first that works is used."""

SINKS = ("auto", *PROGRAMS, "null")
ABSENT = "no program that plays sound is installed (aplay is in alsa-utils)"
LATE = 10.0  # s that a player may exceed its WAV: it waits for a busy device
END_SECONDS = 1.0  # for a killed player to exit: 2 ms on an idle machine
TRY_SECONDS = 5.0  # timeout of the test with a moment of silence

# The player ends with this process, however it ends: the other end of the pipe closes, and the
# shell that reads from it kills the player. The shell waits for both, so that no zombie is left
# where nobody reaps it (in a container).
GUARDED = (
    "/bin/sh",
    "-c",
    """exec 3<&0 </dev/null
    "$@" 3<&- & player=$!
    (read -r _ <&3; kill -9 $player) >/dev/null 2>&1 & guard=$!
    exec 3<&- 2>/dev/null
    wait $player; status=$?
    kill -9 $guard; wait $guard
    exit $status""",
    "tangy",
)


class PlayerError(TangyError):
    """No sound can be played; one sentence that says why."""


class SoundPlayer(Protocol):
    """Plays WAV files, one at a time."""

    @property
    def name(self) -> str:
        """Its name: the program, or `null`."""

    async def play(self, wav: Path) -> None:
        """Play a WAV; return when it has ended, or was stopped.

        Raises:
            PlayerError: no sound comes out.
        """

    def stop(self) -> None:
        """Stop playing at once."""


class ProgramPlayer:
    """Plays with the first of several programs that works; a failed one is not retried."""

    def __init__(self, commands: Sequence[Sequence[str]], *, late: float = LATE) -> None:
        """Set the commands, to which the path of a WAV is added; `late` is in s.

        Raises:
            PlayerError: there are no commands.
        """
        if not commands:
            raise PlayerError(f"{ABSENT[0].upper()}{ABSENT[1:]}.")
        self._commands = [tuple(command) for command in commands]
        self._late = late
        self._holding: int | None = None
        self._stopped = False

    @property
    def name(self) -> str:
        """The current program."""
        return Path(self._commands[0][0]).name

    async def play(self, wav: Path) -> None:
        """Play a WAV; return when it has ended, or was stopped.

        Raises:
            PlayerError: every program failed, or exceeded the WAV's length by ten seconds.
        """
        while problem := await self._play(wav):
            if len(self._commands) == 1:
                raise PlayerError(f"No sound comes out of {self.name}: {problem}.")
            del self._commands[0]

    def stop(self) -> None:
        """Stop playing: the player is killed within a few milliseconds."""
        self._stopped = True
        self._let_go()

    async def _play(self, wav: Path) -> str:
        """Play a WAV with the first program; return the problem ("": none).

        The caller may be cancelled, but not during the start of a process: asyncio would then wait
        forever for its pipes.
        """
        self._stopped = False
        running = asyncio.create_task(self._run(wav))
        try:
            return await asyncio.shield(running)
        except asyncio.CancelledError:
            self.stop()
            await asyncio.wait({running})
            raise

    async def _run(self, wav: Path) -> str:
        if self._stopped:
            return ""
        reading, self._holding = os.pipe()
        try:
            process = await asyncio.create_subprocess_exec(
                *GUARDED,
                *self._commands[0],
                str(wav.absolute()),  # noqa: ASYNC240 - touches no disk
                stdin=reading,
                stdout=asyncio.subprocess.DEVNULL,
                stderr=asyncio.subprocess.PIPE,
                start_new_session=True,
            )
        except OSError as error:
            self._let_go()
            return f"it cannot be started ({error.strerror})"
        finally:
            os.close(reading)
        try:
            async with asyncio.timeout(wav_seconds(wav) + self._late):
                _, said = await process.communicate()
        except TimeoutError:
            return "it does not come to an end; the device may be in use"
        finally:
            self._let_go()
            await _let_end(process)
        if self._stopped or process.returncode == 0:
            return ""
        return _last_line(said) or f"it ended with status {process.returncode}"

    def _let_go(self) -> None:
        if self._holding is not None:
            os.close(self._holding)
            self._holding = None


class NullPlayer:
    """Plays nothing, but takes as long as the sound, on any clock."""

    name = "null"

    def __init__(self, sleep: Callable[[float], Awaitable[None]] = asyncio.sleep) -> None:
        self._sleep = sleep
        self._playing: asyncio.Future[None] | None = None

    async def play(self, wav: Path) -> None:
        """Wait for the duration of a WAV, or until it is stopped."""
        self._playing = asyncio.ensure_future(self._sleep(wav_seconds(wav)))
        try:
            await asyncio.wait({self._playing})
        finally:
            self._playing.cancel()

    def stop(self) -> None:
        """End the wait."""
        if self._playing is not None:
            self._playing.cancel()


def open_player(
    sink: str = "auto", which: Callable[[str], str | None] = shutil.which
) -> SoundPlayer:
    """Open a player by the name of its sink: `auto`, a program, or `null`.

    Raises:
        PlayerError: there is no such sink, or its program is not installed.
    """
    if sink == "null":
        return NullPlayer()
    if sink not in SINKS:
        raise PlayerError(plain(f"There is no sink {sink[:40]!r}: {nearest(sink, SINKS)}"))
    commands = _installed(which) if sink == "auto" else _installed(which, sink)
    if not commands and sink != "auto":
        raise PlayerError(f"{sink} is not installed.")
    return ProgramPlayer(commands)


def examine_output(which: Callable[[str], str | None] = shutil.which) -> tuple[str, str]:
    """Test with a moment of silence whether sound can be played.

    Returns:
        The program, and the problem if none works; one of them is "".
    """
    problem = ABSENT
    for program, *options in _installed(which):
        problem = _try(program, options)
        if not problem:
            return Path(program).name, ""
    return "", problem


async def _let_end(process: asyncio.subprocess.Process) -> None:
    """Wait for a released player; kill its process group if it does not exit."""
    try:
        await asyncio.wait_for(process.wait(), END_SECONDS)
    except TimeoutError:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
        await process.wait()


def _try(program: str, options: Sequence[str]) -> str:
    with tempfile.NamedTemporaryFile(suffix=".wav") as file:
        with wave.open(file, "wb") as silence:
            silence.setparams((1, 2, 22_050, 0, "NONE", ""))
            silence.writeframes(bytes(2 * 1_102))
        file.flush()
        try:
            done = subprocess.run(  # noqa: S603 - found on the path
                [program, *options, file.name],
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=TRY_SECONDS,
                start_new_session=True,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return f"{Path(program).name} does not come to an end; the device may be in use"
        except OSError as error:
            return f"{Path(program).name} cannot be started ({error.strerror})"
    if done.returncode == 0:
        return ""
    said = _last_line(done.stderr) or f"status {done.returncode}"
    return f"{Path(program).name} finds nothing to play on ({said})"


def _installed(which: Callable[[str], str | None], *names: str) -> list[tuple[str, ...]]:
    found = ((which(name), PROGRAMS[name]) for name in names or PROGRAMS)
    return [(path, *command[1:]) for path, command in found if path]


def _last_line(said: bytes) -> str:
    """Return a program's last message, without the location in its code."""
    lines = [line for line in said.decode(errors="replace").splitlines() if line.strip()]
    return plain(re.sub(r"^\w+: main:\d+: ", "", lines[-1])).strip(" .")[-120:] if lines else ""
