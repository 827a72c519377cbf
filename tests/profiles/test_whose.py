"""Selecting the person of a fact: the first for whom it holds, in stages and behaviours."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tangy_profiles.codec import decode, encode
from tangy_profiles.declared.activity import DeclaredActivity, read_declared
from tangy_profiles.declared.checking import findings
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.memory import GameMemory, game_from, memory_of
from tangy_profiles.declared.source import MistakesError
from tangy_profiles.declared.state_keys import state_key
from tangy_tui.text.activities import selector_words

BUZZ = Path(__file__).parent.parent / "support" / "activities" / "buzz.toml"
PLAYERS = ("ann", "ben", "cat")
RIGHT, WRONG = "whose guess is right", "whose guess is wrong"


@pytest.fixture(scope="module")
def activity() -> DeclaredActivity:
    return read_declared(BUZZ)


@pytest.fixture
def game(activity: DeclaredActivity) -> DeclaredGame:
    game = DeclaredGame(activity.declaration, PLAYERS)
    game.execute("welcome all", None)
    game.execute("ask all", None)
    return game


def test_the_selector_means_the_first_of_several_people(game: DeclaredGame) -> None:
    assert game.whom(RIGHT) is None
    for one, said in (("cat", "a dog"), ("ann", "dogs"), ("ben", "a fish")):
        game.observe("guess", one, said)
    assert (game.whom(RIGHT), game.whom(WRONG)) == ("cat", "ben")
    stage, about = game.stage()
    assert (stage.name, about) == ("right", "cat")
    assert ("whose guess is right", "cat") in joint_state(game).whom
    game.observe(
        "guess", "cat", "a fish"
    )  # a person who changes the answer goes to the end of the order
    assert (game.whom(RIGHT), game.whom(WRONG)) == ("ann", "ben")
    game.observe("here", "ann", "no")
    assert game.whom(RIGHT) is None


def test_the_first_person_is_stored_and_part_of_the_state(game: DeclaredGame) -> None:
    other = game.copy()
    for one in ("cat", "ann"):
        game.observe("guess", one, "a dog")
    for one in ("ann", "cat"):
        other.observe("guess", one, "a dog")
    assert state_key(game) != state_key(other)
    logged = decode(GameMemory, encode(memory_of(game)))
    again = game_from(game.declaration, PLAYERS, logged)
    assert again is not None and again.whom(RIGHT) == "cat"


@pytest.mark.slow
def test_games_with_the_selector_are_searched_completely(activity: DeclaredActivity) -> None:
    found = findings(activity)
    assert found.flaws == () and not any(one.cut for one in found.searches)


@pytest.mark.parametrize(
    ("written_as", "told"),
    [
        ("whose guess is rihgt", "'rihgt' is not a value of 'guess'; did you mean 'right'?"),
        ("whose gess is right", "'gess' is not a fact; did you mean 'guess'?"),
        ("whose trun", "'whose trun' is not known; did you mean 'whose turn'?"),
        ("whose open is yes", "'open' must be a fact of each player"),
        ("whose any guess is right", "'guess' must be a fact of each player"),
        ("whose guess right", "'whose guess right' is not known; write whose FACT is VALUE."),
    ],
)
@pytest.mark.parametrize("key", ["about", "to", "expected"])
def test_a_mistake_in_the_selector_is_reported_with_its_place(
    tmp_path: Path, key: str, written_as: str, told: str
) -> None:
    shutil.copy(BUZZ.with_suffix(".csv"), tmp_path)
    places = {"about": f'about = "{RIGHT}"', "to": f'to = ["{RIGHT}"', "expected": f"-> {RIGHT}"}
    text = BUZZ.read_text(encoding="utf-8")
    assert text.count(places[key]) == 1
    file = tmp_path / "buzz.toml"
    file.write_text(text.replace(places[key], places[key].replace(RIGHT, written_as)))
    with pytest.raises(MistakesError) as found:
        read_declared(file)
    (line,) = (one for one in found.value.lines if told in one)
    number = int(line.split(":")[1])
    assert written_as in file.read_text(encoding="utf-8").splitlines()[number - 1]


def test_the_selector_has_words() -> None:
    assert selector_words(RIGHT) == "the person whose guess is right"


def test_a_stage_about_a_selected_person_sees_only_the_selected_value(tmp_path: Path) -> None:
    shutil.copy(BUZZ.with_suffix(".csv"), tmp_path)
    text = BUZZ.read_text(encoding="utf-8")
    about = 'about = "whose guess is right"'
    other = text.replace(f"{about} }}", f'{about}, sees = ["guess"] }}')
    other = other.replace(
        'about = "whose guess is wrong" }', 'about = "whose guess is not right", sees = ["guess"] }'
    )
    (tmp_path / "buzz.toml").write_text(other, encoding="utf-8")
    found = read_declared(tmp_path / "buzz.toml").situations
    seen = {stage: [one.user_state for one in found if one.stage == stage] for stage, *_ in found}
    assert seen["right"] == ["guess is right"]
    assert len(seen["wrong"]) == 3  # three states, as perhaps nobody is meant
