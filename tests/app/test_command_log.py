"""A teacher's command, the question about it and the answer share one id in the log."""

from __future__ import annotations

import re
from pathlib import Path

from tangy_profiles.process_log import PROGRAM_LOG, logging_to
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.teaching_events import Undo
from tangy_tui.learning.verification import Reply, Say

LINE = re.compile(r"\[(.+)\] teaching: (.+)")


def test_an_answer_is_logged_by_the_id_of_its_question_with_the_behaviour(
    workspace: Workspace, tmp_path: Path
) -> None:
    teaching = workspace.teaching("Ada", 1)
    teaching.begin(resume=False)
    with logging_to(tmp_path):
        for command in (Say("call number"), Reply(yes=True), Undo(), Reply(yes=True)):
            teaching.apply(command)
    text = (tmp_path / PROGRAM_LOG).read_text(encoding="utf-8")
    (said, asked), (replied, did), (undone, _), (late, _) = LINE.findall(text)
    assert said == replied
    assert asked == "Say -> Asked call number"
    assert did.startswith("Reply -> Executed call number")
    assert len({said, undone, late}) == 3, "another command, or an answer to nothing, has its own"
