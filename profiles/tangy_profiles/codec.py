"""Typed records and the JSON that stands for them: one codec, made from the fields of a class.

A dataclass is a table, a plain named tuple a row, a tuple a list; `Annotated` says what else holds
of a value. What does not fit is refused, and the reason is the tail of a sentence ("has 'step'
that is not a count"), which staff read in `tangy store check`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Literal,
    NamedTuple,
    TypeVar,
    Union,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

from tangy_profiles.reading import nearest

T = TypeVar("T")
Reader = Callable[[Any], Any]
"""Returns what a JSON value stands for, or refuses it."""

LARGEST = 1e12
"""No measure in a log is larger: s, counts, probabilities, what devices say."""


class Unreadable(ValueError):
    """A value is not what it should be; the text is the tail of a sentence ("is not text")."""


class Key(NamedTuple):
    """The key under which a field stands, where it is not called as the field is."""

    key: str


class By(NamedTuple):
    """What reads a value in place of its type."""

    reader: Reader


class _Place(NamedTuple):
    """How a field stands in the table of its record."""

    flat: bool = False
    sparse: bool = False
    unlogged: bool = False


Flat = Annotated[T, _Place(flat=True)]
"""A record whose keys stand among those of the record that has it."""
Sparse = Annotated[T, _Place(sparse=True)]
"""A value whose key is left out where it is the default."""
Unlogged = Annotated[T, _Place(unlogged=True)]
"""A value that is known from elsewhere, and has no key."""


def at_least(least: int) -> Reader:
    """Let whole numbers pass from `least` on, and texts and lists of at least that length."""

    def check(value: Any) -> Any:
        if isinstance(value, int):
            if not least <= value <= LARGEST:
                raise Unreadable("is not a count")
        elif len(value) < least:
            raise Unreadable("is too short")
        return value

    return check


def measurement(value: Any) -> Any:
    """Let pass what a device measures: any number that is one, yes or no, or a word."""
    if isinstance(value, str | bool):
        return value
    if isinstance(value, int | float) and abs(value) <= sys.float_info.max:
        return value
    raise Unreadable("is not a measurement")


Count = Annotated[int, at_least(0)]
"""A whole number from 0 on."""


def read(kind: type[T], value: Any) -> T:
    """Return what a value of a JSON document stands for.

    Raises:
        Unreadable: it is not of that kind; says where and why.
    """
    return cast(T, reader(cast(Any, kind))(value))


def written(value: Any) -> Any:
    """Return the JSON that stands for a record, or for a value within one."""
    if isinstance(value, str | int | float | NoneType):
        return value
    if isinstance(value, Mapping):
        return {key: written(one) for key, one in value.items()}
    if isinstance(value, frozenset):
        return sorted(value)
    if not _is_record(type(value)):
        return [written(one) for one in value]
    table: dict[str, Any] = {}
    for field in fields_of(cast(Any, type(value))):
        one = getattr(value, field.name)
        if field.place.flat:
            table |= written(one)
        elif not (field.place.sparse and one == field.default):
            table[field.key] = written(one)
    told = derived(type(value))
    return table | {key: written(getattr(value, name)) for key, name in told.items()}


def keys_of(kind: Any) -> frozenset[str]:
    """Return the keys that the table of a record may have."""
    found: set[str] = set(derived(kind))
    for field in fields_of(kind):
        if field.place.flat:
            found.update(*map(keys_of, get_args(field.hint) or [field.hint]))
        else:
            found.add(field.key)
    return frozenset(found)


def derived(kind: Any) -> Mapping[str, str]:
    """Return the keys of a record that hold its properties: they are written, and never read."""
    found: Mapping[str, str] = getattr(kind, "DERIVED", {})
    return found


def _is_record(kind: Any) -> bool:
    """Say whether a table stands for it: a dataclass, or a named tuple with a `glance`."""
    return is_dataclass(kind) or hasattr(kind, "glance")


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a record: its key, what it holds, and what it is where the key is missing."""

    name: str
    key: str
    hint: Any
    checks: tuple[Reader, ...]
    place: _Place
    default: Any


@cache
def fields_of(kind: Any) -> tuple[Field, ...]:
    """Return the fields of a record that its table has."""
    tuples = dict.fromkeys(getattr(kind, "_fields", ()), MISSING)  # need each of their keys
    defaults = tuples or {one.name: one.default for one in fields(kind)}
    hints = get_type_hints(kind, include_extras=True)
    found = []
    for name in defaults:
        hint, marks = _unpacked(hints[name])
        key = next((mark.key for mark in marks if isinstance(mark, Key)), name)
        place = next((mark for mark in marks if isinstance(mark, _Place)), _Place())
        checks = tuple(mark for mark in marks if not isinstance(mark, Key | _Place))
        if not place.unlogged:
            found.append(Field(name, key, hint, checks, place, defaults[name]))
    return tuple(found)


