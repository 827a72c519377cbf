"""Diagnosis: the first rule that matches explains a symptom, and two faults are two."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.errors import ProfileError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import Condition, FaultBook, FaultRule
from tangy_profiles.health import NEVER, Fact
from tangy_profiles.robot import Contact, load_robot
from tangy_sim.worlds.devices import WELL, readings
from tangy_sim.worlds.injection import KINDS
from tangy_tui.learning.effects import Effects, Mismatch
from tangy_tui.monitoring.detection import Detector, symptoms
from tangy_tui.monitoring.diagnosis import diagnose, narrows
from tangy_tui.monitoring.evidence import evidence_words
from tangy_tui.text.calls import whom_to_call

ROBOT = load_robot()
BOOK = load_faults(ROBOT)
SHOWING = sorted(name for name, kind in KINDS.items() if kind.symptom)


def evidence(*kinds: str) -> dict[str, Fact]:
    """Return the devices' evidence 5 s after faults of these kinds began."""
    from tangy_profiles.activity import load_activity

    found = readings([(symptom, 5.0) for k in kinds if (symptom := KINDS[k].symptom)])
    return dict(Detector(load_activity("bingo"), ROBOT, Effects({})).watch(found or WELL))


def diagnosed(found: dict[str, Fact], book: FaultBook = BOOK) -> list[str]:
    return [diagnosis.rule.code for diagnosis in diagnose(book, found)]


def test_a_healthy_robot_has_no_diagnosis() -> None:
    assert diagnosed(evidence()) == []


@pytest.mark.parametrize("kind", SHOWING)
def test_each_device_fault_has_one_diagnosis(kind: str) -> None:
    assert diagnosed(evidence(kind)) == [KINDS[kind].code]


def test_a_lost_link_is_one_fault() -> None:
    found = evidence("link-lost")
    assert len(symptoms(found)) == len(ROBOT.devices)
    assert diagnosed(found) == ["link-lost"]


def test_a_robot_without_voice_and_screen_is_mute() -> None:
    assert diagnosed(evidence("voice-dead", "screen-dead")) == ["mute"]


@pytest.mark.slow
@given(st.sets(st.sampled_from(SHOWING), min_size=1, max_size=5))
def test_diagnoses_are_sorted_by_urgency_and_complete(kinds: set[str]) -> None:
    found = evidence(*kinds)
    told = diagnose(BOOK, found)
    urgencies = [diagnosis.rule.urgency for diagnosis in told]
    assert urgencies == sorted(urgencies)
    explained = frozenset().union(*(diagnosis.rule.symptoms for diagnosis in told))
    assert symptoms(found) <= explained
    for kind in kinds:  # it is named, or explained by a worse fault, or its device is silent
        rule = BOOK.rule(KINDS[kind].code)
        silent = found[f"{rule.device}.state"] == "STALE"
        assert rule in [d.rule for d in told] or rule.symptoms & explained or silent


@given(
    st.dictionaries(
        st.sampled_from(sorted(key for rule in BOOK.rules for key in rule.symptoms)),
        st.one_of(st.booleans(), st.floats(-10, 10), st.sampled_from(["STALE", "ERROR", "none"])),
    )
)
def test_every_symptom_is_explained_once(found: dict[str, Fact]) -> None:
    told = diagnose(BOOK, found)
    assert len({d.rule.code for d in told}) == len(told)
    left = symptoms(found)
    for diagnosis in told:
        left -= diagnosis.rule.symptoms | set(diagnosis.evidence)
    assert not left


def test_an_unexplained_symptom_asks_the_teacher_with_its_evidence() -> None:
    mismatch = Mismatch("call number", "others' requests", ("kept",), "none left")
    (told,) = diagnose(BOOK, {"mismatch.others' requests": "none left"}, [mismatch])
    assert told.rule is BOOK.fallback
    assert told.rule.recovery == ("teacher",)
    words = evidence_words(told.evidence, told.mismatches, ROBOT, label=lambda name: "LABEL")
    assert "LABEL" in words and "call number" not in words


@pytest.mark.parametrize(("age", "since"), [(1.7, " for 1.7 s"), (NEVER, " yet")])
def test_the_evidence_tells_for_how_long_data_are_missing(age: float, since: str) -> None:
    words = evidence_words({"screen.state": "STALE", "screen.age": age}, (), ROBOT)
    assert words.endswith(f"no data{since}")


