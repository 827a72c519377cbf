"""The kinds of event in the log and what the body of each holds: a closed set.

A body is checked where it is written and where it is read, so that whoever reads events has only
those that are as Tangy writes them. Keys that are not named here may stand in any body.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tangy_profiles.game_world import GAME_WORLDS
from tangy_profiles.persuading import LEAST_KEPT, METHODS, PERIODS, PRIORS, is_method
from tangy_profiles.shapes import (
    LARGEST,
    Check,
    Fields,
    count,
    fact,
    list_of,
    maybe,
    number,
    one_of,
    row_of,
    table_of,
    text,
    whole,
    yes_or_no,
)
from tangy_profiles.state import VARIABLES

MOVES = (
    "kept",
    "asked",
    "remedied",
    "teacher asked",
    "halted",
    "acknowledged",
    "expert called",
    "still there",
    "escalated",
    "went on",
    "recovered",
    "taught",
    "accepted",
    "cleared",
    "ended",
    "left",
    "given up",
    "left open",
)
"""What can be done about a fault."""
# ------------------------------------------------------------------------ what bodies are made of

_SITUATION = row_of(text, one_of("ANR", "AR"), text)
_NAMES = list_of(text)


def _one_group(state: Mapping[str, Any]) -> str:
    ids = [user[0] for user in state["users"]]
    if len(set(ids)) < len(ids):
        return "has somebody twice"
    there = state["attended"] is None or state["attended"] in ids
    return "" if there else "has somebody 'attended' who is not among the 'users'"


def _state(closed: bool) -> Check:
    """A joint state; the first games were logged without who was `closed`."""
    told: Mapping[str, Check] = {"closed": maybe(text)}
    closely = Fields(
        {
            "step": count,
            "situation": _SITUATION,
            "place": text,
            "attended": maybe(text),
            "users": list_of(row_of(text, text, one_of("ANR", "AR"))),
            **(told if closed else {}),
        },
        {} if closed else told,
        whole=_one_group,
    )
    return lambda value: "" if _plainly_a_state(value) else closely(value)


def _plainly_a_state(value: Any) -> bool:
    """Say at a glance that a state is as it should be: most of a log are states."""
    try:
        stage, request, activity = value["situation"]
        ids = []
        for user in value["users"]:
            id, doing, asks = user
            if type(user) is not list or type(doing) is not str or asks not in ("ANR", "AR"):
                return False
            ids.append(id)
        attended, closed = value["attended"], value["closed"]
        return (
            type(value["situation"]) is type(value["users"]) is list
            and type(stage) is type(activity) is type(value["place"]) is str
            and request in ("ANR", "AR")
            and type(value["step"]) is int
            and 0 <= value["step"] < LARGEST
            and all(type(id) is str for id in ids)
            and len(set(ids)) == len(ids)
            and (attended is None or attended in ids)
            and (closed is None or type(closed) is str)
        )
    except (TypeError, KeyError, ValueError):
        return False


def _same_group(step: Mapping[str, Any]) -> str:
    before, after = step["state"], step.get("after") or step["state"]
    same = [user[0] for user in before["users"]] == [user[0] for user in after["users"]]
    return "" if same else "has other people in 'after' than in 'state'"


_STEP = Fields(
    {
        "behaviour": text,
        "target": maybe(text),
        "state": _state(closed=True),
        "after": _state(closed=True),
    },
    {"completed": yes_or_no, "heard": maybe(text), "confidence": maybe(number)},
    whole=_same_group,
)
_RESOLUTION = Fields({"situation": _SITUATION, "right": _NAMES, "wrong": list_of(whole)})
_MISMATCH = Fields(
    {"behaviour": text, "variable": one_of(*VARIABLES), "expected": _NAMES, "seen": text},
    only=True,
)
_FOREST = Fields(
    {},
    {"trees": count, "bootstrap": yes_or_no, "min_samples_leaf": count, "seed": whole},
    only=True,
)


def _kept(value: Any) -> str:
    share = number(value)
    return share or ("" if LEAST_KEPT <= value <= 1 else "is not a share that can be kept")


def _method(value: Any) -> str:
    return "" if isinstance(value, str) and is_method(value) else one_of(*METHODS)(value)


_METHOD = Fields(
    {},
    {
        "method": _method,
        "prior": one_of(*PRIORS),
        "forgetting": _kept,
        "forgetting_per": one_of(*PERIODS),
    },
)
_ANSWERED = Fields(
    {
        "round": count,
        "fault": text,
        "name": text,
        "recovery": text,
        "advice": _NAMES,
        "named": text,
        "acted": text,
        "seconds": number,
        "may_clear": maybe(yes_or_no),
        "cleared": maybe(yes_or_no),
    }
)


_EDITS: Mapping[str, Fields] = {
    "delete": Fields({"ids": list_of(text, 1)}),
    "restore": Fields({"ids": list_of(text, 1)}),
    "resolve": _RESOLUTION,
    "merge": Fields({"ids": list_of(text, 1), "made": row_of(text)}),
    "split": Fields({"ids": row_of(text), "made": row_of(text, text), "kept": count}),
}


def _edited(body: Any) -> str:
    return Fields({"activity": text, "what": one_of(*_EDITS)})(body) or _EDITS[body["what"]](body)


def _shown_again(body: Mapping[str, Any]) -> str:
    again = body.get("origin") == "again"
    return "has no 'of' or 'kept'" if again and not (body.get("of") and "kept" in body) else ""


# ------------------------------------------------------------------------------------- the kinds

_DEMONSTRATION = Fields({"demonstration": text})
_GAME = Fields({"game": text})
_OF_EVENT = Fields({"of": text})
_EDIT = Fields({"activity": text, "edit": whole})
_ANY = Fields()

BODIES: Mapping[str, Check] = {
    "events lost": Fields({"first": count, "last": count}),
    "renamed": _ANY,
    "forgotten": _ANY,
    "speech noted": _ANY,
    "demonstration begun": Fields(
        {
            "demonstration": text,
            "activity": text,
            "teacher": text,
            "seed": whole,
            "people": _NAMES,
        },
        {
            "guided": yes_or_no,
            "origin": one_of("shown", "again", "asked", "merged", "split"),
            "of": _NAMES,
            "kept": count,
        },
        whole=_shown_again,
    ),
    "demonstration step": _STEP.joined(_DEMONSTRATION),
    "demonstration step undone": Fields({"demonstration": text}, {"step": count}),
    "demonstration step redone": _DEMONSTRATION,
    "demonstration finished": _DEMONSTRATION,
    "demonstrations edited": _edited,
    "demonstrations edit undone": _EDIT,
    "demonstrations edit redone": _EDIT,
    "policy learnt": Fields(
        {
            "name": text,
            "activity": text,
            "demonstrations": _NAMES,
            "forest": _FOREST,
            "versions": table_of(text),
            "digest": text,
            "rows": list_of(row_of(text, one_of("ANR", "AR"), text, text, number)),
        },
        {"resolved": list_of(_RESOLUTION), "asks": list_of(_SITUATION)},
    ),
    "game begun": Fields(
        {"game": text, "people": _NAMES},
        {
            "number": count,
            "activity": text,
            "policy": text,
            "seed": whole,
            "world": one_of(*GAME_WORLDS),
        },
    ),
    "game world set": Fields({"game": text, "world": one_of(*GAME_WORLDS)}, {"by": text}),
    "game step": Fields(
        {
            "game": text,
            "behaviour": text,
            "target": maybe(text),
            "state": _state(closed=False),
        },
        {
            "strategy": maybe(text),
            "share": maybe(number),
            "teacher": maybe(text),
            "draws": maybe(table_of(number)),
            "numbers": list_of(whole),
            "completed": yes_or_no,
            "seconds": maybe(number),
            "after": maybe(_state(closed=False)),
        },
        whole=_same_group,
    ),
    "response": Fields(
        {},
        {"game": maybe(text), "followed": maybe(yes_or_no), "seconds": maybe(number)},
    ),
    "response awaited": Fields({}, {"game": maybe(text)}),
    "game ended": Fields({"game": text, "steps": count, "stopped": maybe(text)}),
    "feedback": Fields(
        {}, {"game": maybe(text), "of": maybe(text), "world": maybe(one_of(*GAME_WORLDS))}
    ),
    "void": Fields({"of": text}, {"why": text}),
    "taken back": Fields({"of": text}, {"what": text}),
    "strategy switched": Fields({"on": yes_or_no}),
    "method chosen": Fields({"chosen": maybe(_METHOD)}),
    "fault": Fields(
        {
            "game": text,
            "fault": text,
            "code": text,
            "name": text,
            "criticality": one_of("critical", "non-critical"),
            "recovery": text,
            "step": count,
            "seconds": number,
            "behaviour": text,
            "console": text,
            "why": text,
            "evidence": table_of(fact),
            "mismatches": list_of(_MISMATCH),
            "advice": _NAMES,
        }
    ),
    "recovery": Fields(
        {"game": text, "fault": text, "kind": one_of(*MOVES), "seconds": number},
        {
            "attempt": count,
            **dict.fromkeys(("by", "to", "speech", "image", "remedy"), text),
        },
    ),
    "effect accepted": _STEP.joined(
        Fields({"activity": text, "game": text, "fault": text, "by": text})
    ),
    "acceptance taken back": Fields({"number": whole}),
    "staff action": Fields({"game": text, "what": text, "by": text}, {"seconds": maybe(number)}),
    "drill": Fields(
        {
            "who": text,
            "activity": text,
            "seed": whole,
            "rounds": count,
            "answers": list_of(_ANSWERED),
        }
    ),
    "microphone checked": Fields({"source": text}),  # odd settings are as good as none
    "microphone check forgotten": Fields({"source": text}),
    "consent to recordings": Fields({"who": text, "yes": yes_or_no}),
    "recordings forgotten": _ANY,
    "consent to face": Fields({"yes": yes_or_no}, {"how": text}),
    "face forgotten": _ANY,
}
"""What the body of each kind of event holds."""

ABOUT_PEOPLE = frozenset(
    (
        "renamed",
        "forgotten",
        "speech noted",
        "response",
        "response awaited",
        "feedback",
        "void",
        "taken back",
        "strategy switched",
        "method chosen",
        "consent to face",
        "face forgotten",
    )
)
"""The kinds that are about a person, who is named in the row."""
WITH_STRATEGY = frozenset(("response", "response awaited", "feedback", "void", "strategy switched"))
"""The kinds that are about a strategy as well."""


def wrong_with(kind: str, person: str | None, strategy: str | None, body: Mapping[str, Any]) -> str:
    """Say what is wrong with an event of a known kind, as the tail of a sentence ("": nothing).

    Of a kind that is not known nothing can be said.
    """
    check = BODIES.get(kind)
    if check is None:
        return ""
    if person is None and kind in ABOUT_PEOPLE:
        return "says of nobody whom it is about"
    if strategy is None and kind in WITH_STRATEGY:
        return "has no strategy"
    return check(body)
