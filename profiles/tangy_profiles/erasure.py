"""Erasing a person's name from texts, so that nothing else in them changes.

A name is found as a whole word, however it is written: by small letters, without its accents, in
other spaces or hyphens, as HTML, JSON and addresses spell it. What only looks like it stays: other
people's longer names, phrases of the activity ("mark numbers", where somebody is called Mark), and
in running text the small word that some names are ("will", "may").
"""

from __future__ import annotations

import html
import json
import re
import unicodedata
from collections.abc import Collection, Iterable, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import quote

from tangy_profiles.events import BODIES
from tangy_profiles.reading import read_toml
from tangy_profiles.shapes import Fields

FREE_TEXT = frozenset(
    ("heard", "why", "how", "console", "advice", "speech", "image", "stopped", "what")
)
"""The keys of an event's body that hold words of people, or sentences of Tangy."""
WHOSE = frozenset(("teacher", "by", "who"))
"""The keys that say which teacher or member of staff it was; they may be called the same."""
CHOSEN_WORDS = frozenset(("demonstrations edited", "speech noted", "taken back"))
"""The kinds of event whose `what` is a word of Tangy's own."""

_UNKNOWN = Fields()
_MARKS = "\u0300-\u036f"  # accents that stand apart
_TOKEN = re.compile(rf"(?:[^\W_]|[{_MARKS}])+")
_BETWEEN = r"(?:&(?:\#x?\w+|nbsp|apos);|%20|[\s+\-_'\u2019.]){1,3}"
_APOSTROPHES = re.compile("['\u2019\u02bc]")
_ACCENTS = re.compile(f"[{_MARKS}]")
_UNSPACED = re.compile("[\u0e00-\u0e7f\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af]")
_HTML = re.compile(
    r"(?P<code><style\b.*?</style\s*>|<script\b.*?</script\s*>)"
    r"|(?P<tag><[^<>]*>)|(?P<text>[^<]+|<)",
    re.I | re.S,
)
_SHOWN = re.compile(
    r"""(?i)\b(title|alt|aria-label|content|value|label)(\s*=\s*)("[^"]*"|'[^']*')"""
)


class NameEraser:
    """Puts a stand-in (the person's id) where a name stands."""

    def __init__(self, names: Iterable[str], stand_in: str, *, but: Collection[str] = ()) -> None:
        """Learn what to look for.

        Args:
            names: what the person is called, in every form that is to go.
            stand_in: what is put in its place.
            but: phrases and other people's names that stay as they are where they hold the name.
        """
        self.names = tuple(dict.fromkeys(name.strip() for name in names if name.strip()))
        self.stand_in = stand_in
        small = small_words()
        forms = {form for name in self.names for form in _forms(name)}
        self._small = {n for n in self.names if n.casefold() in small or len(n) < 2}
        self._written = {form for name in self._small for form in _as_written(name)}
        self._any = {f for name in self.names if name not in self._small for f in _forms(name)}
        self._anchors = frozenset(_anchor(form) for form in forms)
        self._typed = self._pattern(forms, (), but)
        self._running = self._pattern(self._any, self._written, but)

    def may_hold(self, text: str) -> bool:
        """Say at a glance whether a text may hold the name: most of a log does not."""
        folded = text.casefold()
        return any(anchor in folded for anchor in self._anchors)

    def text(self, text: str) -> str:
        """Erase the name from running text, such as a report."""
        return self._put(self._running, text)

    def typed(self, text: str) -> str:
        """Erase the name from what was typed or said, which is in small letters."""
        return self._put(self._typed, text)

    def page(self, page: str) -> str:
        """Erase the name from what an HTML page or an SVG shows; tags and styles stay."""
        return _HTML.sub(self._shown, page)

    def body(self, kind: str, body: dict[str, Any]) -> dict[str, Any]:
        """Return the body of an event without the name in its free texts."""
        return {
            key: self._value(value, key == "heard") if _is_free(kind, key) else value
            for key, value in body.items()
        }

    def is_left(self, body: Mapping[str, Any]) -> bool:
        """Say whether the name stands in a body as that of a teacher or of staff."""
        words = (body[key] for key in WHOSE if isinstance(body.get(key), str))
        return any(self.typed(word) != word for word in words)

    def overwrite(self, data: bytes) -> bytes:
        """Overwrite the name in bytes that are no text, so that nothing moves.

        It is looked for beside the person's id as well, as it stands in a table of names.
        """
        for forms, flags in ((self._any, re.I), (self._written, re.NOFLAG)):
            for form in sorted(forms, key=len, reverse=True):
                found = _bytes_pattern(form.encode(), self.stand_in.encode(), flags)
                data = found.sub(lambda match: b"-" * len(match[0]), data)
        return data

    def _value(self, value: Any, typed: bool) -> Any:
        if isinstance(value, str):
            return self.typed(value) if typed else self.text(value)
        if isinstance(value, list):
            return [self._value(item, typed) for item in value]
        if isinstance(value, dict):
            return {key: self._value(item, typed) for key, item in value.items()}
        return value

    def _shown(self, match: re.Match[str]) -> str:
        if match["text"]:
            return self.text(match["text"])
        if match["code"]:
            return match["code"]
        return _SHOWN.sub(lambda a: a[1] + a[2] + self.text(a[3]), match["tag"])

    def _put(self, pattern: re.Pattern[str] | None, text: str) -> str:
        if pattern is None or not self.may_hold(text):
            return text
        return pattern.sub(lambda m: self.stand_in if m["name"] else m[0], text)

    def _pattern(
        self, forms: Collection[str], written: Collection[str], but: Collection[str]
    ) -> re.Pattern[str] | None:
        """Compile what finds the name: `forms` in any letters, and those `written` just so.

        What is to stay stands before it, as far as it holds the name among other words.
        """
        sought = [_one(form, "i") for form in sorted(forms, key=_longest)]
        sought += [_one(form, "") for form in sorted(written, key=_longest)]
        if not sought:
            return None
        name = re.compile("|".join(sought))
        own = {_plainest(name) for name in self.names}
        stays = [text for text in but if name.search(text) and _plainest(text) not in own]
        kept = [_one(text, "i") for text in sorted(stays, key=_longest)]
        return re.compile("|".join([*kept, f"(?P<name>{name.pattern})"]))


