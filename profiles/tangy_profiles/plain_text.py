"""Text of unknown origin, made fit to be shown: nothing in it steers a terminal or hides."""

from __future__ import annotations

import re

_UNPRINTABLE = re.compile(
    "[\x00-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff]"
)


def plain(text: str) -> str:
    """Replace what would act on a terminal instead of being read on it (controls, bidi marks).

    Bytes that were no text come from the command line as lone surrogates, which no file and no
    terminal takes: they are replaced as well.
    """
    return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)
