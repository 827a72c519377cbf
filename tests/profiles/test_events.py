"""The kinds of event are a closed set; code that uses another kind is named."""

from __future__ import annotations

import ast
import copy
import json
import re
import sys
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import is_dataclass
from functools import cache
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles import codec, events, records
from tangy_profiles.codec import InvalidValue, encode, fields_of
from tangy_profiles.events import EventRecord, Unknown, kinds, read_record
from tangy_profiles.game_records import MoveKind
from tangy_profiles.health import Fact
from tangy_profiles.people_records import PersonAdded
from tangy_profiles.persuading import PERIODS, PERSUASION_METHODS, PRIORS
from tangy_profiles.records import kind
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.state import ActivityState, Request, Situation, UserState
from tangy_tui.text import fault_moves
from tests.support.laws import tried

ROOT = Path(__file__).parents[2]
CODE = [ROOT / top for top in ("tangy_tui", "hw/tangy_hw", "sim/tangy_sim", "profiles")]
NOT_READ = {
    "Renamed": "names stand in a table",
    "SpeechNoted": "how people are spoken to stands in a table",
    "PersonForgotten": "it is for people who look at the log",
}
"""The records that the program writes and never reads, with reasons."""

# ------------------------------------------------------------------ every place of every kind


@cache
def places() -> tuple[set[str], set[str]]:
    """Return the records that the program's code makes, and those that it reads.

    To save time, sources that name no record are not parsed.
    """
    names = {record.__name__ for record in kinds().values()}
    some = re.compile(rf"\b(?:{'|'.join(names)})\b")
    made, named = set[str](), set[str]()
    for path in (path for top in CODE for path in sorted(top.rglob("*.py"))):
        source = path.read_text(encoding="utf-8")
        if not some.search(source):
            continue
        nodes = list(ast.walk(ast.parse(source)))
        called = [node.func for node in nodes if isinstance(node, ast.Call)]
        makers = [call.value if isinstance(call, ast.Attribute) else call for call in called]
        made |= {maker.id for maker in makers if isinstance(maker, ast.Name)} & names
        if path.name not in (
            "people_records.py",
            "teaching_records.py",
            "game_records.py",
            "staff_records.py",
        ):
            there = {id(call) for call in called}
            found = (n.id for n in nodes if isinstance(n, ast.Name) and id(n) not in there)
            named |= names.intersection(found)
    return made, named


@pytest.mark.parametrize("of", sorted(kinds()))
def test_every_kind_of_event_is_written_and_read_by_the_program(of: str) -> None:
    record: type[EventRecord] = kinds()[of]
    name = record.__name__
    made, read = places()
    assert name in made, f"{name} ({record.KIND!r}): nothing in the program writes it"
    assert name in read or name in NOT_READ, (
        f"{name} ({record.KIND!r}): nothing in the program reads it; read it, or say in NOT_READ "
        f"of {Path(__file__).name} why it is only kept"
    )


def test_every_record_is_in_a_known_module() -> None:
    known = {f"tangy_profiles.{module}" for module in events.MODULES}
    strange = {r.__name__: r.__module__ for r in kinds().values() if r.__module__ not in known}
    assert strange == {}, "name their modules in MODULES of tangy_profiles.events"


def test_no_code_reads_events_by_the_keys_of_their_body() -> None:
    reads = [
        f"{path.relative_to(ROOT)}:{number}"
        for top in CODE
        for path in sorted(top.rglob("*.py"))
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if ".body[" in line or ".body.get(" in line
    ]
    assert reads == []


def test_the_program_writes_no_event_that_has_no_record() -> None:
    makes = [path.name for path in (p for top in CODE for p in sorted(top.rglob("*.py")))
             if "Unknown(" in path.read_text()]  # fmt: skip
    assert makes == ["events.py", "records.py", "rows.py"], "give the kind a record"


def test_a_kind_has_one_record() -> None:
    with pytest.raises(TypeError, match="GameStep is the record of 'game step' already"):
        kind("game step")(type("Other", (EventRecord,), {"__annotations__": {}}))


def test_every_move_about_a_fault_has_words() -> None:
    assert set(get_args(MoveKind)) == set(fault_moves.MOVES)


# ------------------------------------------------------------------------------- round trips

WORDS = st.text(max_size=8)
COUNTS = st.integers(0, 10**9)
NUMBERS = st.integers(-(10**9), 10**9) | st.floats(-1e9, 1e9)
OF_FIELDS: dict[str, st.SearchStrategy[Any]] = {
    "trees": st.integers(1, 1_000),
    "min_samples_leaf": st.integers(1, 1_000_000),
    "method": st.sampled_from(PERSUASION_METHODS),
    "prior": st.sampled_from(PRIORS),
    "forgetting": st.floats(0.5, 1),
    "forgetting_per": st.sampled_from(PERIODS),
}


