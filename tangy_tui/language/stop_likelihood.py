"""How likely everyday words are to stop the robot, by a model that is learnt from sentences.

The rules of `stop_sentence` know the verbs of stopping and what their objects mean; this knows the
many ways without such a verb ("that'll do now", "don't you come any closer") from those that
`stop_phrases` has. The model comes with Tangy; `tests/bench/stop_training.py` fits it.
"""

from __future__ import annotations

from importlib.resources import files

from tangy_tui.language.intent_model import IntentModel, read_model
from tangy_tui.language.words import Words

MODEL = "stop_model.json"
STOP = "stop"


_used: list[IntentModel] = []


def stop_likelihood(words: Words) -> float:
    """Return the probability, from 0 to 1, that a sentence is to stop the robot or the game.

    The words are in lower case and without apostrophes, and "game" is what the game is called.
    """
    if not _used:
        text = files("tangy_tui.language").joinpath(MODEL).read_text(encoding="utf-8")
        use_model(read_model(text))
    return _used[0].probabilities(words)[STOP]


def use_model(model: IntentModel) -> None:
    """Judge by another model from now on."""
    _used[:] = [model]
