"""Intent models of activities, trained once and stored under the digest of their examples.

Training takes seconds, loading milliseconds. The models of Tangy's activities are included; others
are trained when first needed.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
from contextlib import suppress
from pathlib import Path

from tangy_profiles.activity import Activity
from tangy_tui.language.examples import common_requests, examples_of, templates
from tangy_tui.language.intent_model import IntentModel, UnreadableModel, read_model

VERSION = 5
"""Incremented when examples, features or the fit change, to invalidate stored models."""
SHIPPED = Path(__file__).parent / "learnt"
MOST = 32
"""The number of models to keep, the latest ones."""
LARGEST = 20_000_000
"""The largest file to read (bytes); the model of Bingo has 400,000."""

_log = logging.getLogger(__name__)


class Intents:
    """Trains the intent models of activities, and caches them in a folder."""

    def __init__(self, folder: Path | None = None) -> None:
        """Use a folder, by default the user's cache folder."""
        self._folder = folder
        self._models: dict[str, IntentModel] = {}

    def model(self, activity: Activity) -> IntentModel:
        """Return the model of an activity; train it if it is not cached."""
        digest = digest_of(activity)
        model = self._models.get(digest) or self._kept(digest)
        if model is None:
            from tangy_tui.language.intent_training import train

            model = train(examples_of(activity))
            self._keep(digest, model)
        self._models[digest] = model
        return model

    def _kept(self, digest: str) -> IntentModel | None:
        for folder in (SHIPPED, self._where()):
            path = folder / f"{digest}.json"
            try:
                if path.stat().st_size <= LARGEST:
                    return read_model(path.read_text(encoding="utf-8"))
            except OSError:
                continue
            except (UnreadableModel, UnicodeDecodeError) as error:
                _log.warning("%s is learnt anew: %s", path, error)
        return None

    def _keep(self, digest: str, model: IntentModel) -> None:
        """Write a file atomically, and delete the oldest files; ignore write errors."""
        folder = self._where()
        part = folder / f"{digest}.{os.getpid()}.part"
        try:
            folder.mkdir(parents=True, mode=0o700, exist_ok=True)
            part.write_text(model.to_json(), encoding="utf-8")
            part.replace(folder / f"{digest}.json")
            kept = sorted(folder.glob("*.json"), key=lambda file: file.stat().st_mtime)
            for old in kept[:-MOST]:
                old.unlink(missing_ok=True)
        except OSError as error:
            _log.info("what was learnt is not kept: %s", error)
            with suppress(OSError):
                part.unlink(missing_ok=True)

    def _where(self) -> Path:
        if self._folder is None:
            from platformdirs import user_cache_path

            self._folder = user_cache_path("tangy", appauthor=False) / "understanding"
        return self._folder


def digest_of(activity: Activity) -> str:
    """Return the digest of everything that a model's examples are made from."""
    own = [
        (b.name, b.phrases, b.wordings, b.question, b.effect, b.persuades)
        for b in activity.behaviours.values()
    ]
    made_of = json.dumps([VERSION, templates(), common_requests(), activity.object, own])
    return hashlib.sha256(made_of.encode()).hexdigest()[:32]
