"""Erasure of a person's name from texts, without any other change.

A name is found as a whole word in all spellings: lower case, without accents, with other spaces or
hyphens, and as HTML, JSON and URLs encode it. Similar words stay: longer names of other people,
phrases of the activity ("mark numbers", if a person is called Mark), and in running text the common
words that some names are ("will", "may").
"""

from __future__ import annotations

import html
import itertools
import json
import math
import re
import unicodedata
from collections.abc import Collection, Iterable, Mapping
from functools import cache
from typing import Any
from urllib.parse import quote

from tangy_profiles.codec import keys_of
from tangy_profiles.defaults import SHIPPED
from tangy_profiles.events import kinds
from tangy_profiles.reading import read_toml

FREE_TEXT = frozenset(("heard", "how", "what", "why", "stopped"))
"""The keys of an event's body that hold people's words."""
SENTENCES = frozenset(("console", "advice", "speech", "image"))
"""The keys that hold Tangy's sentences, in which a name is spelt exactly."""
WHOSE = frozenset(("teacher", "by", "who"))
"""The keys with a teacher's or staff member's name, who may have the same name."""
OWN_WORDS = frozenset(("demonstrations edited", "speech noted", "taken back"))
"""The kinds of event whose `what` is one of Tangy's own words."""

OWN_PHRASE = "own phrase"
"""The kind of event whose `text` is a phrase that a teacher taught."""
SAID = frozenset(("told", "heard", "noted"))
"""What staff did if the `detail` of their action holds what a person said, or a note in words."""

MOST_SPELLINGS = 128
"""The most spellings of a name with special letters; beyond that, fewer mixtures are searched."""

_SPELT_OUT = {"ä": ("ae",), "ö": ("oe",), "ü": ("ue",), "å": ("aa",), "ø": ("o", "oe"),
              "æ": ("ae",), "œ": ("oe",), "ß": ("ss",), "ł": ("l",), "đ": ("d",)}  # fmt: skip
_MARKS = "\u0300-\u036f"  # combining accents
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
_HEARD = (
    rb'("target":"%b"(?:(?!"heard":|\dT\d\d:).){0,4000}"heard":")((?:[^"\\\x00-\x1f]|\\.)*)(?=")'
)
"""Words heard for a person, in the bytes of a log, before the time of the next event."""
_OWN_PHRASE = re.compile(
    rb'("teacher":"(?:[^"\\\x00-\x1f]|\\.)*","text":")((?:[^"\\\x00-\x1f]|\\.)*)(?=","behaviour":)'
)
"""A teacher's own phrase, in the bytes of a log."""
_SHOWN = re.compile(
    r"""(?i)\b(title|alt|aria-label|content|value|label)(\s*=\s*)("[^"]*"|'[^']*')"""
)


