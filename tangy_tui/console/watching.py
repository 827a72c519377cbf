"""Looking on in the console: the events of a game that another program runs."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

from tangy_profiles.codec import encode
from tangy_profiles.reading import plain
from tangy_profiles.store import Store
from tangy_tui.app.watching import WATCH_SECONDS, Guest, News, WatchedLog
from tangy_tui.text import watching as text
from tangy_tui.text.endings import ending_words
from tangy_tui.text.log import game_words, moment_lines
from tangy_tui.text.register import staff_names


class WatchingLines:
    """Writes a game in lines, or as JSON lines. Call `look` repeatedly, or `run`."""

    def __init__(
        self, folder: Path, store: Store, write: Callable[[str], None], *, as_json: bool = False
    ) -> None:
        """Look on at the games of a data folder.

        Args:
            folder: the data folder.
            store: its log, open for reading.
            write: writes a line.
            as_json: write each line as a JSON document.
        """
        self.guest = Guest(folder)
        self._log = WatchedLog(store)
        self._name = staff_names(self._log.name)
        self._write, self._as_json = write, as_json
        self._said = ""
        self._there = False

    def run(self, ends: Callable[[], bool] = lambda: False) -> None:
        """Write events until `ends` returns True, or the program that ran the games has ended."""
        self._tell_first()
        while not ends():
            was = self._there
            self.look()
            if was and not self._there:
                break
            time.sleep(WATCH_SECONDS)
        self.guest.close()

    def look(self) -> None:
        """Write new events."""
        self._there = self.guest.look()
        self._tell_news(self._log.news())
        self._tell_phase()

    def _tell_news(self, news: News | None) -> None:
        if news is not None:
            if self._as_json:
                for moment in news.moments:
                    when = {"seconds": moment.seconds, "step": moment.step, "at": moment.at}
                    self._json({"game": news.game.id, **moment.to_json(), **when})
            else:
                if news.begun:
                    self._write(plain(game_words(news.game, news.activity)))
                for moment in news.moments:
                    for line in moment_lines(moment, news.replay.timed, news.activity, self._name):
                        self._write(plain(line))
                if news.game.ended is not None:
                    self._write(plain(ending_words(news.game)))

    def _tell_first(self) -> None:
        self._there = self.guest.look_first()
        news = self._log.news()  # it knows people's names, and the activity
        if not self._as_json:
            activity = None if news is None else news.activity
            lines = text.view_lines(self.guest.view, activity, self._name)
            for line in lines if self._there else [text.NOBODY]:
                self._write(plain(line))
        self._tell_news(news)

    def _tell_phase(self) -> None:
        view = self.guest.view
        said = "" if view is None else f"{view.game} {view.phase} {view.robot}"
        if view is None or said == self._said:
            return
        self._said = said
        if self._as_json:
            self._json({"kind": "view", **encode(view)})
        else:
            self._write(plain(text.phase_line(view)))

    def _json(self, said: object) -> None:
        self._write(json.dumps(said, ensure_ascii=False))
