"""`tangy activity new` asks an author, and what it writes is checked and can be played at once."""

from __future__ import annotations

import csv
import json
import tomllib
from collections.abc import Callable
from itertools import permutations
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_tui.app.activity_bases import choice_questions, examples
from tangy_tui.app.authors_words import kept, name_of
from tangy_tui.app.new_activity import KINDS, Draft, Problem
from tangy_tui.text.activity_questions import (
    ENDS,
    ENDS_EMPTY,
    ENDS_OF_TEMPLATES,
    PROBLEMS,
    answers,
    draft_lines,
)
from tangy_tui.verbs.activity_files import built
from tests.support.media import make_picture

Tangy = Callable[..., CompletedProcess[str]]
PIECES = {
    "quiz": ("Which flower has thorns?; rose; tulip, daisy; It is red.", "Is ice cold?; yes; no"),
    "talk": ("Who was your best friend?; What did you do together?", "What did you cook?"),
    "songs": ("Row your boat; Row, row, row your boat", "My Bonnie; My Bonnie lies over the ocean"),
    "exercises": ("Raise your arms; Lift both arms and lower them again; six",),
    "memory": ("apples; top; An apple a day ...", "boats"),
}
WAYS = [
    *(pytest.param(kind, (), id=kind) for kind in KINDS),
    *(
        pytest.param(kind, [part for row in rows for part in ("--row", row)], id=f"{kind} of mine")
        for kind, rows in PIECES.items()
    ),
    pytest.param("quiz", ("--teams", "Reds, Blues", "--no-points", "--rounds", 3), id="teams"),
    pytest.param("talk", ("--item", "a poem", "--no-turns"), id="a group"),
    pytest.param("game", ("--win-at", 2), id="a short game"),
    pytest.param("cards", ("--claim", "house", "--pattern", "x", "--numbers", 50), id="lotto"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "options"), WAYS)
def test_each_kind_of_new_activity_is_taught_learnt_and_played_at_once(
    kind: str, options: tuple[object, ...], tangy: Tangy, tmp_path: Path
) -> None:
    folder = tmp_path / "mine"
    made = tangy("activity", "new", folder, "--title", "Ours", "--kind", kind, "--yes", *options)
    assert (made.returncode, made.stderr) == (0, "")
    (file,) = folder.glob("*.toml")
    checked = json.loads(tangy("activity", "check", "--json", file).stdout)
    assert [(one["mistakes"], one["warnings"]) for one in checked["files"]] == [([], [])]
    at = ("--activity", file, "--data", tmp_path / "data")
    taught = tangy("teach", "--teacher", "scripted", "--guided", "--games", 1, *at)
    assert (taught.returncode, taught.stderr) == (0, "")
    assert tangy("learn", *at).returncode == 0
    done = tangy("play", "--games", 5, "--headless", "--json", "--seed", 3, *at)
    played = json.loads(done.stdout)
    assert (played["finished"], played["asked"], played["faults"]) == (5, 0, [])


@pytest.mark.slow
@pytest.mark.timeout(400)
@pytest.mark.parametrize("kind", ["quiz", "cards"])
def test_a_new_activity_is_played_on_the_bench(kind: str, tangy: Tangy, tmp_path: Path) -> None:
    tangy("activity", "new", tmp_path, "--title", "Ours", "--kind", kind, "--yes")
    at = ("--activity", tmp_path / "ours.toml", "--data", tmp_path / "data")
    tangy("teach", "--teacher", "scripted", "--guided", *at)
    tangy("learn", *at)
    played = tangy("live", "--bench", "--headless", "--json", "--seed", 2, *at)
    assert json.loads(played.stdout)["finished"] == 1


QUIZ = """Garden quiz
1

maybe
y

Which flower has thorns?
tulip
back
rose
rose, tulip, ROSE
tulip, daisy

What do bees make?
honey
milk, silk


"""


@pytest.mark.slow
def test_questions_are_asked_again_until_they_fit_and_can_be_gone_back_to(
    tangy: Tangy, tmp_path: Path
) -> None:
    made = tangy("activity", "new", tmp_path, stdin=f"!\n{QUIZ}\n\n\ny\n")
    assert (made.returncode, made.stderr) == (0, "")
    for problem in ("yes", "letters", "same"):
        assert made.stdout.count(PROBLEMS[problem]) == 1
    head, *rows = csv.reader((tmp_path / "garden-quiz.csv").read_text("utf-8").splitlines())
    table = [dict(zip(head, row, strict=True)) for row in rows]
    assert [(row["ask"], row["right"]) for row in table] == [
        ("Which flower has thorns?", "rose"),
        ("What do bees make?", "honey"),
    ]
    assert [row["hint"] for row in table] == ["It is not daisy.", "It is not silk."]