def _unpacked(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return a type, and what `Annotated` says beside."""
    if get_origin(hint) is Annotated:
        return hint.__origin__, hint.__metadata__
    return hint, ()


# ------------------------------------------------------------------------- readers of values


@cache
def reader(hint: Any) -> Reader:
    """Return what reads values of a type.

    Raises:
        TypeError: no value of a JSON document stands for that type.
    """
    plain, checks = _unpacked(hint)
    if checks:
        own = next((mark.reader for mark in checks if isinstance(mark, By)), None)
        others = tuple(mark for mark in checks if not isinstance(mark, By))
        return _checked(own or reader(plain), others)
    origin, args = get_origin(hint), get_args(hint)
    if hint in _PLAIN:
        return _PLAIN[hint]
    if origin is Literal:
        return one_of(*args)
    if origin in (Union, UnionType):
        return _union(args)
    if origin is tuple:
        return _list_of(args[0], tuple) if args[1:] == (...,) else _row_of(args, _tupled)
    if origin is frozenset:
        return _list_of(args[0], frozenset)
    if origin in (dict, Mapping):
        return _table_of(args[1])
    if _is_record(hint):
        return _record(hint)
    if hasattr(hint, "_fields"):
        return _row_of(tuple(get_type_hints(hint, include_extras=True).values()), hint)
    raise TypeError(f"The codec reads no {hint!r}: say in {__name__} how.")


def _checked(inner: Reader, checks: Sequence[Reader]) -> Reader:
    def take(value: Any) -> Any:
        value = inner(value)
        for check in checks:
            value = check(value)
        return value

    return take


def _text(value: Any) -> Any:
    if not isinstance(value, str):
        raise Unreadable("is not text")
    return value


def _whole(value: Any) -> Any:
    if not isinstance(value, int) or isinstance(value, bool):
        raise Unreadable("is not a whole number")
    return value


def _number(value: Any) -> Any:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise Unreadable("is not a number")
    if not abs(value) <= LARGEST:  # what is not a number neither
        raise Unreadable("is beyond all measure")
    return value


def _yes_or_no(value: Any) -> Any:
    if not isinstance(value, bool):
        raise Unreadable("is neither yes nor no")
    return value


_PLAIN: Mapping[Any, Reader] = {
    str: _text,
    int: _whole,
    float: _number,
    bool: _yes_or_no,
    Any: lambda value: value,
}


def one_of(*words: str) -> Reader:
    """Return what lets one of these words pass."""

    def take(value: Any) -> Any:
        if isinstance(value, str) and value in words:
            return value
        _text(value)
        raise Unreadable(f"is {value[:40]!r} ({nearest(value, words).rstrip('.')})")

    return take


def _union(kinds: tuple[Any, ...]) -> Reader:
    others = tuple(kind for kind in kinds if kind is not NoneType)
    if len(others) == 1:
        inner = reader(others[0])
        return lambda value: None if value is None else inner(value)
    if not all(map(is_dataclass, others)):
        raise TypeError(f"The codec cannot tell {kinds!r} apart.")
    tag = fields_of(others[0])[0].key  # the first field of each says which it is
    tagged = {fields_of(kind)[0].default: reader(kind) for kind in others}
    known = one_of(*tagged)

    def take(value: Any) -> Any:
        _need_table(value)
        return tagged[_of_key(tag, known, _need(value, tag))](value)

    return take


def _list_of(each: Any, made: Callable[[Any], Any]) -> Reader:
    inner = reader(each)

    def take(value: Any) -> Any:
        if not isinstance(value, list):
            raise Unreadable("is not a list")
        return made([_held(inner, one) for one in value])

    return take


def _row_of(each: tuple[Any, ...], made: Callable[..., Any]) -> Reader:
    inner = [reader(one) for one in each]

    def take(value: Any) -> Any:
        if not isinstance(value, list) or len(value) != len(inner):
            raise Unreadable(f"is not a list of {len(inner)}")
        return made(*[_held(test, one) for test, one in zip(inner, value, strict=True)])

    return take


def _tupled(*values: Any) -> tuple[Any, ...]:
    return values


def _table_of(each: Any) -> Reader:
    inner = reader(each)

    def take(value: Any) -> Any:
        _need_table(value)
        return {key: _held(inner, one) for key, one in value.items()}

    return take


def _record(kind: Any) -> Reader:
    """Return what reads the table of a record; what it says of itself as a whole counts too."""
    parts = [
        (one.name, None if one.place.flat else one.key, reader(_hint(one)), one.default)
        for one in fields_of(kind)
    ]
    misfit, glance = getattr(kind, "misfit", None), getattr(kind, "glance", None)

    def take(value: Any) -> Any:
        if glance is not None and (seen := glance(value)) is not None:
            return seen
        _need_table(value)
        found: dict[str, Any] = {}
        for name, key, inner, default in parts:
            if key is None:
                found[name] = inner(value)
            elif key in value or default is MISSING:
                found[name] = _of_key(key, inner, _need(value, key))
        made = kind(**found)
        if misfit is not None and (why := misfit(made)):
            raise Unreadable(why)
        return made

    return take


def _hint(field: Field) -> Any:
    return Annotated[(field.hint, *field.checks)] if field.checks else field.hint


def _need_table(value: Any) -> None:
    if not isinstance(value, dict):
        raise Unreadable("is not a table")


def _need(table: Mapping[str, Any], key: str) -> Any:
    if key not in table:
        raise Unreadable(f"has no {key!r}")
    return table[key]


def _of_key(key: str, inner: Reader, value: Any) -> Any:
    try:
        return inner(value)
    except Unreadable as why:
        raise Unreadable(f"has {key!r} that {why}") from None


def _held(inner: Reader, value: Any) -> Any:
    try:
        return inner(value)
    except Unreadable as why:
        raise Unreadable(f"holds one that {why}") from None
