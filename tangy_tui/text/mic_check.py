"""Words for a microphone check: loudness of the voice, and understood words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any, assert_never

if TYPE_CHECKING:
    from tangy_hw.audio.meter import SoundTrouble
    from tangy_tui.speech.calibration import CalibrationPrompt
    from tangy_tui.speech.loudness import SoundAdvice
    from tangy_tui.speech.microphone_check import CheckNews, CheckResult, CheckStep


def trouble_words(trouble: SoundTrouble) -> str:
    """Describe a fault of the sound in one line."""
    match trouble.kind:
        case "nothing comes":
            return f"The microphone has sent nothing for {trouble.seconds} s: is it connected?"
        case "no sound":
            return (
                f"No sound for {trouble.seconds} s: is the microphone plugged in? It may be muted."
            )
        case "too loud":
            return "Too loud: move a little away from the microphone, or turn it down."
        case "very quiet":
            return "Very quiet: move closer to the microphone, or turn it up."
        case forgotten:
            assert_never(forgotten)


LOUD_ENOUGH = "The sound is loud enough."


def news_words(news: CheckNews) -> str:
    """Tell the next step of a check, or the problem with the sound."""
    from tangy_hw.audio.meter import SoundTrouble
    from tangy_tui.speech.microphone_check import SourceNews

    if isinstance(news, SourceNews):
        return news.words
    return trouble_words(news) if isinstance(news, SoundTrouble) else _step_words(news)


def _step_words(step: CheckStep) -> str:
    match step.kind:
        case "recording holds":
            return f"{step.about} should hold these, with a second of quiet between:"
        case "be quiet":
            return f"Please be quiet for {step.number} seconds."
        case "say all":
            return f"Now say each of these, as you would to Tangy ({step.number} in all)."
        case "say":
            return f"{step.number}. {step.about}"
        case "say again":
            return f"I heard nothing. Please say it again: {step.about}"
        case "goes on by itself":
            return "The check goes on as soon as Tangy hears something; Ctrl+C ends it."
        case "works out":
            return "Thank you. One moment."
        case forgotten:
            assert_never(forgotten)


def numbered(asked: Sequence[CalibrationPrompt]) -> list[str]:
    """Return the sentences to say, a line each."""
    return [f"{number}. {one.text}" for number, one in enumerate(asked, 1)]


def advice_words(advice: SoundAdvice) -> str:
    """Tell what to change about the sound."""
    match advice:
        case "turn down":
            return "Some of it was too loud: move a little away, or turn the microphone down."
        case "turn up":
            return "Your voice is very quiet: move closer, or turn the microphone up."
        case "room as loud":
            return "The room is nearly as loud as your voice: a headset helps most."
        case "room rather loud":
            return "The room is rather loud: move closer to the microphone, or use a headset."
        case "speak soon":
            return "Tangy did not hear some phrases: speak as soon as you see one, then pause."
        case "without a pause":
            return "The sound is good. Say each phrase as you see it, without a pause in it."
        case forgotten:
            assert_never(forgotten)


def reason_words(checked: CheckResult) -> str:
    """Tell why the result of a check is not good enough to be stored; "" if it is."""
    figures = checked.chosen.figures
    known = figures.understood + figures.offered
    if checked.parted:
        return ""
    if not figures.kept:
        few = f"only {known}" if known else "none"
        were = "was" if known == 1 else "were"
        why = f"{few} of {figures.commands} commands {were} understood"
    elif not figures.others:
        why = "Tangy heard none of the other sentences"
    else:
        were = "was" if figures.taken == 1 else "were"
        why = f"{figures.taken} of {figures.others} other sentences {were} taken for a command"
    return f"Nothing was stored: {why}."


def checked_document(checked: CheckResult) -> dict[str, Any]:
    """Return the result of a check as a JSON document."""
    return {
        "room_db": round(checked.room, 1) if checked.room_heard else None,
        "voice_db": round(checked.voice, 1),
        "heard": [
            {"asked": asked.text, "command": asked.meant is not None, "heard": words}
            for asked, words in checked.heard
        ],
        "settings": asdict(checked.chosen.settings),
        "figures": asdict(checked.chosen.figures),
        "usual": asdict(checked.chosen.usual),
        "parted": checked.parted,
        "reason": reason_words(checked) or None,
        "advice": [advice_words(one) for one in checked.advice],
    }


def checked_lines(checked: CheckResult, mic: str) -> list[str]:
    """Describe the result of a microphone check."""
    return [
        _loudness(checked),
        *_misheard(checked),
        _understood(checked),
        *_settings(checked, mic),
        *map(advice_words, checked.advice),
    ]


def _loudness(checked: CheckResult) -> str:
    from tangy_tui.speech.loudness import CLEAR, FAIR

    if not checked.room_heard:
        return (
            "The recording has no room noise at all (digital silence), so Tangy cannot measure how "
            "much louder your voice is."
        )
    above = checked.voice - checked.room
    how = "clear" if above >= CLEAR else "enough" if above >= FAIR else "too little"
    return f"Your voice is {max(0.0, above):.0f} dB louder than the room: {how}."


def _misheard(checked: CheckResult) -> list[str]:
    return [
        f"  asked for {asked.text!r}, heard {words!r}" if words is not None
        else f"  asked for {asked.text!r}, heard nothing"
        for asked, words in checked.heard
        if asked.meant and words != asked.text
    ]  # fmt: skip


def _understood(checked: CheckResult) -> str:
    figures = checked.chosen.figures
    offered = f", {figures.offered} offered as a choice" if figures.offered else ""
    taken = (
        f"{figures.taken} of {figures.others} other sentences taken for one"
        if figures.others
        else "no other sentence was heard"
    )
    return f"{figures.understood} of {figures.commands} commands understood{offered}; {taken}."


def _settings(checked: CheckResult, mic: str) -> list[str]:
    from tangy_tui.speech.evidence import USUAL

    usual = checked.chosen.usual
    if not checked.parted:
        return []
    settings = checked.chosen.settings
    learnt = ["Your voice differs from those that Tangy knows, so it has learnt yours."]
    learnt = learnt if settings.voice else []
    if replace(settings, voice="") == USUAL:
        return [f"The usual settings suit this microphone. They are stored for {mic}.", *learnt]
    return [
        f"With the usual settings: {usual.understood} understood, {usual.offered} offered, "
        f"{usual.taken} taken for one.",
        f"Other settings suit this microphone better. They are stored for {mic}.",
        *learnt,
    ]
