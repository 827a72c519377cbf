"""The stored settings of microphones, from their last checks."""

from __future__ import annotations

import hashlib
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from tangy_profiles.activity import LISTENING
from tangy_profiles.errors import TangyError
from tangy_profiles.people_records import MicrophoneChecked, MicrophoneForgotten
from tangy_profiles.reading import nearest, plain
from tangy_profiles.store import Store
from tangy_tui.speech.calibration import SHIFTS, CalibrationResult
from tangy_tui.speech.evidence import USUAL, EvidenceSettings
from tangy_tui.speech.other_voices import is_voice


def microphone(source: str) -> str:
    """Return the name under which the settings of a source are stored.

    Paths are stored as a digest, because they may contain names of people.
    """
    kind, _, rest = source.partition(":")
    if source in ("-", "arecord", "socket") or (kind == "arecord" and rest):
        return source
    path = Path(rest if kind == "socket" and rest else source).absolute()
    digest = hashlib.sha256(str(path).encode(errors="replace")).hexdigest()[:12]
    return f"{'socket' if kind == 'socket' else 'file'} {digest}"


def keep(store: Store, source: str, chosen: CalibrationResult, teacher: str = "") -> None:
    """Store the calibration of a microphone, and the voice of the teacher who spoke."""
    settings = asdict(chosen.settings)
    del settings["mode"]
    figures = asdict(chosen.figures)
    store.append(
        MicrophoneChecked(
            source=microphone(source), settings=settings, figures=figures, teacher=teacher
        )
    )


def forget(store: Store, source: str) -> bool:
    """Reset a microphone to the default settings; return whether it had others."""
    if _stored(store, source) is None:
        return False
    store.append(MicrophoneForgotten(source=microphone(source)))
    return True


def is_checked(store: Store, source: str) -> bool:
    """Return whether a microphone has settings of its own."""
    return _stored(store, source) is not None


def settings_for(
    store: Store, source: str | None, mode: str = "tiers", teacher: str = ""
) -> EvidenceSettings:
    """Return the settings of a microphone: those of its last check, or else the defaults.

    Args:
        store: the log with the checks.
        source: its name, as in `tangy_hw.audio.sources`; None for no particular one.
        mode: one of LISTENING.
        teacher: who speaks: the voice is that of their last check with this microphone.

    Raises:
        TangyError: there is no such mode.
    """
    if mode not in LISTENING:
        raise TangyError(plain(f"--mode {mode[:40]!r} is not known; {nearest(mode, LISTENING)}"))
    stored = None if source is None else _stored(store, source, teacher)
    return replace(stored or USUAL, mode=mode)


def _stored(store: Store, source: str, teacher: str = "") -> EvidenceSettings | None:
    found: EvidenceSettings | None = None
    name, voice = microphone(source), ""
    for event in store.events(MicrophoneChecked, MicrophoneForgotten):
        match event.record:
            case MicrophoneChecked(source=of, settings=settings, teacher=who) if of == name:
                found = _read(settings)
                if who == teacher:
                    voice = found.voice if found else ""
            case MicrophoneForgotten(source=of) if of == name:
                found, voice = None, ""
    return found and replace(found, voice=voice)


def _read(written: Any) -> EvidenceSettings | None:
    """Read stored settings; return None if they are invalid."""
    try:
        settings = replace(USUAL, garbage=float(written["garbage"]), shift=float(written["shift"]))
        voice = str(written.get("voice", ""))
    except (KeyError, TypeError, ValueError):
        return None
    fits = 0 < settings.garbage <= 10 and SHIFTS[0] <= settings.shift <= SHIFTS[-1]
    return replace(settings, voice=voice if is_voice(voice) else "") if fits else None
