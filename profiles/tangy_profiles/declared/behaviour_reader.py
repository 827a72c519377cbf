"""Reads the behaviours of an activity's file: effects, persons, texts, phrases."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from itertools import chain
from pathlib import Path

from tangy_profiles.declared.conditions import Facts, Phrasing
from tangy_profiles.declared.items import read_csv
from tangy_profiles.declared.model import PAUSE_SECONDS, DeclaredBehaviour
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.vocabulary import SLOT, Selector
from tangy_profiles.reading import nearest

KEYS = (
    "does",
    "needs",
    "to",
    "says",
    "phrases",
    "wordings",
    "question",
    "posture",
    "image",
    "again",
    "picture",
    "sound",
    "pause",
)
LONGEST_PAUSE = 300.0  # s
POSTURE = "rest"
PHRASE = re.compile(r"[a-z']+( [a-z']+)*")
OF_EACH = " of each"
"""Suffix of a count's name in a slot: the counts of all players."""
SPEECH_COLUMNS = ["behaviour", "strategy", "text"]
Texts = dict[str, tuple[str, ...]]


def read_behaviours(
    top: Section,
    phrasing: Phrasing,
    strategies: Sequence[str],
    plain: str,
    folder: Path,
    columns: Sequence[str],
) -> dict[str, DeclaredBehaviour]:
    """Read all behaviours of a file, and the CSV file of their speech if it names one.

    Args:
        top: the file.
        phrasing: parses conditions and effects.
        strategies: the names of the persuasive strategies.
        plain: the strategy for behaviours that ask nobody to do anything.
        folder: the folder of the CSV files.
        columns: the columns of the items.
    """
    slots = known_slots(phrasing.facts, columns)
    spoken = _read_speech(top, folder, strategies, slots)
    section = top.table("behaviours")
    found: dict[str, DeclaredBehaviour] = {}
    said: dict[str, str] = {}
    for name in section:
        one = section.table(name)
        one.only(*KEYS)
        effects = phrasing.effects(one, "does")
        texts = _read_says(one, strategies, plain, slots) | spoken.get(name, {})
        behaviour = DeclaredBehaviour(
            name,
            effects,
            phrasing.conditions(one, "needs"),
            _read_to(one, phrasing),
            texts,
            _read_phrases(one, name, said),
            one.text("question", name),
            one.text("posture", POSTURE),
            _text(one, "image", one.text("image", ""), slots),
            _read_wordings(one, name, said),
            tuple(_text(one, "again", text, slots) for text in one.texts("again", single=True)),
            one.text("picture", ""),
            one.text("sound", ""),
            one.number("pause", 0.0, LONGEST_PAUSE, PAUSE_SECONDS),
        )
        if behaviour.again and not any(who != "group" for who in behaviour.to):
            one.wrong("again", "needs a person in 'to': it is a person who is asked again")
        for text in set(behaviour.again).intersection(chain.from_iterable(texts.values())):
            one.wrong("again", f"{text!r} stands in 'says' already: use other words", text)
        if behaviour.again and behaviour.invites:
            one.wrong("again", "cannot stand with 'invite': teach when to invite a person again")
        if behaviour.invites and set(texts) != set(strategies) and texts:
            missing = next(s for s in strategies if s not in texts)
            one.wrong("says", f"says nothing by the strategy {missing!r}")
        found[name] = behaviour
    for name in spoken:
        if name not in found:
            top.wrong("speech", f"{name!r} is not a behaviour; {nearest(name, found)}")
    if not found:
        top.wrong("behaviours", "there must be at least 1")
    elif not any(e.does == "finish" for b in found.values() for e in b.effects):
        top.wrong("behaviours", "one of them must 'finish', or no game would end")
    return found


def known_slots(facts: Facts, columns: Sequence[str]) -> list[str]:
    """Return the valid slots of speech and screen texts in an activity."""
    slots = ["name", "n", "turn", *columns]
    for fact in facts.values():
        if not fact.built_in:
            slots.append(fact.name)
            if fact.kind == "count" and fact.per_player:
                slots.append(fact.name + OF_EACH)
    return slots


def _text(section: Section, key: str, text: str, slots: Collection[str]) -> str:
    for slot in SLOT.findall(text):
        if slot not in slots:
            section.wrong(key, f"cannot fill in {{{slot}}}; {nearest(slot, slots)}", text)
    if re.search(r"[{}]", SLOT.sub("", text)):
        section.wrong(key, "has an unpaired brace", text)
    return text


def _read_says(
    section: Section, strategies: Sequence[str], plain: str, slots: Collection[str]
) -> Texts:
    if not isinstance(section.raw("says"), dict):
        texts = section.texts("says", single=True)
        texts = tuple(_text(section, "says", text, slots) for text in texts)
        return {plain: texts} if texts else {}
    table = section.table("says")
    found: Texts = {}
    for name in table:
        if name not in strategies:
            table.wrong(name, f"is not a strategy; {nearest(name, strategies)}")
        texts = table.texts(name, single=True)
        found[name] = tuple(_text(table, name, text, slots) for text in texts)
    return {name: texts for name, texts in found.items() if texts}


def _read_to(section: Section, phrasing: Phrasing) -> tuple[Selector, ...]:
    named = section.texts("to", single=True)
    return tuple(found for one in named if (found := phrasing.selector(section, "to", one)))


def _read_phrases(section: Section, name: str, said: dict[str, str]) -> tuple[str, ...]:
    phrases = section.texts("phrases")
    for phrase in phrases:
        if not PHRASE.fullmatch(phrase):
            section.wrong("phrases", f"{phrase!r} must be small letters, as it is spoken", phrase)
    if PHRASE.fullmatch(name):
        phrases = tuple(dict.fromkeys((*phrases, name)))
    if not phrases:
        section.wrong("phrases", f"{name!r} cannot be spoken: give it phrases", name)
    for phrase in phrases:
        if said.setdefault(phrase, name) != name:
            section.wrong("phrases", f"{phrase!r} belongs to {said[phrase]!r} already", phrase)
    return phrases


def _read_wordings(section: Section, name: str, said: dict[str, str]) -> tuple[str, ...]:
    """Read other wordings of a behaviour; each may belong to only one behaviour."""
    wordings = section.texts("wordings", single=True)
    for wording in wordings:
        if not PHRASE.fullmatch(wording):
            section.wrong("wordings", f"{wording!r} must be small letters, as it is said", wording)
        elif said.setdefault(wording, name) != name:
            section.wrong("wordings", f"{wording!r} belongs to {said[wording]!r} already", wording)
    return wordings


def _read_speech(
    top: Section, folder: Path, strategies: Sequence[str], slots: Collection[str]
) -> Mapping[str, Texts]:
    """Read the CSV file of speech: behaviour, strategy, text."""
    name = top.text("speech", "")
    if not name:
        return {}
    if Path(name).name != name:
        top.wrong("speech", "must be the name of a file beside this one", name)
        return {}
    rows = read_csv(top.source, ("speech",), folder / name)
    if rows and rows[0] != SPEECH_COLUMNS:
        top.wrong("speech", f"{name}: its header must be {','.join(SPEECH_COLUMNS)}")
        return {}
    found: dict[str, Texts] = {}
    for behaviour, strategy, text in rows[1:]:
        if strategy not in strategies:
            near = nearest(strategy, strategies)
            top.wrong("speech", f"{name}: {strategy!r} is not a strategy; {near}", name)
        _text(top, "speech", text, slots)
        texts = found.setdefault(behaviour, {})
        texts[strategy] = (*texts.get(strategy, ()), text)
    return found
