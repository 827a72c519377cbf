"""The shipped fault rules are consistent, and every mistake in a rule file is one line."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tangy_profiles
from tangy_profiles.errors import ProfileError
from tangy_profiles.fault_file import check_faults, load_faults
from tangy_profiles.faults import Condition, FaultBook
from tangy_profiles.reading import plain
from tangy_profiles.robot import Robot, load_robot

SHIPPED = (Path(tangy_profiles.__path__[0]) / "faults.toml").read_text(encoding="utf-8")

LAST = """
[[faults]]
code = "unexplained"
name = "Something unexpected"
criticality = "non-critical"
recovery = ["teacher"]
fallback = true
console = "Why: {why}"
advice = ["Look."]
"""
RULE = """
[[faults]]
code = "laser-silent"
name = "Laser silent"
criticality = "critical"
recovery = ["expert"]
device = "laser"
console = "Nothing comes from the laser."
advice = ["Call the expert."]
when = [{ "laser.state" = { is = "STALE" } }]
"""


@pytest.fixture(scope="module")
def robot() -> Robot:
    """The shipped robot."""
    return load_robot()


def read(folder: Path, robot: Robot, text: str) -> FaultBook:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return load_faults(robot, path)


def refusal(folder: Path, robot: Robot, text: str) -> str:
    with pytest.raises(ProfileError) as caught:
        read(folder, robot, text)
    sentence = str(caught.value)
    assert sentence.startswith("mine.toml: ")
    assert sentence.isprintable(), "one line, and nothing that acts on a terminal"
    return sentence


def test_the_shipped_rules_load_and_end_with_a_fallback(robot: Robot) -> None:
    book = load_faults(robot)
    assert book.rules[-1] is book.fallback
    assert book.fallback.fallback
    assert [rule.code for rule in book.rules if rule.fallback] == [book.fallback.code]
    for rule in book.rules:
        assert rule.critical == (rule.recovery[0] == "expert"), rule.code


def test_a_rule_is_found_by_its_code_or_the_nearest_suggested(robot: Robot) -> None:
    book = load_faults(robot)
    assert book.rule("path-blocked").code == "path-blocked"
    with pytest.raises(ProfileError, match="did you mean 'path-blocked'"):
        book.rule("path-blokked")


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ('code = "laser-silent"', 'code = "Laser silent"', "lower-case words with hyphens"),
        ('"critical"', '"crital"', "did you mean 'critical'?"),
        ('["expert"]', '["exprt"]', "did you mean 'expert'?"),
        ('["expert"]', '["user", "expert"]', 'must begin with "expert"'),
        ('["expert"]', '["expert", "user"]', "nobody comes after that"),
        ('["expert"]', '["expert", "expert"]', "each once"),
        ('["expert"]', "[]", "one or more recoveries"),
        ('device = "laser"', 'device = "lazer"', "did you mean 'laser'?"),
        ('"laser.state"', '"laser.stat"', "did you mean 'laser.state'?"),
        ("{ is =", "{ iz =", "must hold one of: is, not, above"),
        ('is = "STALE"', 'above = "STALE"', "must be a number"),
        ('is = "STALE"', "is = nan", "must be a number"),
        ("when = [{", 'when = [{}, {', "an alternative without a condition"),
        ('when = [{ "laser.state" = { is = "STALE" } }]', "when = []", "at least one alternative"),
        ('"laser.state" = { is', '"behaviour.name" = { is', "must look at a symptom"),
        ("laser.\"\n", "laser {nam}.\"\n", "did you mean 'name'?"),
        ("laser.\"\n", "laser {name!r}.\"\n", "must hold just {name}"),
        ("laser.\"\n", "laser {.\"\n", "unpaired brace"),
        ('["Call the expert."]', "[]", "must tell staff what to do"),
        ('device = "laser"', "tries = 99", "a whole number from 1 to 10"),
        ('device = "laser"', 'remedy = "spinn"', "did you mean 'spin'?"),
        ('device = "laser"', 'solved = "evidense gone"', "did you mean 'evidence gone'?"),
        ('device = "laser"', 'also = ["mismatch.crd"]', "did you mean 'mismatch.card'?"),
        ('device = "laser"', 'devise = "laser"', "did you mean 'device'?"),
        ('name = "Laser silent"', "", "is missing; it must be text in quotes"),
    ],
)  # fmt: skip
def test_every_mistake_is_reported_in_one_line_with_a_suggestion(
    tmp_path: Path, robot: Robot, right: str, wrong: str, told: str
) -> None:
    assert right in RULE
    read(tmp_path, robot, RULE + LAST)
    assert told in refusal(tmp_path, robot, RULE.replace(right, wrong, 1) + LAST)


@pytest.mark.parametrize(
    ("key", "wrong", "told"),
    [
        ("laser.state", 'is = "stale"', "did you mean 'STALE'?"),
        ("laser.state", 'not = "OKAY"', "did you mean 'OK'?"),
        ("stop_button.latched", 'is = "yes"', "must be true or false"),
        ("stop_button.latched", "above = 0", "use is or not"),
        ("navigator.path", 'is = "nonne"', "did you mean 'none'?"),
        ("camera.brightness", "below = -3", "a number from 0 to 1"),
        ("camera.brightness", "is = true", "a number from 0 to 1"),
    ],
)
def test_a_condition_that_a_device_can_never_meet_is_refused(
    tmp_path: Path, robot: Robot, key: str, wrong: str, told: str
) -> None:
    text = RULE.replace('"laser.state" = { is = "STALE" }', f'"{key}" = {{ {wrong} }}', 1)
    assert text != RULE
    assert told in refusal(tmp_path, robot, text + LAST)


@pytest.mark.parametrize("text", ["Ask {nome}.", "Brace {", "{name.__class__}"])
@pytest.mark.parametrize("key", ["name", "advice"])
def test_texts_may_use_only_known_slots(tmp_path: Path, robot: Robot, key: str, text: str) -> None:
    right = {"name": '"Laser silent"', "advice": '"Call the expert."'}[key]
    assert right in RULE
    assert key in refusal(tmp_path, robot, RULE.replace(right, f'"{text}"', 1) + LAST)


def test_a_rule_that_asks_users_needs_speech_and_image(tmp_path: Path, robot: Robot) -> None:
    text = RULE.replace('"critical"', '"non-critical"').replace('["expert"]', '["user", "expert"]')
    assert "what a user is asked to do" in refusal(tmp_path, robot, text + LAST)
    said = text + 'aloud = "Please uncover me."\nimage = "Please uncover me"\n'
    assert read(tmp_path, robot, said + LAST).rules[0].recovery == ("user", "expert")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (RULE + RULE + LAST, "was used before"),
        (RULE + RULE.replace("laser-silent", "again") + LAST, "'laser-silent' matches first"),
        (LAST + RULE, "comes after 'unexplained', which explains everything"),
        (RULE, "the last of the faults must have `fallback = true`"),
        ("", "is empty"),
        ("faults = 3", "must be a list of tables"),
    ],
)
def test_an_unreachable_rule_is_refused(tmp_path: Path, robot: Robot, text: str, told: str) -> None:
    assert told in refusal(tmp_path, robot, text)


def test_a_weaker_condition_after_a_stronger_one_is_reachable(tmp_path: Path, robot: Robot) -> None:
    strong = RULE.replace(
        '"laser.state" = { is = "STALE" }', '"laser.near_share" = { above = 0.9 }'
    )
    weak = strong.replace("0.9", "0.5").replace("laser-silent", "weaker")
    assert len(read(tmp_path, robot, strong + weak + LAST).rules) == 3
    assert "'weaker' matches first" in refusal(tmp_path, robot, weak + strong + LAST)


def test_all_mistakes_of_a_file_are_reported_one_for_each_entry(
    tmp_path: Path, robot: Robot
) -> None:
    path = tmp_path / "mine.toml"
    bad = RULE.replace('"critical"', '"crital"'), RULE.replace("laser.state", "laser.stat")
    path.write_text("".join(bad) + RULE + LAST + "colour = 1\n", encoding="utf-8")
    book, mistakes = check_faults(robot, path)
    assert book is None
    assert len(mistakes) == 3
    assert ["crital" in mistakes[0], "laser.stat" in mistakes[1], "colour" in mistakes[2]] == [
        True,
        True,
        True,
    ]
    assert mistakes[0] == refusal(tmp_path, robot, path.read_text(encoding="utf-8"))


NUMBERS = st.floats(-10, 10)


@given(
    st.sampled_from(["above", "below", "at_least", "is"]), NUMBERS,
    st.sampled_from(["above", "below", "at_least", "is"]), NUMBERS, NUMBERS,
)  # fmt: skip
def test_implication_of_conditions_is_sound(
    test: str, value: float, other_test: str, other_value: float, found: float
) -> None:
    one, other = Condition("x", test, value), Condition("x", other_test, other_value)
    evidence = {"x": found}
    if one.implies(other) and one.holds(evidence):
        assert other.holds(evidence)


WORDS = st.sampled_from(
    ["", "[[faults]]", "=", '"', "{", "}", "]", "true", "-1", "nan", "1e999", '"laser.state"',
     '["expert"]', "[[", "{name}", "{x!r}", "[[faults]]\n", 'code = "mute"\n', "\x00", "\u202e"]
)  # fmt: skip


@pytest.mark.slow
@given(st.integers(0, len(SHIPPED)), st.integers(0, 60), WORDS | st.text(max_size=12))
def test_a_damaged_file_causes_no_traceback(
    tmp_path_factory: pytest.TempPathFactory, place: int, length: int, put: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "damaged.toml"
    text = SHIPPED[:place] + put + SHIPPED[place + length :]
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    book, mistakes = check_faults(load_robot(), path)
    assert (book is None) == bool(mistakes)
    for line in mistakes:
        assert line.startswith("damaged.toml: ")
        assert line == plain(line)
