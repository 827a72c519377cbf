"""Claims in staff's own words."""

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import read_command
from tangy_tui.app.game_commands import ClaimCard, GameCommand
from tangy_tui.app.typed_line import Several, read_typed

BINGO = load_activity("bingo")
IDS = {"rosa": "user2", "emil": "user3", "karl": "user4", "ada de vries": "user5"}


def find(wanted: str) -> str:
    if wanted.casefold() not in IDS:
        raise TangyError(f"There is nobody called {wanted!r}.")
    return IDS[wanted.casefold()]


def read(text: str) -> GameCommand | None:
    return read_command(text, find, {"bingo"}, BINGO.rules)


@pytest.mark.parametrize(
    ("text", "claim"),
    [
        ("Emil says he has bingo", ClaimCard(0, "user3")),
        ("Emil says that he's got bingo now", ClaimCard(0, "user3")),
        ("Karl says he's got a line", ClaimCard(0, "user4")),
        ("Karl has got two lines!", ClaimCard(0, "user4")),
        ("I think Rosa has a bingo", ClaimCard(0, "user2")),
        ("rosa shouted bingo at table 3", ClaimCard(0, "user2")),
        ("Rosa is shouting bingo", ClaimCard(0, "user2")),
        ("Emil's got bingo", ClaimCard(0, "user3")),
        ("Ada de Vries has the full card", ClaimCard(0, "user5")),
        ("Rosa's card has bingo", ClaimCard(0, "user2")),
        ("Rosa has bingo on card 187", ClaimCard(187, "user2")),
        ("Rosa with card 187 has bingo", ClaimCard(187, "user2")),
        ("card 187 has bingo", ClaimCard(187)),
        ("187 has a line", ClaimCard(187)),
        ("card number 187 wins", ClaimCard(187)),
        ("somebody has bingo with card 187", ClaimCard(187)),
        ("bingo for Emil", ClaimCard(0, "user3")),
        ("bingo card 187", ClaimCard(187)),
        ("check card number 187 for Rosa", ClaimCard(187, "user2")),
        ("check Rosa's card", ClaimCard(0, "user2")),
        ("bingo Rosa 187", ClaimCard(187, "user2")),
    ],
)
def test_a_sentence_about_the_activitys_win_is_a_claim(text: str, claim: ClaimCard) -> None:
    assert read(text) == claim


@pytest.mark.parametrize(
    "text",
    [
        *("somebody shouted bingo at table 3", "bingo at table 3", "there is a bingo at table 3"),
        *("someone has a line", "the lady at table 2 says she has bingo", "we have a bingo"),
        *("there's another bingo", "she has bingo", "bingo for somebody at the back"),
    ],
)
def test_a_claim_of_nobody_in_particular_asks_for_the_card(text: str) -> None:
    with pytest.raises(TangyError, match=r"Whose card is it\? Type bingo and the number of"):
        read(text)


def test_a_claim_of_a_name_that_nobody_has_tells_so() -> None:
    with pytest.raises(TangyError, match="nobody called 'Greta'"):
        read("Greta has bingo")


@pytest.mark.parametrize(
    "text",
    [
        *("who has bingo", "has Rosa got bingo", "it was a mistake, no bingo", "nobody has bingo"),
        *("Rosa does not have bingo", "Emil hasn't got a line", "if somebody has bingo"),
        *("Rosa has a cold", "Karl says he has a headache"),
    ],
)
def test_what_claims_no_win_is_no_claim(text: str) -> None:
    assert not isinstance(read(text), ClaimCard)


@pytest.mark.parametrize(
    ("text", "claims"),
    [
        ("bingo 71 and 38", (ClaimCard(71), ClaimCard(38))),
        ("bingo 71, 38 and Rosa", (ClaimCard(71), ClaimCard(38), ClaimCard(0, "user2"))),
        ("bingo 71 and bingo 38", (ClaimCard(71), ClaimCard(38))),
        ("Rosa and Karl both have bingo", (ClaimCard(0, "user2"), ClaimCard(0, "user4"))),
        ("cards 71 and 38 have bingo", (ClaimCard(71), ClaimCard(38))),
    ],
)
def test_a_line_claims_for_several(text: str, claims: tuple[ClaimCard, ...]) -> None:
    assert read_typed(text, read, find, lambda _: True) == Several(claims)
