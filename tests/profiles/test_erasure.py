"""Erasing a person's name wherever it is used as a name, and nothing else."""

from __future__ import annotations

import json

import pytest

from tangy_profiles.erasure import NameEraser

ROSA = NameEraser(["Rosa"], "user2")


@pytest.mark.parametrize(
    ("name", "text", "erased"),
    [
        (
            "Rosa",
            "Go to Rosa, ROSA or rosa: Rosa's card",
            "Go to user2, user2 or user2: user2's card",
        ),
        (
            "Rosa",
            "Rosalind has a rosary and prosa; Rosa2",
            "Rosalind has a rosary and prosa; Rosa2",
        ),
        ("Anne-Marie", "go to anne marie", "go to user2"),
        ("Mary Ann", "Mary, Ann and Mary  Ann", "Mary, Ann and user2"),
        ("José", "go to jose, Jose\u0301 or JOSÉ", "go to user2, user2 or user2"),
        ("Élise Müller", "Elise Müller, Élise Muller, elise mueller", "user2, user2, user2"),
        ("Søren Weiß", "Soren Weiß, SÖREN Weiss, soeren weiss", "user2, SÖREN Weiss, user2"),
        ("O'Brien", "O&#x27;Brien, O\u2019Brien, obrien", "user2, user2, user2"),
        ("Zoë", '{"a": "Zo\\u00eb"} zo%C3%AB', '{"a": "user2"} user2'),
        ("田中", "田中さん", "user2さん"),
        ("Mr. X", "ask Mr. X. Mr. Xu stays", "ask user2. Mr. Xu stays"),
    ],
)
def test_a_name_is_erased_in_any_spelling_as_a_whole_word(
    name: str, text: str, erased: str
) -> None:
    assert NameEraser([name], "user2").text(text) == erased


def test_ordinary_words_and_phrases_of_the_activity_are_kept() -> None:
    mark = NameEraser(["Mark"], "user2", but=["mark numbers", "mark", "Mark Lee"])
    told = mark.text("Tangy went to Mark to mark a card; Mark Lee won.")
    assert told == "Tangy went to user2 to mark a card; Mark Lee won."
    assert mark.typed("mark numbers please, then go to mark") == (
        "mark numbers please, then go to user2"
    )


def test_a_spoken_form_is_erased_only_in_commands() -> None:
    mark = NameEraser(["Mark"], "user2", said=["mark"])
    assert mark.text("Mark has to mark a card") == "user2 has to mark a card"
    assert mark.typed("go to mark") == "go to user2"
    letter = NameEraser(["C++"], "user2", said=["c"])
    assert (
        letter.text("C++ and c, C") == "C++ and c, C"
        and letter.page("<b>C++</b>") == "<b>user2</b>"
    )


def test_erasing_a_body_changes_only_texts() -> None:
    body = {"behaviour": "rosa", "teacher": "Rosa", "heard": "go to rosa", "advice": ["ask Rosa"]}
    assert ROSA.body("demonstration step", body) == {
        "behaviour": "rosa",
        "teacher": "Rosa",
        "heard": "go to user2",
        "advice": ["ask user2"],
    }
    other = {"game": "rosa", "note": {"asked": ["Was Rosa well?"]}}
    assert ROSA.body("game begun", other) == {
        "game": "rosa",
        "note": {"asked": ["Was user2 well?"]},
    }
    told = {"console": "Help: ask Help.", "why": "Help is there", "recovery": "help"}
    assert NameEraser(["HELP"], "user2").body("fault", told) == told
    chosen = {"what": "delete"}
    assert NameEraser(["Delete"], "user2").body("demonstrations edited", chosen) == chosen