def test_each_mismatch_is_listed_with_its_fault() -> None:
    place = Mismatch("navigate to user", "robot's place", ("with the person who asked",), "front")
    other = Mismatch("navigate to user", "others' requests", ("kept",), "fewer")
    found = {
        **evidence("path-blocked"),
        "mismatch.robot's place": "front",
        "mismatch.others' requests": "fewer",
    }
    told = {d.rule.code: d.mismatches for d in diagnose(BOOK, found, [place, other])}
    assert told == {"path-blocked": (place,), "request-withdrawn": (other,)}


def test_staff_see_the_expert_or_that_none_is_named() -> None:
    nobody = load_robot()
    assert whom_to_call(nobody).startswith("No expert is named")
    named = replace(nobody, expert=Contact("Anna Berg", "030 901820"))
    assert whom_to_call(named) == "Call the expert, Anna Berg: 030 901820."
    assert whom_to_call(replace(nobody, expert=Contact("Anna Berg"))) == (
        "Call the expert, Anna Berg."
    )


def test_a_robots_file_names_the_expert(tmp_path: Path) -> None:
    shipped = load_robot().file.read_text(encoding="utf-8")
    file = tmp_path / "mine.toml"
    file.write_text(f'{shipped}\n[expert]\nname = "Anna Berg"\n', encoding="utf-8")
    assert load_robot(str(file)).expert == Contact("Anna Berg")
    file.write_text(f'{shipped}\n[expert]\nnmae = "Anna Berg"\n', encoding="utf-8")
    with pytest.raises(ProfileError, match="expert"):
        load_robot(str(file))


# A separate book states the guarantees of any rules.


def rule(code: str, *when: Condition, **more: object) -> FaultRule:
    told = {"criticality": "non-critical", "recovery": ("continue",), "console": "", "advice": ()}
    return FaultRule(code, code, **{**told, "when": (when,), **more})  # type: ignore[arg-type]


def book(*rules: FaultRule) -> FaultBook:
    return FaultBook((*rules, rule("unexplained", recovery=("teacher",), fallback=True)), "test")


FAILED = Condition("base.state", "is", "ERROR")
PLACE = {"mismatch.robot's place": "front", "mismatch.card": "bingo"}
FEWER = {"mismatch.others' requests": "fewer"}


@pytest.mark.parametrize(
    ("critical", "completed", "left"),
    [
        (True, False, set(FEWER)),
        (True, True, {*PLACE, *FEWER}),
        (False, False, {*PLACE, *FEWER}),
    ],
    ids=["broken off by it", "carried out all the same", "not critical"],
)
def test_only_a_critical_fault_explains_an_interrupted_behaviour(
    critical: bool, completed: bool, left: set[str]
) -> None:
    mine = rule("dead", FAILED, criticality="critical" if critical else "non-critical")
    found: dict[str, Fact] = {
        "base.state": "ERROR",
        **PLACE,
        **FEWER,
        "behaviour.completed": completed,
    }
    told = {d.rule.code: d for d in diagnose(book(mine), found)}
    assert set(told) == {"dead", "unexplained"}
    assert set(told["unexplained"].evidence) == left
    assert "mismatch.card" not in told["dead"].evidence


def test_a_behaviour_interrupted_by_a_critical_fault_is_one_fault() -> None:
    mine = rule("dead", FAILED, criticality="critical")
    found: dict[str, Fact] = {"base.state": "ERROR", **PLACE, "behaviour.completed": False}
    assert diagnosed(found, book(mine)) == ["dead"]


def test_later_rules_explain_symptoms_beside_a_critical_fault() -> None:
    first = rule("dead", FAILED, criticality="critical")
    later = rule("left", Condition("mismatch.others' requests", "is", "fewer"))
    found: dict[str, Fact] = {"base.state": "ERROR", **PLACE, **FEWER, "behaviour.completed": False}
    assert sorted(diagnosed(found, book(first, later))) == ["dead", "left"]


