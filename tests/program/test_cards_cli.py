"""`tangy cards`: the same cards for a number and a seed, on paper, as pictures and as a list."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import cv2
import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.card_face import HEIGHT, TAGS, WIDTH, CardLayout, numbers_of
from tangy_tui.pages.card_sheets import card_sheets

Tangy = Callable[..., CompletedProcess[str]]


def test_pictures_and_their_list_match_the_list_of_cards(tangy: Tangy, tmp_path: Path) -> None:
    done = tangy("cards", "print", "--first", 17, "--count", 2, "--png", tmp_path, "--dpi", 60)
    assert done.returncode == 0, done.stderr
    listed = json.loads(tangy("cards", "list", "--first", 17, "--count", 2, "--json").stdout)
    written = json.loads((tmp_path / "cards.json").read_text())["cards"]
    assert [(c["id"], c["numbers"]) for c in written] == [
        (c["id"], c["numbers"]) for c in listed["cards"]
    ]
    scale = 60 / 25.4
    for card in written:
        picture = cv2.imread(str(tmp_path / card["file"]), cv2.IMREAD_GRAYSCALE)
        assert picture is not None
        assert picture.shape == (round(HEIGHT * scale), round(WIDTH * scale))
        left, top, right, bottom = card["grid"]
        assert picture[round(top + 5) : round(bottom - 5), round(left)].max() < 128  # its line
        assert 0 < left < right < picture.shape[1] and 0 < top < bottom < picture.shape[0]


def test_the_four_tags_of_a_picture_encode_its_card(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 249, "--count", 1, "--png", tmp_path, "--dpi", 60)
    picture = cv2.imread(str(tmp_path / "card-249.png"), cv2.IMREAD_GRAYSCALE)
    assert picture is not None
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_1000))
    corners, ids, _ = detector.detectMarkers(picture)
    found = {int(tag): corner[0] for tag, corner in zip(ids.ravel(), corners, strict=True)}
    assert set(found) >= {996, 997, 998, 999}  # digits in a cell can look like a tag
    for tag, place in zip((996, 997, 998, 999), TAGS, strict=True):
        assert abs(found[tag][0] / (60 / 25.4) - (place.left, place.top)).max() < 0.6  # mm


def test_a_deck_is_determined_by_its_seed(activity: Activity, lanterns: Activity) -> None:
    assert numbers_of(activity.deck, 3) == numbers_of(activity.deck, 3, 1)
    assert numbers_of(activity.deck, 3, 2) != numbers_of(activity.deck, 3, 1)
    assert len({numbers_of(activity.deck, card) for card in range(1, 250)}) == 249
    assert numbers_of(activity.deck, 1) == (
        *(2, 30, 42, 52, 67, 11, 22, 39, 59, 61, 8, 28, 37, 49, 71),
        *(10, 16, 44, 53, 65, 15, 19, 45, 50, 73),
    )  # people have printed cards, so they must not change
    assert CardLayout(lanterns.deck).grid.right <= WIDTH


@pytest.mark.slow
@pytest.mark.parametrize(("paper", "sheets"), [("a4", 3), ("letter", 3), ("a5", 4)])
def test_card_sheets_are_reproducible(
    paper: str, sheets: int, lanterns: Activity, activity: Activity
) -> None:
    for played in (lanterns, activity):
        made = card_sheets(played, range(5, 8), 9, paper)
        assert made == card_sheets(played, range(5, 8), 9, paper)
        assert made.startswith(b"%PDF-") and made.count(b"/Type /Page\n") == sheets


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["print"], "--pdf FILE"),
        (["print", "--pdf", "/nowhere/at/all.pdf"], "cannot be written"),
        (["print", "--pdf", "x.pdf", "--paper", "leter"], "letter"),
        (["list", "--first", "240", "--count", "20"], "249 cards"),
        (["print", "--count", "0"], "--count"),
    ],
)
def test_an_impossible_print_is_refused_in_one_sentence(
    arguments: list[str], says: str, tangy: Tangy
) -> None:
    done = tangy("cards", *arguments)
    assert done.returncode == 2 and not done.stdout
    assert says in done.stderr and done.stderr.count("\n") == 1
