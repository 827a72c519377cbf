"""The documents of both scenarios have their agreed keys, and self-contained pages."""

from __future__ import annotations

import re
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from tangy_profiles.persuading import known_methods
from tangy_tui.experiments import figures, published
from tangy_tui.experiments.figures import INKS
from tangy_tui.experiments.report import report
from tangy_tui.text.comparison import compare, of_all
from tangy_tui.text.numbers import counted, percent
from tests.experiments.conftest import Ran, run

pytestmark = pytest.mark.xdist_group("scenarios")


def share(value: Any) -> bool:
    return isinstance(value, int | float) and 0 <= value <= 1


def test_the_document_has_its_agreed_keys(ran: Ran) -> None:
    document = ran.document
    if document["experiment"] == 1:
        assert document["seeds"] == 1
        assert share(document["guided"]["exact_after_one"])
        assert list(document["random"]["exact_within"]) == ["1", "2", "3", "4"]
        assert all(share(value) for value in document["random"]["exact_within"].values())
        assert 20 < document["behaviours_per_demonstration"] < 150
        teachers = document["teachers"]
        assert (teachers["count"], teachers["identical"]) == (5, True)
        assert len(teachers["each"]) == 5
        rows = teachers["with_mistakes"]
        assert {row["placed"] for row in rows} == {"anywhere", "commonest", "rarest"}
        assert {row["rate"] for row in rows} == {0, 0.01, 0.02, 0.03, 0.05}
        assert document["minutes_to_teach"] is document["typing"] is None
        assert document["paper"] == dict(published.SCENARIO_ONE)
        return
    assert [set(user) for user in document["users"]] == [
        {"name", "best", "optimal_share", "one_run"}
    ] * 4
    assert all(share(value) for user in document["users"] for value in user["optimal_share"])
    assert {"mean", "sd"} <= set(document["suboptimal_before_convergence"])
    assert document["interactions_per_user_game"] > 0
    assert {"thompson", "bayes_ucb"} <= set(document["algorithms"])
    assert {row["method"] for row in document["algorithms"].values()} == set(known_methods())
    for row in document["algorithms"].values():
        assert list(row["regret"]) == ["23", "60", "300"]
        assert share(row["optimal_share"])
    assert document["paper"] == dict(published.SCENARIO_TWO)


def test_a_document_records_its_versions_and_settings(ran: Ran) -> None:
    assert {"python", "tangy", "numpy", "scikit-learn"} <= set(ran.document["versions"])
    assert re.fullmatch("[0-9a-f]{64}", ran.document["code"])
    assert ran.document["settings"]["activity"] == "Bingo"


@pytest.mark.slow
def test_the_results_are_printed_in_words(ran: Ran) -> None:
    done = run(*ran.words)
    assert (done.returncode, done.stderr) == (0, "")
    rows = compare(ran.document)
    for row in rows:
        assert (
            f"{row.what} ({row.source})\n  paper: {row.paper}\n  here:  {row.here}\n"
            f"  {row.words}\n" in done.stdout
        )


def test_a_page_is_well_formed_and_self_contained(ran: Ran) -> None:
    page = ran.page
    root = ElementTree.fromstring(page.partition("\n")[2])  # noqa: S314 - our own page
    assert root.tag == "html"
    assert len(root.findall(".//svg")) == (2 if ran.document["experiment"] == 1 else 3)
    assert not re.search(r"https?:|src=|@import|url\((?!#)|<link|<script", page)
    for element in root.iter():
        for name, value in element.attrib.items():
            assert name != "href" or value.startswith("#")
    ids = Counter(element.get("id") for element in root.iter() if element.get("id"))
    assert max(ids.values()) == 1
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', page))
    assert used <= set(ids)
    parser = HTMLParser()
    parser.feed(page)
    parser.close()


def test_a_page_contains_no_local_path(ran: Ran) -> None:
    for place in (ran.folder, Path.home(), Path.cwd(), Path("/tmp")):  # noqa: S108
        assert str(place) not in ran.page


def test_figures_take_the_colours_of_the_page(ran: Ran) -> None:
    for svg in re.findall(r"<svg.*?</svg>", ran.page, flags=re.DOTALL):
        assert not set(re.findall(r"#[0-9a-f]{6}\b", svg)) & set(INKS)
        assert "var(--ink)" in svg
        assert "#ffffff" not in svg


