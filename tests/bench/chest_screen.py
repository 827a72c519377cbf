"""Delay of the driving loop while strangers hold half-sent requests to the chest screen.

`python tests/bench/chest_screen.py [CONNECTIONS]`: a loop like the robot's ticks twenty times a
second beside a chest screen; strangers in another process send halves of requests, first
none, then CONNECTIONS, then as fast as they can.
"""

from __future__ import annotations

import asyncio
import subprocess
import sys
import time
from pathlib import Path

from tangy_hw.drivers.chest import WebChestScreen

TICK_SECONDS = 0.05
TICKS = 120

STRANGERS = """
import resource, socket, sys, time
port, most, churn = map(int, sys.argv[1:])
resource.setrlimit(resource.RLIMIT_NOFILE, (4096, 4096))
held = []
print("ready", flush=True)
while True:
    try:
        one = socket.create_connection(("127.0.0.1", port), timeout=0.2)
        one.sendall(b"GET / HTTP/1.1\\r\\nHost: 127.0.0.1\\r\\nX: ")
        held.append(one)
    except OSError:
        time.sleep(0.01)
    if len(held) >= most:
        if churn:
            held.pop(0).close()
        else:
            time.sleep(0.05)
"""


async def ticks() -> list[float]:
    """Tick, and return how late each tick was, in ms."""
    late = []
    due = time.monotonic() + TICK_SECONDS
    for _ in range(TICKS):
        await asyncio.sleep(max(0.0, due - time.monotonic()))
        late.append(1000 * (time.monotonic() - due))
        due = max(due + TICK_SECONDS, time.monotonic())
    return sorted(late)


def files() -> str:
    """Return the number of files this process has open."""
    try:
        return f"{sum(1 for _ in Path('/proc/self/fd').iterdir()):8}"
    except OSError:
        return "    none can be opened"


async def measure(most: int, *, churn: bool) -> None:
    """Measure beside this many strangers, and print a row."""
    screen = WebChestScreen(port=0)
    await screen.start()
    strangers = None
    if most:
        strangers = await asyncio.create_subprocess_exec(
            sys.executable, "-c", STRANGERS, str(screen.port), str(most), str(int(churn)),
            stdout=subprocess.PIPE,
        )  # fmt: skip
        assert strangers.stdout is not None
        await strangers.stdout.readline()
        await asyncio.sleep(3)
    late = await ticks()
    opens = files()
    told = f"{late[len(late) // 2]:8.1f}{late[int(0.99 * len(late))]:8.1f}{late[-1]:8.1f}"
    print(f"{most:6}{'  fast' if churn else '  held'}{told}{opens}", flush=True)
    if strangers is not None:
        strangers.kill()
        await strangers.wait()
    await screen.close()


async def run() -> None:
    """Run the measurements in turn."""
    most = int(sys.argv[1]) if sys.argv[1:] else 1100
    print("strangers       p50     p99     max   files open (times in ms)")
    await measure(0, churn=False)
    await measure(most, churn=False)
    await measure(64, churn=True)


if __name__ == "__main__":
    asyncio.run(run())