@st.composite
def states(draw: st.DrawFn) -> ActivityState:
    ids, request = ("user1", "user2"), st.sampled_from(get_args(Request))
    return ActivityState(
        draw(COUNTS),
        Situation(draw(WORDS), draw(request), draw(WORDS)),
        draw(WORDS),
        draw(st.none() | st.sampled_from(ids)),
        tuple(UserState(id, draw(WORDS), draw(request)) for id in ids),
        draw(st.none() | WORDS),
    )


def records_of(kind: Any) -> st.SearchStrategy[Any]:
    """Return a strategy of records with generated fields."""
    hints = get_type_hints(kind, include_extras=True)
    names = [field.name for field in fields_of(kind)]
    made = {n: OF_FIELDS[n] if n in OF_FIELDS else values(hints[n]) for n in names}
    return st.builds(kind, **made).filter(lambda one: not getattr(one, "invalid_reason", str)())


def values(hint: Any) -> st.SearchStrategy[Any]:
    """Return a strategy for the values of a type."""
    origin, args = get_origin(hint), get_args(hint)
    if hint is Any:
        return st.none() | WORDS
    if hint == Fact:
        return st.booleans() | WORDS | NUMBERS
    if hint is float:
        return NUMBERS
    if hint is ActivityState:
        return states()
    if origin is Annotated:
        return COUNTS if args[0] is int else values(args[0]).filter(lambda one: one != ())
    if origin in (Union, UnionType):
        return st.one_of([st.none() if one is NoneType else values(one) for one in args])
    if origin is tuple:
        if args[-1] is ...:
            return st.lists(values(args[0]), max_size=3).map(tuple)
        return st.tuples(*map(values, args))
    if origin is Mapping:
        return st.dictionaries(WORDS, values(args[1]), max_size=3)
    if hasattr(hint, "_fields"):
        return st.builds(hint, *map(values, get_type_hints(hint).values()))
    return records_of(hint) if is_dataclass(hint) else st.from_type(hint)


@pytest.mark.parametrize("name", sorted(kinds()))
def test_a_record_is_read_back_unchanged(name: str) -> None:
    @settings(max_examples=30, deadline=None)
    @given(records_of(kinds()[name]))
    def goes_round(record: EventRecord) -> None:
        text = json.dumps(record.body, allow_nan=False)
        assert read_record(name, "p", "s", json.loads(text)) == record

    goes_round()


OLD = (
    (Path(__file__).parent / "bodies_before_records.jsonl").read_text(encoding="utf-8").splitlines()
)


MOVED = {("staff action", "what"): "detail"}
"""The key in which a later version stores a value."""


@pytest.mark.parametrize("row", OLD, ids=[f"{json.loads(row)[0]}-{n}" for n, row in enumerate(OLD)])
def test_events_from_before_records_are_read_and_written_alike(row: str) -> None:
    kind, person, strategy, body = json.loads(row)
    now = json.loads(json.dumps(read_record(kind, person, strategy, body).body))
    assert {key: now.get(MOVED.get((kind, key), key), "is gone") for key in body} == body


def test_every_old_kind_of_event_is_known() -> None:
    assert {json.loads(row)[0] for row in OLD} <= kinds().keys()


@given(states(), st.data())
def test_quick_decoding_of_a_state_equals_strict_decoding(state: ActivityState, data: Any) -> None:
    table = json.loads(json.dumps(encode(state)))
    assert ActivityState.decode_quickly(table) == state
    spoilt = data.draw(st.sampled_from(sorted(table)))
    table[spoilt] = data.draw(ODD)
    glance = ActivityState.decode_quickly(table)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ActivityState, "decode_quickly", lambda _: None)
        closely = codec.reader.__wrapped__(ActivityState)
        assert glance is None or closely(table) == glance


ODD: Any = st.recursive(
    st.sampled_from(["user1", "AR", "", 1, -1, 10**13, True, None, 1.5]),
    lambda one: st.lists(one, max_size=4) | st.dictionaries(WORDS, one, max_size=2),
    max_leaves=6,
)


@tried(200)
@given(st.sampled_from(sorted(kinds())), st.data())
def test_a_corrupt_body_is_read_or_refused_in_words(name: str, data: Any) -> None:
    body = json.loads(json.dumps(data.draw(records_of(kinds()[name])).body))
    key = data.draw(st.sampled_from(sorted(body) or ["of"]))
    if data.draw(st.booleans()):
        body.pop(key, None)
    else:
        body[key] = data.draw(ODD)
    try:
        record = read_record(name, "p", "s", body)
    except InvalidValue as why:
        assert str(why).split()[0] in ("has", "is", "holds")
    else:
        again = read_record(name, "p", "s", json.loads(json.dumps(record.body)))
        assert again == record


