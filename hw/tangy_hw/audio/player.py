"""Where a WAV is heard: a program that plays it, in a process of its own, or nothing (`null`)."""

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
"""The programs that play a WAV, and how they are called; the first that works is used."""

SINKS = ("auto", *PROGRAMS, "null")
ABSENT = "no program that plays sound is installed (aplay is in alsa-utils)"
LATE = 10.0  # s that a player may take longer than its WAV: a device that is in use lets it wait
END_SECONDS = 1.0  # for a player to be gone when it was killed: 2 ms when nothing else runs
TRY_SECONDS = 5.0  # for a moment of silence to be played

# The player ends with us, however we end: then our end of the pipe closes, and the shell that reads
# from it kills the player. The shell waits for both, so that no dead process is left behind where
# nobody else would (in a container).
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
    """No sound comes out; one sentence that says why."""


class SoundPlayer(Protocol):
    """Something on which a WAV is heard, one at a time."""

    @property
    def name(self) -> str:
        """Its name: the program, or `null`."""

    async def play(self, wav: Path) -> None:
        """Play a WAV; return when it has been heard to its end, or was stopped.

        Raises:
            PlayerError: no sound comes out.
        """

    def stop(self) -> None:
        """Stop playing at once."""


class ProgramPlayer:
    """Plays with the first of some programs that works; one that failed is not tried again."""

    def __init__(self, commands: Sequence[Sequence[str]], *, late: float = LATE) -> None:
        """Take the commands, to which the path of a WAV is added; `late` is in s.

        Raises:
            PlayerError: there is none.
        """
        if not commands:
            raise PlayerError(f"{ABSENT[0].upper()}{ABSENT[1:]}.")
        self._commands = [tuple(command) for command in commands]
        self._late = late
        self._holding: int | None = None
        self._stopped = False

    @property
    def name(self) -> str:
        """The program that plays."""
        return Path(self._commands[0][0]).name

    async def play(self, wav: Path) -> None:
        """Play a WAV; return when it has been heard to its end, or was stopped.

        Raises:
            PlayerError: every program failed, or played for ten seconds too long.
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
        """Play a WAV with the first program; return what went wrong ("": nothing).

        Who waits for it may give up, but not in the middle of the start of a process: asyncio
        would then wait for ever for its pipes.
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
                str(wav.absolute()),  # noqa: ASYNC240 - it touches no disk
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
    """Plays nothing, but takes as long as the sound would, on a clock that can be driven."""

    name = "null"

    def __init__(self, sleep: Callable[[float], Awaitable[None]] = asyncio.sleep) -> None:
        self._sleep = sleep
        self._playing: asyncio.Future[None] | None = None

    async def play(self, wav: Path) -> None:
        """Wait for as long as a WAV is; return early when it is stopped."""
        self._playing = asyncio.ensure_future(self._sleep(wav_seconds(wav)))
        try:
            await asyncio.wait({self._playing})
        finally:
            self._playing.cancel()

    def stop(self) -> None:
        """Wait no longer."""
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
    """Try, with a moment of silence, whether anything could be heard here.

    Returns:
        The player's program, and the problem if there is none; one of them is "".
    """
    problem = ABSENT
    for program, *options in _installed(which):
        problem = _try(program, options)
        if not problem:
            return Path(program).name, ""
    return "", problem


async def _let_end(process: asyncio.subprocess.Process) -> None:
    """Wait for a player that was let go of; kill all of its group if it does not end."""
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
    """Return what a program said last, without the place in its code where it said so."""
    lines = [line for line in said.decode(errors="replace").splitlines() if line.strip()]
    return plain(re.sub(r"^\w+: main:\d+: ", "", lines[-1])).strip(" .")[-120:] if lines else ""
