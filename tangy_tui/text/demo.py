"""The demo, as it is told: captions of what a real teacher, learner and game do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beliefs
from tangy_profiles.state import Response
from tangy_tui.learning.explanation import Why
from tangy_tui.learning.policy import Policy
from tangy_tui.text.decisions import shown_words, why_words
from tangy_tui.text.numbers import counted
from tangy_tui.text.questions import DID_YOU_SAY

TEACHER = "Ada"
"""Who teaches in the demo."""

SCENES = (
    "A command and its question",
    "A mistake, taken back",
    "What Tangy learnt, and why",
    "Somebody says no",
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
"""Heads of the panel beside the room."""

TYPES = f"{TEACHER} types"
ANSWERS_YES = "yes"
WELCOME = (
    f"{TEACHER} teaches Tangy to host {{}}. Tangy stands at the front, and four people sit behind "
    "the table. All that you see happens now, in the simulated room."
)
SHE_TYPES = "She types what Tangy should do, in her own words."
IT_ASKS = "Tangy asks before it does anything. Nothing happens until she says yes."
SHE_SAYS_YES = "She says yes, and Tangy does it. That is the first step of the demonstration."
SECOND = "So she goes on, one command and one yes at a time."
GOES_ON = "And on. People mark their cards, and make mistakes as people do."
SLIP = "Now a mistake. She types this, and says yes too soon."
NOTICED = "Tangy notices at once, and says what may be wrong. It learns nothing from a slip."
NOT_NOTICED = "That was not what she wanted."
TAKEN_BACK = "One key takes the step back, and the room is as it was."
NOW_RIGHT = "Now she gives the right command."
HELPED = "Tangy helps as she tells it to, and learns what each card looks like when it helps."
THE_REST = "The rest of the game, faster. Everything comes up that Tangy has to learn."
THINKS = "The game is over. Tangy learns from it."
BEGINS = "Now Tangy runs a game by itself, by what it has learnt."
PLAYS = "It calls, listens for who needs help, and goes there."
SAYS_IT = "Tangy can ask in several ways. Now it {}."
REFUSED = "{} does not do it. Tangy takes note, and does not press."
LATE = "{} takes so long that Tangy counts it as a no. It takes note, and does not press."
ANOTHER_WAY = "The next time it asks in another way: it {}."
COMPLIED = "That worked. Tangy will ask {} this way more often."
AT_ONCE = "{} does it. Tangy notes which way of asking worked."
NOW_A_FAULT = "Now a scarf falls over the camera in Tangy's head."
DIAGNOSED = "Tangy sees that something is wrong, finds out what, and says so."
ASKS_PEOPLE = "It can put this right itself: it asks the people at the table."
RECOVERED = "The scarf is gone, and the game goes on. What it cannot put right, it calls staff for."
PLAYS_ON = "It plays the game to its end."
BELIEVES_THIS = "This is what it knows by now of how to ask each person. It goes on learning."
YOUR_TURN = "Your turn. One guided game is enough for Tangy to learn from you."
YOUR_TURN_LINES = (
    "In the program: choose Guided on the first screen.",
    "In a shell: tangy teach --guided",
)


def learnt_caption(steps: int, shown: int, situations: int) -> str:
    """Say from how much Tangy has learnt, and for how many situations."""
    return (
        f"From {counted(steps, 'step')} Tangy has learnt what to do in {shown} of "
        f"{situations} situations. The share says how sure it is."
    )


def why_caption(times: int) -> str:
    """Say what a decision rests on."""
    steps = counted(times, "step")
    return f"Ask why, and Tangy names what it rests on: {steps} that {TEACHER} showed."


def belief_lines(beliefs: Mapping[str, Beliefs], name: Callable[[str], str]) -> list[str]:
    """Say of each person which ways of asking were tried, and how often they worked."""
    lines = []
    for person, profile in beliefs.items():
        tried = [
            f"{strategy} worked {belief.complied} of {counted(belief.trials, 'time')}"
            for strategy, belief in profile.items()
            if belief.trials
        ]
        lines.append(f"{name(person)}: {', '.join(tried) or 'was not asked for anything yet'}")
    return lines


def addressed(phrase: str, name: str) -> str:
    """Write a command for a person: "go to user", "User 1" -> "go to user 1"."""
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


def why_lines(activity: Activity, why: Why) -> list[str]:
    """Say why Tangy does something, and which steps that rests on."""
    steps = [shown_words(activity, shown, lambda id: "this game") for shown in why.rests_on]
    return [*why_words(activity, why), *steps]


def response_caption(
    response: Response, before: Sequence[Response], name: Callable[[str], str]
) -> str:
    """Say what a person did after a request, and what Tangy makes of it."""
    who = name(response.person)
    if not response.complied:
        return (LATE if response.followed else REFUSED).format(who)
    refused = any(not one.complied and one.person == response.person for one in before)
    return (COMPLIED if refused else AT_ONCE).format(who)


def scene_words(number: int) -> str:
    """Head a scene, from 1 on."""
    return f"Scene {number} of {len(SCENES)}: {SCENES[number - 1]}"


def typed_words(typed: str) -> str:
    """Say by lines what the teacher types."""
    return f"{TYPES}: {typed}"


def asked_words(question: str) -> str:
    """Say by lines what Tangy asks, and what is answered."""
    return f"{DID_YOU_SAY}{question}? {TEACHER}: {ANSWERS_YES}."


NOTHING_TO_SAY = "The scripted teacher has no command for this."
ASKS = f"{DID_YOU_SAY}{{}}?"
YES_KEYS = (("Y", "yes, do it"), ("N", "no, let me change it"))
"""How the question is drawn."""
HOLD, EARLIER, LATER = "hold", "back", "on"
"""What keys do."""
HELD, ENDED = "held", "the end"


def scene_note(number: int) -> str:
    """Say which scene is shown, from 1 on."""
    return f"scene {number} of {len(SCENES)}"


HELP = (
    "A story in six scenes. A teacher shows a game, Tangy learns and plays: all of it happens "
    "while you watch, in a data folder that is gone afterwards. {still} holds it, {left} and "
    "{right} go back and on, {back} leaves."
)
