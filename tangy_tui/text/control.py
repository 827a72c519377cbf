"""Replies to what staff do in a game."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, assert_never

from tangy_profiles.state import FRONT
from tangy_tui.app.game_commands import CallAgain, ClaimCard, ComesIn, GoesAway, TakeBackCall
from tangy_tui.text import joining
from tangy_tui.text.decisions import shown_here
from tangy_tui.text.numbers import listed
from tangy_tui.text.planned_time import SIMULATED_TIME, planned_words
from tangy_tui.text.player_reports import player_report_words

if TYPE_CHECKING:
    from tangy_tui.app.claim_controls import ClaimNow
    from tangy_tui.app.game_commands import Autonomy, GameCommand
    from tangy_tui.app.robot_controls import PersonWait
    from tangy_tui.app.staff_notes import NoteKind, Proposal, StaffNote

HELD = {
    "slow": "Something is near: Tangy drives slowly.",
    "stands": "Something is close: Tangy stands. Turn, or back away.",
    "overridden": (
        "Tangy moves at a crawl and stops for nothing. Watch it, and release the key in time."
    ),
}
"""Why the robot does not drive as told."""

WAIT_EXPLANATIONS = {
    "walking": "I let you pass.",
    "standing": "May I pass, please?",
    "object": "May I pass, please?",  # it may be a person after all
}
"""The robot's words to people for whom it waits on its way."""

NOT_ACCEPTABLE = "Tangy is asking nothing that you could call all right."

ACCEPT = "Is all well, and shall Tangy go on?"

SPOKEN_SECONDS = 12.0
"""Calls closer together (in s) may wait for Tangy's voice: a call took 8 to 10 s on the bench."""

TAKE_CALL_BACK = "Take the last call back"
"""The name of undo in a live game."""


WAITS = {
    "walking": "It lets somebody pass.",
    "standing": "It waits: somebody is in the way.",
    "object": "It waits: something is in the way, or somebody.",
}
"""Why the robot waits on its way."""

WAITS_FOR_YOU = "waits for your answer"
"""The status while Tangy's question to staff is open."""
FINDS_ITS_PLACE = "finds its place"
WAITS_SHORT = {
    "walking": "lets somebody pass",
    "standing": "somebody is in the way",
    "object": "something is in the way",
}
"""The same, shorter, for a line with other facts."""


def autonomy_words(level: Autonomy) -> str:
    """Describe a level of autonomy."""
    match level:
        case "alone":
            return "does everything by itself"
        case "unsure":
            return "asks when it is less sure"
        case "each":
            return "asks before everything it does"
        case forgotten:
            assert_never(forgotten)


def stopped_words(by: str) -> str:
    """Tell that the robot is stopped, and by which onlooker; by="": staff at this console."""
    return f"{by[0].upper()}{by[1:]} stopped Tangy" if by else "Tangy was stopped"


def going_words(going: str, name: Callable[[str], str], lets: str = "") -> str:
    """Tell the robot's destination, and for whom it waits; "" if it is not driving."""
    if not going:
        return ""
    waits = f" {words}" if (words := WAITS.get(lets)) else ""
    return f"Tangy drives to {'the front' if going == FRONT else name(going)}.{waits}"


def person_wait_words(waits: PersonWait | None, name: Callable[[str], str]) -> str:
    """Tell for whom the robot waits, and for how long at most; "" if for nobody."""
    if waits is None:
        return ""
    who, most = name(waits.person) if waits.person else "everybody", f"up to {waits.seconds} s"
    match waits.kind:
        case "response":
            return f"Tangy waits for {who} to respond, {most}."
        case "sign":
            return f"Tangy waits until {who} has put the sign down, {most}."
        case "act":
            return f"Tangy waits for {who}, {most}."
        case forgotten:
            assert_never(forgotten)


def short_going_words(going: str, name: Callable[[str], str], lets: str = "") -> str:
    """Tell the same in short, for the header."""
    if not going:
        return ""
    return WAITS_SHORT.get(lets) or f"drives to {'the front' if going == FRONT else name(going)}"


def proposal_words(proposal: Proposal, name: Callable[[str], str], key: str = "Y") -> str:
    """Ask staff to approve the next behaviour; `key` says yes."""
    whom = f" ({name(proposal.target)})" if proposal.target else ""
    because = shown_here(proposal.seen, proposal.share)
    return f"Next: {proposal.behaviour}{whom}, {because}. {key}: do it. N: tell Tangy what else."


BY_KEYS: dict[NoteKind, str] = {
    "paused": "Paused: {pause} goes on.",
    "stopped": "STOP. Press {pause} to go on.",
    "stopped first": "Not now: {stopped}. Press {pause} to go on first.",
    "asks first": "Tangy is asking: answer first ({command} to type).",
    "still halted": "A fault still halts Tangy: do what the dialog says.",
}
"""Other words for staff who have keys, and type only to answer."""


