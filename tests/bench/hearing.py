"""The longest gap of the screen's loop while speech is decoded or made, against an idle one.

Run by hand: `python tests/bench/hearing.py [--rounds N]`; needs flite and espeak-ng. A child in a
real pty shows the teaching screen with a microphone that plays sentences in real time. It is idle
for some seconds, then the key is pushed and the sentences are decoded while level and words are
drawn; then all calls of a game are prepared, in an empty cache, while Tangy speaks (to nobody).
The loop asks to be woken every 5 ms; a gap is the delay of a wake. CPU is the child's own.
"""

from __future__ import annotations

import asyncio
import fcntl
import json
import os
import pty
import shutil
import struct
import subprocess
import sys
import termios
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tangy_hw.audio.voice import SpeechVoice
    from tangy_profiles.activity import Activity

SENTENCES = ("greet everyone", "call the next number", "ask him to move the card closer")
PHASE_SECONDS = 5.0
WAKES = 0.005
MOST_MORE = 0.050
"""Seconds by which the longest gap may grow while speech is decoded."""

# Stands in for arecord: plays a file over and over, as fast as it was spoken.
MICROPHONE = """#!{python}
import sys, time
sound = open({sound!r}, "rb").read()
at, begun = 0, time.monotonic()
while True:
    sys.stdout.buffer.write(sound[at % len(sound) :][:1600])
    sys.stdout.buffer.flush()
    at += 1600
    time.sleep(max(0.0, begun + at / 32000 - time.monotonic()))
"""


def main() -> int:
    """Print the table; the exit status is 1 if the limit is exceeded."""
    flite = shutil.which("flite")
    if flite is None:
        print("flite is not installed")
        return 1
    rounds = int(sys.argv[sys.argv.index("--rounds") + 1]) if "--rounds" in sys.argv else 3
    kept = True
    print(f"{'window':>9} {'phase':<9} {'longest':>9} {'99 %':>9} {'CPU':>6}")
    for columns, lines in ((80, 24), (120, 40)):
        for _ in range(rounds):
            with TemporaryDirectory(prefix="tangy-bench-") as folder:
                found = measure(flite, Path(folder), columns, lines)
            for phase, (longest, usual, cpu) in found.items():
                print(
                    f"{columns:>4} x {lines:<2} {phase:<9} {longest * 1000:>6.1f} ms "
                    f"{usual * 1000:>6.1f} ms {cpu:>6.1%}",
                    flush=True,
                )
            kept = kept and max(f[0] for f in found.values()) <= found["idle"][0] + MOST_MORE
    print(f"limit: {MOST_MORE * 1000:.0f} ms more than idle:", "kept" if kept else "NOT KEPT")
    return 0 if kept else 1


def measure(
    flite: str, folder: Path, columns: int, lines: int
) -> dict[str, tuple[float, float, float]]:
    """Have a child measure itself in a window of this size."""
    sound = b""
    for n, words in enumerate(SENTENCES):
        wav = folder / f"{n}.wav"
        subprocess.run([flite, "-voice", "slt", "-t", words, "-o", str(wav)], check=True)  # noqa: S603
        sound += wav.read_bytes()[44:] + bytes(16_000)
    (folder / "sound.raw").write_bytes(sound)
    microphone = folder / "arecord"
    script = MICROPHONE.format(python=sys.executable, sound=str(folder / "sound.raw"))
    microphone.write_text(script, encoding="utf-8")
    microphone.chmod(0o755)
    terminal, child = pty.openpty()
    fcntl.ioctl(child, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
    process = subprocess.Popen(  # noqa: S603 - our own program
        [sys.executable, __file__, "--child", str(folder)],
        stdin=child,
        stdout=child,
        stderr=child,
        env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "TERM": "xterm-256color"},
        start_new_session=True,
    )
    os.close(child)
    reader = Thread(target=drain, args=(terminal,), daemon=True)
    reader.start()
    process.wait(120)
    reader.join(2)
    os.close(terminal)
    found: dict[str, tuple[float, float, float]] = json.loads(
        (folder / "found.json").read_text(encoding="utf-8")
    )
    return found


def drain(terminal: int) -> None:
    """Read a terminal's output until its program ends."""
    try:
        while os.read(terminal, 1 << 16):
            pass
    except OSError:
        pass


async def gaps(seconds: float) -> tuple[float, float, float]:
    """Return the loop's longest gap, that of 99 in 100 wakes, and the share of a core."""
    found: list[float] = []
    begun, used = perf_counter(), process_time()
    while perf_counter() < begun + seconds:
        before = perf_counter()
        await asyncio.sleep(WAKES)
        found.append(perf_counter() - before - WAKES)
    cpu = (process_time() - used) / (perf_counter() - begun)
    found.sort()
    return found[-1], found[int(len(found) * 0.99)], cpu


def be_the_child(folder: Path) -> int:
    """Show the teaching screen, measure, and leave."""
    from tangy_hw.audio.player import open_player
    from tangy_hw.audio.synthesis import Synthesiser
    from tangy_hw.audio.voice import SpeechVoice
    from tangy_profiles.voice import VoicePreference
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.speech.input import SpeechInput
    from tangy_tui.ui.app import run_app
    from tangy_tui.ui.program import Program
    from tangy_tui.ui.screens.teach import TeachScreen
    from tangy_tui.ui.speaking import opening_lines
    from tangy_tui.ui.terminal import terminal_kind

    def silent_voice(activity: Activity, *calls: Any) -> SpeechVoice:
        return SpeechVoice(Synthesiser(folder / "voice"), open_player("null"), deck=activity.deck)

    workspace = Workspace(folder / "data")
    teaching = workspace.teaching("ann", 1)
    teaching.begin()
    ears = SpeechInput("arecord", teaching.phrasebook, folder=workspace.store.folder)
    partial: set[str] = set()

    async def start(program: Program) -> None:
        await program.push_screen(TeachScreen(workspace, teaching))
        while ears.state != "off":  # noqa: ASYNC110 - its `changed` is the screen's
            await asyncio.sleep(0.05)
        await asyncio.sleep(1.0)
        found = {"idle": await gaps(PHASE_SECONDS)}
        await program.action_talk()
        found["decoding"] = await gaps(PHASE_SECONDS)
        partial.add(ears.words)
        program.speaker.make_voice = silent_voice
        program.speaker.prepare(opening_lines(workspace.activity))
        program.speaker.switch(True)
        program.speaker.say("Good afternoon, everybody, and welcome.", VoicePreference())
        found["speaking"] = await gaps(PHASE_SECONDS)
        (folder / "found.json").write_text(json.dumps(found), encoding="utf-8")
        program.leave()

    status = run_app(Program(workspace, start, kind=terminal_kind(), ears=ears))
    workspace.close()
    if not any(partial):
        raise SystemExit("nothing was heard")
    return status


if __name__ == "__main__":
    if "--child" in sys.argv:
        sys.exit(be_the_child(Path(sys.argv[-1])))
    sys.exit(main())
