"""A test that hangs fails by its name, and holds up no other.

pytest-timeout interrupts a test after the seconds of `timeout` in pyproject.toml, and shows where
it hung. Some tests cannot be interrupted (a joined thread, a call that never returns, a clean-up
that waits), and would hold up the whole run. Their process is ended `GRACE` seconds later.
Its stacks are written, and pytest-xdist names the test and goes on in another process.
"""

from __future__ import annotations

import faulthandler
import os
import signal
import threading
from typing import Any

import pytest

SLOW_SECONDS = 900
"""The time limit of a slow test that sets none itself."""

GRACE = float(os.environ.get("TANGY_TEST_GRACE", "60"))
"""Seconds that an interrupted test has to clean up."""

AGAIN = 1.0
"""Seconds between interruptions: one in a background task ends only that task."""

_STDERR = pytest.StashKey[int]()


def pytest_configure(config: pytest.Config) -> None:
    """Keep the real standard error: pytest captures the usual one while a test runs."""
    capture = config.pluginmanager.getplugin("capturemanager")
    with capture.global_and_fixture_disabled():
        config.stash[_STDERR] = os.dup(2)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Give slow tests more time."""
    for item in items:
        if item.get_closest_marker("slow") and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(SLOW_SECONDS))


def _end_process_after(item: pytest.Item, seconds: float) -> None:
    faulthandler.dump_traceback_later(seconds, exit=True, file=item.config.stash[_STDERR])


@pytest.hookimpl(wrapper=True, optionalhook=True)
def pytest_timeout_set_timer(item: pytest.Item, settings: Any) -> Any:
    """End the process if interrupting the test does not help."""
    _end_process_after(item, settings.timeout + GRACE)
    done = yield
    if settings.method == "signal" and threading.current_thread() is threading.main_thread():
        signal.setitimer(signal.ITIMER_REAL, settings.timeout, AGAIN)
    return done


@pytest.hookimpl(trylast=True)
def pytest_exception_interact(node: pytest.Item | pytest.Collector) -> None:
    """Guard the clean-up of a failed test: pytest and the plugin end their own timeout with it."""
    if isinstance(node, pytest.Item):
        _end_process_after(node, GRACE)


def pytest_runtest_logfinish() -> None:
    """Cancel the end of the process: the test is over."""
    faulthandler.cancel_dump_traceback_later()
