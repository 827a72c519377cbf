"""Names are compared as people read them."""

from __future__ import annotations

import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.person import folded


@given(st.text(max_size=20))
def test_names_are_equal_in_any_unicode_normal_form(name: str) -> None:
    assert folded(unicodedata.normalize("NFD", name)) == folded(unicodedata.normalize("NFC", name))


@given(st.text(max_size=20))
def test_folding_is_idempotent(name: str) -> None:
    assert folded(folded(name)) == folded(name)


def test_case_and_outer_spaces_are_ignored_but_accents_count() -> None:
    assert folded(" ZOÉ") == folded("Zoe\N{COMBINING ACUTE ACCENT}") == "zoé"
    assert folded("Zoe") != folded("Zoé")
