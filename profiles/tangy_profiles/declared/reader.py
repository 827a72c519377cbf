"""Reads a declared activity from its file, and reports every mistake with line and column."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import cast

from tangy_profiles.declared.behaviour_reader import read_behaviours
from tangy_profiles.declared.conditions import ALIKE, Phrasing
from tangy_profiles.declared.facts_reader import read_facts, read_words
from tangy_profiles.declared.items import check_right_answers, read_csv, with_right_options
from tangy_profiles.declared.media import read_media
from tangy_profiles.declared.model import (
    Declaration,
    DeclaredBehaviour,
    Expectation,
    Habit,
    Items,
    Stage,
)
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.source import Path as Place
from tangy_profiles.declared.source import SourceText
from tangy_profiles.declared.vocabulary import (
    ASKING,
    ORDERS,
    SLOT,
    TURNS,
    Order,
    Turns,
)
from tangy_profiles.errors import ProfileError
from tangy_profiles.given_file import lines_of, read_given
from tangy_profiles.phones import read_phones
from tangy_profiles.plain_text import plain
from tangy_profiles.reading import LARGEST_PROFILE, nearest, read_toml

KEYS = (
    *("name", "title", "items", "flags", "teams", "facts", "stages", "expected", "people"),
    *("behaviours", "strategies", "plain_strategy", "speech", "patience", "pronunciations"),
    *("words", "summary", "turns"),
)
PLAIN = "plain"
GROUP = "group"
RESERVED = ("name", "n", "turn")
"""Slots that are not columns of the items."""
HABIT_KEYS = ("while", "chance", "last")
ASKS = "asks"
"""The habit of asking for the robot."""
MOST_TEAMS, MOST_STAGES, LONGEST_LIST = 12, 40, 200


def read_declaration(path: Path) -> Declaration:
    """Read and check an activity's file and the CSV files beside it.

    Raises:
        MistakesError: the file has mistakes; it lists each with its line and column.
        ProfileError: it cannot be read, or is not TOML.
    """
    read_toml(path)  # reports invalid TOML in one line
    text = lines_of(read_given(path, LARGEST_PROFILE, ProfileError))
    source = SourceText(plain(path.name), text)
    top = Section(source, tomllib.loads(text))
    declaration = _read(top, path)
    source.close()
    return declaration


def _read(top: Section, path: Path) -> Declaration:
    top.only(*KEYS)
    items = _read_items(top, path.parent)
    if "items" in top and not items.rows:
        top.source.close()  # most of the other mistakes would only follow from it
    facts = read_words(top, read_facts(top, items.columns))
    items = with_right_options(top, items, facts.values())
    check_right_answers(top, items, facts.values())
    phrasing = Phrasing(facts)
    name = top.text("name", plain(path.stem))
    title = top.text("title", name[:1].upper() + name[1:])
    strategies = {key: top.table("strategies").text(key) for key in top.table("strategies")}
    strategies = strategies or {PLAIN: PLAIN}
    plain_strategy = top.word("plain_strategy", strategies, next(iter(strategies)))
    behaviours = read_behaviours(
        top, phrasing, tuple(strategies), plain_strategy, path.parent, items.columns
    )
    stages = _read_stages(top, phrasing)
    expected = _read_expected(top, phrasing, stages, behaviours)
    return Declaration(
        name=name,
        title=title,
        source=path.name,
        facts=facts,
        stages=stages,
        behaviours=behaviours,
        items=items,
        teams=_read_teams(top),
        turns=cast(Turns, top.word("turns", TURNS, "in order")),
        habits=_read_habits(top, phrasing),
        expected=expected,
        strategies=strategies,
        plain_strategy=plain_strategy,
        summary=top.text("summary", ""),
        patience=top.number("patience", 0.1, 600, 10.0),
        pronunciations=_read_pronunciations(top.table("pronunciations")),
        media=read_media(top, behaviours, items, path.parent),
        whose=phrasing.whose,
        tables=tuple(top.source.tables),
    )


def _read_items(top: Section, folder: Path) -> Items:
    if "items" not in top:
        return Items()
    section = top.table("items")
    section.only("file", "order", "rounds")
    name = section.text("file")
    order = cast(Order, section.word("order", ORDERS, "given"))
    if not name or Path(name).name != name:
        if name:
            section.wrong("file", "must be the name of a file beside this one", name)
        return Items()
    rows = read_csv(section.source, ("items", "file"), folder / name)
    if not rows:
        section.whole("rounds", 1, 999, 1)
        return Items()
    wrong = [one for one in rows[0] if one in RESERVED or not one.isidentifier()]
    for column in wrong:
        words = "_".join(re.findall(r"\w+", column))
        such = f", such as {words!r}" if words.isidentifier() and words not in RESERVED else ""
        problem = f"a column cannot be called {column!r}: give it a name of one word{such}"
        section.wrong("file", f"{name}: {problem}", name)
    if wrong:
        return Items()
    rounds = section.whole("rounds", 1, len(rows) - 1, len(rows) - 1)
    return Items(tuple(rows[0]), tuple(map(tuple, rows[1:])), order, rounds, plain(name))


def _read_teams(top: Section) -> tuple[str, ...]:
    teams = top.texts("teams")
    if "teams" in top and not 1 <= len(set(teams)) == len(teams) <= MOST_TEAMS:
        top.wrong("teams", f"must be from 1 to {MOST_TEAMS} names, each another")
    return teams


def _read_stages(top: Section, phrasing: Phrasing) -> tuple[Stage, ...]:
    stages: list[Stage] = []
    sections = top.tables("stages")
    for place, section in enumerate(sections):
        section.only("name", "when", "about", "sees", "words")
        name = section.text("name")
        if any(stage.name == name for stage in stages):
            section.wrong("name", f"the stage {name!r} stands here twice", name)
        sees = section.texts("sees")
        for one in sees:
            fact = phrasing.fact(section, "sees", one, one)
            if fact is not None and not fact.values:
                section.wrong("sees", f"{one!r} is a number: give it bands to see it by", one)
        known = [one for one in sees if one in phrasing.facts and phrasing.facts[one].values]
        when = phrasing.conditions(section, "when")
        last = place == len(sections) - 1
        if last and section.texts("when"):
            section.wrong("when", "the last stage must have none, or a game could be in no stage")
        if not last and not section.texts("when"):
            section.wrong("name", f"no stage after {name!r} can be reached: give it 'when'", name)
        about = section.text("about", GROUP)
        about = phrasing.selector(section, "about", about) or GROUP
        words = section.text("words", "")
        for slot in SLOT.findall(words):
            if slot != "name":
                section.wrong("words", f"{{{slot}}} is not known; only {{name}} is", slot)
        stages.append(Stage(name, when, about, tuple(known), words))
    if not 1 <= len(stages) <= MOST_STAGES:
        top.wrong("stages", f"there must be from 1 to {MOST_STAGES}")
    return tuple(stages)


def _read_habits(top: Section, phrasing: Phrasing) -> tuple[Habit, ...]:
    habits: list[Habit] = []
    people = top.table("people")
    for name in people:
        section = people.table(name)
        fact = phrasing.facts.get(ASKING if name == ASKS else name)
        if fact is None or (fact.built_in and name != ASKS) or fact.kind in ("test", "timer"):
            known = [n for n, f in phrasing.facts.items() if not f.built_in and f.kind != "test"]
            near = nearest(name, [*known, ASKS])
            people.wrong(name, f"{name!r} is nothing that people do; {near}")
            continue
        when = phrasing.conditions(section, "while")
        chance = section.number("chance", 0.0, 1.0, 0.1)
        values = ("yes",) if name == ASKS or fact.kind == "count" else fact.values
        weights: list[tuple[str, float]] = []
        for key in section:
            if key in HABIT_KEYS:
                continue
            if key not in values:
                near = nearest(key, (*values, *HABIT_KEYS))
                section.wrong(key, f"is neither a key nor a value here; {near}")
            else:
                weights.append((key, section.number(key, 0.0, LONGEST_LIST, 1.0)))
        last = section.texts("last")
        for one in last:
            if one not in values:
                section.wrong("last", f"{one!r} is no value here; {nearest(one, values)}", one)
        usual = [(value, 1.0) for value in (values[1:] or values)]
        habits.append(Habit(fact.name, when, chance, tuple(weights or usual), last))
    return tuple(habits)


def _read_expected(
    top: Section,
    phrasing: Phrasing,
    stages: Sequence[Stage],
    behaviours: Mapping[str, DeclaredBehaviour],
) -> tuple[Expectation, ...]:
    found: list[Expectation] = []
    lines = top.raw("expected") if "expected" in top else []
    good = isinstance(lines, list) and all(
        isinstance(one, list) and len(one) >= 2 and all(isinstance(word, str) for word in one)
        for one in lines
    )
    if not good:
        top.wrong("expected", "must be a list of lists: stage, conditions, behaviour")
        return ()
    names = [stage.name for stage in stages]
    places: dict[str, Place] = {one: ("stages", n, "name") for n, one in enumerate(names)}
    misspelt = _misspelt(top, places, {stage for stage, *_ in lines})
    places = {one: ("behaviours", one) for one in behaviours}
    misspelt |= _misspelt(top, places, {one.partition("->")[0].strip() for *_, one in lines})
    for line in lines:
        stage, *conditions, last = line
        behaviour, _, to = (part.strip() for part in last.partition("->"))
        if stage not in names and names and stage not in misspelt:
            top.wrong("expected", f"{stage!r} is not a stage; {nearest(stage, names)}", stage)
        if behaviour not in behaviours and behaviours and behaviour not in misspelt:
            near = nearest(behaviour, behaviours)
            top.wrong("expected", f"{behaviour!r} is not a behaviour; {near}", last)
        to = phrasing.selector(top, "expected", to, last) if to else ""
        if to and behaviour in behaviours and to not in behaviours[behaviour].to:
            top.wrong("expected", f"{behaviour!r} lacks {to!r} among its 'to'", last)
        conditions_of = phrasing.all_of(top, "expected", conditions)
        found.append(Expectation(stage, conditions_of, behaviour, to or None))
    return tuple(found)


def _misspelt(top: Section, named: Mapping[str, Place], expected: Collection[str]) -> set[str]:
    """Return the expected names that are spelt otherwise where the file defines them; record those.

    A name is meant by an unknown one if it is much like it, and is not expected itself.

    Args:
        top: the file.
        named: where the file defines each name.
        expected: the names in `expected`.
    """
    unused, found = [name for name in named if name not in expected], set[str]()
    for name in sorted(set(expected).difference(named)):
        near = get_close_matches(name, unused, 1, ALIKE)
        if near:
            line = top.source.line(("expected",), f'"{name}')
            problem = f"{near[0]!r} is {name!r} in 'expected' (line {line}); use one spelling"
            top.source.wrong(named[near[0]], problem, near[0], cause=True)
            found.add(name)
    return found


def _read_pronunciations(section: Section) -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for word in section:
        ways = []
        for way in section.texts(word, single=True):
            try:
                ways.append(read_phones(way))
            except ProfileError as error:
                section.wrong(word, str(error), way)
        found[word] = tuple(ways)
    return found
