"""`tangy activity`: shipped files are valid, and mistakes in a file are reported line by line."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

import tangy_profiles
from tangy_profiles.activity import read_activity, shipped_activities
from tangy_profiles.errors import ProfileError
from tangy_profiles.person import load_people
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_sim.worlds.injection import KINDS
from tangy_tui.language.activity_check import CheckedFile, check_activity
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.monitoring.rules import check_rules
from tangy_tui.text.rules import together_words
from tangy_tui.verbs.activity import checked_file
from tests.support.changed import changed_trivia

Tangy = Callable[..., CompletedProcess[str]]
SHIPPED = shipped_activities()["bingo"].read_text(encoding="utf-8")
LANTERNS = Path(__file__).parent.parent / "lanterns.toml"
RULES_FILE = Path(tangy_profiles.__path__[0]) / "faults.toml"
RULES = """
[[faults]]
code = "unexplained"
name = "Something unexpected"
criticality = "non-critical"
recovery = ["teacher"]
fallback = true
console = "Why: {why}"
advice = ["Look."]
"""


def checked(folder: Path, text: str) -> CheckedFile:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    people = load_room().placed(load_people(4))
    return check_activity(read_activity(path), load_robot(), people)


def warnings(folder: Path, text: str) -> list[str]:
    found = checked(folder, text)
    assert not found.mistakes
    return list(found.warnings)


def mistakes(folder: Path, text: str) -> list[str]:
    found = checked(folder, text)
    assert not found.warnings
    return list(found.mistakes)


def with_phrases(*phrases: tuple[str, str]) -> str:
    """Return a shipped activity with more phrases, each before an existing one."""
    text = SHIPPED
    for before, more in phrases:
        assert f'"{before}", ' in text
        text = text.replace(f'"{before}", ', f'"{more}", "{before}", ', 1)
    return text


@pytest.mark.slow  # it searches every activity completely, as tests/profiles does one by one
def test_every_shipped_file_passes_the_check(tangy: Tangy) -> None:
    done = tangy("activity", "check", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    document = json.loads(done.stdout)
    assert document["ok"]
    assert [file["kind"] for file in document["files"][-2:]] == ["activity", "faults"]
    assert not any(file.get("warnings") for file in document["files"])
    rules = document["files"][-1]
    assert not rules["kinds_without_rule"]
    assert not rules["evidence_without_rule"]


def test_the_list_names_every_playable_activity(tangy: Tangy) -> None:
    listed = json.loads(tangy("activity", "list", "--json").stdout)
    bingo = next(one for one in listed if one["name"] == "bingo")
    assert (bingo["name"], len(bingo["behaviours"]), len(bingo["situations"])) == ("bingo", 11, 11)
    assert "Bingo" in tangy("activity", "list").stdout
    assert {"exercises", "trivia", "team-trivia"} <= {one["name"] for one in listed}
    assert json.loads(tangy("activity", "--json").stdout) == listed


def test_a_custom_activity_is_checked_by_its_path(tangy: Tangy) -> None:
    done = tangy("activity", "check", LANTERNS)
    assert (done.returncode, done.stderr) == (0, "")
    assert "lanterns.toml" in done.stdout


def test_each_mistake_is_one_line_and_sets_the_exit_status(tangy: Tangy, tmp_path: Path) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text(SHIPPED.replace('posture = "', 'posture = "xx', 1), encoding="utf-8")
    rules = tmp_path / "rules.toml"
    wrong = RULES.replace('"teacher"', '"teecher"').replace("unexplained", "other")
    rules.write_text(wrong + RULES.replace("{why}", "{whi}"), encoding="utf-8")
    done = tangy("activity", "check", "bingo", "bingoo", bad, rules)
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert len(lines) == 4
    assert "did you mean 'bingo'?" in lines[0]
    assert lines[1].startswith("bad.toml: behaviours[")
    assert "did you mean 'teacher'?" in lines[2]
    assert "did you mean 'why'?" in lines[3]
    document = json.loads(tangy("activity", "check", bad, rules, "--json").stdout)
    assert not document["ok"]
    assert [len(file["mistakes"]) for file in document["files"]] == [1, 2]


def test_an_unreadable_file_is_reported_in_one_line(tangy: Tangy, tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_bytes(b"\xff\xfe")
    for given in (["none.toml"], [tmp_path / "x.toml"], [tmp_path], ["--faults", "none.toml"]):
        done = tangy("activity", "check", *given)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_folders_and_empty_files_are_reported(tangy: Tangy, tmp_path: Path) -> None:
    empty, folder = tmp_path / "empty.toml", tmp_path / "folder"
    empty.touch()
    folder.mkdir()
    for option in ((), ("--faults",)):
        assert "empty.toml: is empty" in tangy("activity", "check", *option, empty).stderr
        assert "folder: is a folder" in tangy("activity", "check", *option, folder).stderr


def test_the_check_lists_rules_that_need_two_injected_faults(tangy: Tangy) -> None:
    rules = json.loads(tangy("activity", "check", RULES_FILE, "--json").stdout)["files"][-1]
    together = rules["only_by_kinds_together"]
    assert together == {"mute": ["voice-dead", "screen-dead"]}
    assert not {"mute", "unknown-situation"} & set(rules["rules_without_kind"])
    said = tangy("activity", "check", RULES_FILE).stdout
    assert together_words(["voice-dead", "screen-dead"], "mute") in said


@pytest.mark.parametrize(
    ("put", "reason"),
    [
        ('name = "nap"\nwhen = "otherwise"', None),
        ('name = "nap"\nwhen = "before"\nbehaviour = "greeting"', "always holds first"),
        ('name = "nap"\nwhen = "beside requester"', "always holds first"),
        ('name = "nap"\nwhen = "after"\nbehaviour = "valediction"', "the activity is over"),
        ('name = "nap"\nwhen = "after"\nbehaviour = "joke"', None),
        (
            'name = "nap"\nwhen = "count"\nbehaviour = "call number"\nsince = "joke"\nevery = 40',
            "always holds first",
        ),
    ],
)
def test_an_unreachable_stage_is_reported(tmp_path: Path, put: str, reason: str | None) -> None:
    *first, last = SHIPPED.split("[[stages]]")
    text = "[[stages]]".join([*first, f" \n{put}\n\n", last])
    found = [line for line in warnings(tmp_path, text) if "stages[nap]" in line]
    assert [reason in line for line in found if reason] == ([True] if reason else [])


def test_a_stage_after_otherwise_is_unreachable(tmp_path: Path) -> None:
    *first, last = SHIPPED.split("[[stages]]")
    put = '\nname = "nap"\nwhen = "otherwise"\n\n'
    found = warnings(tmp_path, "[[stages]]".join([*first, put, last]))
    assert [line for line in found if "'nap' stands before it" in line] == found
    assert len(found) == 1


def colliding() -> str:
    """Return an activity in which a behaviour takes another's name and phrase."""
    first = '"greet everyone", '
    assert SHIPPED.index(first) < SHIPPED.index('"tell a joke"')
    text = SHIPPED.replace(first, first + '"joke", ', 1)
    begun = text.index("question = ")
    return text[:begun] + 'question = "say two"' + text[text.index("\n", begun) :]