def noted_words(noted: StaffNote, name: Callable[[str], str], *, by_keys: bool = False) -> str:
    """Describe the result of a command in a sentence."""
    about = noted.about
    if by_keys and (words := BY_KEYS.get(noted.kind)):
        return words.replace("{stopped}", stopped_words(noted.words))
    match noted.kind:
        case "paused":
            return "Paused: Tangy does nothing more after this. Type: go on."
        case "goes on":
            return "Tangy goes on."
        case "one step":
            return "Tangy does one thing."
        case "stopped":
            return "STOP: Tangy stands still. Type: go on."
        case "takes over":
            return "When this is done, you say what Tangy does next."
        case "given back":
            return "Tangy goes on by itself."
        case "autonomy":
            level = next(one for one in ("alone", "unsure", "each") if one == about)
            return f"Tangy {autonomy_words(level)}."
        case "call again":
            return f"Tangy calls {about} again."
        case "calls again soon":
            return waits_words(CallAgain(), name)
        case "call taken back":
            return f"{about} counts as not called, and comes again later."
        case "pace":
            spoken = ", or as soon as it has spoken" if float(about) < SPOKEN_SECONDS else ""
            return f"Tangy calls every {about} seconds{spoken}."
        case "time planned":
            return planned_words(about, noted.words)
        case "not in a simulation":
            return SIMULATED_TIME
        case "claim kept":
            return f"Card {about}: Tangy checks it as soon as the game goes on."
        case "claim right":
            return f"{_whose_card(noted, name)} wins. Tangy tells everybody: {noted.words}"
        case "claim late":
            late = "wins, too, but another card was first, and there is one winner"
            return f"{_whose_card(noted, name)} {late}. Tangy tells everybody: {noted.words}"
        case "claim wrong":
            then = f"Tangy tells everybody: {noted.words}" if noted.words else CELEBRATES_FIRST
            return f"{_whose_card(noted, name)} does not win yet. {then}"
        case "claim with others":
            return f"{_whose_card(noted, name)} does not win yet. {CHECKS_OTHERS}"
        case "claims told":
            return f"Tangy tells everybody: {noted.words}"
        case "card given":
            before = "".join(f" It counted as {name(one)}'s until now." for one in noted.people)
            had = f" {name(about)} had card {noted.before} before." if noted.before else ""
            return f"{name(about)} has card {noted.words}.{had}{before}"
        case "patterns":
            already = f" It is played for {noted.words} already." if noted.words else ""
            return f"Played for: {about}.{already}"
        case "several":
            return "Everybody who has the pattern at the same call wins."
        case "one winner":
            return "Only one person wins."
        case "visits":
            return "Tangy also visits people who do not ask."
        case "no visits":
            return "Tangy visits only people who ask."
        case "comes":
            return f"{name(about)} is here."
        case "joins":
            return f"{name(about)} joins: {noted.words}. Tangy sets itself up for one more person."
        case "no name" | "nobody joins" | "teams play" | "not at front" | "joining" as why:
            return joining.REFUSED[why]
        case "known already":
            return joining.known_words(name(about))
        case "which person":
            return joining.which_words(noted.words, [*map(name, noted.people)])
        case "most people":
            return joining.full_words(about)
        case "no seat there":
            return joining.no_seat_there_words(noted.words, about)
        case "no seat":
            return joining.no_seat_words(noted.words, about)
        case "goes":
            return f"{name(about)} has left."
        case "here before":
            return f"{name(about)} is here already."
        case "away before":
            return f"{name(about)} has left already."
        case "is away":
            who = name(about)
            return (
                f"Tangy does not go to {who}, who is not here. If {who} is back, type: here {who}."
            )
        case "last one":
            return f"{name(about)} is the only one left: end the game instead."
        case "not playing":
            return f"{name(about)} is not among the people of this game."
        case "no cards":
            return "This activity has no cards and no pace."
        case "no such card":
            return f"There is no card {about} in this game.{_cards(noted)}"
        case "whose card":
            return (
                f"Tangy does not know whose card {about} is. Claim it again, with their name."
                f"{_cards(noted)}"
            )
        case "which card":
            who = name(about)
            return f"Tangy does not know {who}'s card. Add its number: check 17 {who}."
        case "asked for":
            return f"You asked for {name(about)}. Tangy goes there in turn."
        case "asked to help":
            return f"You asked for {name(about)}. Tangy helps in turn."
        case "asked already" if noted.words:
            return f"Tangy is with {name(about)} already, or on its way."
        case "asked already":
            before = listed([name(one) for one in noted.people])
            where = f"after {before}" if before else "and is the first of those who wait"
            return f"{name(about)} waits for Tangy already, {where}."
        case (
            "told"
            | "told right"
            | "told wrong"
            | "told unclear"
            | "not told"
            | "not asked"
            | "whose"
        ):
            return player_report_words(noted, name(about) if about else "")
        case "voided":
            return f"{name(about)}'s last response does not count any more."
        case "driven":
            return HELD.get(about, stands_words(about) if about else "Tangy has driven.")
        case "ended":
            return "You ended the game. Tangy stands still."
        case "seen before":
            return (
                "You have seen it already. Type expert to see whom to call, or clear to let "
                "Tangy go on."
            )
        case "stopped first":
            return f"Not now: {stopped_words(noted.words)}. Type first: go on."
        case "asks first":
            return f"Tangy is asking: answer first{', or type: give back' if about else ''}."
        case "halted first":
            return "Not now: a fault halts Tangy. Type: what."
        case "still halted":
            return (
                f"A fault still halts Tangy: {about}. "
                "When all is well again, type: seen, and then: clear."
            )
        case "ends":
            return "Tangy does not do that any more: you ended the game."
        case "no game":
            return "There is no game now."
        case "no robot":
            return "That needs a robot, or the bench: this game is simulated."
        case "nothing to tell":
            return "In this activity Tangy itself sees what people do."
        case "nothing called":
            return "No number was called yet."
        case "not called":
            return f"{about} was not called."
        case "nothing to void":
            return f"There is no response of {name(about)} in this game that counts."
        case "not halted":
            return "No fault halts Tangy."
        case "reached":
            return "Noted: you have reached the expert."
        case "nobody named":
            return "No expert is named in the robot's file."
        case "not seen yet":
            return "Say first that you have seen it: seen."
        case "nothing asked":
            return "Tangy asks nothing now."
        case "not acceptable":
            return NOT_ACCEPTABLE
        case "cannot":
            return about
        case forgotten:
            assert_never(forgotten)


