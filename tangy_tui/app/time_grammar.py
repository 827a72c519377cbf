"""The grammar of the planned time: plan more of it, and ask about it."""

from __future__ import annotations

import re

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_commands import PlanTime

LONGEST = 600  # minutes
EXAMPLES = "plan 20 minutes, 10 more minutes, plan until 15:40, no time limit"

_UNIT = r"(?: ?min(?:ute)?s?\.?)"
_FROM_NOW = re.compile(
    rf"(?:plan|time) (?:for )?(\d{{1,4}}){_UNIT}?(?: from now)?"
    rf"|(?:plan|play)(?: on)? for (\d{{1,4}}){_UNIT}",
    re.I,
)
_MORE = re.compile(
    rf"(?:plan |add |play )?(?:(?:another )?(\d{{1,4}}) more{_UNIT}|another (\d{{1,4}}){_UNIT}"
    rf"|(\d{{1,4}}){_UNIT} (?:more|longer))",
    re.I,
)
_UNTIL = re.compile(
    r"(?:plan|play|time)(?: on)? (?:until|till|to) (\d{1,2})[:.h](\d{2})(?: ?o'?clock)?", re.I
)
_OPEN = re.compile(
    r"(?:plan |time )?(?:no|without(?: a)?) (?:time )?(?:limit|end)"
    r"|(?:plan |play )?as long as (?:you|we|they) like",
    re.I,
)
_BEGINS = re.compile(r"plan\b.*", re.I)
_HOW_LONG = re.compile(r"(?:and |but |so )?how (?:long|much time|much longer|many minutes)\b(.*)")
_WHEN = re.compile(r"(?:and |but |so )?(?:when|until when|till when|(?:at )?what time)\b(.*)")
_ALONE = frozenset({"time", "the time", "time left", "planned time", "how late is it"})
_ENDS = frozenset({
    *("end", "ends", "over", "stop", "finish", "finished", "done", "play", "planned", "left"),
})  # fmt: skip
"""Words of which a question about the end has one."""
_OTHERS = frozenset({
    *("is", "are", "do", "does", "did", "will", "must", "can", "may", "have", "has", "should"),
    *("to", "going", "minutes", "longer", "today", "altogether", "in", "all", "ending", "time"),
    *("it", "this", "that", "we", "you", "tangy", "the", "game", "games", "session", "there", "a"),
    *("still", "yet", "now", "so", "far", "for", "on", "at", "until", "till", "got", "be", "been"),
    *("been", "played", "playing", "last", "lasts", "lasted", "take", "takes", "go", "goes"),
})  # fmt: skip
"""The other words of these questions; any further word, such as a name, asks something else."""


def read_time(said: str) -> PlanTime | None:
    """Parse words that plan the time of the session; None if they are none.

    Raises:
        TangyError: they resemble one, but a part of it is wrong; one sentence.
    """
    if from_now := _FROM_NOW.fullmatch(said):
        return PlanTime(_minutes(from_now))
    if more := _MORE.fullmatch(said):
        return PlanTime(_minutes(more), more=True)
    if until := _UNTIL.fullmatch(said):
        hour, minute = int(until[1]), int(until[2])
        if hour > 23 or minute > 59:
            raise TangyError(f"There is no {hour}:{minute:02} o'clock.")
        return PlanTime(until=(hour, minute))
    if _OPEN.fullmatch(said):
        return PlanTime()
    if _BEGINS.fullmatch(said):
        raise TangyError(f"To plan the time, say it as in: {EXAMPLES}.")
    return None


def _minutes(found: re.Match[str]) -> int:
    minutes = int(next(filter(None, found.groups())))
    if not 1 <= minutes <= LONGEST:
        raise TangyError(f"You can plan 1 to {LONGEST} minutes.")
    return minutes


def asks_time(said: str) -> bool:
    """Return whether words ask how long the session has lasted, or when it ends."""
    words = " ".join(said.replace("\u2019", "'").split()).casefold().rstrip(" ?.!")
    words = words.replace("what's", "what is").replace("when's", "when is")
    if words.removeprefix("what is ") in _ALONE:
        return True
    if found := _HOW_LONG.fullmatch(words):
        return {*found[1].split()} <= _ENDS | _OTHERS
    found = _WHEN.fullmatch(words)
    asked = set[str]() if found is None else {*found[1].split()}
    return not asked.isdisjoint(_ENDS) and asked <= _ENDS | _OTHERS