class NameEraser:
    """Replaces a person's name by a stand-in (the person's id)."""

    def __init__(
        self,
        names: Iterable[str],
        stand_in: str,
        *,
        said: Iterable[str] = (),
        but: Collection[str] = (),
        commands: Collection[str] = (),
    ) -> None:
        """Compile the patterns.

        Args:
            names: the names to erase, as they are written.
            stand_in: the replacement.
            said: the spoken forms of the names.
            but: phrases and other people's names that contain the name and stay.
            commands: the words of commands, in lower case. In a command for the person every other
                word may be the name misspelt or misheard, and is erased; if empty, only the parts
                of the name are erased.
        """
        self.names = tuple(dict.fromkeys(name.strip() for name in names if name.strip()))
        self.stand_in = stand_in
        self._commands = frozenset(commands)
        self._heard = re.compile(_HEARD % re.escape(stand_in.encode()), re.S)
        plain = [name for name in self.names if not _is_small(name)]
        typed = {form for name in (*self.names, *said) for form in _forms(name)}
        anywhere = {form for name in plain for form in _forms(name)}
        small = [name for name in self.names if _is_small(name) and len(_letters(name)) > 1]
        written = {form for name in small for form in (name, name.title(), name.upper())}
        self._anchors = frozenset(_anchor(form) for form in typed)
        self._typed = self._pattern(typed, (), but)
        self._running = self._pattern(anywhere, written, but)
        self._exact = self._pattern((), [name for name in plain if len(_letters(name)) > 2], but)
        several = [_TOKEN.findall(name) for name in self.names]
        words = {word for parts in several if parts[1:] for word in parts if len(word) > 1}
        parts = sorted({form for word in words for form in _forms(word)}, key=_longest)
        self._anchors |= {_anchor(form) for form in parts}
        spelt = "|".join(map(re.escape, parts)) or "(?!)"
        self._parts = re.compile(rf"\b(?:{spelt})\b", re.I)
        own = {form for word in words if not _is_small(word) for form in _forms(word)}
        self._own = self._pattern(typed | own, (), but)
        self._bytes = [
            _bytes_pattern(form, stand_in, self._stays([form], but), flags)
            for forms, flags in ((anywhere, re.I), (written, re.NOFLAG))
            for form in sorted(forms, key=_longest)
        ]

    def may_hold(self, text: str) -> bool:
        """Return quickly whether a text may contain the name; most do not."""
        folded = text.casefold()
        return any(anchor in folded for anchor in self._anchors)

    def may_change(self, body: str) -> bool:
        """Return quickly whether a stored body may have to change."""
        return self.may_hold(body) or f'"target":"{self.stand_in}"' in body

    def text(self, text: str) -> str:
        """Erase the name from running text, such as a report."""
        return self._put(self._running, text)

    def typed(self, text: str) -> str:
        """Erase the name from typed or spoken text, which is in lower case."""
        return self._put(self._typed, text)

    def page(self, page: str) -> str:
        """Erase the name from the visible text of an HTML page or SVG; tags and styles stay."""
        return _HTML.sub(self._shown, page)

    def body(self, kind: str, body: dict[str, Any]) -> dict[str, Any]:
        """Return the body of an event without the name in its free texts.

        In a typed or spoken command for the person, every part of the name is erased too, as people
        say "Rosa" or "Frau Weber". So it is in a teacher's own phrase, which may be for nobody, but
        common words stay there ("may").
        """
        did = body.get("did")
        if kind == OWN_PHRASE and isinstance(body.get("text"), str):
            return {**body, "text": self._put(self._own, body["text"])}
        left = {key: self._value(value, _kept_in(kind, key, did)) for key, value in body.items()}
        heard = left.get("heard")
        if left.get("target") == self.stand_in and isinstance(heard, str):
            heard = self._parts.sub(self.stand_in, heard)
            left["heard"] = _TOKEN.sub(self._command_word, heard) if self._commands else heard
        return left

    def is_left(self, body: Mapping[str, Any]) -> bool:
        """Return whether a body has the name as a teacher's or staff member's."""
        words = (body[key] for key in WHOSE if isinstance(body.get(key), str))
        return any(self.typed(word) != word for word in words)

    def overwrite(self, data: bytes) -> bytes:
        """Overwrite the name in binary data, without changing its length.

        It is also found directly after the person's id, as in a table of names. In commands for the
        person, all words that are not command words are overwritten.
        """
        if self._commands:
            data = self._heard.sub(self._heard_bytes, data)
        data = _OWN_PHRASE.sub(self._own_bytes, data)
        for found in self._bytes:
            data = found.sub(lambda m: b"-" * len(m["name"]) if m["name"] else m[0], data)
        return data

    def _value(self, value: Any, kept: str) -> Any:
        pattern = {"typed": self._typed, "running": self._running, "exact": self._exact}.get(kept)
        if isinstance(value, str):
            return self._put(pattern, value)
        if isinstance(value, list):
            return [self._value(item, kept) for item in value]
        if isinstance(value, dict) and kept == "running":
            return {key: self._value(item, kept) for key, item in value.items()}
        return value

    def _heard_bytes(self, match: re.Match[bytes]) -> bytes:
        heard = match[2].decode(errors="surrogateescape")
        left = _TOKEN.sub(
            lambda m: m[0] if self._command_word(m) == m[0] else "-" * len(m[0].encode()), heard
        )
        return match[1] + left.encode(errors="surrogateescape")

    def _own_bytes(self, match: re.Match[bytes]) -> bytes:
        text = match[2].decode(errors="surrogateescape")
        if self._own is None or not self.may_hold(text):
            return match[0]
        left = self._own.sub(lambda m: "-" * len(m[0].encode()) if m["name"] else m[0], text)
        return match[1] + left.encode(errors="surrogateescape")

    def _command_word(self, match: re.Match[str]) -> str:
        word = match[0].casefold()
        stays = word in self._commands or word.isdecimal() or match[0] == self.stand_in
        return match[0] if stays else self.stand_in

    def _shown(self, match: re.Match[str]) -> str:
        if match["text"]:
            alone = html.unescape(match["text"]).strip() in self.names
            return self.stand_in if alone else self.text(match["text"])
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
        """Compile the pattern of a name: `forms` in any case, `written` case-sensitive.

        Phrases to keep that contain the name come first.
        """
        sought = [_one(form, "i") for form in sorted(forms, key=_longest)]
        sought += [_one(form, "") for form in sorted(written, key=_longest)]
        if not sought:
            return None
        name = re.compile("|".join(sought))
        kept = [_one(text, "i") for text in self._stays([name], but)]
        return re.compile("|".join([*kept, f"(?P<name>{name.pattern})"]))

    def _stays(self, sought: Iterable[str | re.Pattern[str]], but: Collection[str]) -> list[str]:
        """Return the phrases that contain the name among other words, longest first."""
        own = {_plainest(name) for name in self.names}
        found = [
            text
            for text in but
            if _plainest(text) not in own
            and any(
                one.search(text)
                if isinstance(one, re.Pattern)
                else one.casefold() in text.casefold()
                for one in sought
            )
        ]
        return sorted(found, key=_longest)