def test_diagnoses_are_sorted_by_urgency_and_the_order_of_rules() -> None:
    calm, asks = rule("calm", FAILED), rule("asks", Condition("voice.state", "is", "ERROR"))
    stops = rule("stops", Condition("link.state", "is", "ERROR"), recovery=("expert",))
    again = rule("again", Condition("arms.state", "is", "ERROR"))
    found: dict[str, Fact] = dict.fromkeys(
        ("base.state", "voice.state", "link.state", "arms.state"), "ERROR"
    )
    found["screen.state"] = "STALE"
    assert diagnosed(found, book(calm, asks, stops, again)) == [
        "stops",
        "unexplained",
        "calm",
        "asks",
        "again",
    ]


def test_a_symptom_explained_by_an_earlier_rule_is_no_further_fault() -> None:
    first = rule("first", FAILED, also=("voice.state",))
    second = rule("second", Condition("voice.state", "is", "ERROR"))
    found: dict[str, Fact] = {"base.state": "ERROR", "voice.state": "ERROR"}
    assert diagnosed(found, book(first, second)) == ["first"]
    assert diagnosed({"voice.state": "ERROR"}, book(first, second)) == ["second"]


def test_the_evidence_includes_the_age_of_the_device() -> None:
    found: dict[str, Fact] = {
        "base.state": "ERROR",
        "base.age": 2.5,
        "voice.age": 9.0,
        "base.speed": 1.0,
    }
    (told,) = diagnose(book(rule("dead", FAILED)), found)
    assert told.evidence == {"base.state": "ERROR", "base.age": 2.5}
    assert told.beside == frozenset()


BELOW, AT_LEAST = Condition("laser.fit", "below", 0.8), Condition("laser.fit", "at_least", 0.8)
STALE, NOT_STALE = Condition("link.state", "is", "STALE"), Condition("link.state", "not", "STALE")


@pytest.mark.parametrize(
    ("mine", "others", "beside"),
    [
        ((FAILED, BELOW), (AT_LEAST,), {"laser.fit"}),
        ((FAILED, AT_LEAST), (BELOW,), {"laser.fit"}),
        ((FAILED, NOT_STALE), (STALE,), {"link.state"}),
        ((FAILED, STALE), (NOT_STALE,), {"link.state"}),
        ((BELOW,), (AT_LEAST,), set()),
        ((BELOW, NOT_STALE), (AT_LEAST, STALE), set()),
        ((FAILED, BELOW), (Condition("laser.fit", "at_least", 0.7),), set()),
        ((FAILED, BELOW), (Condition("laser.near", "at_least", 0.8),), set()),
        ((FAILED, BELOW), (Condition("laser.fit", "below", 0.8),), set()),
        ((FAILED, BELOW), (Condition("laser.fit", "above", 0.8),), set()),
    ],
)
def test_a_condition_is_excluding_only_if_another_rule_has_its_opposite(
    mine: tuple[Condition, ...], others: tuple[Condition, ...], beside: set[str]
) -> None:
    rules = book(rule("mine", *mine), rule("other", *others))
    assert {condition.key for condition in mine if narrows(condition, mine, rules)} == beside
    fit = 0.9 if AT_LEAST in mine else 0.5
    link = "STALE" if STALE in mine else "OK"
    found: dict[str, Fact] = {"base.state": "ERROR", "laser.fit": fit, "link.state": link}
    told = {d.rule.code: d for d in diagnose(rules, found)}
    if "mine" in told:
        assert told["mine"].beside == beside


def test_context_facts_create_no_fault_from_an_explained_symptom() -> None:
    first = rule("first", FAILED, also=("voice.state",))
    drawn = Condition("behaviour.effect", "is", "draw")
    second = rule("second", Condition("voice.state", "is", "ERROR"), drawn)
    found: dict[str, Fact] = {
        "base.state": "ERROR",
        "voice.state": "ERROR",
        "behaviour.effect": "draw",
    }
    assert diagnosed(found, book(first, second)) == ["first"]


def test_a_mismatch_belongs_to_the_first_fault_that_explains_it() -> None:
    first = rule("first", FAILED, also=("mismatch.card",))
    second = rule("second", Condition("voice.state", "is", "ERROR"), also=("mismatch.card",))
    card = Mismatch("mark numbers", "card", (), "bingo")
    found: dict[str, Fact] = {
        "base.state": "ERROR",
        "voice.state": "ERROR",
        "mismatch.card": "bingo",
    }
    told = {d.rule.code: d.mismatches for d in diagnose(book(first, second), found, [card])}
    assert told == {"first": (card,), "second": ()}
