"""The events about people, teachers, their microphones, and the log itself."""

from __future__ import annotations

from typing import Any

from tangy_profiles.codec import Count, Sparse
from tangy_profiles.game_world import GameWorld
from tangy_profiles.persuading import PersuasionConfig
from tangy_profiles.records import EventRecord, kind


@kind("events lost")
class EventsLost(EventRecord):
    """Events were missing when the log was opened: the first and the last one.

    If `last` is before `first`, it is unknown whether later ones existed.
    """

    first: Count
    last: Count
    damaged: Sparse[bool] = False

    @property
    def unknown(self) -> bool:
        """Whether it is unknown how many events are missing, if any."""
        return self.last < self.first


@kind("loss accepted")
class LossAccepted(EventRecord):
    """Staff accepted the losses, which are not reported again."""


@kind("renamed", about="person")
class Renamed(EventRecord):
    """A person got another name, which the log does not hold."""


@kind("person added", about="person")
class PersonAdded(EventRecord):
    """A person takes part from now on; a guest only on that day."""

    guest: Sparse[bool] = False


@kind("person archived", about="person")
class PersonArchived(EventRecord):
    """A person was archived (`on`), or restored; their data stays."""

    on: bool = True


@kind("forgotten", about="person")
class PersonForgotten(EventRecord):
    """A person's name was forgotten; it was erased from this many events."""

    texts: Sparse[Any] = 0


@kind("speech noted", about="person")
class SpeechNoted(EventRecord):
    """A voice or pronunciation setting of a person changed; the value is not logged."""

    what: Sparse[Any] = ""


@kind("response", about="strategy")
class ResponseGiven(EventRecord):
    """A person's response to a request in a game, with its delay in s."""

    game: str | None = None
    followed: bool | None = None
    seconds: float | None = None


@kind("response awaited", about="strategy")
class ResponseAwaited(EventRecord):
    """A request was made, and the person's response is not known yet."""

    game: str | None = None


@kind("feedback", about="strategy")
class FeedbackGiven(EventRecord):
    """Staff reported a response: to the request `of` (uuid), or outside any game."""

    of: str | None = None
    game: str | None = None
    world: GameWorld | None = None


@kind("void", about="strategy")
class ResponseVoided(EventRecord):
    """The response `of` (uuid), of this person and strategy, no longer counts."""

    of: str
    why: str = ""


@kind("taken back", about="person")
class ChangeTakenBack(EventRecord):
    """The event `of` (uuid), of this person, was undone; an undone void counts again."""

    of: str
    what: str = ""


@kind("strategy switched", about="strategy")
class StrategySwitched(EventRecord):
    """A strategy was switched on or off for a person."""

    on: bool


@kind("method chosen", about="person")
class MethodChosen(EventRecord):
    """The method for a person was chosen; None: the activity's."""

    chosen: PersuasionConfig | None


@kind("consent to face", about="person")
class FaceConsent(EventRecord):
    """A person agreed or refused to have face features stored, and how they said so."""

    yes: bool
    how: str = ""


@kind("face forgotten", about="person")
class FaceForgotten(EventRecord):
    """A person's face data was deleted, and their consent withdrawn."""


@kind("consent to recordings")
class RecordingConsent(EventRecord):
    """A teacher agreed or refused to be recorded."""

    who: str
    yes: bool


@kind("recordings forgotten")
class RecordingsForgotten(EventRecord):
    """All recordings were deleted, and all consent withdrawn."""


@kind("microphone checked")
class MicrophoneChecked(EventRecord):
    """The result of a microphone check; invalid settings count as none.

    `teacher` is who spoke; "" if that is not known.
    """

    source: str
    settings: Any = None
    figures: Any = None
    teacher: str = ""


@kind("microphone check forgotten")
class MicrophoneForgotten(EventRecord):
    """The settings of a microphone were reset to the defaults."""

    source: str
