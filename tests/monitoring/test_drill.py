"""Drills: simulated rounds, their correct answers, and the stored score."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from random import Random
from typing import Any

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.drill_sheet import NOTHING_WRONG, AnsweredRound, Sheet
from tangy_profiles.errors import TangyError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import RECOVERIES
from tangy_profiles.game_records import DrillAnswered, DrillHeld
from tangy_profiles.person import Person
from tangy_profiles.robot import load_robot
from tangy_profiles.store import Store
from tangy_tui.console.drills import drill_by_lines
from tangy_tui.learning.policies import keep_policy
from tangy_tui.monitoring import drill_policy, drill_rounds
from tangy_tui.monitoring.drill import NOTHING, Drill
from tangy_tui.monitoring.drill_log import (
    interrupted_sheet,
    keep_interrupted,
    last_sheet,
    read_sheets,
)
from tangy_tui.monitoring.drill_policy import DrillPolicy, policy_for_drill
from tangy_tui.monitoring.drill_rounds import (
    CHOICES,
    QUIET,
    QUIET_KINDS,
    DrillSimulator,
    Round,
    RoundKind,
    draw_rounds,
    round_kinds,
)
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text.drills import device_words, round_parts, sheet_lines, sheets_lines, told_lines
from tests.support.append_body import append_body

BOOK = load_faults(load_robot())
KINDS = round_kinds(BOOK)


class Clock:
    """A clock that the test advances."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture(scope="module")
def learnt(tmp_path_factory: pytest.TempPathFactory, activity: Activity) -> DrillPolicy:
    """The policy of drills without demonstrations."""
    with Store.open(tmp_path_factory.mktemp("nothing") / "data") as nothing:
        return policy_for_drill(nothing, activity)


@pytest.fixture(scope="module")
def table(learnt: DrillPolicy, activity: Activity, people: tuple[Person, ...]) -> DrillSimulator:
    """A table-top with the four sample people."""
    names = {person.id: person.name for person in people}
    return DrillSimulator(learnt.policy, learnt.effects, BOOK, load_robot(), activity, names)


def right_keys(drill: Drill) -> list[str]:
    """Answer a round correctly; return the keys."""
    keys: list[str] = []
    shown = drill.round
    assert shown is not None
    while drill.question is not None:
        right = {
            "what": shown.code,
            "do": shown.recovery,
            "clear": "yes" if shown.release and shown.release.right else "no",
        }[drill.question.kind]
        key = next(c.key for c in drill.question.choices if c.value == right)
        drill.answer(key)
        keys.append(key)
    return keys


# --------------------------------------------------------------------------- the drawn rounds


@pytest.mark.parametrize("rounds", range(1, 51))
def test_rounds_cover_every_class_before_a_fault_repeats(rounds: int) -> None:
    for seed in range(20):
        drawn = draw_rounds(BOOK, rounds, Random(seed))
        assert len(drawn) == rounds
        faults = [kind for kind in drawn if kind != QUIET]
        if rounds >= 4:
            assert {BOOK.rule(kind.code).recovery[0] for kind in faults} == set(RECOVERIES)
        for start in range(0, len(faults), len(KINDS)):
            some = faults[start : start + len(KINDS)]
            assert len(set(some)) == len(some)
        assert drawn == draw_rounds(BOOK, rounds, Random(seed))


def test_about_one_round_in_five_has_no_fault() -> None:
    drawn = Counter(
        kind == QUIET for seed in range(200) for kind in draw_rounds(BOOK, 6, Random(seed))
    )
    assert 0.15 < drawn[True] / 1200 < 0.25


def test_different_seeds_draw_different_drills() -> None:
    drills = {tuple(draw_rounds(BOOK, 6, Random(seed))) for seed in range(20)}
    assert len(drills) == 20


# ----------------------------------------------------------------------- the course of a round


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])
def test_each_round_shows_exactly_its_fault(table: DrillSimulator, kind: RoundKind) -> None:
    shown = table.play(3, kind, Random(1))
    rule = BOOK.rule(kind.code)
    assert (shown.number, shown.kind, shown.rule) == (3, kind, rule)
    assert shown.fault is not None
    assert (shown.fault.code, shown.fault.recovery) == (rule.code, shown.recovery)
    assert shown.noticed == shown.fault.why
    assert (shown.release is not None) is rule.critical
    assert len(set(shown.choices)) == CHOICES
    assert shown.code in shown.choices
    others = [BOOK.rule(code) for code in shown.choices if code != shown.code]
    assert any(
        (rule.device and other.device == rule.device) or other.recovery[0] == rule.recovery[0]
        for other in others
    )


