"""Parallel work in a forked copy of this process.

pocketsphinx holds the GIL, so a thread would not run in parallel.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Generic, TypeVar

Asked = TypeVar("Asked")
Answer = TypeVar("Answer")


class ForkedWorker(Generic[Asked, Answer]):
    """A function evaluated in a child process.

    With a single core, or if the child cannot be forked or has died, the function is evaluated in
    this process, which only takes longer. The child ends with this process, however that ends.
    """

    def __init__(self, work: Callable[[Asked], Answer]) -> None:
        """Fork the child; the function must not keep state between calls."""
        self._work = work
        self._there: Connection | None = None
        self._process: multiprocessing.process.BaseProcess | None = None
        self._asked: list[Asked] = []
        self._number = 0
        if len(processors()) > 1 and "fork" in multiprocessing.get_all_start_methods():
            self._fork()

    def ask(self, asked: Asked) -> None:
        """Start an evaluation; `answer` returns its result."""
        self._asked = [asked]
        self._number += 1
        if self._there is not None:
            try:
                self._there.send((self._number, asked))
            except OSError:
                self._there = None

    def answer(self) -> Answer:
        """Wait for the result of the last request."""
        while self._there is not None:
            try:
                number, answer = self._there.recv()
            except (EOFError, OSError):
                self._there = None
            else:
                if number == self._number:  # else it is the result of an abandoned request
                    found: Answer = answer
                    return found
        return self._work(self._asked.pop())

    def close(self) -> None:
        """End the child process."""
        if self._there is not None:
            self._there.close()
            self._there = None
        if self._process is not None:
            self._process.join()
            self._process = None

    def _fork(self) -> None:
        context = multiprocessing.get_context("fork")
        here, there = context.Pipe()
        try:
            process = context.Process(target=self._serve, args=(here, there), daemon=True)
            process.start()
        except OSError:
            here.close()
        else:
            self._there, self._process = here, process
        there.close()

    def _serve(self, here: Connection, there: Connection) -> None:
        """Answer requests until the pipe closes."""
        own = there.fileno()
        here.close()
        os.closerange(3, own)  # else other pipes would never close
        os.closerange(own + 1, os.sysconf("SC_OPEN_MAX"))
        try:
            while True:
                number, asked = there.recv()
                there.send((number, self._work(asked)))
        except (EOFError, OSError, KeyboardInterrupt):
            os._exit(0)


def processors() -> range:
    """Return a range as long as the number of cores that this process may use."""
    usable = getattr(os, "sched_getaffinity", None)
    return range(len(usable(0)) if usable is not None else os.cpu_count() or 1)
