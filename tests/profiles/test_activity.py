"""Reading an activity's TOML file; every mistake is reported in one line."""

from __future__ import annotations

from pathlib import Path
from string import Formatter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity, read_activity, shipped_activities
from tangy_profiles.behaviour import SLOTS
from tangy_profiles.effects import EFFECTS
from tangy_profiles.errors import ProfileError
from tangy_profiles.state import Outcome, Situation

PAPERS_BEHAVIOURS = {
    "greeting", "call number", "joke", "remove markers", "mark numbers", "encourage",
    "move card closer", "navigate to user", "navigate to front", "celebrate", "valediction",
}  # fmt: skip
SHIPPED = shipped_activities()["bingo"].read_text(encoding="utf-8")


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "mine.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def refusal(folder: Path, text: str | bytes) -> str:
    with pytest.raises(ProfileError) as caught:
        read_activity(written(folder, text))
    sentence = str(caught.value)
    assert sentence.startswith("mine.toml: ")
    assert sentence.isprintable(), "one line, and nothing that acts on a terminal"
    assert len(sentence) < 700
    return sentence


def test_bingo_has_the_papers_eleven_behaviours_four_strategies_and_five_user_states(
    activity: Activity,
) -> None:
    assert set(activity.behaviours) == PAPERS_BEHAVIOURS
    assert set(activity.strategies) == {"praise", "suggestion", "scarcity", "neutral"}
    assert [state.name for state in activity.user_states] == [
        "occluded", "bingo", "incorrectly marked", "missing numbers", "correctly marked",
    ]  # fmt: skip
    assert activity.stages == ("start", "end", "help", "navigate", "socialize", "facilitate")


def test_table_two_has_exactly_eleven_expected_behaviours(activity: Activity) -> None:
    assert set(activity.expected) == set(activity.situations)
    assert len(activity.situations) == 11
    assert set(activity.expected.values()) == PAPERS_BEHAVIOURS


def test_persuading_behaviours_have_a_different_speech_for_each_strategy(
    activity: Activity,
) -> None:
    persuading = [b for b in activity.behaviours.values() if b.persuades]
    assert {b.name for b in persuading} == {
        "remove markers", "mark numbers", "encourage", "move card closer",
    }  # fmt: skip
    for behaviour in persuading:
        assert len(set(behaviour.speech.values())) == len(activity.strategies), behaviour.name


def test_an_action_has_posture_speech_image_place_and_strategy(
    activity: Activity,
) -> None:
    behaviour = activity.behaviours["remove markers"]
    action = activity.action(behaviour, "user2", "praise")
    assert (action.behaviour, action.target, action.strategy) == (behaviour, "user2", "praise")
    assert action.speech == behaviour.speech["praise"]
    assert (action.posture, action.image, action.place) == (
        behaviour.posture, behaviour.image, behaviour.place,
    )  # fmt: skip
    assert activity.action(behaviour, None, None).strategy == activity.plain_strategy == "neutral"


def test_pressing_strategies_have_a_default(tmp_path: Path, activity: Activity) -> None:
    (line,) = [line for line in SHIPPED.splitlines() if line.startswith("pressing_strategies")]
    quiet = read_activity(written(tmp_path, SHIPPED.replace(line, "")))
    assert quiet.pressing == activity.pressing == ("scarcity",)
    said = SHIPPED.replace(line, "pressing_strategies = []")
    none = read_activity(written(tmp_path, said))
    assert none.pressing == ()


def test_every_template_can_be_filled(activity: Activity, lanterns: Activity) -> None:
    for one in (activity, lanterns):
        for behaviour in one.behaviours.values():
            assert behaviour.effect in EFFECTS
            for template in (*behaviour.speech.values(), behaviour.image):
                text = one.fill(template, "Rosa", one.deck.numbers[:2])
                slots = {slot for _, slot, _, _ in Formatter().parse(template) if slot}
                assert slots <= set(SLOTS)
                assert ("Rosa" in text) == ("name" in slots)
                assert "{" not in text


def test_few_of_many_numbers_are_spoken_and_all_are_shown(activity: Activity) -> None:
    request, deck = activity.behaviours["mark numbers"], activity.deck
    action = activity.action(request, "user1", None)

    def words(count: int) -> tuple[str, str]:
        return activity.words_of(action, Outcome(True, 0.0, deck.numbers[:count], None), str)

    assert words(5)[0].count("-") == 5 and "more" not in words(5)[0]
    said, shown = words(25)
    assert "B-1, B-2, B-3, B-4, and 21 more" in said and said.count("-") == 4
    assert shown.count("-") == 25


