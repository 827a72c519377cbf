"""The guarantees of the log under kills and with several processes."""

import random
import subprocess
import sys
from pathlib import Path

import pytest

from tangy_profiles.errors import StoreBusy
from tangy_profiles.store import Store
from tests.support.append_body import append_body

KILLS = 15

WRITER = """
import sys
from pathlib import Path
from tangy_profiles.events import Unknown
from tangy_profiles.store import Store
store = Store.open(Path(sys.argv[1]))
print("open", flush=True)
while True:
    with store.transaction():
        first = store.append(Unknown("first", {"filling": "words " * 200}))
        store.append(Unknown("second", {"of": first}))
        third = Unknown("third", {"of": first})
        third = store.append(third, person="p", strategy="s", complied=True)
    print(third, flush=True)
"""

HOLDER = """
import sys
from pathlib import Path
from tangy_profiles.events import Unknown
from tangy_profiles.store import Store
with Store.open(Path(sys.argv[1])) as store:
    store.append(Unknown("greeting"))
    print("open", flush=True)
    sys.stdin.read()
"""


def start(script: str, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(  # noqa: S603
        [sys.executable, "-c", script, str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


@pytest.mark.slow
def test_every_acknowledged_event_survives_a_kill(tmp_path: Path) -> None:
    """Kill the writer repeatedly, at a random acknowledgement, while it goes on writing."""
    rng = random.Random()  # new numbers each time; the law holds for all of them
    acknowledged = total = 0
    for _ in range(KILLS):
        with start(WRITER, tmp_path) as child:
            assert child.stdout is not None
            wanted = rng.choice([0, 1, 2, rng.randrange(60)])
            said = [line for _, line in zip(range(wanted), child.stdout, strict=False)]
            child.kill()
            said += child.stdout  # printed before it died, so acknowledged
        numbers = [int(line) for line in said if line.endswith("\n") and line != "open\n"]
        acknowledged = max([acknowledged, *numbers])
        with Store.open(tmp_path) as store:
            assert store.notices == store.check() == []
            events = list(store.events())
        assert [event.seq for event in events] == list(range(1, len(events) + 1))
        assert len(events) >= max(acknowledged, total), "an event was lost"
        assert [event.kind for event in events] == ["first", "second", "third"] * (len(events) // 3)
        total = len(events)
    assert acknowledged > 0


def test_a_second_writer_is_refused_until_the_first_ends(tmp_path: Path) -> None:
    with start(HOLDER, tmp_path) as child:
        assert child.stdout is not None and child.stdin is not None
        assert child.stdout.readline() == "open\n"
        with pytest.raises(StoreBusy) as caught:
            Store.open(tmp_path)
        assert f"(process {child.pid})" in str(caught.value) and "--data" in str(caught.value)
        with Store.open(tmp_path, write=False) as console:  # everybody may read
            assert [event.kind for event in console.events()] == ["greeting"]
        child.stdin.close()
        assert child.wait(30) == 0
    with Store.open(tmp_path) as store:
        assert append_body(store, "mine", {}) == 2


def test_a_killed_process_leaves_no_lock(tmp_path: Path) -> None:
    with start(HOLDER, tmp_path) as child:
        assert child.stdout is not None and child.stdout.readline() == "open\n"
        child.kill()
        assert child.wait(30) != 0
    with Store.open(tmp_path) as store:
        assert append_body(store, "mine", {}) == 2