@pytest.mark.slow
def test_answers_can_be_changed_by_their_number_and_rows_removed(
    tangy: Tangy, tmp_path: Path
) -> None:
    changes = "1\nMeadow quiz\n6\nWhich flower pricks?\n\n\n\n7\n-\ny\n"
    made = tangy("activity", "new", tmp_path, stdin=f"{QUIZ}\n\n\n{changes}")
    assert (made.returncode, made.stderr) == (0, "")
    assert not (tmp_path / "garden-quiz.toml").exists()
    _, *rows = csv.reader((tmp_path / "meadow-quiz.csv").read_text("utf-8").splitlines())
    assert [row[0] for row in rows] == ["Which flower pricks?"]
    assert "rounds = 1 " in (tmp_path / "meadow-quiz.toml").read_text("utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["n\n", "", "back\n"])
def test_nothing_is_written_without_a_yes(ending: str, tangy: Tangy, tmp_path: Path) -> None:
    made = tangy("activity", "new", tmp_path, stdin=f"{QUIZ}\n\n\n{ending}")
    assert made.returncode == (0 if ending == "n\n" else 2)
    assert list(tmp_path.glob("garden*")) == []


@pytest.mark.slow
def test_pictures_of_questions_are_shown_and_must_exist(tangy: Tangy, tmp_path: Path) -> None:
    make_picture(tmp_path / "rose.png")
    row = "Which flower is this?; rose; tulip, daisy; It has thorns.; rose.png"
    rows = ("--yes", "--row", row, "--row", "Is ice cold?; yes; no")
    made = tangy("activity", "new", tmp_path, "--title", "Flowers", *rows)
    assert (made.returncode, made.stderr) == (0, "")
    assert "rose.png" in tangy("activity", "try", tmp_path / "flowers.toml").stdout
    assert "sound" not in (tmp_path / "flowers.toml").read_text("utf-8")
    lacks = ("--yes", "--row", "Who?; you; me; ; no.png")
    other = tangy("activity", "new", tmp_path, "--title", "Other", *lacks)
    assert other.returncode == 2
    assert "There is no no.png" in other.stderr


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--kind", "chess"), "--kind: Please type a number"),
        (("--teams", "Reds"), "--teams: Please type from 2 to 6 names"),
        (("--row", "Who?; me; me"), "--row: Two of the answers are the same"),
        (("--row", "Who?"), "--row: Please type an answer."),
        (("--rounds", "0"), "--rounds: Please type a number from 1"),
        (("--kind", "cards", "--row", "x"), "--row: This kind has no rows."),
        (("--kind", "cards", "--numbers", "52"), "--numbers: Please type a number that 5 divides"),
        (("--kind", "talk", "--row", "a", "--row", "b", "--rounds", "2"), "--rounds: This is for"),
        (("--kind", "cards", "--welcome", "Hi all"), "--welcome: This is for another kind"),
        (("--kind", "talk", "--teams", "Reds, Blues"), "--teams: This is for another kind"),
        (("--row", f"Who?; me; you; ; {'ä' * 150}"), "--row: There is no ää"),
        (("--kind", "cards", "--claim", "Left"), "--claim: Staff type left for something else"),
    ],
)
def test_an_option_that_cannot_be_taken_is_named(
    options: tuple[str, ...], told: str, tangy: Tangy, tmp_path: Path
) -> None:
    made = tangy("activity", "new", tmp_path, "--title", "Ours", "--yes", *options)
    assert made.returncode == 2
    assert told in made.stderr
    assert list(tmp_path.glob("ours*")) == []


@pytest.mark.slow
@pytest.mark.parametrize("said", ["poem", "a poem", "An old poem", "the poem", "a"])
def test_the_article_of_an_item_is_removed(said: str, tangy: Tangy, tmp_path: Path) -> None:
    options = ("--title", "Poems", "--kind", "talk", "--item", said, "--yes")
    assert tangy("activity", "new", tmp_path, *options).returncode == 0
    item = said.removeprefix("An ").removeprefix("a ").removeprefix("the ")
    assert f"The first {item}," in (tmp_path / "poems.csv").read_text("utf-8")