def _is_free(kind: str, key: str) -> bool:
    """Say whether a key of a body holds words, or what no kind of event of ours has."""
    if key in FREE_TEXT:
        return not (key == "what" and kind in CHOSEN_WORDS)
    body = BODIES.get(kind, _UNKNOWN)
    known = {*body.needs, *body.may} if isinstance(body, Fields) else {key}
    return key not in known and key not in WHOSE


@cache
def small_words() -> frozenset[str]:
    """Return the small words that are people's names as well."""
    top = read_toml(Path(str(files("tangy_profiles"))) / "people" / "small_words.toml")
    words = frozenset(top.texts("words"))
    top.close()
    return words


def _forms(name: str) -> tuple[str, ...]:
    """Return the ways in which a name may be written in a file, in whatever letters."""
    composed = unicodedata.normalize("NFC", name)
    apart = unicodedata.normalize("NFD", name)
    bare = unicodedata.normalize("NFC", _ACCENTS.sub("", unicodedata.normalize("NFKD", name)))
    plainly = [name, composed, apart, bare]
    plainly += [_APOSTROPHES.sub("", form) for form in plainly]
    plainly += [form.casefold() for form in plainly]
    coded = [json.dumps(form)[1:-1] for form in plainly]
    coded += [html.escape(form) for form in plainly] + [quote(form) for form in plainly]
    return tuple(dict.fromkeys(form for form in (*plainly, *coded) if form))


def _as_written(name: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys((name, name.title(), name.upper())))


def _plainest(text: str) -> str:
    return " ".join(_TOKEN.findall(text.casefold()))


def _anchor(form: str) -> str:
    """Return the longest plain part of a form, which every text that holds it has as well."""
    parts = re.findall("[a-z0-9]+", form.casefold())
    return max(parts, key=len) if parts else form.casefold()


def _longest(text: str) -> tuple[int, str]:
    return -len(text), text


def _one(text: str, flags: str) -> str:
    """Return the pattern of one form: its words in any spaces, and no letter before or after."""
    tokens = _TOKEN.findall(text)
    coded = "&" in text or "\\" in text or "%" in text
    inner = _BETWEEN.join(map(re.escape, tokens)) if tokens and not coded else re.escape(text)
    if not _UNSPACED.search(text):
        inner = rf"(?<!\w){inner}" if text[0].isalnum() or coded else inner
        inner = rf"{inner}(?![\w{_MARKS}])" if text[-1].isalnum() or coded else inner
    return f"(?{flags}:{inner})" if flags else f"(?:{inner})"


def _bytes_pattern(form: bytes, id: bytes, flags: re.RegexFlag) -> re.Pattern[bytes]:
    """Return what finds a form as a whole word, or at once behind the person's id."""
    edge, sought = rb"[0-9A-Za-z_\x80-\xff]", re.escape(form)
    whole = b"(?<!%b)%b(?!%b)" % (edge, sought, edge)
    return re.compile(b"%b|(?<=%b)%b" % (whole, re.escape(id), sought), flags)
