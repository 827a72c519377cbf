"""The policies and teachers to look at and compare."""

from __future__ import annotations

from tangy_profiles.activity import Activity
from tangy_profiles.store import Store
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import stored_policies
from tangy_tui.text.numbers import counted
from tangy_tui.ui.dialogs.choose import Option

DIGEST_SHOWN = 8
"""The digits shown of a digest: enough to distinguish policies."""


def policy_options(store: Store, activity: Activity) -> list[Option]:
    """Return every stored policy once, the latest first."""
    found: dict[str, Option] = {}
    for kept in reversed(stored_policies(store, activity.name)):
        digest = kept.digest
        shown = counted(len(kept.demonstrations), "demonstration")
        when = kept.at[:16].replace("T", " ")
        note = f"{digest[:DIGEST_SHOWN]}  {shown}  {when}"
        found.setdefault(digest, Option(digest, kept.name, note))
    return list(found.values())


def comparison_options(store: Store, activity: Activity) -> list[Option]:
    """Return what can be compared: stored policies, and the demonstrations of each teacher."""
    options = [
        Option(f"policy:{option.id}", option.name, option.note)
        for option in policy_options(store, activity)
    ]
    given: dict[str, int] = {}
    for shown in read_library(store, activity.name).finished:
        given[shown.teacher] = given.get(shown.teacher, 0) + 1
    options += [
        Option(f"teacher:{teacher}", teacher, _taught_words(times))
        for teacher, times in given.items()
    ]
    return options


def _taught_words(times: int) -> str:
    return f"what {counted(times, 'demonstration')} {'teaches' if times == 1 else 'teach'}"
