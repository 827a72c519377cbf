"""Activity learning (III-A-4): a random forest maps the attended-user triple to a behaviour.

The state space is finite, so the forest is evaluated once for every triple and decisions are looked
up. The default settings are exact after one demonstration that covers all situations. `PAPER` is
the paper's bagging: the same decisions, with fewer votes.
"""

from __future__ import annotations

import hashlib
import json
import platform
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from itertools import product
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from tangy_profiles.declared.whom import Whom, learn_whom
from tangy_profiles.errors import TangyError
from tangy_profiles.state import FACTS, Situation
from tangy_profiles.teaching_records import ForestSettings as ForestSettings
from tangy_profiles.teaching_records import LearntRow, PolicyLearnt
from tangy_tui.learning.conflicts import Resolution, find_conflicts, training_rows

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.demonstration import Demonstration

SURE = 0.7
"""A decision with a smaller share of votes is unsure."""


class NothingToLearnFrom(TangyError):
    """No demonstration has a step."""


class NotOfThisActivity(TangyError):
    """A demonstration has a step that the activity, as it is now, does not have."""


EXACT = ForestSettings()
PAPER = ForestSettings(bootstrap=True)
FORESTS: Mapping[str, ForestSettings] = MappingProxyType({"exact": EXACT, "paper": PAPER})


@dataclass(frozen=True, slots=True)
class Decision:
    """The decision in a situation: pi(s) = b, with the share of trees that voted for it.

    `votes` lists every behaviour with votes, most first. `seen` counts the training steps in
    exactly this situation. `contested`: demonstrations disagree, and no teacher has said who is
    right. `right` are the answers that a teacher called right.
    """

    behaviour: str
    share: float
    votes: tuple[tuple[str, float], ...]
    seen: int
    contested: bool = False
    right: tuple[str, ...] = ()
    whatever: tuple[str, ...] = ()
    """The facts that a teacher's rule ignores here, if a rule covers this situation."""

    @property
    def sure(self) -> bool:
        """Whether the decision may be carried out: demonstrated, not contested, enough votes.

        If a teacher has called answers right, they need no majority.
        """
        if self.contested:
            return False
        return self.behaviour in self.right or (self.seen > 0 and self.share >= SURE)


@dataclass(frozen=True)
class Policy:
    """A learnt policy: one decision for every triple of the activity, and its training data."""

    name: str
    activity: str
    demonstrations: tuple[str, ...]
    settings: ForestSettings
    table: Mapping[Situation, Decision]
    digest: str
    versions: Mapping[str, str]
    resolutions: tuple[Resolution, ...] = ()
    whom: Whom = field(default_factory=dict)
    """The selectors of the addressee of a behaviour, by stage and behaviour."""

    def decide(self, situation: Situation) -> Decision:
        """Look up the decision for a situation.

        Raises:
            KeyError: the situation is not one of the activity.
        """
        return self.table[situation]

    @property
    def named_by_count(self) -> bool:
        """Whether its name is only the activity and the number of demonstrations."""
        return self.name == _name_by_count(self.activity, self.demonstrations)

    def exact(self, activity: Activity) -> bool:
        """Return whether it agrees with every expected behaviour of the activity.

        Return False if the activity does not declare the expected behaviours.
        """
        return bool(activity.expected) and not self.errors(activity)

    def errors(self, activity: Activity) -> dict[Situation, str]:
        """Return the situations with an unexpected decision, and that decision."""
        return {
            situation: self.table[situation].behaviour
            for situation, behaviour in activity.expected.items()
            if self.table[situation].behaviour != behaviour
        }

    def record(self) -> PolicyLearnt:
        """Return the log record: the training data, settings, digest and decisions."""
        known = {s: one for s, one in self.table.items() if one.seen or one.right}
        return PolicyLearnt(
            name=self.name,
            activity=self.activity,
            demonstrations=self.demonstrations,
            forest=self.settings,
            versions=self.versions,
            digest=self.digest,
            resolved=self.resolutions,
            rows=tuple(LearntRow(*s, one.behaviour, one.share) for s, one in known.items()),
            asks=tuple(situation for situation, one in known.items() if not one.sure),
        )


def all_situations(activity: Activity) -> Iterator[Situation]:
    """Yield every combination of stage, request and user state, reachable or not."""
    yield from activity.imaginable()


