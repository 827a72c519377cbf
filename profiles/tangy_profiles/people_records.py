"""The events about the people of the group, teachers and their microphones, and the log itself."""

from __future__ import annotations

from typing import Any

from tangy_profiles.codec import Count, Sparse
from tangy_profiles.game_world import GameWorld
from tangy_profiles.persuading import PersuasionConfig
from tangy_profiles.records import EventRecord, kind


@kind("events lost")
class EventsLost(EventRecord):
    """Events were gone when the log was opened: the first and the last of them.

    Where the last comes before the first, nobody can tell whether later ones were kept.
    """

    first: Count
    last: Count
    damaged: Sparse[bool] = False

    @property
    def unknown(self) -> bool:
        """Whether nobody can tell how many are gone, or whether any are."""
        return self.last < self.first


@kind("loss accepted")
class LossAccepted(EventRecord):
    """Staff have seen which events are gone, and need not be told again."""


@kind("renamed", about="person")
class Renamed(EventRecord):
    """A person has another name, which the log does not hold."""


@kind("person added", about="person")
class PersonAdded(EventRecord):
    """A person takes part from now on; a guest only in the session of that day."""

    guest: Sparse[bool] = False


@kind("person archived", about="person")
class PersonArchived(EventRecord):
    """A person is archived (`on`), or brought back; their data stays."""

    on: bool = True


@kind("forgotten", about="person")
class PersonForgotten(EventRecord):
    """A person's name was forgotten; it was erased from so many events."""

    texts: Sparse[Any] = 0


@kind("speech noted", about="person")
class SpeechNoted(EventRecord):
    """How to speak of or to a person was noted: what of it, but not how."""

    what: Sparse[Any] = ""


@kind("response", about="strategy")
class ResponseGiven(EventRecord):
    """A person's response to a request in a game, with its delay in s."""

    game: str | None = None
    followed: bool | None = None
    seconds: float | None = None


@kind("response awaited", about="strategy")
class ResponseAwaited(EventRecord):
    """A request was put to a person, and it is not known yet what they did."""

    game: str | None = None


@kind("feedback", about="strategy")
class FeedbackGiven(EventRecord):
    """Staff said what a person did: `of` the request with this uuid, or in no game."""

    of: str | None = None
    game: str | None = None
    world: GameWorld | None = None


@kind("void", about="strategy")
class ResponseVoided(EventRecord):
    """The event `of` (by uuid), of this person and strategy, counts no more."""

    of: str
    why: str = ""


@kind("taken back", about="person")
class ChangeTakenBack(EventRecord):
    """The event `of` (by uuid), of this person, does not hold; a void counts again."""

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
    """A person agreed that features of their face are kept, or did not, and how they said so."""

    yes: bool
    how: str = ""


@kind("face forgotten", about="person")
class FaceForgotten(EventRecord):
    """A person's face data was deleted, and their consent withdrawn."""


@kind("consent to recordings")
class RecordingConsent(EventRecord):
    """A teacher agreed to be recorded, or did not."""

    who: str
    yes: bool


@kind("recordings forgotten")
class RecordingsForgotten(EventRecord):
    """All recordings were deleted, and all consent taken back."""


@kind("microphone checked")
class MicrophoneChecked(EventRecord):
    """The result of a microphone check; odd settings count as none."""

    source: str
    settings: Any = None
    figures: Any = None


@kind("microphone check forgotten")
class MicrophoneForgotten(EventRecord):
    """A microphone is listened with as usual again."""

    source: str