def _kept_in(kind: str, key: str, did: object) -> str:
    """Return how a key of a body may contain a name ("": not at all); `did` is its key `did`.

    "typed" is typed or spoken text, "running" is text by people or an unknown key, and "exact" a
    sentence of Tangy.
    """
    if key == "heard":
        return "typed"
    if key in SENTENCES or (kind, key) == ("fault", "why"):
        return "exact"
    if key in FREE_TEXT:
        return "" if key == "what" and kind in OWN_WORDS else "running"
    if (kind, key) == ("answer not clear", "said"):
        return "running"
    if (kind, key) == ("staff action", "detail") and did in SAID:
        return "running"
    known = keys_of(kinds()[kind]) if kind in kinds() else frozenset()
    return "" if key in known or key in WHOSE else "running"


def _is_small(name: str) -> bool:
    """Return whether a name is also a common word, or too short."""
    return name.casefold() in small_words() or len(_letters(name)) < 2


def _letters(name: str) -> str:
    return "".join(_TOKEN.findall(name))


@cache
def small_words() -> frozenset[str]:
    """Return the common words that are also names."""
    top = read_toml(SHIPPED / "people" / "small_words.toml")
    words = frozenset(top.texts("words"))
    top.close()
    return words


def _forms(name: str) -> tuple[str, ...]:
    """Return all encodings of a name in files, in any case."""
    plainly = [name]
    for spelling in _spellings(unicodedata.normalize("NFC", name)):
        plainly += [spelling, unicodedata.normalize("NFD", spelling)]
    plainly += [_APOSTROPHES.sub("", form) for form in plainly]
    plainly += [form.casefold() for form in plainly]
    coded = [json.dumps(form)[1:-1] for form in plainly]
    coded += [html.escape(form) for form in plainly] + [quote(form) for form in plainly]
    return tuple(dict.fromkeys(form for form in (*plainly, *coded) if form))


def _spellings(name: str) -> list[str]:
    """Return spellings of a name: each special letter as it is, without accents, or spelt out."""
    letters = [tuple(dict.fromkeys((letter, *_plainer(letter)))) for letter in name]
    if math.prod(map(len, letters)) > MOST_SPELLINGS:  # then all letters in the same way
        return ["".join(options[min(way, len(options) - 1)] for options in letters)
                for way in range(3)]  # fmt: skip
    return ["".join(chosen) for chosen in itertools.product(*letters)]


def _plainer(letter: str) -> tuple[str, ...]:
    """Return what people type if their keyboard lacks a letter."""
    bare = _ACCENTS.sub("", unicodedata.normalize("NFKD", letter))
    return (unicodedata.normalize("NFC", bare), *_SPELT_OUT.get(letter.casefold(), ()))


def _plainest(text: str) -> str:
    return " ".join(_TOKEN.findall(text.casefold()))


def _anchor(form: str) -> str:
    """Return the longest ASCII part of a form, which every text with the form contains."""
    parts = re.findall("[a-z0-9]+", form.casefold())
    return max(parts, key=len) if parts else form.casefold()


def _longest(text: str) -> tuple[int, str]:
    return -len(text), text


def _one(text: str, flags: str) -> str:
    """Return the pattern of one form: its words with any spaces, as whole words."""
    tokens = _TOKEN.findall(text)
    coded = "&" in text or "\\" in text or "%" in text
    if tokens and not coded:
        before, after = text[: text.index(tokens[0])], text[text.rindex(tokens[-1]) :]
        inner = re.escape(before) + _BETWEEN.join(map(re.escape, tokens))
        inner += re.escape(after.removeprefix(tokens[-1]))
    else:
        inner = re.escape(text)
    if not _UNSPACED.search(text):
        inner = rf"(?<!\w){inner}" if text[0].isalnum() or coded else inner
        inner = rf"{inner}(?![\w{_MARKS}])" if text[-1].isalnum() or coded else inner
    return f"(?{flags}:{inner})" if flags else f"(?:{inner})"


def _bytes_pattern(
    form: str, id: str, stays: Iterable[str], flags: re.RegexFlag
) -> re.Pattern[bytes]:
    """Return a pattern that finds a form as a whole word, or directly after the person's id."""
    edge, sought = rb"[0-9A-Za-z_\x80-\xff]", re.escape(form.encode())
    kept = b"".join(b"%b|" % re.escape(text.encode()) for text in stays)
    sides = b"(?<!%b)%b(?!%b)|(?<=%b)%b" % (edge, sought, edge, re.escape(id.encode()), sought)
    return re.compile(b"%b(?P<name>%b)" % (kept, sides), flags)
