"""Detects streams that are not the expected raw 16-bit samples."""

from __future__ import annotations

HOW = "send raw 16-bit samples, 16,000 a second, one channel"
KINDS = {
    b"fLaC": "FLAC", b"OggS": "Ogg", b"ID3": "MP3", b"FORM": "AIFF", b".snd": "AU",
    b"caff": "CAF", b"RF64": "RF64", b"\x1aE\xdf\xa3": "WebM or Matroska",
}  # fmt: skip
AT_LEAST = 200  # bytes; fewer do not tell

TEXT = frozenset((9, 10, 13, 27, *range(32, 127)))
MIDDLE = frozenset(range(0x40, 0xC0))  # 8-bit silence is 0x80
SMALL = frozenset((0x00, 0x80, *range(0x20, 0x40), *range(0xA0, 0xC0)))  # floats from -1 to 1


def odd_kind(head: bytes) -> str:
    """Return a sentence about the format of a stream's head, "" if it may be raw samples.

    Real 16-bit sound crosses zero within a few hundred samples, so its high bytes include 0x00 and
    0xFF; its low bytes take every value.
    """
    for magic, kind in KINDS.items():
        if head.startswith(magic):
            return f"this is {kind}, not raw sound; {HOW}."
    if len(head) < AT_LEAST:
        return "this is text, not sound." if head.strip() and set(head) <= TEXT else ""
    if set(head) <= TEXT:
        return f"this is text, not sound; {HOW}."
    if set(head) <= MIDDLE:
        return f"this is 8-bit sound; {HOW}."
    high = head[3 : len(head) // 4 * 4 : 4]
    full = sum(byte not in (0x00, 0x80) for byte in high)
    if set(high) <= SMALL and full > len(high) / 2 and len(set(head[1 : 4 * len(high) : 4])) > 32:
        return f"this is floating-point sound; {HOW}."
    return ""
