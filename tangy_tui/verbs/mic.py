"""`tangy mic`: forward a laptop's microphone to the Tangy on this robot."""

from __future__ import annotations

import asyncio
import shlex
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.mic_check import LOUD_ENOUGH, trouble_words
from tangy_tui.verbs.common import Data, as_given, hand_on_options

if TYPE_CHECKING:
    from tangy_hw.audio.forwarding import Forwarder

LINUX = "arecord -q -t raw -f S16_LE -r 16000 -c 1 | ssh ROBOT tangy mic"
MACOS = "rec -q -t raw -b 16 -e signed -r 16000 -c 1 - | ssh ROBOT tangy mic"

HELP = f"""Send a laptop's microphone to the Tangy on this robot.

    That Tangy was started with --mic socket.

Run it from the laptop, beside the connection in which Tangy runs. ROBOT is how you log in there.

\b
Linux:
  {LINUX}
macOS, with sox:
  {MACOS}
macOS, with ffmpeg:
  ffmpeg -loglevel error -f avfoundation -i :default -f s16le -ar 16000 -ac 1 - \\
    | ssh ROBOT tangy mic

It takes raw samples (16 bits, 16,000 a second, one channel) or a WAV of them, waits for a Tangy
that does not listen yet, and finds it again when it is started again. Ctrl+C ends it.
"""

BAR = 30  # columns
WORDS_SECONDS = 1.0  # between two checks of the meter
FIRST_WORDS = 4  # checks after connecting, before reporting that all is well

app = typer.Typer(rich_markup_mode=None, help=HELP)


@app.callback(invoke_without_command=True)
def mic(
    context: typer.Context,
    data: Data = None,
    socket: Annotated[
        Path | None, typer.Option(help="The socket that Tangy was given as --mic socket:PATH.")
    ] = None,
) -> None:
    """Hand standard input on, where no verb is given."""
    if context.invoked_subcommand is None:
        forward(data, socket)
    else:
        hand_on_options(context)


def forward(data: Path | None, socket: Path | None) -> None:
    """Forward standard input until it ends."""
    from tangy_hw.audio.forwarding import Forwarder, TakenOver
    from tangy_hw.audio.piped_source import open_standard_input
    from tangy_hw.audio.sources import SOCKET_NAME
    from tangy_tui.app.workspace import data_folder

    if sys.stdin is not None and sys.stdin.isatty():
        there = as_given(data) + ("" if socket is None else f" --socket {shlex.quote(str(socket))}")
        for system, command in (("Linux", LINUX), ("macOS", MACOS)):
            print(f"{system}: {plain(command + there)}", file=sys.stderr)
        raise TangyError("mic: no sound comes in: pipe it, as above. See `tangy mic --help`.")
    source = open_standard_input("mic", 0, convert=False)
    forwarder = Forwarder(source, socket or data_folder(data) / SOCKET_NAME, tell=_say)
    try:
        asyncio.run(_run(forwarder))
    except KeyboardInterrupt:
        pass
    except TakenOver as error:
        _say(str(error))
        raise typer.Exit(1) from None
    finally:
        if sys.stderr.isatty():
            print(file=sys.stderr)


async def _run(forwarder: Forwarder) -> None:
    showing = asyncio.create_task(_show(forwarder))
    try:
        await forwarder.run()
    finally:
        showing.cancel()


async def _show(forwarder: Forwarder) -> None:
    """Show the level: every second on a terminal, otherwise only changes."""
    connected, wrong = 0, None
    while True:
        await asyncio.sleep(WORDS_SECONDS)
        connected += forwarder.connected
        if sys.stderr.isatty():
            _draw(forwarder)
            continue
        trouble = forwarder.meter.trouble(speaking=connected == FIRST_WORDS)
        kind = None if trouble is None else trouble.kind
        if kind != wrong or connected == FIRST_WORDS:
            _say(LOUD_ENOUGH if trouble is None else trouble_words(trouble))
            connected += connected == FIRST_WORDS
        wrong = kind


def _draw(forwarder: Forwarder) -> None:
    """Redraw the bar, with any trouble beside it."""
    state = "connected" if forwarder.connected else "waiting for Tangy"
    columns = shutil.get_terminal_size().columns
    bar = "#" * round(BAR * forwarder.meter.loudest(1.5 * WORDS_SECONDS))
    trouble = forwarder.meter.trouble(speaking=False)
    line = f"[{bar:<{BAR}}] {state if trouble is None else trouble_words(trouble)}"
    print(f"\r{plain(line)[: columns - 1]}\033[K", end="", file=sys.stderr, flush=True)


def _say(sentence: str) -> None:
    start = "\r\033[K" if sys.stderr.isatty() else ""
    print(f"{start}tangy: {plain(sentence)}", file=sys.stderr, flush=True)
