"""Text of unknown origin, made safe to display in a terminal."""

from __future__ import annotations

import re

_UNPRINTABLE = re.compile(
    "[\x00-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff]"
)


def plain(text: str) -> str:
    """Replace control characters, bidirectional marks and other invisible characters.

    Lone surrogates, which represent invalid bytes of the command line, are replaced too, because
    they cannot be encoded.
    """
    return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)
