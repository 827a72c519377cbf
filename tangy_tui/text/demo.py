"""Words of the demo: captions for a real teaching session, policy and game."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beliefs
from tangy_profiles.state import Response
from tangy_tui.learning.explanation import DecisionReasons
from tangy_tui.learning.policy import Policy
from tangy_tui.text.decisions import shown_words, why_words
from tangy_tui.text.numbers import counted
from tangy_tui.text.questions import DID_YOU_SAY

TEACHER = "Ada"
"""The teacher in the demo."""

SCENES = (
    "A command and its question",
    "A mistake, taken back",
    "What Tangy learnt, and why",
    "A person would rather not",
    "Something goes wrong",
    "Your turn",
)

STEPS, LEARNT, WHY, GAME, BELIEVES = (
    "Steps",
    "What Tangy learnt",
    "Why",
    "The game",
    "What works with whom",
)
"""Titles of the panels beside the room."""

TYPES = f"{TEACHER} types"
ANSWERS_YES = "yes"
WELCOME = (
    f"{TEACHER} teaches Tangy to host {{}}. Tangy stands at the front, and four people sit behind "
    "the table. Everything you see happens now, in the simulated room."
)
SHE_TYPES = "She types what Tangy should do, in her own words."
IT_ASKS = "Tangy asks before it does anything. Nothing happens until she says yes."
SHE_SAYS_YES = "She says yes, and Tangy does it. That is the first step of the demonstration."
SECOND = "So she goes on, one command and one yes at a time."
GOES_ON = "People mark their cards. Now and then they make mistakes, as people do."
SLIP = "Now a mistake. She types this, and says yes too soon."
NOTICED = "Tangy notices at once, and says what may be wrong. It learns nothing from a slip."
NOT_NOTICED = "That was not what she wanted."
TAKEN_BACK = "One key takes the step back, and the room is as it was before."
NOW_RIGHT = "Now she gives the right command."
HELPED = "Tangy helps as she says, and learns which card needs which help."
THE_REST = "The rest of the game, faster. It has everything that Tangy needs to learn."
THINKS = "The game is over. Tangy learns from it."
BEGINS = "Now Tangy runs a game by itself, with what it has learnt."
PLAYS = "It calls, notices when a person needs help, and goes there."
SAYS_IT = "Tangy can ask in several ways. Now it {}."
REFUSED = "{} would rather not just now. Tangy notes that, and leaves it."
LATE = "{} does it a little late, which does not count. Tangy does not press."
ANOTHER_WAY = "Next time it asks in another way: it {}."
COMPLIED = "That worked. Tangy will ask {} this way more often."
AT_ONCE = "{} does it. Tangy notes which way of asking worked."
NOW_A_FAULT = "Now a scarf falls over the camera in Tangy's head."
DIAGNOSED = "Tangy notices that something is wrong, finds the cause, and says so."
ASKS_PEOPLE = "It can put this right itself: it asks the people at the table."
RECOVERED = "The scarf is gone, and the game goes on. If it cannot help itself, Tangy calls staff."
PLAYS_ON = "It plays the game to its end."
BELIEVES_THIS = "This is what Tangy now knows about asking each person. It goes on learning."
YOUR_TURN = "Your turn. One guided game is enough for Tangy to learn from you."
YOUR_TURN_LINES = (
    "In the program: choose Guided on the first screen.",
    "In a shell: tangy teach --guided",
)


def learnt_caption(steps: int, shown: int, situations: int) -> str:
    """Tell from how many steps Tangy has learnt, and how many situations it knows."""
    return (
        f"From {counted(steps, 'step')} Tangy has learnt what to do in {shown} of "
        f"{situations} situations. The percentage shows how sure it is."
    )


def why_caption(times: int) -> str:
    """Tell what a decision is based on."""
    steps = counted(times, "step")
    return f"Ask why, and Tangy names its reason: {steps} that {TEACHER} showed."


def belief_lines(beliefs: Mapping[str, Beliefs], name: Callable[[str], str]) -> list[str]:
    """Tell for each person which strategies were tried, and how often they worked."""
    lines = []
    for person, profile in beliefs.items():
        tried = [
            f"{strategy} {_worked(belief.complied, belief.trials)}"
            for strategy, belief in profile.items()
            if belief.trials
        ]
        lines.append(f"{name(person)}: {', '.join(tried) or 'not asked yet'}")
    return lines


def _worked(complied: int, trials: int) -> str:
    if trials == 1:
        return "worked once" if complied else "did not work"
    return f"worked {complied} of {trials} times"


def addressed(phrase: str, name: str) -> str:
    """Insert a person into a command: "go to user", "User 1" -> "go to user 1"."""
    *words, last = phrase.split()
    if name.casefold().startswith(last.casefold()):
        return " ".join((*words, name.lower()))
    return f"{phrase} {name}"


def learnt_lines(activity: Activity, policy: Policy) -> list[str]:
    """List what Tangy does in each situation, and how sure it is."""
    lines = []
    for situation in activity.situations:
        decision = policy.decide(situation)
        done = activity.behaviour_words(decision.behaviour)
        lines.append(f"{activity.in_words(situation)} -> {done} ({decision.share:.0%})")
    return lines


def why_lines(activity: Activity, why: DecisionReasons) -> list[str]:
    """Explain a decision, with the steps that support it."""
    steps = [shown_words(activity, shown, lambda id: "this game") for shown in why.rests_on]
    return [*why_words(activity, why), *steps]


def response_caption(
    response: Response, before: Sequence[Response], name: Callable[[str], str]
) -> str:
    """Describe a person's response to a request, and Tangy's conclusion."""
    who = name(response.person)
    if not response.complied:
        return (LATE if response.followed else REFUSED).format(who)
    refused = any(not one.complied and one.person == response.person for one in before)
    return (COMPLIED if refused else AT_ONCE).format(who)


def scene_words(number: int) -> str:
    """Return the title of a scene, from 1."""
    return f"Scene {number} of {len(SCENES)}: {SCENES[number - 1]}"


def typed_words(typed: str) -> str:
    """Format the teacher's command."""
    return f"{TYPES}: {typed}"


def asked_words(question: str) -> str:
    """Format Tangy's question, and the answer."""
    return f"{DID_YOU_SAY}{question}? {TEACHER}: {ANSWERS_YES}."


NOTHING_TO_SAY = "The scripted teacher has no command for this."
ASKS = f"{DID_YOU_SAY}{{}}?"
YES_KEYS = (("Y", "yes, do it"), ("N", "no, let me change it"))
"""The keys of the question."""
HOLD, EARLIER, LATER = "pause", "back", "forward"
"""The actions of the keys."""
HELD, ENDED = "paused", "the end"


def scene_note(number: int) -> str:
    """Tell which scene is shown, counted from 1."""
    return f"scene {number} of {len(SCENES)}"


HELP = (
    "A story in six scenes: a teacher shows a game, Tangy learns it and plays it. It all happens "
    "while you watch, in a temporary data folder. {still} pauses it, {left} and {right} go back "
    "and forward, {back} leaves."
)