def test_the_present_folder_is_named_in_words(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    lacks = ("--title", "Ours", "--yes", "--row", "Who?; you; me; ; no.png")
    assert "There is no no.png in this folder." in tangy("activity", "new", *lacks).stderr


def test_the_first_row_of_a_table_can_be_left_to_examples(tangy: Tangy, tmp_path: Path) -> None:
    asked = tangy("activity", "new", tmp_path, stdin="Poems\ntalk\npoem\n\nOde\n")
    assert f"Poem 1, as Tangy should say it{ENDS_EMPTY}:" in asked.stdout
    assert f"Poem 2, as Tangy should say it{ENDS}:" not in asked.stdout


def test_an_existing_file_is_not_overwritten(tangy: Tangy, tmp_path: Path) -> None:
    (tmp_path / "poems.csv").write_text("mine", encoding="utf-8")
    made = tangy("activity", "new", tmp_path, "--title", "Poems", "--kind", "talk", "--yes")
    assert made.returncode == 2
    assert "is there already" in made.stderr
    assert (tmp_path / "poems.csv").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    ("title", "name"),
    [
        ("Chair exercises: Rücken & arms", "chair-exercises-ruecken-arms"),
        ("Größe ÖL", "groesse-oel"), ("Café Señora", "cafe-senora"), ("u\u0308ben", "ueben"),
        ("Zoé's  quiz", "zoe-s-quiz"), ("\u82b1\u5b50 2", "2"), ("\u82b1\u5b50", ""),
    ],
)  # fmt: skip
def test_a_file_name_has_plain_letters(title: str, name: str) -> None:
    assert name_of(title) == name


@pytest.mark.parametrize(
    ("said", "kind"),
    [("exercise", "exercises"), ("Song", "songs"), ("ex", "exercises"), ("4", "exercises")],
)
def test_a_kind_is_known_by_its_beginning(said: str, kind: str) -> None:
    draft = Draft(Path(), examples())
    assert draft.answer("kind", said) is None
    assert draft.kind == kind


def drafted(tmp_path: Path, *answers: str) -> Draft:
    """Return a draft with these answers, in their order."""
    draft = Draft(tmp_path, examples())
    for said in answers:
        key = draft.open()
        assert key is not None
        assert draft.answer(key, said) is None
    return draft


def test_the_rounds_follow_the_table_unless_the_author_chose_them(tmp_path: Path) -> None:
    draft = drafted(tmp_path, "Moves", "exercises", "Nod", "Slowly", "6", "", "", "")
    assert draft.open() is None  # of one movement, one comes up
    draft.reopen("move.2")
    for said in ("Wave", "Gently", "five times", "Clap", "Softly", "", "", ""):
        draft.answer(draft.open() or "", said)
    assert (draft.open(), draft.said["rounds"], draft.said["times.2"]) == (None, "3", "five")
    draft.reopen("move.4")
    for said in ("Sway", "Gently", "", ""):
        draft.answer(draft.open() or "", said)
    assert (draft.open(), draft.said["rounds"]) == (None, "4")
    draft.reopen("rounds")
    draft.answer("rounds", "2")
    draft.reopen("move.5")
    for said in ("Bow", "Gently", "", ""):
        draft.answer(draft.open() or "", said)
    assert (draft.open(), draft.said["rounds"]) == (None, "2")


def test_how_many_times_is_a_number(tmp_path: Path) -> None:
    draft = drafted(tmp_path, "Moves", "exercises", "Nod", "Slowly")
    assert draft.answer("times.1", "Stamp your feet") == Problem("times")
    assert draft.answer("times.1", "twenty-five times") is None


def test_teams_get_as_many_questions_each_or_a_remark(tmp_path: Path) -> None:
    asked = ("Who?", "me", "you", "", "Why?", "so", "no", "", "When?", "now", "later", "", "")
    draft = drafted(tmp_path, "Ours", "quiz", "Reds, Blues", "", "", *asked)
    assert draft.default("rounds") == "2"
    draft.answer("rounds", "3")
    told = "2 teams cannot share 3 questions evenly: some get one more. Even: 2."
    assert told in "\n".join(draft_lines(draft))


def test_a_picture_can_be_named_by_its_whole_path(tmp_path: Path) -> None:
    make_picture(tmp_path / "rose.png")
    draft = drafted(tmp_path, "Ours", "quiz", "", "", "y", "Who?", "me", "you", "")
    assert draft.answer("picture.1", str(tmp_path / "rose.png")) is None
    assert draft.said["picture.1"] == "rose.png"


@pytest.mark.slow
@pytest.mark.parametrize("kind", [one for one in KINDS if one != "cards"])
def test_a_game_begins_and_ends_with_the_sentences_of_its_author(
    kind: str, tangy: Tangy, tmp_path: Path
) -> None:
    ends = ("--welcome", 'Hello, "dear" all!', "--goodbye", "See you soon.")
    made = tangy("activity", "new", tmp_path, "--title", "Ours", "--kind", kind, "--yes", *ends)
    assert (made.returncode, made.stderr) == (0, "")
    tried = tangy("activity", "try", tmp_path / "ours.toml").stdout
    said = [line for line in tried.splitlines() if "Tangy says: " in line]
    assert said[0] == '   Tangy says: Hello, "dear" all!'
    assert said[-1] == "   Tangy says: See you soon."


