"""The keymap: one meaning for each key, a word for each action, and custom keys."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tangy_profiles.errors import ProfileError
from tangy_tui.app.keymap import ACTIONS, BY_ID, Keymap, is_letter
from tangy_tui.app.user_settings import read_settings
from tangy_tui.text import conflicts, demonstrations, phrases, policies, sensors
from tangy_tui.text.keys import NAMES, with_keys


def keys_of(tmp_path: Path, written: str) -> Keymap:
    (tmp_path / "settings.toml").write_text(f"[keys]\n{written}\n")
    return read_settings(tmp_path).keymap


def test_no_key_has_two_meanings() -> None:
    keys = Counter(key for action in ACTIONS for key in action.keys)
    assert [key for key, count in keys.items() if count > 1] == []


def test_every_changeable_action_has_a_unique_word() -> None:
    assert set(NAMES) == set(BY_ID)
    words = Counter(action.word for action in ACTIONS if action.word)
    assert [word for word, count in words.items() if count > 1] == []
    assert [action.id for action in ACTIONS if not action.fixed and not action.word] == []


def test_actions_during_typing_have_a_key_that_is_no_letter() -> None:
    typing = [action for action in ACTIONS if action.with_line]
    assert [a.id for a in typing if all(is_letter(key) for key in a.keys)] == []


@pytest.mark.parametrize(
    ("written", "id", "keys"),
    [
        ('undo = "f12"', "undo", ("f12",)),
        ('undo = ["F12", "ctrl+b"]', "undo", ("f12", "ctrl+b")),
        ('pause = ";"', "pause", ("semicolon",)),
        ('drive = "p"\npause = "d"', "drive", ("p",)),
        ('stop = "f12"', "stop", ("ctrl+x", "f12")),
        ('seen = "z"', "acknowledge", ("z",)),
    ],
)
def test_a_user_can_change_keys(
    tmp_path: Path, written: str, id: str, keys: tuple[str, ...]
) -> None:
    keymap = keys_of(tmp_path, written)
    assert keymap.keys(id) == keys
    assert all(keymap.action(key) == id for key in keys)


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ('undoo = "f12"', r"keys\.undoo.*undo"),
        ('undo = "f13"', r"keys\.undo.* 'f13' is no key"),
        ('undo = "u"', r"keys\.undo.* works while you type"),
        ('undo = "f5"', r"keys\.undo.* is the key of learn"),
        ('undo = "ctrl+w"', r"keys\.undo.* edits"),
        ('yes = "n"', r"keys\.yes.* is no action"),
        ("undo = 2", r"keys\.undo"),
        ('pause = "d"', r"keys\.pause.* is the key of drive"),
    ],
)
def test_a_mistake_is_reported_in_one_sentence_with_its_place(
    tmp_path: Path, written: str, told: str
) -> None:
    with pytest.raises(ProfileError, match=told):
        keys_of(tmp_path, written)


def test_texts_name_custom_keys(tmp_path: Path) -> None:
    keymap = keys_of(tmp_path, 'undo = "f12"')
    assert with_keys("{undo} takes it back, {redo} not; {other}", keymap) == (
        "f12 takes it back, f3 not; {other}"
    )


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        (conflicts.keys_words("learn"), ["undo"]),
        (demonstrations.MARK_FIRST, ["mark", "merge"]),
        (demonstrations.NOTHING_LOST, ["undo"]),
        (demonstrations.changed_words("Deleted."), ["undo"]),
        (phrases.LIST_HELP, ["filter", "hear", "pronounce"]),
        (policies.ALL_THE_SAME, ["differences"]),
        (sensors.look_words("camera"), ["camera"]),
    ],
)
def test_lists_and_pictures_name_the_current_key(text: str, ids: list[str]) -> None:
    set_by_user = {id: (f"f1{number}",) for number, id in enumerate(ids)}
    told = with_keys(text, Keymap(set_by_user))
    assert [key for (key,) in set_by_user.values() if key in told] == [
        f"f1{n}" for n in range(len(ids))
    ]