@pytest.mark.slow
def test_no_round_is_at_the_end_of_its_game(
    table: DrillSimulator, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen: list[bool] = []
    real = DrillSimulator.fault_round

    def look(
        self: DrillSimulator, number: int, kind: RoundKind, game: Supervision, *rest: Any
    ) -> Round:
        chosen.append(game.over)
        return real(self, number, kind, game, *rest)

    monkeypatch.setattr(DrillSimulator, "fault_round", look)
    monkeypatch.setattr(drill_rounds, "SETS_IN", (40, 70))  # in which most games end
    late = next(kind for kind in KINDS if kind.name == "request-withdrawn")
    for seed in range(8):
        table.play(1, late, Random(seed))
    assert chosen == [False] * 8


@pytest.mark.slow
def test_a_round_reveals_neither_the_fault_nor_its_recovery(table: DrillSimulator) -> None:
    for kind in KINDS:
        shown = table.play(1, kind, Random(2))
        assert shown.rule is not None
        assert shown.fault is not None
        seen = " ".join(text for _, text in round_parts(table, shown)).lower()
        for told in (shown.fault.name, shown.fault.console, *shown.fault.advice):
            assert told.lower() not in seen, kind.name
        assert "critical" not in seen


@pytest.mark.slow
def test_a_quiet_round_shows_a_distraction_without_a_fault(
    table: DrillSimulator,
) -> None:
    rounds = [table.play(1, QUIET, Random(seed)) for seed in range(24)]
    assert {shown.quiet for shown in rounds} == set(QUIET_KINDS)
    for shown in rounds:
        assert (shown.fault, shown.code, shown.recovery) == (None, "", "continue")
        assert len(set(shown.choices)) == CHOICES
        assert shown.noticed
        assert {state for _, state in shown.devices} == {"OK"}


@pytest.mark.slow
def test_the_correct_answer_on_clearing_matches_the_supervision(table: DrillSimulator) -> None:
    critical = [kind for kind in KINDS if BOOK.rule(kind.code).critical]
    right = Counter[bool]()
    for seed in range(3):
        for kind in critical:
            shown = table.play(1, kind, Random(seed))
            assert shown.release is not None
            assert shown.fault is not None
            # The fault is gone exactly if the robot's observation has changed since.
            same = shown.fault.why.startswith(shown.release.seen)
            assert shown.release.right is not same, (kind.name, shown.release, shown.fault.why)
            right[shown.release.right] += 1
    assert min(right.values()) >= len(critical) // 2, "both come up"


def test_the_same_seed_gives_the_same_rounds(table: DrillSimulator, store: Store) -> None:
    def seen() -> list[tuple[object, ...]]:
        drill = Drill(table, store, who="ada", seed=7, rounds=4)
        found: list[tuple[object, ...]] = []
        while (shown := drill.next()) is not None:
            found.append((shown.kind, shown.state, shown.noticed, shown.choices, shown.release))
            right_keys(drill)
        return found

    assert seen() == seen()


def test_an_impossible_round_is_replaced_by_one_of_its_class(
    table: DrillSimulator, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = next(kind for kind in KINDS if BOOK.rule(kind.code).recovery[0] == "user")
    real = DrillSimulator.try_once

    def hardly(self: DrillSimulator, number: int, kind: RoundKind, seed: int) -> Round | None:
        return None if kind == wanted else real(self, number, kind, seed)

    monkeypatch.setattr(DrillSimulator, "try_once", hardly)
    shown = table.play(1, wanted, Random(1))
    assert shown.kind != wanted
    assert shown.recovery == "user"
    monkeypatch.setattr(DrillSimulator, "try_once", lambda *_: None)
    with pytest.raises(TangyError, match="No fault of Bingo could be brought about"):
        table.play(1, wanted, Random(1))


# ----------------------------------------------------------------------------------- the policy


def test_a_fresh_installation_gets_a_temporary_policy(store: Store, activity: Activity) -> None:
    found = policy_for_drill(store, activity)
    assert found.note == "nothing learnt"
    assert all(found.policy.decide(situation).sure for situation in activity.situations)
    assert list(store.events()) == []


def test_a_drill_replaces_an_incomplete_or_lost_policy(
    store: Store, activity: Activity, learnt: DrillPolicy, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep_policy(store, replace(learnt.policy, demonstrations=("gone",)))
    found = policy_for_drill(store, activity)
    assert found.note == "unusable"
    gap = dict(learnt.policy.table)
    first = next(iter(activity.situations))
    gap[first] = replace(gap[first], seen=0)
    gappy = replace(learnt.policy, table=gap)
    monkeypatch.setattr(drill_policy, "load_policy", lambda *_: (gappy, []))
    found = policy_for_drill(store, activity)
    assert found.note == "gaps"
    assert found.policy.decide(first).sure
    whole = replace(learnt.policy, name="whole")
    monkeypatch.setattr(drill_policy, "load_policy", lambda *_: (whole, []))
    found = policy_for_drill(store, activity)
    assert (found.policy.name, found.note) == ("whole", None)


def test_an_activity_without_expected_behaviours_must_be_taught_first(
    store: Store, activity: Activity
) -> None:
    with pytest.raises(TangyError, match="Teach Tangy Bingo first"):
        policy_for_drill(store, replace(activity, expected={}))


# ---------------------------------------------------------------------------- answers and score


def test_right_answers_score_fully_and_only_the_sheet_is_stored(
    table: DrillSimulator, store: Store
) -> None:
    clock = Clock()
    drill = Drill(table, store, who="ada", seed=2, rounds=6, clock=clock)
    while drill.next() is not None:
        drill.shown()
        clock.now += 3.0
        assert list(store.events(DrillHeld)) == []
        right_keys(drill)
    assert drill.over
    sheet = drill.sheet
    assert sheet.finished
    assert sheet.points == sheet.most == sum(one.most for one in sheet.answered)
    assert sheet.median == 3.0
    assert sheet.again == ()
    *rounds, event = store.events()
    assert {one.kind for one in rounds} == {DrillAnswered.KIND} and len(rounds) == 5
    assert (event.kind, event.person) == (DrillHeld.KIND, None)
    assert [replace(kept, at="") for kept in read_sheets(store)] == [sheet]
    assert drill.next() is None
    drill.leave()
    assert len(list(store.events(DrillHeld))) == 1, "it is kept once"


def test_a_resumed_drill_has_the_original_rounds(table: DrillSimulator, store: Store) -> None:
    whole = Drill(table, store, who="ada", seed=2, rounds=4)
    shown = []
    while (one := whole.next()) is not None:
        shown.append(one)
        right_keys(whole)
    before = Drill(table, store, who="bea", seed=2, rounds=4)
    for _ in range(2):
        before.next()
        right_keys(before)
    before.next()  # and the program was killed
    past = interrupted_sheet(store, "Bea", "bingo")
    assert past is not None and past.answered == before.sheet.answered
    assert interrupted_sheet(store, "ada", "bingo") is None
    assert interrupted_sheet(store, "bea", "trivia") is None

    after = Drill(table, store, who="bea", past=past)
    third = after.next()
    assert third is not None and third.number == 3
    for what in ("kind", "state", "choices", "devices", "recovery"):
        assert getattr(third, what) == getattr(shown[2], what)
    right_keys(after)
    after.next()
    right_keys(after)
    assert after.over and after.sheet.points == after.sheet.most == whole.sheet.points
    assert after.sheet.finished and interrupted_sheet(store, "bea", "bingo") is None


def test_a_rejected_interrupted_drill_is_stored_as_unfinished(
    table: DrillSimulator, store: Store
) -> None:
    drill = Drill(table, store, who="ada", seed=2, rounds=4)
    drill.next()
    right_keys(drill)
    past = interrupted_sheet(store, "ada", "bingo")
    assert past is not None
    keep_interrupted(store, past)
    assert interrupted_sheet(store, "ada", "bingo") is None
    assert [len(sheet.answered) for sheet in read_sheets(store, "ada")] == [1]


def test_each_wrong_answer_loses_its_point(table: DrillSimulator, store: Store) -> None:
    drill = Drill(table, store, who="ada", seed=2, rounds=4)
    while (shown := drill.next()) is not None:
        answered = None
        while (question := drill.question) is not None:
            right = {
                "what": shown.code,
                "do": shown.recovery,
                "clear": "yes" if shown.release and shown.release.right else "no",
            }[question.kind]
            answered = drill.answer(next(c.key for c in question.choices if c.value != right))
        assert answered is not None
        assert (answered.named_right, answered.acted_right) == (False, False)
        assert answered.cleared_right is (None if shown.release is None else False)
        assert (answered.points, answered.most) == (0, 2 if shown.release is None else 3)
        told = [text for _, text in told_lines(table, shown, answered)]
        assert told[0].startswith("Not quite. Right would be: ")
        assert shown.fault is None or all(any(a in t for t in told) for a in shown.fault.advice)
    sheet = drill.sheet
    assert sheet.points == 0
    assert len(sheet.again) == 4
    assert set(sheet.by_class) == {one.kind for one in sheet.answered}
    assert sum(most for _, most in sheet.by_class.values()) == sheet.most
    assert all(one.advice for one in sheet.again if one.code)


def test_the_time_starts_when_the_round_is_shown(table: DrillSimulator, store: Store) -> None:
    clock = Clock()
    drill = Drill(table, store, who="ada", seed=1, rounds=1, clock=clock)
    drill.next()
    clock.now += 50
    drill.shown()
    clock.now += 4
    drill.answer(NOTHING)
    drill.shown()  # too late to start over
    clock.now += 2
    right_keys(drill)
    assert drill.sheet.answered[0].seconds == 6


def test_leaving_a_drill_keeps_its_answers(table: DrillSimulator, store: Store) -> None:
    drill = Drill(table, store, who="ada", seed=1, rounds=5)
    assert drill.leave() is None
    assert last_sheet(store) is None
    drill = Drill(table, store, who="ada", seed=1, rounds=5)
    drill.next()
    right_keys(drill)
    drill.next()
    drill.answer(NOTHING)
    drill.leave()
    kept = last_sheet(store)
    assert kept is not None
    assert (len(kept.answered), kept.rounds, kept.finished) == (1, 5, False)
    assert "left after 1 of 5" in sheet_lines(kept)[0][1]


def test_an_invalid_answer_is_refused(table: DrillSimulator, store: Store) -> None:
    drill = Drill(table, store, who="ada", seed=1, rounds=1)
    with pytest.raises(TangyError, match="Nothing is asked"):
        drill.answer("1")
    drill.next()
    assert drill.next() is None, "the round is to be answered first"
    with pytest.raises(TangyError, match="one of: 1, 2, 3, 4, 0"):
        drill.answer("5")
    for rounds in (0, 51):
        with pytest.raises(TangyError, match="from 1 to 50"):
            Drill(table, store, who="ada", rounds=rounds)


def test_a_drill_without_a_seed_gets_a_new_one(table: DrillSimulator, store: Store) -> None:
    for expected in (1, 2, 3):
        drill = Drill(table, store, who="ada", rounds=1)
        assert drill.sheet.seed == expected
        drill.next()
        right_keys(drill)


def test_the_last_score_of_the_same_person_is_shown(table: DrillSimulator, store: Store) -> None:
    first = Drill(table, store, who="ada", rounds=1)
    assert first.before is None
    first.next()
    right_keys(first)
    assert Drill(table, store, who="bea", rounds=1).before is None
    before = Drill(table, store, who="Ada", rounds=1).before
    assert before is not None
    assert before.points == first.sheet.points
    lines = [text for _, text in sheet_lines(SHEET, before=before)]
    assert lines[1] == f"The last time: {before.points} of {before.most} points."


@pytest.mark.slow
def test_the_log_of_a_drill_contains_no_names(
    learnt: DrillPolicy, store: Store, activity: Activity
) -> None:
    names = {f"user{number}": f"Xaver{number}" for number in range(1, 5)}
    table = DrillSimulator(learnt.policy, learnt.effects, BOOK, load_robot(), activity, names)
    drill = Drill(table, store, who="ada", seed=4, rounds=30)
    while drill.next() is not None:
        right_keys(drill)
    assert "Xaver" not in str([event.body for event in store.events()])


# ------------------------------------------------------------------------------------- in words


SHEET = Sheet(
    "ada",
    "bingo",
    3,
    2,
    (
        AnsweredRound(
            1, "mute", "Neither voice nor screen", "expert", ("Call.",), "mute", "user", 8.0, True
        ),
        AnsweredRound(2, "", "Nothing was wrong", "continue", (), "", "continue", 4.0),
    ),
    "2026-03-01T09:00:00+00:00",
)  # fmt: skip


@pytest.mark.parametrize("width", [54, 74, 120])
def test_the_score_sheet_fits_the_width(width: int) -> None:
    lines = [text for _, text in sheet_lines(SHEET, width)]
    assert lines[0] == "ada: 3 of 5 points. Median time 6 s."
    assert lines[2].split()[-4:] == ["yes", "NO", "NO", "8"]
    assert lines[3].split()[-4:] == ["yes", "yes", "-", "4"]
    assert "1 of 3" in lines[4]
    assert lines[-2:] == [
        "Neither voice nor screen: keep people away, call the expert, then clear.",
        "  1. Call.",
    ]
    assert all(len(line) <= width for line in lines[:6])


def test_a_score_sheet_is_read_back_from_the_log(store: Store) -> None:
    append_body(store, DrillHeld, encode(SHEET))
    (kept,) = read_sheets(store, "ADA")
    assert replace(kept, at=SHEET.at) == SHEET
    assert read_sheets(store, "bea") == []
    assert encode(SHEET)["classes"] == {"expert": [1, 3], NOTHING_WRONG: [2, 2]}
    (head, line) = sheets_lines([SHEET], lambda at: at[:10])
    assert head.startswith("When")
    assert " ".join(line.split()) == "2026-03-01 ada 2 of 2 3 of 5 6 Neither voice nor screen"
    assert sheets_lines([], str) == ["No drill yet: tangy drill begins one."]


def test_the_summary_of_devices_lists_faulty_ones() -> None:
    assert device_words([("a", "OK"), ("b", "OK")]) == "None reports an error."
    assert device_words([("a", "STALE"), ("b", "STALE")]) == "all 2: no data."
    mixed = device_words([("a", "ERROR"), ("b", "OK"), ("c", "STALE")])
    assert mixed == ("a: failed; c: no data; no error from the other 1 device.")


def test_an_invalid_line_is_asked_again_until_the_input_ends(
    table: DrillSimulator, store: Store
) -> None:
    drill = Drill(table, store, who="ada", seed=3, rounds=4)
    told: list[str] = []
    lines = iter(["", "# a remark", "7", "0", "1", "y"])
    sheet = drill_by_lines(drill, told.append, lambda: next(lines, None))
    assert sum(line.startswith("Type the number") for line in told) >= 1
    assert "Round 1 of 4" in told
    assert sheet is not None
    assert last_sheet(store) == replace(sheet, at=last_sheet(store).at)  # type: ignore[union-attr]


@pytest.mark.parametrize("strict", [False, True])
def test_stop_by_lines_says_that_nothing_moves(
    table: DrillSimulator, store: Store, strict: bool
) -> None:
    told: list[str] = []
    lines = iter(["stop the robot", "stop the bingo"])
    drill = Drill(table, store, who="ada", seed=3, rounds=4)
    drill_by_lines(drill, told.append, lambda: next(lines, None), strict=strict)
    assert sum(line.startswith("Nothing is moving") for line in told) == 2
    assert not any(line.startswith("Type the number") for line in told)


def test_an_invalid_line_ends_a_script_and_keeps_the_answers(
    table: DrillSimulator, store: Store
) -> None:
    drill = Drill(table, store, who="ada", seed=3, rounds=4)

    def line() -> str:
        assert drill.question is not None
        return "seven" if drill.number == 2 else drill.question.keys[0]

    with pytest.raises(TangyError, match="Round 2, What is it\\? 'seven'"):
        drill_by_lines(drill, lambda _: None, line, strict=True)
    kept = last_sheet(store)
    assert kept is not None
    assert (len(kept.answered), kept.finished) == (1, False)