def test_a_phrase_with_another_meaning_is_reported(tmp_path: Path) -> None:
    text = colliding().replace('"tell a joke", ', '"tell a joke", "say two", ', 1)
    found = mistakes(tmp_path, text)
    assert len(found) == 2
    assert all("behaviours[joke].phrases" in line for line in found)
    assert all("is heard as 'greeting'" in line for line in found)
    assert not warnings(tmp_path, SHIPPED)


def test_possibly_pressing_strategies_are_reported_if_none_is_named(tmp_path: Path) -> None:
    (line,) = [line for line in SHIPPED.splitlines() if line.startswith("pressing_strategies")]
    guilt = SHIPPED.replace(line, "").replace("scarcity", "guilt")
    (told,) = warnings(tmp_path, guilt)
    assert "pressing_strategies" in told and "guilt" in told
    assert not warnings(tmp_path, SHIPPED.replace("scarcity", "guilt"))
    assert not warnings(tmp_path, SHIPPED.replace(line, "pressing_strategies = []"))


def test_a_behaviour_without_a_usable_phrase_is_reported(tmp_path: Path) -> None:
    text = colliding()
    begun = text.rindex("phrases", 0, text.index('"tell us a joke"'))
    text = text[:begun] + 'phrases = ["say two"]' + text[text.index("]", begun) + 1 :]
    (found,) = mistakes(tmp_path, text)
    assert "behaviours[joke].phrases: nobody can ask for it" in found