def test_the_page_shows_the_papers_figures_and_the_versions(ran: Ran) -> None:
    text = "".join(ElementTree.fromstring(ran.page.partition("\n")[2]).itertext())  # noqa: S314
    for row in compare(ran.document):
        for words in (row.what, row.paper, row.here, row.words):
            assert words in text
    for name, version in ran.document["versions"].items():
        assert name in text and version in text


@pytest.mark.slow
def test_a_page_depends_only_on_its_document(ran: Ran) -> None:
    assert report(ran.document) == ran.page


def test_percentages_are_formatted_for_readers() -> None:
    written = {0.02899: "2.9%", 0.9235: "92.3%", 0.2: "20%", 1: "100%", 0: "0%"}
    written |= {0.9996: ">99.9%", 0.0004: "<0.1%", 0.9989: "99.9%"}
    assert {share: percent(share) for share in written} == written
    assert percent(None) == "\N{EN DASH}"
    assert (of_all(1.0, 1), of_all(0.4, 5)) == ("1 of 1", "2 of 5")
    assert of_all(0.95, 20) == "19 of 20 (95%)"
    assert (counted(1, "sequence"), counted(2000, "game")) == ("1 sequence", "2,000 games")


def test_small_samples_are_given_as_counts(ran: Ran) -> None:
    if ran.document["experiment"] == 1:
        policies = compare(ran.document)[3].here
        assert policies.startswith("groups of 5 in which all are the same: 1 of 1; after exactly 3")
        assert "%" not in policies
        assert re.search(r"Before conflicts are settled [\d.]+% of the right dec", ran.page)
        assert "1 sequence of games" in ran.page
    else:
        for crowd in ("algorithms", "uneven", "drifting"):
            assert ran.document[crowd]
        assert ran.page.count("optimal in 101 to 200</th>") == 3, "tables that are alike"
        told = re.findall(r"begins from earlier people: Thompson .*?; Bayes-UCB .*?<", ran.page)
        assert len(told) == 3, "what is gained is said of each method by its name"


def test_only_predictions_are_said_to_agree(ran: Ran) -> None:
    rows = compare(ran.document)
    assert {row.source for row in rows} > {"predicted", "fitted"}
    assert all(row.source == "predicted" for row in rows if "gree" in row.words)
    for row in rows:
        assert f">{row.source}</td>" in ran.page


def test_the_chosen_settings_are_shown_beside_alternatives(ran: Ran) -> None:
    if ran.document["experiment"] == 2:
        choices = ran.document["other_choices"]
        (used,) = (one for one in choices if one["used"])
        assert (used["preferred"], used["other"]) == (0.9, 0.4)
        others = sorted(one["mean"] for one in choices if not one["used"])
        first, *_ = compare(ran.document)
        assert first.source == "chosen"
        assert f"{others[0]:.1f} to {others[-1]:.1f}" in first.words
        assert ran.page.count("chosen here") == 1


@pytest.mark.slow
def test_identical_curves_stay_visible(ran: Ran) -> None:
    if ran.document["experiment"] == 1:
        drawing = figures.mistakes(ran.document["teachers"]["with_mistakes"])
        assert drawing.count("stroke-width: 4") == 3 + 1, (
            "a broad line in each panel and the legend"
        )


def test_the_words_follow_the_numbers(ran: Ran) -> None:
    if ran.document["experiment"] == 1:
        near = {**ran.document, "behaviours": {"mean": 61.0, "se": 1.0, "n": 9, "all": []}}
        far = {**near, "behaviours": {**near["behaviours"], "mean": 50.0}}
        assert compare(near)[2].words.startswith("Within two standard errors.")
        assert compare(far)[2].words.startswith("Lower by 12.")
    else:
        four = {"mean": 10.0, "sd": 3.0, "n": 9}
        far = {
            **ran.document,
            "four_users": four,
            "suboptimal_before_convergence": {
                "mean": 20.0, "sd": 5.0, "se": 1.0, "n": 25, "never": 2,
                "converged_means_in_a_row": 10,
            },
        }  # fmt: skip
        row = compare(far)[0]
        assert row.words.startswith("Higher by 9.2")
        assert "2 never converged" in row.here
        flat = [{**user, "optimal_share": [0.5] * 8} for user in ran.document["users"]]
        assert compare({**far, "users": flat})[2].words.startswith("Does not rise for User 1, ")
