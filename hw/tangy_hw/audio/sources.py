"""Opens sources of a teacher's voice by name.

    FILE.wav          a recording
    -                 standard input, raw samples or a WAV
    arecord           the local microphone; arecord:DEVICE if there are several
    socket            a laptop's microphone, forwarded by `tangy mic`; socket:PATH for another path

With `-` keys must come from elsewhere: see `tangy_tui.console.inputs`.
"""

from __future__ import annotations

from pathlib import Path

from tangy_hw.audio.source import Recording, Source
from tangy_hw.audio.wav import SoundError, read_wav

__all__ = ["SOCKET_NAME", "Source", "open_source"]

SOCKET_NAME = "mic.sock"  # in the data folder


def open_source(
    name: str, *, stdin: int = 0, folder: Path | None = None, spoken: bool = False
) -> Source:
    """Open a source by its name.

    Args:
        name: one of those above.
        stdin: the file descriptor of `-`.
        folder: the data folder, which contains `socket`.
        spoken: play a recording at the speed of speech (see `Recording.spoken`).

    Raises:
        SoundError: it cannot be used; one sentence that says why.
    """
    source = _opened(name, stdin, folder)
    return source.spoken() if spoken and isinstance(source, Recording) else source


def _opened(name: str, stdin: int, folder: Path | None) -> Source:
    kind, colon, rest = name.partition(":")
    if name == "arecord" or (kind == "arecord" and rest):
        from tangy_hw.audio.arecord import LocalMicrophone

        return LocalMicrophone(name, rest)
    if name == "socket" or (kind == "socket" and rest):
        from tangy_hw.audio.socket_source import LaptopMicrophone

        if not rest and folder is None:
            raise SoundError("socket: there is no data folder to listen in; give socket:PATH.")
        return LaptopMicrophone(name, Path(rest) if rest else (folder or Path()) / SOCKET_NAME)
    if name == "-":
        from tangy_hw.audio.piped_source import open_standard_input

        return open_standard_input("--mic -", stdin)
    if colon and not rest and kind in ("arecord", "socket"):
        raise SoundError(f"{name} names nothing after the colon; leave the colon out.")
    return Recording(name, read_wav(Path(name)))
