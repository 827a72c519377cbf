"""What is said of a microphone that was checked: how loud the voice is, what was understood."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_tui.speech.microphone_check import CheckResult

LOUD_ENOUGH = "The sound is loud enough."


def checked_lines(checked: CheckResult, mic: str) -> list[str]:
    """Say what came of the check of a microphone."""
    return [
        _loudness(checked),
        *_misheard(checked),
        _understood(checked),
        *_settings(checked, mic),
        *checked.advice,
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
    if checked.chosen.settings == USUAL:
        return [f"The usual settings suit this microphone. They are stored for {mic}."]
    return [
        f"With the usual settings: {usual.understood} understood, {usual.offered} offered, "
        f"{usual.taken} taken for one.",
        f"Other settings suit this microphone better. They are stored for {mic}.",
    ]
