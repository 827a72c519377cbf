"""The learnt model of sentences that stop the robot without a verb of stopping."""

from __future__ import annotations

import json
from importlib.resources import files

import pytest

from tangy_tui.language.stop_likelihood import MODEL, stop_likelihood
from tangy_tui.language.stop_phrases import stop_sets, stop_texts
from tangy_tui.language.stop_sentence import stops
from tests.bench.stop_training import digest_of, stop_examples


@pytest.mark.parametrize(
    "said",
    [
        "that'll do now",
        "don't you come any closer",
        "get away from my foot",
        "please keep away from me",
    ],
)
def test_everyday_sentences_without_a_stop_verb_stop(said: str) -> None:
    assert stops(said)


@pytest.mark.parametrize(
    "said",
    [
        "that'll do for the sugar",
        "come a bit closer",
        "get away for the weekend",
        "hold on i have that one",
        "undo that",
        "call the next number",
    ],
)
def test_similar_sentences_do_not_stop(said: str) -> None:
    assert not stops(said)


@pytest.mark.parametrize("said", ["do not stop", "no do not stop", "please do not stop the game"])
def test_a_negation_in_full_is_as_unlikely_as_its_short_form(said: str) -> None:
    assert stop_likelihood(tuple(said.split())) < 0.2


def test_an_unknown_sentence_has_a_moderate_likelihood() -> None:
    assert 0 < stop_likelihood(("zyxt", "qwv")) < 0.6


def test_an_excluded_set_is_not_in_the_training_texts() -> None:
    own = set(stop_sets()["everyday"]["stops"])
    assert own <= set(stop_texts())
    assert not {"let's call it a day tangy", "brakes tangy brakes"} & set(stop_texts("everyday"))


@pytest.mark.slow
def test_the_shipped_model_matches_the_current_sentences() -> None:
    kept = json.loads(files("tangy_tui.language").joinpath(MODEL).read_text(encoding="utf-8"))
    assert kept["made_of"] == digest_of(stop_examples())