@pytest.mark.slow
def test_the_preview_goes_to_the_end_of_the_game(tangy: Tangy, tmp_path: Path) -> None:
    asked = tangy("activity", "new", tmp_path, stdin="Ours\nsongs\n" + "\n" * 4 + "n\n")
    assert "What does Tangy say to welcome people? [Welcome! Who feels" in asked.stdout
    assert "left out)" in asked.stdout
    assert "Tangy says: Goodbye, and keep humming!" in asked.stdout


ROWS_OF = {
    "quiz": ("", "", "", "Who?", "me", "you", "", "Why?", "so", "no", ""),
    "talk": ("poem", "", "One", "", "Two", ""),
    "songs": ("Row", "Row, row", "Sail", "Sail, sail"),
    "exercises": ("Nod", "Slowly", "", "Wave", "Slowly", ""),
    "memory": ("apples", "", "", "boats", "", ""),
}


def finish(draft: Draft) -> None:
    """Answer the open questions with Enter; a row that begins gets words."""
    while (key := draft.open()) is not None:
        assert draft.answer(key, "" if draft.default(key) is not None else "words") is None


@pytest.mark.parametrize(("first", "second"), list(permutations(KINDS, 2)))
def test_any_kind_can_be_changed_into_any_other(first: str, second: str, tmp_path: Path) -> None:
    offered = examples()
    said = {**offered.said, "talk": ENDS_OF_TEMPLATES, "game": ENDS_OF_TEMPLATES}
    draft = Draft(tmp_path, offered._replace(said=said))
    for answer in ("Ours", first, *ROWS_OF.get(first, ())):
        assert draft.answer(draft.open() or "", answer) is None
    finish(draft)
    (keys,) = [keys for label, keys in answers(draft) if label == "kind"]
    draft.reopen(*keys)
    for answer in (second, *ROWS_OF.get(second, ())):
        assert draft.answer(draft.open() or "", answer) is None
    finish(draft)
    toml, _ = built(draft)
    assert tomllib.loads(toml)["title"] == "Ours"
    assert draft_lines(draft)


def ends_of(draft: Draft) -> list[str]:
    """Return the welcome and goodbye of a draft without an open question."""
    finish(draft)
    return [draft.said["welcome"], draft.said["goodbye"]]


@pytest.mark.parametrize("late", [False, True])
def test_the_welcome_changes_with_the_title_and_kind_unless_the_author_wrote_it(
    late: bool, tmp_path: Path
) -> None:
    of_game = ("Welcome to {title}!", "That was {title}.")
    said_by = {"game": of_game, "songs": ("La!", "Oh!")}
    draft = Draft(tmp_path, examples()._replace(said=said_by))
    for said in ("Ours", "game", ""):
        draft.answer(draft.open() or "", said)
    draft.answer("welcome", "Come in!")
    assert ends_of(draft) == ["Come in!", "That was Ours."]
    draft.reopen("title", *(("welcome", "goodbye") if late else ()))
    draft.answer("title", "Theirs")
    assert ends_of(draft) == ["Come in!", "That was Theirs."]
    draft.reopen("kind", *(("goodbye",) if late else ()))
    draft.answer("kind", "songs")
    assert ends_of(draft) == ["Come in!", "Oh!"]
    draft.reopen("title")
    draft.answer("title", "Yours")
    assert draft.open() is None  # the usual sentences of songs do not name the title


def test_a_given_welcome_stays_if_the_title_changes(tmp_path: Path) -> None:
    draft = drafted(tmp_path, "Ours", "songs")
    draft.answer("welcome", str(draft.default("welcome")))
    draft.given.add("welcome")
    draft.reopen("kind")
    draft.answer("kind", "memory")
    assert draft.said["welcome"] == examples().said["songs"][0]


def test_an_empty_line_that_cannot_be_taken_names_the_way_back(
    tangy: Tangy, tmp_path: Path
) -> None:
    asked = tangy("activity", "new", tmp_path, stdin="Ours\n1\n\ny\n\nWhich?\n\n")
    assert "Please type an answer. Type back to return to the question before." in asked.stdout


def test_a_wrong_answer_that_was_typed_twice_is_offered_once() -> None:
    row = {"ask": "What is red?", "right": "rose", "wrong": "sky, sky, sea;, sea;"}
    (question,) = choice_questions([row])
    assert sorted(question.options) == ["rose", "sea;", "sky"]


@pytest.mark.parametrize(("quotes", "line"), [(True, 'a "b" c'), (False, "a “b” c")])
def test_a_line_loses_what_means_something_in_the_files(quotes: bool, line: str) -> None:
    assert kept('  a \\"b" {c}|', quotes=quotes) == line
