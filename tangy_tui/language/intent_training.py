"""Training of the intent model on an activity's examples, with scikit-learn.

`python -m tangy_tui.language.intent_training` trains the models of Tangy's activities, which are
stored beside this module: run it after a change of `asking.toml` or of a phrase.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tangy_tui.language.examples import Example
from tangy_tui.language.intent_model import IntentModel, features

FEWEST = 3  # examples with a feature; rarer features do not generalise
INVERSE_REGULARISATION = 30.0  # scikit-learn's C
MOST_STEPS = 400
TOLERANCE = 1e-5
DIGITS = 2


def train(examples: Sequence[Example]) -> IntentModel:
    """Fit a model to examples. It takes some seconds, and is deterministic."""
    import numpy as np
    from sklearn.feature_extraction import DictVectorizer
    from sklearn.linear_model import LogisticRegression

    rows = [features(example.words) for example in examples]
    seen = Counter(name for row in rows for name in row)
    kept = [{name: v for name, v in row.items() if seen[name] >= FEWEST} for row in rows]
    vectorizer = DictVectorizer(dtype=np.float64)
    table = vectorizer.fit_transform(kept)
    classifier = LogisticRegression(C=INVERSE_REGULARISATION, max_iter=MOST_STEPS, tol=TOLERANCE)
    classifier.fit(table, [example.behaviour for example in examples])
    weights = np.round(classifier.coef_, DIGITS)
    offsets = classifier.intercept_
    if len(classifier.classes_) == 2:  # binary: scikit-learn has one row for both classes
        weights, offsets = np.vstack([0 * weights, weights]), np.array([0.0, offsets[0]])
    names = vectorizer.get_feature_names_out()
    return IntentModel(
        tuple(map(str, classifier.classes_)),
        tuple(round(float(one), DIGITS) for one in offsets),
        {
            str(name): tuple(map(float, column))
            for name, column in zip(names, weights.T, strict=True)
            if column.any()
        },
    )


def main() -> None:
    """Train the models of the activities that come with Tangy."""
    from tangy_profiles.activity import load_activity, shipped_activities
    from tangy_tui.language.intents import SHIPPED, Intents

    SHIPPED.mkdir(exist_ok=True)
    for old in SHIPPED.glob("*.json"):
        old.unlink()
    for name in shipped_activities():
        Intents(SHIPPED).model(load_activity(name))


if __name__ == "__main__":
    main()
