"""`tangy activity phrases` lists a teacher's own phrases, and removes them."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from subprocess import CompletedProcess

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.own_phrases import OwnPhrases

Tangy = Callable[..., CompletedProcess[str]]
WORDS = "let it all begin"


def test_own_phrases_are_listed_and_can_be_removed(tangy: Tangy, tmp_path: Path) -> None:
    with closing(Workspace(tmp_path)) as workspace:
        own = OwnPhrases(workspace.store, workspace.activity, workspace.teacher)
        own.note(WORDS, "greeting", kept=True)
    listed = json.loads(tangy("activity", "phrases", "--data", tmp_path, "--json").stdout)
    assert listed["own"] == {WORDS: "greeting"}
    (greeting,) = (one for one in listed["behaviours"] if one["behaviour"] == "greeting")
    assert WORDS in greeting["phrases"]
    forget = ("activity", "phrases", "--forget", WORDS, "--data", tmp_path, "--json")
    assert json.loads(tangy(*forget).stdout)["own"] == {}
    again = tangy(*forget)
    assert (again.returncode, again.stdout) == (2, "")
    assert WORDS in again.stderr