def test_a_limit_of_spoken_numbers_needs_its_words(tmp_path: Path) -> None:
    (line,) = [line for line in SHIPPED.splitlines() if line.startswith("more_numbers")]
    with pytest.raises(ProfileError, match="more_numbers"):
        read_activity(written(tmp_path, SHIPPED.replace(line, "")))


@given(st.text())
def test_braces_in_a_name_are_not_filled(name: str) -> None:
    activity = load_activity("bingo")
    assert activity.fill("{name} {call} {numbers}", name, (5, 16)) == f"{name} B-5 B-5, I-16"
    assert activity.fill("{name}", name, ()) == name
    assert activity.fill("{name}: {call}", name, ()) == ""
    assert activity.fill("{name}: {numbers}", name, ()) == ""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('title = "Bingo"', 'titel = "Bingo"', ("title", "missing")),
        ("patience = 10.0", "patience = 10.0\npatiense = 1", ("patiense", "'patience'?")),
        ('effect = "draw"', 'effect = "drow"', ("behaviours[call number].effect", "'draw'?")),
        ('place = "front"', 'place = "fornt"', ("behaviours[greeting].place", "'front'?")),
        ('checker = "unread"', 'checker = "unraed"', ("user_states[occluded].checker", "'unread'")),
        ('closes = "always"', 'closes = "allways"', ("closes = 'allways'", "'always'?")),
        ('needs = ["bingo"]', 'needs = ["bongo"]', ("needs", "'bongo'", "'bingo'?")),
        ('when = "beside requester"', 'when = "beside"', ("stages[help].when", "requester'?")),
        ('since = "joke"', 'since = "yoke"', ("stages[socialize].since", "'joke'?")),
        ('since = "joke"', 'since = "call number"', ("since", "another behaviour")),
        ('plain_strategy = "neutral"', 'plain_strategy = "natural"', ("'neutral'?",)),
        ("speech.praise = \"{name}, you follow", "speech.prayse = \"{name}, you follow",
         ("behaviours[remove markers].speech", "'praise'?")),
        ('"tell a joke",', '"tell a joke", "greet everyone",', ("'greet everyone'", "'greeting'")),
        ('"tell a joke",', '"Tell a joke!",', ("'Tell a joke!'", "lower-case")),
        ('"tell a joke",', f'"{"A" * 99_999}",', ("phrases = ['AA", "must be lower-case words")),
        ('phrases = [\n    "tell a joke"', 'phrases = []\nx = [\n"tell a joke"',
         ("behaviours[joke].phrases = []", "at least one")),
        ('keywords = ["joke", "funny"]', "keywords = 3", ("keywords = 3", "list of texts")),
        ("patience = 10.0", "patience = nan", ("patience = nan", "0.1 to 600")),
        ("patience = 10.0", "patience = inf", ("patience = inf", "0.1 to 600")),
        ("patience = 10.0", "patience = -1", ("patience = -1",)),
        ("patience = 10.0", "patience = true", ("patience = True", "a number")),
        ("patience = 10.0", 'patience = "10"', ("patience = '10'", "a number")),
        ("patience = 10.0", f"patience = 1{'0' * 400}", ("patience = 1000", "0.1 to 600")),
        ("patience = 10.0", f"patience = 1{'0' * 5000}", ("digits",)),
        ("every = 18", "every = 18.5", ("every = 18.5", "a whole number")),
        ("every = 18", "every = 0", ("every = 0", "1 to 999")),
        ("every = 18", "every = true", ("every = True",)),
        ("rows = 5", "rows = [5]", ("deck.rows = [5]",)),
        ("persuades = true", "persuades = 1", ("persuades = 1", "true or false")),
        ('"{call}"', '"{coll}"', ("image", "{coll}", "'call'?")),
        ('"{call}"', '"{call"', ("image = '{call'", "unpaired brace")),
        ('"{call}"', '"call}"', ("unpaired brace",)),
        ('"{call}"', '"{}"', ("cannot fill in {}",)),
        ('"{call}"', '"{call.real}"', ("cannot fill in",)),
        ('"{call}"', '"{call!r}"', ("just {call}",)),
        ('"{call}"', '"{call:>999999999}"', ("just {call}",)),
        ('title = "Bingo"', 'title = "Bin\\u001b[31mgo"', ("title", "cannot be shown")),
        ('title = "Bingo"', 'title = "Bin\\u202ego"', ("title", "cannot be shown")),
        ('title = "Bingo"', 'title = "  "', ("title", "empty")),
        ('title = "Bingo"', 'title = "Bingo"\n"a\\u001b[2J\\n" = 1', ("not a key here",)),
        ('title = "Bingo"', f"title.{'.'.join('a' * 3000)} = 1", ("title = {", "text in quotes")),
        ('title = "Bingo"', f"title = ['{'a' * 99_999}']", ("title", "text in quotes")),
        ('title = "Bingo"', f"title = 'B'\n{'a' * 99_999} = 1", ("not a key here",)),
        ('title = "Bingo"', "title = 2024-02-31", ("not TOML", "line 3")),
        ('title = "Bingo"', "title = Bingo", ("not TOML", "line 3")),
        ('title = "Bingo"', 'title = "a"\ntitle = "b"', ("not TOML", "line 4")),
        ('user_state = "bingo"', 'user_state = "bingoo"', ("expected[4].user_state", "'bingo'?")),
        ('stage = "end"\nrequest = "AR"', 'stage = "end"\nrequest = "ANR"', ("never come about",)),
        ('name = "joke"\nquestion', 'name = "greeting"\nquestion', ("behaviours[greeting].name",)),
        ('effect = "finish"', 'effect = "none"', ("behaviours", "'finish'")),
        ('name = "facilitate"\nwhen = "otherwise"', 'name = "f"\nwhen = "beside requester"',
         ("stages", "'otherwise'")),
        ('checker = "otherwise"', 'checker = "missing marks"', ("user_states", "'otherwise'")),
        ('name = "bingo"\nlabel', 'name = "occluded"\nlabel', ("user_states", "same name")),
        ("[[expected]]", "[[expacted]]", ("expacted", "'expected'?")),
    ],
)  # fmt: skip
def test_a_mistake_is_reported_in_one_line_with_key_value_and_suggestion(
    tmp_path: Path, old: str, new: str, said: tuple[str, ...]
) -> None:
    assert old in SHIPPED
    sentence = refusal(tmp_path, SHIPPED.replace(old, new))
    for words in said:
        assert words in sentence


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"\xff\xfe" + SHIPPED.encode(), "not UTF-8"),
        (SHIPPED.encode("utf-16"), "not UTF-8"),
        ("x = " + "[" * 100_000, "nested too deeply"),
        (SHIPPED + "#" * 1_000_000, "larger than 1,000,000 bytes"),
        ("", "is empty"),
        ("patience = 4.0", "missing"),
        ("\x00", "not TOML"),
        (SHIPPED.replace("[strategies]", "[strategies]\n[other]"), "strategy"),
    ],
)
def test_an_invalid_file_is_refused_in_one_line(
    tmp_path: Path, text: str | bytes, said: str
) -> None:
    assert said in refusal(tmp_path, text)


