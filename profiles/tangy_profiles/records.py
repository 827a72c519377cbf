"""Kinds of events in the log: records with a name, a version, and a subject."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import FrozenInstanceError, dataclass, fields
from threading import Lock
from typing import Any, ClassVar, Literal, TypeAlias, TypeVar, dataclass_transform

from tangy_profiles import codec

About: TypeAlias = Literal["nobody", "person", "strategy"]
"""The subject of an event: none, a person, or a person and a strategy."""
Older: TypeAlias = Callable[[int, dict[str, Any]], dict[str, Any]]
"""Converts the body of an earlier version to the current one."""

VERSION_KEY = "v"
"""The key of a body's version; without it, the version is 1."""


_GENERATING = Lock()


class EventRecord:
    """The body of one kind of event, typed and frozen; declare one with `@kind`.

    Methods are implemented once here, and `__init__` is generated when it is first called: to
    generate all for each class took a tenth of the start-up time.
    """

    __slots__ = ()
    DECLARED: ClassVar[type]
    KIND: ClassVar[str]
    VERSION: ClassVar[int]
    ABOUT: ClassVar[About]
    OLDER: ClassVar[Older]

    def __init__(self, **values: Any) -> None:
        """Create the record of an event from the values of its fields."""
        made = type(self)
        with _GENERATING:
            if "__init__" not in made.__dict__:
                declared: Any = dataclass(frozen=True, kw_only=True, eq=False, repr=False)
                made.__init__ = declared(made.DECLARED).__init__  # type: ignore[method-assign]
        self.__init__(**values)  # type: ignore[misc]  # the one of this class from now on

    def __setattr__(self, name: str, value: Any) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def __setstate__(self, state: Any) -> None:
        for name, value in state[1].items():  # of the slots, when a copy is made
            object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._values() == EventRecord._values(other)

    def __hash__(self) -> int:
        return hash((type(self), *self._values().values()))

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value!r}" for name, value in self._values().items())
        return f"{type(self).__name__}({values})"

    def _values(self: Any) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def body(self) -> dict[str, Any]:
        """The body as the log stores it."""
        table: dict[str, Any] = codec.encode(self)
        return table if self.VERSION == 1 else {VERSION_KEY: self.VERSION, **table}


R = TypeVar("R", bound=EventRecord)


KINDS: dict[str, type[EventRecord]] = {}
"""The record class of each kind whose module is imported; `events.kinds` has all."""


class Unknown(EventRecord):
    """An event of an unknown kind: it only has a body."""

    __slots__ = ("KIND", "_body")
    _body: dict[str, Any]
    VERSION, ABOUT = 1, "nobody"

    def __init__(self, kind: str = "", body: Mapping[str, Any] | None = None) -> None:
        object.__setattr__(self, "KIND", kind)  # per instance
        object.__setattr__(self, "_body", dict(body or {}))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Unknown) and (self.KIND, self.body) == (other.KIND, other.body)

    __hash__ = None  # type: ignore[assignment]  # the body is a dict

    @property
    def body(self) -> dict[str, Any]:
        """The body as it is in the log."""
        return self._body


def _as_it_is(version: int, body: dict[str, Any]) -> dict[str, Any]:
    return body


@dataclass_transform(eq_default=False, frozen_default=True, kw_only_default=True)
def kind(
    name: str, *, about: About = "nobody", version: int = 1, older: Older = _as_it_is
) -> Callable[[type[R]], type[R]]:
    """Make a class the record of a kind of event.

    Args:
        name: the name of the kind in the log.
        about: the subject of its rows.
        version: incremented whenever an earlier body would be misread.
        older: converts bodies of earlier versions to this one.

    Raises:
        TypeError: the kind has a record already.
    """

    def make(cls: type[R]) -> type[R]:
        if name in KINDS:
            raise TypeError(f"{KINDS[name].__name__} is the record of {name!r} already.")
        declared = type(cls.__name__, (), {**cls.__dict__})
        made = dataclass(init=False, slots=True, kw_only=True, eq=False, repr=False)(cls)
        made.DECLARED = declared
        made.KIND, made.VERSION, made.ABOUT = name, version, about
        made.OLDER = staticmethod(older)
        KINDS[name] = made
        return made

    return make


def name_of(kind: type[EventRecord] | str) -> str:
    """Return the name of a kind of event in the log."""
    return kind if isinstance(kind, str) else kind.KIND
