"""Names are compared as people read them."""

from __future__ import annotations

import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.person import folded


@given(st.text(max_size=20))
def test_a_name_is_the_same_however_its_accents_are_written(name: str) -> None:
    assert folded(unicodedata.normalize("NFD", name)) == folded(unicodedata.normalize("NFC", name))


@given(st.text(max_size=20))
def test_what_is_folded_stays_as_it_is(name: str) -> None:
    assert folded(folded(name)) == folded(name)


def test_letters_and_spaces_round_a_name_do_not_matter_and_accents_do() -> None:
    assert folded(" ZOÉ") == folded("Zoe\N{COMBINING ACUTE ACCENT}") == "zoé"
    assert folded("Zoe") != folded("Zoé")