# ------------------------------------------------------------------------ versions and refusals


@pytest.fixture
def renamed() -> Iterator[type[EventRecord]]:
    """A kind of event whose second version has another key."""

    def older(version: int, body: dict[str, Any]) -> dict[str, Any]:
        return {"after": body["before"]}

    @kind("renamed key", version=2, older=older)
    class RenamedKey(EventRecord):
        after: str

    yield RenamedKey
    del records.KINDS["renamed key"]


def test_a_body_of_an_earlier_version_is_converted(renamed: Any) -> None:
    new = renamed(after="x")
    assert new.body == {"v": 2, "after": "x"}
    assert read_record("renamed key", None, None, {"before": "x"}) == new
    assert read_record("renamed key", None, None, new.body) == new


@pytest.mark.parametrize("version", [3, 0, -1, "2", None, True])
def test_a_body_of_an_unknown_version_is_refused(renamed: Any, version: Any) -> None:
    with pytest.raises(InvalidValue, match="is of version"):
        read_record("renamed key", None, None, {"v": version, "after": "x"})


def test_threads_can_create_the_first_record_of_a_kind_concurrently() -> None:
    def one_more(name: str) -> type[EventRecord]:
        @kind(name)
        class Made(EventRecord):
            first: int
            second: str = ""

        return Made

    names = [f"made together {number}" for number in range(20)]
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(8) as threads:
            for made in map(one_more, names):
                records_made = threads.map(lambda number, made=made: made(first=number), range(8))
                assert [one.body["first"] for one in records_made] == list(range(8))
    finally:
        sys.setswitchinterval(interval)
        for name in names:
            records.KINDS.pop(name, None)


def test_a_record_can_be_copied() -> None:
    record = PersonAdded(guest=True)
    unknown = Unknown("drlll", {"seed": 1})
    assert [copy.deepcopy(one) for one in (record, unknown)] == [record, unknown]


def test_an_unknown_kind_is_never_read_as_another() -> None:
    assert isinstance(read_record("drlll", None, None, {"seed": 1}), Unknown)


POLICY: dict[str, Any] = {"name": "x", "activity": "a", "demonstrations": []}
WHY = [
    ("game ended", {"steps": 3, "stopped": None}, "has no 'game'"),
    ("game ended", {"game": "g", "steps": -1, "stopped": None}, "has 'steps' that is not a count"),
    ("game ended", {"game": 4, "steps": 1, "stopped": None}, "has 'game' that is not text"),
    ("game begun", {"game": "g", "people": [1]}, "has 'people' that holds one that is not text"),
    ("game world set", {"game": "g", "world": "lve"}, "has 'world' that is 'lve' (did you"),
    ("strategy switched", {"on": 1}, "has 'on' that is neither yes nor no"),
    ("demonstrations edited", {"activity": "a", "what": "x"}, "has 'what' that is 'x'"),
    ("demonstrations edited", {"activity": "a", "what": "delete", "ids": []}, "is too short"),
    ("method chosen", {"chosen": {"forgetting": 0.1}}, "is not a share that can be kept"),
    ("recordings forgotten", [], "is not a table"),
    (
        "policy learnt",
        {**POLICY, "forest": {"depth": 3}},
        "'forest' that has 'depth', which is not",
    ),
]


@pytest.mark.parametrize(("name", "body", "words"), WHY)
def test_a_refused_body_names_the_place_and_the_reason(name: str, body: Any, words: str) -> None:
    with pytest.raises(InvalidValue) as refused:
        read_record(name, "p", "s", body)
    assert words in str(refused.value)


@pytest.mark.parametrize("measured", [0, -2.5, 1.7e18, 10**30, True, "STALE"])
def test_any_measurement_can_be_stored_with_its_fault(measured: float | str) -> None:
    words = ("game", "fault", "code", "name", "recovery", "behaviour", "console", "why")
    fault = {**dict.fromkeys(words, "x"), "criticality": "critical", "step": 3, "seconds": 4.5}
    lists = {"mismatches": [], "advice": ["look"], "evidence": {"laser.stamp": measured}}
    assert read_record("fault", None, None, {**fault, **lists}).body["evidence"] == {
        "laser.stamp": measured
    }


def test_an_earlier_log_still_marks_injected_faults() -> None:
    told = {
        "a fault was brought about: camera covered": ("fault injected", "camera covered"),
        "a fault was lifted: camera covered": ("fault lifted", "camera covered"),
        "faults are to be brought about: 2 kinds": ("faults planned", "2 kinds"),
        "the pace is 20 s": ("noted", "the pace is 20 s"),
    }
    for what, expected in told.items():
        record = read_record("staff action", None, None, {"game": "g", "what": what, "by": "x"})
        assert isinstance(record, StaffAction)
        assert (record.did, record.detail) == expected