def test_a_missing_file_is_refused_with_its_path(tmp_path: Path) -> None:
    for name in (str(tmp_path / "none.toml"), str(tmp_path / ("n" * 300 + ".toml"))):
        with pytest.raises(ProfileError, match=r"none\.toml: there is no such|cannot be read"):
            load_activity(name)
    (tmp_path / "folder.toml").mkdir()
    for folder in (tmp_path, tmp_path / "folder.toml"):
        with pytest.raises(ProfileError, match="is a folder; name the TOML file in it"):
            load_activity(str(folder))
    with pytest.raises(ProfileError, match="There is no activity ''"):
        load_activity("")
    with pytest.raises(ProfileError, match="There is no activity 'nn"):
        load_activity("n" * 300)
    with pytest.raises(ProfileError, match="did you mean 'bingo'"):
        load_activity("bingoo")


@given(st.data())
def test_a_file_with_a_lost_or_doubled_line_causes_no_traceback(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    lines = SHIPPED.splitlines()
    place = data.draw(st.integers(0, len(lines) - 1))
    times = data.draw(st.sampled_from([0, 2]))
    changed = "\n".join([*lines[:place], *[lines[place]] * times, *lines[place + 1 :]])
    path = written(tmp_path_factory.mktemp("mine"), changed)
    try:
        read_activity(path)
    except ProfileError as error:
        assert str(error).startswith("mine.toml: ")
        assert str(error).isprintable()


def test_a_final_stage_without_winner_exists_with_and_without_a_request(lanterns: Activity) -> None:
    assert Situation("leaving", "AR", "hidden") in lanterns.situations
    assert Situation("leaving", "ANR", "hidden") in lanterns.situations


def test_asking_for_an_unknown_behaviour_names_the_nearest(activity: Activity) -> None:
    with pytest.raises(ProfileError, match="Bingo has no behaviour 'jok': did you mean 'joke'"):
        activity.behaviour("jok")