def test_a_word_without_pronunciation_is_refused_with_the_line_to_add(tmp_path: Path) -> None:
    text = with_phrases(("tell a joke", "jestificate"))
    (found,) = mistakes(tmp_path, text)
    assert found.startswith("mine.toml: pronunciations: 'jestificate' has no pronunciation; add: ")
    line, _, hear = found.partition("add: ")[2].partition(" (hear it: tangy activity hear ")
    phones = line.partition(" = ")[2]
    assert hear.strip("')") == phones.strip('"')
    table = "[pronunciations]\n"
    assert not mistakes(tmp_path, text.replace(table, table + line + "\n", 1))


@pytest.mark.parametrize(
    ("phrases", "told"),
    [
        (
            (("tell a joke", "raise it"), ("remove markers", "raze it")),
            (
                "behaviours[remove markers].phrases = 'raze it': it sounds like ",
                "behaviours[joke].phrases = 'raise it'; ",
            ),
        ),
        (
            (("tell a joke", "raise two"), ("remove markers", "raise too")),
            (
                "behaviours[remove markers].phrases = 'raise too': it sounds like ",
                "behaviours[joke].phrases = 'raise two'; ",
            ),
        ),
        (
            (("tell a joke", "do it now"), ("remove markers", "do it then")),
            (
                "behaviours[remove markers].phrases = 'do it then': only small words tell it from ",
                "behaviours[joke].phrases = 'do it now'; ",
            ),
        ),
    ],
)
def test_phrases_that_sound_alike_are_refused_with_a_suggestion(
    tmp_path: Path, phrases: tuple[tuple[str, str], ...], told: tuple[str, ...]
) -> None:
    (found,) = mistakes(tmp_path, with_phrases(*phrases))
    for words in told:
        assert words in found
    helps = found.partition("put another word into one of them, such as ")[2].strip("'.")
    ours, theirs = phrases[1][1], phrases[0][1]
    assert ours != theirs
    better = with_phrases(phrases[0], (phrases[1][0], f"{ours} {helps}"))
    assert not mistakes(tmp_path, better)


@pytest.mark.parametrize(
    ("phrase", "why"),
    [
        ("stop now", "always stops the robot"),
        ("please halt", "always stops the robot"),
        ("yes please", "is an answer to Tangy's questions"),
        ("no thank you", "is an answer to Tangy's questions"),
    ],
)
def test_a_phrase_that_is_a_stop_or_an_answer_is_refused_with_a_suggestion(
    tmp_path: Path, phrase: str, why: str
) -> None:
    (found,) = mistakes(tmp_path, with_phrases(("tell a joke", phrase)))
    assert f"behaviours[joke].phrases = '{phrase}': it {why}; " in found
    word = found.partition("another word, such as ")[2].strip("'.")
    assert not mistakes(tmp_path, with_phrases(("tell a joke", f"{word} {phrase}")))


@pytest.mark.parametrize(
    ("change", "name", "told"),
    [
        (
            ('"allow time"', '"stop the game"'),
            "stop the game",
            "this name always stops the robot; give it another",
        ),
        (
            ('[behaviours."allow time"]', '[behaviours."allow time"]\nposture = "clap"'),
            "allow time",
            "'clap'",
        ),
    ],
)
def test_a_mistake_is_told_with_its_line_before_the_search(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: tuple[str, str], name: str, told: str
) -> None:
    monkeypatch.setattr("tangy_profiles.declared.checking.findings", None)  # it would fail
    path = tmp_path / changed_trivia(tmp_path, change).source
    (line,) = checked_file(str(path), load_robot())[0].mistakes
    number = path.read_text("utf-8").splitlines().index(f'[behaviours."{name}"]')
    assert line.startswith(f"{path.name}:{number + 1}: behaviours[")
    assert told in line


def test_a_file_with_a_colon_in_its_name_tells_the_line_of_a_mistake(tmp_path: Path) -> None:
    change = ('"allow time"', '"stop the game"')
    written = tmp_path / changed_trivia(tmp_path, change).source
    path = written.rename(tmp_path / "at 3: quiz.toml")
    (line,) = checked_file(str(path), load_robot())[0].mistakes
    number = path.read_text("utf-8").splitlines().index('[behaviours."stop the game"]')
    assert line.startswith(f"at 3: quiz.toml:{number + 1}: behaviours[")


