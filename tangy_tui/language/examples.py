"""Training sentences for the intent model, made from an activity's own words.

Templates (`asking.toml`) are filled with each behaviour's phrases, question and name; negative
examples are talk with the same words. What many activities have (a greeting, a hint, the scores) is
learnt from `common_requests.toml` as well. A person or seat is one token, so the model does not
depend on the participants.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from itertools import cycle
from typing import Any, NamedTuple

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_tui.language.words import Words, spoken, words_of

SOMEBODY = "somebody0"
"""The token for a person or a seat; no text contains it."""
ASKS = "ask"  # first word of a question that asks a person to do something
ARTICLES = frozenset(("a", "an", "the", "any", "next", "another"))
MADE = ARTICLES - {"the"}  # before a new thing, not an existing one
EVERY = 3  # each phrase is used with one in this many templates
PEOPLE = 2  # a sentence is spoken with so many people
WORDED = 6  # each other wording is used with one in this many templates of talk


class Example(NamedTuple):
    """A sentence, and the behaviour that it asks for; "" for none."""

    words: Words
    behaviour: str


@cache
def templates() -> Mapping[str, Any]:
    """Return the templates of requests and talk."""
    return _read("asking.toml")


@cache
def common_requests() -> Sequence[Mapping[str, Sequence[str]]]:
    """Return requests that many activities share: `asks`, `talk`, and the texts they are `of`."""
    return tuple(_read("common_requests.toml")["common"])


def wordings_of(behaviour: Behaviour) -> tuple[str, ...]:
    """Return other wordings of a behaviour: the activity's own, then common ones."""
    them = cycle(templates()["people_said"])
    common = (
        _fill(form, them=who["them"], sub=who["sub"], their=who["their"])
        for form, who in zip(_common(behaviour).get("asks", ()), them, strict=False)
    )
    return tuple(dict.fromkeys((*behaviour.wordings, *common)))


def examples_of(activity: Activity) -> tuple[Example, ...]:
    """Return the training sentences of an activity, without duplicates, in a fixed order."""
    found: dict[Words, str] = {}
    behaviours = activity.behaviours.values()
    for behaviour in behaviours:  # first, as no common request may take them
        for text in (*own_phrases(behaviour), *behaviour.wordings):
            found.setdefault(_words(text), behaviour.name)
    for behaviour in behaviours:
        for text in _asking(behaviour, activity):
            found.setdefault(_words(text), behaviour.name)
    for text in _talk(activity):
        found.setdefault(_words(text), "")
    return tuple(Example(words, behaviour) for words, behaviour in found.items() if words)


def spoken_examples(activity: Activity, people: Sequence[str]) -> Iterator[str]:
    """Yield the training sentences as they are spoken, with ways to refer to people in turn."""
    them = cycle(people or ("somebody",))
    for words, _ in examples_of(activity):
        for _ in range(PEOPLE if SOMEBODY in words else 1):
            yield " ".join(next(them) if word == SOMEBODY else spoken((word,)) for word in words)


def _asking(behaviour: Behaviour, activity: Activity) -> Iterator[str]:
    """Yield sentences that ask for a behaviour, its own phrases first."""
    known = templates()
    own = own_phrases(behaviour)
    yield from own
    for place, phrase in enumerate(own):
        for form in known["asking"][place % EVERY :: EVERY]:
            yield _fill(form, do=phrase, doing=_doing(phrase))
    for text in wordings_of(behaviour):
        for form in known["wordings"]:
            yield _fill(form, do=text)
    for thing in _things(behaviour, MADE):
        for form in known["things"]:
            yield form.replace("{thing}", thing)
    yield from _by_effect(behaviour, activity)
    if _asks(behaviour):
        yield from _through(behaviour, known)
    elif behaviour.persuades:
        them = cycle(known["them"])
        for phrase in own:
            for form in known["saying"]:
                yield _fill(form, do=phrase, them=next(them))


def _by_effect(behaviour: Behaviour, activity: Activity) -> Iterator[str]:
    """Yield sentences that ask for the effect of a behaviour."""
    known = templates()
    goes = behaviour.visits
    them, sub = cycle(known["them"]), cycle(known["sub"])
    for form in known["effects"].get(behaviour.effect, ()):
        for who in (SOMEBODY, *_people(behaviour)) if goes else ("",):
            for thing in _things(behaviour, MADE) or ("one",):
                filled = _fill(form, who=who, thing=thing, object=activity.object)
                yield _fill(filled, them=next(them), sub=next(sub))