def learn_policy(
    activity: Activity,
    demonstrations: Sequence[Demonstration],
    *,
    resolutions: Sequence[Resolution] = (),
    settings: ForestSettings = EXACT,
    name: str = "",
    grow: Grow | None = None,
) -> Policy:
    """Fit the forest to demonstrations and evaluate it for every situation.

    The same demonstrations in the same order give the same policy, bit for bit, with the same
    version of scikit-learn. A situation with an unresolved conflict is contested. `grow` returns
    the votes of a forest (default: `grown`).

    Raises:
        NothingToLearnFrom: the demonstrations have no step.
        NotOfThisActivity: the activity was changed after they were made.
    """
    shown, told = training_rows(demonstrations, resolutions)
    rows = shown + told
    contested = {conflict.situation for conflict in find_conflicts(demonstrations, resolutions)}
    right = {resolution.situation: resolution.right for resolution in resolutions}
    rules = {one.situation: one.whatever for one in resolutions if one.whatever}
    situations = list(all_situations(activity))
    strange = set(rows) - set(product(situations, activity.behaviours))
    if strange:
        gone = sorted({behaviour for _, behaviour in strange} - set(activity.behaviours))
        lacks = (
            f"the behaviour {gone[0]!r}"
            if gone
            else f"the situation {' / '.join(min(strange)[0])!r}"
        )
        raise NotOfThisActivity(
            f"{activity.title} has changed since it was demonstrated, and no longer has {lacks}. "
            "Give it its old name in the file again (the 'question' and 'phrases' of a behaviour, "
            "and the 'words' of a stage, are what people read and say), or give the activity "
            "another 'name', and demonstrate it again. What was demonstrated is kept."
        )
    if not rows:
        raise NothingToLearnFrom(
            "There is nothing to learn from yet: demonstrate a game first, with Teach "
            "(`tangy teach`)."
        )
    forest = (grow or grown)(settings, tuple(rows), tuple(situations))
    seen = Counter(situation for situation, _ in shown)
    table: dict[Situation, Decision] = {}
    for situation, votes in zip(situations, forest.votes, strict=True):
        table[situation] = Decision(
            votes[0][0],
            votes[0][1],
            votes,
            seen[situation],
            situation in contested,
            right.get(situation, ()),
            rules.get(situation, ()),
        )
    ids = tuple(d.id for d in demonstrations)
    whom = learn_whom(demonstrations, activity.behaviours)
    return Policy(
        name=name or _name_by_count(activity.name, ids),
        activity=activity.name,
        demonstrations=ids,
        settings=settings,
        table=MappingProxyType(table),
        digest=_digest(settings, rows, table, resolutions, whom),
        versions=MappingProxyType(dict(forest.versions)),
        resolutions=tuple(resolutions),
        whom=MappingProxyType(whom),
    )


def _name_by_count(activity: str, ids: Sequence[str]) -> str:
    return f"{activity}-{len(ids)}"


class Forest(NamedTuple):
    """A forest's votes: for each situation the behaviours voted for, most votes first."""

    votes: tuple[tuple[tuple[str, float], ...], ...]
    versions: tuple[tuple[str, str], ...]


Grow = Callable[[ForestSettings, tuple[tuple[Situation, str], ...], tuple[Situation, ...]], Forest]
"""Returns a forest's votes for situations, given its settings and training rows."""

MANY_CLASSES = r"The number of unique classes is greater than \d+% of the number of samples"
"""Start of a scikit-learn warning that does not apply to behaviours."""


@lru_cache(maxsize=256)
def grown(
    settings: ForestSettings,
    rows: tuple[tuple[Situation, str], ...],
    situations: tuple[Situation, ...],
) -> Forest:
    """Train a forest on rows and evaluate it for every situation; cached by its arguments.

    A hundred trees take a tenth of a second, and the same rows are used again whenever a policy is
    displayed, compared, or learnt after a conflict check that found nothing.
    """
    import numpy as np
    import sklearn
    from sklearn.ensemble import RandomForestClassifier

    encode = encoder(situations)
    forest = RandomForestClassifier(
        n_estimators=settings.trees,
        bootstrap=settings.bootstrap,
        min_samples_leaf=settings.min_samples_leaf,
        random_state=settings.seed % 2**32,
    )
    # After a short game most steps have different behaviours. Class labels are names, so the
    # warning that they look like regression targets is wrong, and staff would see it.
    warnings.filterwarnings("ignore", MANY_CLASSES, UserWarning)
    forest.fit(np.array([encode(s) for s, _ in rows]), [behaviour for _, behaviour in rows])
    shares = forest.predict_proba(np.array([encode(s) for s in situations]))
    behaviours = [str(name) for name in forest.classes_]
    return Forest(
        tuple(
            tuple(
                sorted(
                    (
                        (behaviour, round(share, 9))
                        for behaviour, share in zip(behaviours, row, strict=True)
                        if share > 0
                    ),
                    key=lambda vote: (-vote[1], vote[0]),
                )
            )
            for row in shares.tolist()
        ),
        (
            ("python", platform.python_version()),
            ("numpy", str(np.__version__)),
            ("scikit-learn", str(sklearn.__version__)),
        ),
    )


def encoder(situations: Sequence[Situation]) -> Callable[[Situation], list[float]]:
    """Return the one-hot encoder of situations (stage, request, user state).

    For an activity declared by facts, each fact of the user state is a feature of its own.
    """
    features = {
        situation: [
            *((0, situation.stage), (1, situation.request)),
            *((2, fact) for fact in situation.user_state.split(FACTS)),
        ]
        for situation in situations
    }
    words = dict.fromkeys(word for found in features.values() for word in found)
    order = sorted(words, key=lambda word: word[0])  # stable: keeps the order within each part
    place = {word: index for index, word in enumerate(order)}

    def encode(situation: Situation) -> list[float]:
        row = [0.0] * len(order)
        for word in features[situation]:
            row[place[word]] = 1.0
        return row

    return encode


def _digest(
    settings: ForestSettings,
    rows: list[tuple[Situation, str]],
    table: Mapping[Situation, Decision],
    resolutions: Sequence[Resolution],
    whom: Whom,
) -> str:
    """Return the SHA-256 of the training data and the votes."""
    body: list[object] = [
        asdict(settings),
        [[*situation, behaviour] for situation, behaviour in rows],
        [[*situation, [list(vote) for vote in d.votes]] for situation, d in table.items()],
    ]
    if resolutions:
        body.append([[*r.situation, *r.right] for r in resolutions])
    if whom:
        body.append([[*key, *selectors] for key, selectors in whom.items()])
    canonical = json.dumps(body, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(canonical.encode()).hexdigest()