@pytest.mark.parametrize(
    ("kind", "body", "key", "after"),
    [
        ("staff action", {"did": "told"}, "detail", "user2 sang it"),
        ("staff action", {"did": "heard"}, "detail", "user2 sang it"),
        ("staff action", {"did": "noted"}, "detail", "user2 sang it"),
        ("staff action", {"did": "patterns"}, "detail", "Rosa sang it"),
        ("staff action", {"did": "told"}, "person", "Rosa sang it"),
        ("answer not clear", {}, "said", "user2 sang it"),
        ("answer not clear", {}, "fact", "Rosa sang it"),
        ("game ended", {}, "stopped", "user2 sang it"),
        ("void", {}, "why", "user2 sang it"),
        ("taken back", {}, "what", "Rosa sang it"),
        ("fault", {}, "console", "user2 sang it"),
        ("demonstration step", {}, "heard", "user2 sang it"),
        ("of another version", {}, "anything", "user2 sang it"),
        ("own phrase", {"teacher": "Ada"}, "text", "user2 sang it"),
        ("own phrase", {"text": "let us sing"}, "behaviour", "Rosa sang it"),
    ],
)
def test_a_name_is_erased_where_people_spoke_or_wrote(
    kind: str, body: dict[str, str], key: str, after: str
) -> None:
    assert ROSA.body(kind, {**body, key: "Rosa sang it"}) == {**body, key: after}


@pytest.mark.parametrize(
    ("text", "after"),
    [
        ("rosa shall sing", "user2 shall sing"),
        ("frau weber's turn", "frau user2's turn"),
        ("let rosa weber begin", "let user2 begin"),
        ("may we begin", "may we begin"),
        ("the weber march", "the weber march"),
        ("roast it", "roast it"),
    ],
)
def test_a_teachers_own_phrase_loses_each_part_of_the_name_but_common_words(
    text: str, after: str
) -> None:
    eraser = NameEraser(["Rosa May Weber", "Rosa Weber"], "user2", but=["the weber march"])
    body = {"activity": "bingo", "teacher": "Rosa", "text": text, "behaviour": "greeting"}
    assert eraser.body("own phrase", body) == {**body, "text": after}
    stored = json.dumps(body, separators=(",", ":"))
    data = eraser.overwrite(f"\x00{stored}\x07".encode())
    assert len(data) == len(stored) + 2 and data.startswith(b'\x00{"activity":"bingo","teacher"')
    assert (text in data.decode()) is (text == after)
    assert not any(name in data.split(b'"text"')[1] for name in (b"rosa", b"frau weber"))


def test_a_name_that_stays_as_that_of_staff_is_counted() -> None:
    for key in ("teacher", "by", "who"):
        assert ROSA.is_left({key: "Rosa"}) and not ROSA.is_left({key: "Ada"})
    assert not ROSA.is_left({"heard": "go to rosa", "by": 7})


def test_a_misspelt_name_in_a_command_is_erased() -> None:
    eraser = NameEraser(["Rosa Weber"], "user2", commands={"go", "to", "please"})
    for heard in ("Go to rsoa", "go to Frau Wbeer please", "go to roza 2", "go to réosa"):
        body = {"behaviour": "go", "target": "user2", "heard": heard}
        after = eraser.body("demonstration step", body)["heard"]
        assert set(after.casefold().split()) <= {"go", "to", "please", "user2", "2"}
        other = {**body, "target": "user1"}
        assert eraser.body("demonstration step", other) == other


def test_erasing_a_page_changes_only_visible_text() -> None:
    page = '<style>.rosa{}</style><p class="rosa" title="Rosa">to rosa</p><rosa>'
    assert ROSA.page(page) == (
        '<style>.rosa{}</style><p class="rosa" title="user2">to user2</p><rosa>'
    )


def test_erasing_bytes_keeps_their_length() -> None:
    data = b"\x00\x12user2Rosa\x05\x00" + json.dumps({"heard": "go to rosa"}).encode() + b"rosary"
    after = ROSA.overwrite(data)
    assert len(after) == len(data) and b"user2----" in after and b"go to ----" in after
    assert after.endswith(b"rosary")


def test_bytes_of_a_phrase_of_the_activity_are_kept() -> None:
    number = NameEraser(["Number"], "user2", but=["call number"])
    assert number.overwrite(b'\x00"call number" number') == b'\x00"call number" ------'