def _through(behaviour: Behaviour, known: Mapping[str, Any]) -> Iterator[str]:
    """Yield sentences that tell a person to do what the behaviour asks for."""
    them, sub = cycle((*known["them"], SOMEBODY)), cycle(known["sub"])
    for phrase in own_phrases(behaviour):
        they = _without_asking(phrase)
        for form in known["through"]:
            yield _fill(form, they=they, them=next(them), sub=next(sub))


def _talk(activity: Activity) -> Iterator[str]:
    """Yield sentences that ask for nothing."""
    talk = templates()["talk"]
    yield from talk["other"]
    for behaviour in activity.behaviours.values():
        phrases = tuple(map(_without_asking, own_phrases(behaviour)))
        wordings = wordings_of(behaviour)
        things = _things(behaviour, ARTICLES)
        yield from _common(behaviour).get("talk", ())
        for place, form in enumerate(talk["about"]):
            if "{do" in form or "{did}" in form:
                some = phrases[place % EVERY :: EVERY]
                some += wordings[place % WORDED :: WORDED]
                for phrase in some:
                    yield _fill(form, do=phrase, doing=_doing(phrase), did=_did(phrase))
            elif "{thing}" in form:
                yield from (form.replace("{thing}", thing) for thing in things)
            elif "{who}" in form:
                yield form.replace("{who}", SOMEBODY)
            else:
                yield form.replace("{object}", activity.object)


def _common(behaviour: Behaviour) -> Mapping[str, Sequence[str]]:
    """Return the first common request whose words are in a text of a behaviour."""
    own = [set(words_of(phrase)) for phrase in own_phrases(behaviour)]
    for known in common_requests():
        if any(text.issuperset(words_of(key)) for key in known["of"] for text in own):
            return known
    return {}


def own_phrases(behaviour: Behaviour) -> tuple[str, ...]:
    """Return the activity's texts for a behaviour: phrases, question, name."""
    return tuple(dict.fromkeys((*behaviour.phrases, behaviour.question, behaviour.name)))


def _asks(behaviour: Behaviour) -> bool:
    return words_of(behaviour.question)[:1] == (ASKS,)


def _without_asking(phrase: str) -> str:
    words = phrase.split()
    return " ".join(words[2:]) if words[:2] == [ASKS, "to"] else phrase


def _things(behaviour: Behaviour, after: frozenset[str]) -> tuple[str, ...]:
    """Return the words after an article in the phrases of a behaviour: "joke"."""
    if behaviour.drives:
        return ()
    found = (
        word
        for phrase in own_phrases(behaviour)
        for before, word in zip(phrase.split(), phrase.split()[1:], strict=False)
        if before in after and word not in ARTICLES
    )
    return tuple(dict.fromkeys(found))


def _people(behaviour: Behaviour) -> tuple[str, ...]:
    """Return references to an unnamed person: "the player", "her"."""
    nouns = dict.fromkeys(words_of(phrase)[-1] for phrase in behaviour.phrases)
    return (*(f"the {noun}" for noun in nouns), *templates()["them"][:3])


def _doing(phrase: str) -> str:
    """Return the present participle of a phrase: "telling a joke"."""
    verb, _, rest = phrase.partition(" ")
    if verb.endswith("e") and not verb.endswith("ee"):
        verb = verb[:-1]
    return f"{verb}ing {rest}".strip()


def _did(phrase: str) -> str:
    """Return the past tense of a phrase: "told a joke"."""
    verb, _, rest = phrase.partition(" ")
    told = templates()["past"].get(verb, verb + ("d" if verb.endswith("e") else "ed"))
    return f"{told} {rest}".strip()


def _read(name: str) -> Mapping[str, Any]:
    content = files("tangy_tui.language").joinpath(name).read_text(encoding="utf-8")
    return tomllib.loads(content)


def _fill(form: str, **parts: str) -> str:
    for name, text in parts.items():
        form = form.replace(f"{{{name}}}", text)
    return form


def _words(text: str) -> Words:
    """Split a generated sentence into words, keeping the token for a person."""
    told: Sequence[str] = text.split(SOMEBODY)
    words: list[str] = []
    for place, part in enumerate(told):
        words += [*([SOMEBODY] if place else []), *words_of(part)]
    return tuple(words)
