"""Stand-ins for a microphone, the decoder and its process in the tests of speech."""

from __future__ import annotations

import asyncio
import json
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tangy_hw.audio.wav import RATE
from tangy_tui.language.answers import NO, YES
from tangy_tui.speech.evidence import AcousticEvidence, DecoderVocabulary, Expecting

PATIENCE = 10.0

WORDS = {"c": "call number", "j": "tell a joke", "s": "stop", "y": "yes", "n": "no", "x": "salad"}
"""The meanings of sounds that consist of one letter."""


def sound(letter: str, seconds: float = 0.5) -> bytes:
    """Return a sound that says the word of a letter; a space is silence."""
    return (letter.replace(" ", "\0") * round(seconds * RATE) * 2).encode()


async def soon(condition: Callable[[], bool]) -> None:
    """Run the event loop until a condition holds."""
    async with asyncio.timeout(PATIENCE):
        while not condition():  # noqa: ASYNC110 - there is no event for it
            await asyncio.sleep(0)


class FakeSource:
    """A microphone into which the test speaks."""

    def __init__(self, *, live: bool = True) -> None:
        self.live, self.recorded = live, not live
        self.tell: Callable[[str], None] = lambda sentence: None
        self.closed = 0
        self.coming: asyncio.Queue[bytes | Exception | None] = asyncio.Queue()
        self._taken = False

    async def feed(self, *chunks: bytes) -> None:
        """Say something, and wait until it has been taken."""
        for chunk in chunks:
            self.coming.put_nowait(chunk)
        async with asyncio.timeout(PATIENCE):
            await self.coming.join()

    def end(self, error: Exception | None = None) -> None:
        self.coming.put_nowait(error)

    def __aiter__(self) -> FakeSource:
        return self

    async def __anext__(self) -> bytes:
        if self._taken:
            self.coming.task_done()
        self._taken = False
        said = None if self.closed else await self.coming.get()
        self._taken = True
        if isinstance(said, bytes):
            return said
        raise said or StopAsyncIteration

    async def close(self) -> None:
        self.closed += 1
        self.end()


class FakeRecogniser:
    """Hears letters; silence after them ends an utterance if it looks for the end."""

    made: list[FakeRecogniser]

    def __init__(self, **_: object) -> None:
        self.partial: Callable[[str], None] = lambda words: None
        self.speaking: Callable[[], None] = lambda: None
        self.said = self.left = b""
        self.heard: list[tuple[bytes, Expecting]] = []
        self.failures: list[Exception] = []
        self.wanted: DecoderVocabulary | None = None
        self.closed = False
        self.decoding = asyncio.Event()  # while it is clear, decoding hangs
        self.decoding.set()
        self.made.append(self)

    async def start(self, wanted: DecoderVocabulary) -> None:
        self.wanted = wanted

    async def close(self) -> None:
        self.closed = True
        self.decoding.set()

    async def hear(
        self, chunks: asyncio.Queue[bytes], expecting: Expecting, *, endpoint: bool
    ) -> AcousticEvidence:
        pcm = b""
        self.left = b""
        while chunk := await chunks.get():
            if endpoint and not pcm.strip(b"\0") and chunk.strip(b"\0"):
                self.speaking()
            pcm += chunk
            self.partial(f"{len(pcm)} bytes")
            begun = pcm.lstrip(b"\0")
            if endpoint and b"\0" in begun:
                said, _, rest = begun.partition(b"\0")
                pcm, self.left = said, b"\0" + rest
                break
        return await self._evidence(pcm.strip(b"\0") if endpoint else pcm, expecting)

    async def decode(self, pcm: bytes, expecting: Expecting = "commands") -> AcousticEvidence:
        return await self._evidence(pcm, expecting)

    async def pieces(self, pcm: bytes) -> list[bytes]:
        return [piece for piece in pcm.split(sound(" ", 0.5)) if piece]

    async def _evidence(self, pcm: bytes, expecting: Expecting) -> AcousticEvidence:
        await self.decoding.wait()
        self.said = pcm
        self.heard.append((pcm, expecting))
        if self.failures:
            raise self.failures.pop(0)
        letter = Counter(pcm.decode()).most_common(1)[0][0] if pcm else ""
        words = WORDS.get(letter, "")
        phrase = words if words in (*YES, *NO) else ""
        return AcousticEvidence(words, phrase, 0.0, 1.0, len(pcm) / 2 / RATE)


WORKER = r"""
import base64, json, os, pathlib, signal, sys

folder, plans = pathlib.Path(sys.argv[1]), json.loads(sys.argv[2])
number = len(list(folder.glob("heard.*")))
plan = plans[min(number, len(plans) - 1)]
log = open(folder / f"heard.{number}", "wb", buffering=0)
heard, id, endpoint, chunks = b"", None, False, 0

def write(answer):
    print(json.dumps(answer), flush=True)

def at(moment):
    do = plan.get(moment)
    if do == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if do == "exit":
        sys.exit(3)
    if do == "hang":
        signal.pause()
    if do == "close":
        os.close(1)
        signal.pause()
    if do is not None:
        sys.stdout.write("y" * 3_000_000 if do == "flood" else do)
        sys.stdout.flush()

def end():
    global id
    at("end")
    words = plan.get("words", "call number")
    whole = {"words": words, "phrase": "", "margin": 0.0, "confidence": 1.0,
             "seconds": len(heard) / 32000, "stop": ""}
    write({"id": id, "heard": whole, "used": len(heard)})
    id = None

at("start")
for line in sys.stdin.buffer:
    request = json.loads(line)
    if "wanted" in request:
        at("wanted")
        write({"id": request["id"], "ready": True, "left_out": plan.get("left_out", [])})
    elif "begin" in request:
        id, endpoint, heard = request["id"], request["endpoint"], b""
        log.seek(0)
        log.truncate()
        at("begin")
    elif "pcm" in request and id is not None:
        heard += base64.b64decode(request["pcm"])
        log.write(base64.b64decode(request["pcm"]))
        chunks += 1
        write({"id": id, "partial": f"{len(heard)} bytes"})
        at(f"chunk {chunks}")
        if endpoint and b"." in heard:
            heard = heard[: heard.index(b".") + 1]
            end()
    elif "end" in request and request["id"] == id:
        end()
    elif "pieces" in request:
        write({"id": request["id"], "found": plan.get("found", [])})
    elif "said" in request:
        words = [text for _, text in request["said"]]
        write({"id": request["id"], "voice": "usual " + " ".join(words)})
"""


class Workers:
    """Stand-ins for the decoder's processes, in turn, each with its plan."""

    def __init__(self, folder: Path, *plans: dict[str, Any]) -> None:
        self._folder = folder
        script = folder / "worker.py"
        script.write_text(WORKER)
        self.command = (
            *(sys.executable, "-S", "-E", str(script), str(folder)),
            json.dumps(plans or [{}]),
        )

    @property
    def heard(self) -> list[bytes]:
        """The sound that each of them got of its last utterance."""
        count = len(list(self._folder.glob("heard.*")))
        return [(self._folder / f"heard.{number}").read_bytes() for number in range(count)]
