"""Diagnosis: the first rule that matches explains a symptom, and two faults are two."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.errors import ProfileError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import FaultBook
from tangy_profiles.health import Fact
from tangy_profiles.robot import Contact, load_robot
from tangy_sim.body import WELL, readings
from tangy_sim.injection import KINDS
from tangy_tui.learning.effects import Effects, Mismatch
from tangy_tui.monitoring.detection import Detector, symptoms
from tangy_tui.monitoring.diagnosis import diagnose
from tangy_tui.monitoring.telling import evidence_words, whom_to_call

ROBOT = load_robot()
BOOK = load_faults(ROBOT)
SHOWING = sorted(name for name, kind in KINDS.items() if kind.symptom)


def evidence(*kinds: str) -> dict[str, Fact]:
    """Return what the devices give as evidence when faults of these kinds have lasted for 5 s."""
    from tangy_profiles.activity import load_activity

    found = readings([(symptom, 5.0) for k in kinds if (symptom := KINDS[k].symptom)])
    return dict(Detector(load_activity("bingo"), ROBOT, Effects({})).watch(found or WELL))


def diagnosed(found: dict[str, Fact], book: FaultBook = BOOK) -> list[str]:
    return [diagnosis.rule.code for diagnosis in diagnose(book, found)]


def test_when_all_is_well_nothing_is_diagnosed() -> None:
    assert diagnosed(evidence()) == []


@pytest.mark.parametrize("kind", SHOWING)
def test_what_devices_show_has_one_explanation(kind: str) -> None:
    assert diagnosed(evidence(kind)) == [KINDS[kind].code]


def test_a_lost_link_is_one_fault_and_not_eleven() -> None:
    found = evidence("link-lost")
    assert len(symptoms(found)) == len(ROBOT.devices)
    assert diagnosed(found) == ["link-lost"]


def test_neither_voice_nor_screen_is_worse_than_either() -> None:
    assert diagnosed(evidence("voice-dead", "screen-dead")) == ["mute"]


@given(st.sets(st.sampled_from(SHOWING), min_size=1, max_size=5))
def test_the_critical_one_comes_first_and_none_is_lost(kinds: set[str]) -> None:
    found = evidence(*kinds)
    told = diagnose(BOOK, found)
    urgencies = [diagnosis.rule.urgency for diagnosis in told]
    assert urgencies == sorted(urgencies)
    explained = frozenset().union(*(diagnosis.rule.symptoms for diagnosis in told))
    assert symptoms(found) <= explained
    for kind in kinds:  # it is told, or put down to something worse, or its device is silent
        rule = BOOK.rule(KINDS[kind].code)
        silent = found[f"{rule.device}.state"] == "STALE"
        assert rule in [d.rule for d in told] or rule.symptoms & explained or silent


@given(
    st.dictionaries(
        st.sampled_from(sorted(key for rule in BOOK.rules for key in rule.symptoms)),
        st.one_of(st.booleans(), st.floats(-10, 10), st.sampled_from(["STALE", "ERROR", "none"])),
    )
)
def test_whatever_is_seen_every_symptom_is_explained_once(found: dict[str, Fact]) -> None:
    told = diagnose(BOOK, found)
    assert len({d.rule.code for d in told}) == len(told)
    left = symptoms(found)
    for diagnosis in told:
        left -= diagnosis.rule.symptoms | set(diagnosis.evidence)
    assert not left


def test_what_no_rule_explains_asks_the_teacher_and_says_what_was_seen() -> None:
    mismatch = Mismatch("call number", "others' requests", ("kept",), "fewer")
    (told,) = diagnose(BOOK, {"mismatch.others' requests": "fewer"}, [mismatch])
    assert told.rule is BOOK.fallback
    assert told.rule.recovery == ("teacher",)
    words = evidence_words(told.evidence, told.mismatches, ROBOT)
    assert words == "after 'call number', somebody else who asked for help asks no more"


def test_a_mismatch_belongs_to_the_fault_that_explains_it() -> None:
    place = Mismatch("navigate to user", "robot's place", ("with the person who asked",), "front")
    other = Mismatch("navigate to user", "others' requests", ("kept",), "fewer")
    found = {
        **evidence("path-blocked"),
        "mismatch.robot's place": "front",
        "mismatch.others' requests": "fewer",
    }
    told = {d.rule.code: d.mismatches for d in diagnose(BOOK, found, [place, other])}
    assert told == {"path-blocked": (place,), "unexplained": (other,)}


def test_staff_read_whom_to_call_or_that_nobody_is_named() -> None:
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
