"""Record the program's behaviour, and compare two recordings.

    python -m tests.oracle record DIR [--seeds 30] [--live 2] [--jobs 2]
    python -m tests.oracle compare BEFORE AFTER

A refactoring must not change anything visible to a user, a script or a log. A recording holds the
JSON documents of the verbs for many seeds, the bodies of the log, every help page, and screens as
text. Ids and times differ in every run, so they are replaced (see `normal.py`).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tests.oracle.comparing import differences
from tests.oracle.recording import record


def main() -> int:
    """Run the given command; return 0 if nothing differs."""
    parser = argparse.ArgumentParser(prog="python -m tests.oracle", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    recorder = commands.add_parser("record", help="run the program, and keep what it says")
    recorder.add_argument("folder", type=Path)
    recorder.add_argument("--seeds", type=int, default=30)
    recorder.add_argument("--live", type=int, default=2, help="seeds of games on the bench")
    recorder.add_argument("--jobs", type=int, default=2)
    comparer = commands.add_parser("compare", help="show what differs between two recordings")
    comparer.add_argument("before", type=Path)
    comparer.add_argument("after", type=Path)
    given = parser.parse_args()
    if given.command == "record":
        record(given.folder, seeds=given.seeds, live=given.live, jobs=given.jobs)
        return 0
    found = differences(given.before, given.after)
    for line in found:
        print(line)
    print(f"{len(found)} files differ" if found else "no difference")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