def test_a_phrase_that_sounds_like_one_with_a_person_names_it(tmp_path: Path) -> None:
    (found,) = mistakes(tmp_path, with_phrases(("tell a joke", "go two user won")))
    assert ".phrases, with a person = 'go to user one': it sounds like " in found
    assert "behaviours[joke].phrases = 'go two user won'; " in found


@pytest.mark.parametrize("near", ["lays it", "raises it", "aze it", "raise at"])
def test_phrases_one_sound_apart_are_a_warning_with_a_suggestion(tmp_path: Path, near: str) -> None:
    phrases = ("tell a joke", "raise it"), ("remove markers", near)
    table = '[pronunciations]\naze = "EY Z"\nraises = "R EY Z IY"\nlays = "L EY Z"\n'
    text = with_phrases(*phrases).replace("[pronunciations]\n", table, 1)
    (found,) = [line for line in warnings(tmp_path, text) if "one sound" in line]
    assert f"behaviours[remove markers].phrases = '{near}': one sound alone tells it" in found
    assert "behaviours[joke].phrases = 'raise it'; " in found
    helps = found.partition("put another word into one of them, such as ")[2].strip("'.")
    better = text.replace(f'"{near}"', f'"{near} {helps}"')
    assert not any("one sound" in line for line in warnings(tmp_path, better))


def test_phrases_of_one_behaviour_or_two_sounds_apart_give_no_warning(tmp_path: Path) -> None:
    same = with_phrases(("tell a joke", "raise it"), ("tell a joke", "lays it"))
    assert not warnings(tmp_path, same)
    two = with_phrases(("tell a joke", "raise it"), ("remove markers", "lace it"))
    assert not warnings(tmp_path, two)


def test_the_check_refuses_confusable_phrases_but_the_activity_loads(
    tangy: Tangy, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    text = with_phrases(("tell a joke", "raise it"), ("remove markers", "raze it"))
    path.write_text(text, encoding="utf-8")
    done = tangy("activity", "check", path)
    assert done.returncode == 2
    assert "raze it" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    lexicon = Lexicon(Phrasebook(read_activity(path), load_people(4)))
    assert set(lexicon.left_out()) == {"raze it"}
    assert "raise it" in lexicon.heard()


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ('joke = "JH OW Q"', ("pronunciations.joke = 'JH OW Q'", "'Q'", "did you mean 'K'?")),
        ('joke = "JHOWK"', ("there is no phone 'JHOWK'",)),
        ("joke = []", ("at least one",)),
        ('joke = ""', ("must not be empty",)),
        ("joke = 3", ("must be",)),
        ('"two words" = "T UW"', ("one lower-case word",)),
        ('Joke = "JH OW K"', ("one lower-case word",)),
        (f'joke = "{"B " * 41}"', ("from 1 to 40 phones",)),
    ],
)
def test_an_invalid_pronunciation_is_reported_in_one_line(
    tmp_path: Path, line: str, told: tuple[str, ...]
) -> None:
    table = "[pronunciations]\n"
    with pytest.raises(ProfileError) as caught:
        checked(tmp_path, SHIPPED.replace(table, f"{table}{line}\n", 1))
    assert "\n" not in str(caught.value)
    for words in told:
        assert words in str(caught.value)


def test_stress_and_case_of_phones_are_ignored_and_unused_words_reported(tmp_path: Path) -> None:
    table = "[pronunciations]\n"
    text = SHIPPED.replace(table, table + 'joke = ["jh OW1 k", "JH AO K"]\nzebra = "Z IY"\n', 1)
    (found,) = warnings(tmp_path, text)
    assert "pronunciations.zebra" in found
    activity = read_activity(tmp_path / "mine.toml")
    assert activity.pronunciations["joke"] == ("JH OW K", "JH AO K")


def test_the_check_of_rules_lists_uncovered_symptoms(tmp_path: Path) -> None:
    path = tmp_path / "rules.toml"
    path.write_text(RULES, encoding="utf-8")
    rules = check_rules(load_robot(), path)
    assert "laser.state" in rules.unseen
    right = {name for name, kind in KINDS.items() if kind.code == "unexplained"}
    assert set(rules.unruled) == set(KINDS) - right
