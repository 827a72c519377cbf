"""Laws that the fast tests try with few examples hold with many, too."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.laws import AT_LENGTH

TESTS = Path(__file__).parents[1]
LAWS = sorted(
    path.relative_to(TESTS.parent).as_posix()
    for path in TESTS.rglob("test_*.py")
    if re.search(r"^@tried\(", path.read_text(encoding="utf-8"), re.MULTILINE)
)


@pytest.mark.slow
@pytest.mark.parametrize("path", LAWS)
def test_a_law_holds_with_many_examples(path: str) -> None:
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-m", "pytest", "-n", "0", "-m", "law", path],
        cwd=TESTS.parent,
        env={**os.environ, "HYPOTHESIS_PROFILE": AT_LENGTH},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-4000:]
