"""Synthesises text as WAV files with espeak-ng, and caches them."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import wave
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import did_you_mean, plain
from tangy_profiles.voice import VoicePreference

PROGRAM = "espeak-ng"
USUAL = VoicePreference(rate=140, voice="en-us")  # espeak-ng's default is 175
ABSENT = f"{PROGRAM} is not installed; until it is, what Tangy says is shown as text."
SECONDS = 10.0  # timeout for a text: 15 ms on an idle machine
LONGEST = 5_000  # characters of SSML: some five minutes
MOST_BYTES = 200_000_000  # of the cache; the oldest files are deleted first
UNFINISHED_SECONDS = 60.0  # after which an unfinished file is abandoned
HEADER = 44  # bytes before the samples of a WAV as written here


class VoiceError(TangyError):
    """A text cannot be spoken; one sentence that says why."""


class NoSuchVoice(VoiceError):
    """The requested voice does not exist; the message names the nearest."""


class Synthesiser:
    """Synthesises texts as WAV files, or finds them in its cache.

    Methods block on a process, and may be called from several threads at once.
    """

    def __init__(
        self,
        folder: Path | None = None,
        *,
        which: Callable[[str], str | None] = shutil.which,
        most_bytes: int = MOST_BYTES,
        seconds: float = SECONDS,
    ) -> None:
        """Find espeak-ng, without starting it.

        Args:
            folder: cache for the WAV files; None: the user's cache folder.
            which: finds a program on the path.
            most_bytes: maximum size of the cache.
            seconds: timeout for a text.
        """
        self.folder = folder or cache_folder()
        self._program = which(PROGRAM)
        self._most = most_bytes
        self._seconds = seconds
        self._asking = threading.Lock()  # held during queries to espeak-ng
        self._lock = threading.Lock()  # held for moments only
        self._version: str | None = None
        self._voices: Mapping[str, str] | None = None
        self._variants: frozenset[str] | None = None
        self._bytes: int | None = None
        self._running: set[subprocess.Popen[bytes]] = set()

    @property
    def reason(self) -> str:
        """Why nothing can be spoken, in one sentence; "" if it can."""
        return "" if self._program else ABSENT

    @property
    def version(self) -> str:
        """Version of espeak-ng.

        Raises:
            VoiceError: it is not installed, or cannot be run.
        """
        with self._asking:
            if self._version is None:
                said = self._run(["--version"]).decode(errors="replace")
                found = re.search(r": *(\S+)", said)
                self._version = plain(found[1] if found else said.strip())[:40]
            return self._version

    @property
    def voices(self) -> Mapping[str, str]:
        """Available voices: language by name.

        Raises:
            VoiceError: as for `version`.
        """
        with self._asking:
            if self._voices is None:
                self._voices = MappingProxyType(_read_voices(self._run(["--voices"])))
            return self._voices

    @property
    def variants(self) -> frozenset[str]:
        """Variants (other speakers) that can follow every voice after a plus.

        Raises:
            VoiceError: as for `version`.
        """
        with self._asking:
            if self._variants is None:
                found = re.findall(r"!v/(\S+)", self._run(["--voices=variant"]).decode("utf-8"))
                self._variants = frozenset(found)
            return self._variants

    def check(self, preference: VoicePreference) -> None:
        """Check that a voice exists; espeak-ng itself ignores an unknown variant.

        Raises:
            NoSuchVoice: there is no such voice; the message names the nearest.
            VoiceError: as for `version`.
        """
        name, _, variant = (preference.voice or "").partition("+")
        listed = "tangy say --voices lists all."
        if name and name not in self.voices:
            raise NoSuchVoice(f"There is no voice {name!r}: {_like(name, self.voices)}{listed}")
        if variant and variant not in self.variants:
            near = _like(variant, self.variants)
            raise NoSuchVoice(f"No voice has a variant {variant!r}: {near}{listed}")

    def render(self, marked_up: str, preference: VoicePreference = USUAL) -> Path:
        """Return a WAV of an SSML text, from the cache or new.

        Raises:
            VoiceError: espeak-ng is missing or fails, there is no such voice, or the cache cannot
                be written.
        """
        chosen = preference.over(USUAL)
        path = self.folder / f"{self._key(marked_up, chosen)}.wav"
        if _is_whole(path):
            with contextlib.suppress(OSError):
                os.utime(path)  # a file in use is not the oldest
            return path
        self.check(chosen)
        if len(marked_up) > LONGEST:
            raise VoiceError(f"A text of more than {LONGEST:,} characters is not spoken.")
        arguments = ["--stdin", "--stdout", "-m", "-z", "-b", "1"]
        arguments += ["-v", str(chosen.voice), "-s", str(chosen.rate)]
        self._keep(path, _mended(self._run(arguments, marked_up)))
        return path

    def end(self) -> None:
        """End the current synthesis."""
        with self._lock:
            for process in self._running:
                _kill(process)

    def clear(self) -> int:
        """Delete every WAV, because they may contain names, and return their number.

        Raises:
            VoiceError: a file cannot be deleted.
        """
        count = 0
        try:
            for path, _, _ in self._kept():
                path.unlink(missing_ok=True)
                count += path.suffix == ".wav"
        except OSError as error:
            raise VoiceError(
                plain(f"{self.folder}: what was said cannot be deleted ({error.strerror}).")
            ) from None
        finally:
            with self._lock:
                self._bytes = None
        return count

    def _key(self, marked_up: str, chosen: VoicePreference) -> str:
        parts = (self.version, str(chosen.voice), str(chosen.rate), marked_up)
        return hashlib.sha256("\0".join(parts).encode("utf-8", "replace")).hexdigest()[:32]

    def _run(self, arguments: list[str], text: str = "") -> bytes:
        if self._program is None:
            raise VoiceError(ABSENT)
        try:
            with self._lock:  # so that `end` finds it from the start
                process = subprocess.Popen(  # noqa: S603 - found on the path; text goes to its stdin
                    [self._program, *arguments],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.PIPE,
                    start_new_session=True,
                )
                self._running.add(process)
        except OSError as error:
            raise VoiceError(f"{PROGRAM} cannot be started ({error.strerror}).") from None
        try:
            made, said = process.communicate(text.encode("utf-8", "replace"), self._seconds)
        except subprocess.TimeoutExpired:
            _kill(process)
            process.communicate()
            raise VoiceError(f"{PROGRAM} did not answer in {self._seconds:g} s.") from None
        finally:
            with self._lock:
                self._running.discard(process)
        if process.returncode:
            last = plain(said.decode(errors="replace").strip())[-120:]
            raise VoiceError(f"{PROGRAM} failed: {last or f'status {process.returncode}'}.")
        return made

    def _keep(self, path: Path, content: bytes) -> None:
        """Write a file atomically, and delete the oldest."""
        try:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            descriptor, unfinished = tempfile.mkstemp(".tmp", dir=self.folder)
            try:
                with os.fdopen(descriptor, "wb") as file:
                    file.write(content)
                os.replace(unfinished, path)  # noqa: PTH105 - replaces a file atomically
            except BaseException:
                Path(unfinished).unlink(missing_ok=True)
                raise
        except OSError as error:
            raise VoiceError(
                plain(f"{self.folder}: what is to be said cannot be kept there ({error.strerror}).")
            ) from None
        with self._lock:
            if self._bytes is None:
                self._bytes = sum(size for _, size, _ in self._kept())
            else:
                self._bytes += len(content)
            if self._bytes > self._most:
                self._bytes = self._trim(path)

    def _trim(self, newest: Path) -> int:
        """Delete the oldest files until a tenth of the space is free; return the bytes left."""
        kept = sorted(self._kept(), key=lambda entry: entry[2])
        left = sum(size for _, size, _ in kept)
        for path, size, _ in kept:
            if left <= 0.9 * self._most:
                break
            if path != newest:
                path.unlink(missing_ok=True)
                left -= size
        return left

    def _kept(self) -> list[tuple[Path, int, float]]:
        """Return the cached files, with bytes and time; another process may delete some.

        Unfinished files count once they are abandoned.
        """
        kept: list[tuple[Path, int, float]] = []
        for path in (*self.folder.glob("*.wav"), *self.folder.glob("*.tmp")):
            with contextlib.suppress(OSError):
                status = path.stat()
                if path.suffix == ".wav" or status.st_mtime < time.time() - UNFINISHED_SECONDS:
                    kept.append((path, status.st_size, status.st_mtime))
        return kept


def cache_folder() -> Path:
    """Return the cache folder for spoken texts."""
    from platformdirs import user_cache_path

    return user_cache_path("tangy", appauthor=False) / "voice"


def clear_cache() -> None:
    """Empty the cache of spoken texts, if there is one: they may contain people's names."""
    folder = cache_folder()
    with contextlib.suppress(OSError, VoiceError):
        if folder.is_dir():
            Synthesiser(folder).clear()