DRIVE_TITLE = "Drive by keys"
DRIVE_HELP = (
    "↑ and ↓ drive, ← and → turn, as long as you hold the key. Space stops; esc ends.\n\n"
    "Tangy slows down near people and things that its laser scanner sees, and stops before it "
    "reaches them. Then turn, or back away. It cannot see behind itself or over its scanner: look "
    "there yourself. It backs up slowly. While the scanner is silent, Tangy does not drive.\n\n"
    "If it stands although there is room, Shift+↑ and Shift+↓ move it at a crawl, whatever is near."
)


def stands_words(why: str) -> str:
    """Tell why the robot does not drive."""
    return f"Tangy stands still: {why}."


def _cards(noted: StaffNote) -> str:
    return f" Cards in play: {noted.words}." if noted.words else ""


def _whose_card(noted: StaffNote, name: Callable[[str], str]) -> str:
    return f"Card {noted.about}{''.join(f' ({name(one)})' for one in noted.people)}"


NOT_WHILE_WORKING = "Not now: Tangy is busy. {pause} pauses it, {stop} stops it."
WHO_NEEDS_HELP = "Who needs help?"
BECAUSE_DETAIL = "It is {}. After this, {{autonomy}} turns the questions off."


CELEBRATES_FIRST = "Tangy celebrates the winner first."
CHECKS_OTHERS = "Tangy checks the other cards, then tells everybody."
"""Why Tangy does not tell everybody that a card does not win."""


def claimed_words(claimed: ClaimNow, name: Callable[[str], str], calling: str = "") -> str:
    """Tell the result of a claim while it is news, and what Tangy does about it.

    `calling` is the label of the number that Tangy is just saying.
    """
    card = f"Card {claimed.card}" + (f" ({name(claimed.person)})" if claimed.person else "")
    told = claimed.told is not None
    match claimed.kind:
        case None:
            return f"{card}: Tangy checks it as soon as it has called {calling or 'the number'}."
        case "claim right":
            done = f"{card} wins." + (" Tangy goes there next." if told else "")
        case "claim late":
            done = f"{card} wins, too, but another card was first."
        case "claim wrong":
            done = f"{card} does not win yet."
        case forgotten:
            assert_never(forgotten)
    if claimed.later:
        return done if told else f"{done} {CELEBRATES_FIRST}"
    if claimed.resumed and not told:
        return f"{done} Tangy tells everybody as soon as the game goes on."
    return done if told else f"{done} Tangy finishes this, then tells everybody."


def waits_words(command: GameCommand, name: Callable[[str], str]) -> str:
    """Tell that a command waits until Tangy has finished, and what comes of it then."""
    match command:
        case GoesAway(person):
            then = "and then stays away from that seat"
            return f"{name(person)} has left: Tangy finishes this, {then}."
        case ComesIn(person):
            return f"{name(person)} is here. Tangy finishes this first."
        case ClaimCard(card=card) if card:
            then = f"checks card {card}"
        case TakeBackCall(label) if label:
            then = f"takes {label} back"
        case CallAgain():
            then = "calls the last number again"
        case _:
            then = "does what you said"
    return f"One moment: Tangy finishes this, then {then}."


def confirmed_words(proposal: Proposal, name: Callable[[str], str]) -> tuple[str, str]:
    """Ask staff to approve the next behaviour, with Tangy's certainty."""
    whom = f" ({name(proposal.target)})" if proposal.target else ""
    return f"Next: {proposal.behaviour}{whom}?", BECAUSE_DETAIL.format(
        shown_here(proposal.seen, proposal.share)
    )
