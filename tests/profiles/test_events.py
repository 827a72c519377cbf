"""The kinds of event are a closed set: what writes or reads one that is not in it is named."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles import events
from tangy_profiles.events import ABOUT_PEOPLE, BODIES, MOVES, WITH_STRATEGY, wrong_with
from tangy_tui.text import faults

ROOT = Path(__file__).parents[2]
FLOORS = {"tangy_tui": ROOT, "tangy_hw": ROOT / "hw", "tangy_sim": ROOT / "sim"}
FLOORS["tangy_profiles"] = ROOT / "profiles"


def kinds_written() -> dict[str, set[str]]:
    """Return the kinds of event that the program's code appends, and where."""
    found: dict[str, set[str]] = {}
    for package, above in FLOORS.items():
        for path in sorted((above / package).rglob("*.py")):
            text = path.read_text()
            if "store" not in text.casefold():
                continue
            module = ".".join(path.relative_to(above).with_suffix("").parts)
            for call in ast.walk(ast.parse(text)):
                if isinstance(call, ast.Call) and _appends(call, module):
                    for kind in _named(call.args[0], module):
                        found.setdefault(kind, set()).add(module)
    return found


def _appends(call: ast.Call, module: str) -> bool:
    if not isinstance(call.func, ast.Attribute) or call.func.attr != "append":
        return False
    receiver = ast.unparse(call.func.value)
    return len(call.args) == 2 and (
        receiver.endswith("store") or (receiver == "self" and module.endswith(".store"))
    )


def _named(kind: ast.expr, module: str) -> list[str]:
    if isinstance(kind, ast.Constant):
        return [str(kind.value)]
    assert isinstance(kind, ast.Name), f"{module}: name the kind by a constant"
    return [str(getattr(importlib.import_module(module), kind.id))]


def test_every_kind_that_is_written_has_a_body_that_is_known_and_none_is_left_over() -> None:
    written = kinds_written()
    assert {kind: where for kind, where in written.items() if kind not in BODIES} == {}
    assert BODIES.keys() - written.keys() == set()


def test_what_is_about_people_and_strategies_are_kinds() -> None:
    assert WITH_STRATEGY < ABOUT_PEOPLE < BODIES.keys()


def test_what_can_be_done_about_a_fault_is_said_in_words_and_taken_from_the_log() -> None:
    assert set(MOVES) == set(faults.MOVES)


@pytest.mark.parametrize("kind", sorted(BODIES.keys() - ABOUT_PEOPLE))
def test_a_body_of_nothing_is_that_of_a_kind_only_where_nothing_is_needed(kind: str) -> None:
    empty = wrong_with(kind, None, None, {})
    assert (empty == "") == (kind == "recordings forgotten")
    assert wrong_with(kind, None, None, []) != ""  # type: ignore[arg-type]


ODD: Any = st.sampled_from(["user1", "AR", "x", "", 1, -1, 10**13, True, None, [], {}, ["AR"], 1.5])
USERS: Any = st.lists(
    st.lists(st.sampled_from(["user1", "user2", "AR", "ANR", 3, None, []]), max_size=4)
    | st.tuples(st.sampled_from(["a", "b"]), st.just("x"), st.sampled_from(["AR", "ANR"])).map(list)
    | ODD,
    max_size=3,
)
STATES = st.fixed_dictionaries(
    {"step": ODD | st.just(3), "users": USERS | ODD, "attended": ODD | st.just("a")},
    optional={
        "situation": st.just(["help", "AR", "x"]) | st.lists(ODD, max_size=4) | ODD,
        "place": ODD | st.just("front"),
        "closed": ODD | st.none(),
    },
)


@settings(max_examples=300, deadline=None)
@given(STATES)
def test_what_is_a_state_at_a_glance_is_one_looked_at_closely(state: dict[str, Any]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        glance = events._plainly_a_state(state)
        patch.setattr(events, "_plainly_a_state", lambda _: False)
        closely = events._state(closed=True)(state)
    assert not glance or closely == ""


def test_a_state_as_the_program_writes_it_is_one_at_a_glance() -> None:
    users = [["user1", "occluded", "AR"], ["user2", "occluded", "ANR"]]
    state = {"step": 3, "situation": ["help", "AR", "occluded"], "place": "user1"}
    assert events._plainly_a_state({**state, "attended": "user1", "users": users, "closed": None})


@pytest.mark.parametrize("measured", [0, -2.5, 1.7e18, 10**30, True, "STALE"])
def test_whatever_a_device_measures_can_be_kept_with_its_fault(measured: float | str) -> None:
    assert events.BODIES["fault"]({**FAULT, "evidence": {"laser.stamp": measured}}) == ""


FAULT: dict[str, Any] = {
    **dict.fromkeys(("game", "fault", "code", "name", "recovery", "behaviour", "console"), "x"),
    **{"why": "", "criticality": "critical", "step": 3, "seconds": 4.5},
    **{"mismatches": [], "advice": ["look"], "evidence": {}},
}