def examine_voice(which: Callable[[str], str | None] = shutil.which) -> tuple[str, str]:
    """Test whether a word can be synthesised, without playing or storing it.

    Returns:
        The program with its version ("" if it is not installed), and its problem ("" if there is
        none).
    """
    with tempfile.TemporaryDirectory() as folder:
        synthesiser = Synthesiser(Path(folder), which=which)
        if synthesiser.reason:
            return "", synthesiser.reason
        named = PROGRAM
        try:
            named += f" {synthesiser.version}"
            synthesiser.render("<speak>hello</speak>")
        except VoiceError as error:
            return named, f"{str(error).rstrip('.')}; what Tangy says is shown as text."
    return named, ""


def _mended(made: bytes) -> bytes:
    """Write the true length into a WAV from a pipe, which lacks it."""
    mended = io.BytesIO()
    try:
        with wave.open(io.BytesIO(made)) as source, wave.open(mended, "wb") as target:
            samples = source.readframes(len(made))
            target.setparams(source.getparams())
            target.writeframes(samples)
    except (EOFError, wave.Error):
        samples = b""
    if not samples:
        raise VoiceError(f"{PROGRAM} made no sound of it.")
    return mended.getvalue()


def _is_whole(path: Path) -> bool:
    """Return whether a file is a complete WAV as written here."""
    try:
        with path.open("rb") as file:
            head = file.read(HEADER)
            size = os.fstat(file.fileno()).st_size
    except OSError:
        return False
    samples = int.from_bytes(head[40:44], "little")
    right = head[:4] == b"RIFF" and head[8:12] == b"WAVE" and head[36:40] == b"data"
    return right and samples > 0 and size == HEADER + samples


def _read_voices(listed: bytes) -> dict[str, str]:
    """Parse a list of voices: by language, and by the wider languages that a voice supports.

    If several support one, the one with the lowest number is used, as espeak-ng does.
    """
    voices: dict[str, str] = {}
    wider: dict[str, tuple[int, str]] = {}
    for line in listed.decode("utf-8", "replace").splitlines()[1:]:
        words = line.split(maxsplit=4)
        if len(words) < 5:
            continue
        voices[words[1]] = title = plain(words[3].strip("_").replace("_", " "))
        for language, rank in re.findall(r"\(([\w-]+) (\d+)\)", words[4]):
            wider[language] = min(wider.get(language, (99, "")), (int(rank), title))
    return {language: title for language, (_, title) in wider.items()} | voices


def _like(word: str, words: Mapping[str, str] | frozenset[str]) -> str:
    meant = did_you_mean(word, words)
    return f"{meant} " if meant else ""


def _kill(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
