"""A person's preferred speech rate and voice."""

from __future__ import annotations

import re
from dataclasses import dataclass

from tangy_profiles.errors import ProfileError
from tangy_profiles.reading import plain

SLOWEST, FASTEST = 80, 260  # words a minute
NAME = re.compile(r"[A-Za-z][A-Za-z0-9-]{0,39}(\+[A-Za-z0-9][A-Za-z0-9_-]{0,39})?", re.ASCII)


@dataclass(frozen=True, slots=True)
class VoicePreference:
    """A rate (words per minute, 80 to 260) and a voice; None: the default.

    A voice is named as in the synthesiser: a language and, after a plus, a variant of it (`en-us`,
    `en-gb+f3`). Whether it is installed is only known when it speaks.

    Raises:
        ProfileError: the rate is out of range, or the name of the voice is invalid.
    """

    rate: int | None = None
    voice: str | None = None

    def __post_init__(self) -> None:
        rate, voice = self.rate, self.voice
        if rate is not None and (
            isinstance(rate, bool) or not isinstance(rate, int) or not SLOWEST <= rate <= FASTEST
        ):
            raise ProfileError(
                f"A rate of {plain(str(rate)[:20])} cannot be spoken: "
                f"choose from {SLOWEST} to {FASTEST} words a minute."
            )
        if voice is not None and not (isinstance(voice, str) and NAME.fullmatch(voice)):
            raise ProfileError(
                f"{plain(str(voice)[:60])!r} cannot be a voice: "
                "name one such as en-us or en-gb+f3 (tangy say --voices lists them)."
            )

    def over(self, other: VoicePreference) -> VoicePreference:
        """Return this preference, with missing values taken from the other one."""
        return VoicePreference(
            other.rate if self.rate is None else self.rate,
            other.voice if self.voice is None else self.voice,
        )
