"""Typed records as JSON: one codec, built from the fields of a class.

A dataclass is a table, a plain named tuple a row, a tuple a list; `Annotated` adds constraints.
Invalid values are rejected with the tail of a sentence ("has 'step' that is not a count"), which
staff read in `tangy store check`.

cattrs, msgspec and pydantic were rejected: the sentences, named tuples as tables, flat keys and
omitted keys would still be our code, and every process that opens a log would have to import them
(11 ms of CPU for msgspec, 25 for cattrs).
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
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
"""Decodes a JSON value, or raises InvalidValue."""

LARGEST = 1e12
"""The largest number in a log: s, counts, probabilities, readings of devices."""


class InvalidValue(ValueError):
    """An invalid value; the text is the tail of a sentence ("is not text")."""


class DecodedBy(NamedTuple):
    """Decodes a value with this reader instead of by its type."""

    reader: Reader


class Key(NamedTuple):
    """The key of a field: its name if not the field's, and whether flat, sparse, or unlogged."""

    name: str = ""
    flat: bool = False
    sparse: bool = False
    unlogged: bool = False


Flat = Annotated[T, Key(flat=True)]
"""A record whose keys are merged into those of the containing record."""
Sparse = Annotated[T, Key(sparse=True)]
"""A value whose key is omitted if it is the default."""
Unlogged = Annotated[T, Key(unlogged=True)]
"""A value without a key, known from elsewhere."""


class Field(NamedTuple):
    """One field of a record: its key, its type, and its default."""

    name: str
    key: Key
    hint: Any
    default: Any


def decode(kind: type[T], value: Any) -> T:
    """Decode a value of a JSON document.

    Raises:
        InvalidValue: it is invalid; the message says where and why.
    """
    return cast(T, reader(cast(Any, kind))(value))


def encode(value: Any) -> Any:
    """Encode a record, or a value within one, as JSON."""
    if isinstance(value, str | int | float | NoneType):
        return value
    if isinstance(value, Mapping):
        return {key: encode(one) for key, one in value.items()}
    if not _is_record(kind := cast(Any, type(value))):
        return [encode(one) for one in (sorted(value) if kind is frozenset else value)]
    table: dict[str, Any] = {}
    for field in fields_of(kind):
        one = getattr(value, field.name)
        if field.key.flat:
            table |= encode(one)
        elif not (field.key.sparse and one == field.default):
            table[field.key.name] = encode(one)
    return table | {key: encode(getattr(value, name)) for key, name in _derived(kind).items()}


def keys_of(kind: Any) -> frozenset[str]:
    """Return the keys that the table of a record may have."""
    found = {field.key.name for field in fields_of(kind) if not field.key.flat}
    for flat in (field.hint for field in fields_of(kind) if field.key.flat):
        found.update(*map(keys_of, get_args(flat) or [flat]))
    return frozenset(found | _derived(kind).keys())


@cache
def fields_of(kind: Any) -> tuple[Field, ...]:
    """Return the fields of a record; for a named tuple only sparse ones have defaults."""
    tuples = dict.fromkeys(getattr(kind, "_fields", ()), MISSING)
    usual = getattr(kind, "_field_defaults", {})
    hints, found = get_type_hints(kind, include_extras=True), []
    for name, default in (tuples or {one.name: _default(one) for one in fields(kind)}).items():
        hint, marks = _unpacked(hints[name])
        key = next((mark for mark in marks if isinstance(mark, Key)), Key())
        others = tuple(mark for mark in marks if not isinstance(mark, Key))
        if key.sparse and name in usual:
            default = usual[name]
        if not key.unlogged:
            hint = Annotated[(hint, *others)] if others else hint
            found.append(Field(name, key._replace(name=key.name or name), hint, default))
    return tuple(found)


def _default(field: Any) -> Any:
    return field.default if field.default_factory is MISSING else field.default_factory


def _derived(kind: Any) -> Mapping[str, str]:
    """Return the keys of a record's properties, which are written but not read."""
    return cast(Mapping[str, str], getattr(kind, "DERIVED", {}))


def _is_record(kind: Any) -> bool:
    """Return whether a type is a table: a dataclass, or a named tuple with `decode_quickly`."""
    return is_dataclass(kind) or hasattr(kind, "decode_quickly")


def _unpacked(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return a type, and its `Annotated` metadata."""
    return (hint.__origin__, hint.__metadata__) if get_origin(hint) is Annotated else (hint, ())


# ------------------------------------------------------------------------- readers of values


@cache
def reader(hint: Any) -> Reader:
    """Return the decoder for a type.

    Raises:
        TypeError: no JSON value can represent that type.
    """
    plain, marks = _unpacked(hint)
    origin, args = get_origin(hint), get_args(hint)
    if marks:
        own = [mark.reader for mark in marks if isinstance(mark, DecodedBy)] or [reader(plain)]
        return _in_turn([*own, *(mark for mark in marks if not isinstance(mark, DecodedBy))])
    if hint in _PLAIN:
        return _PLAIN[hint]
    if origin is Literal:
        return one_of(*args)
    if origin in (Union, UnionType):
        return _union([one for one in args if one is not NoneType], NoneType in args)
    if origin is frozenset or (origin is tuple and args[1:] == (...,)):
        return _list_of(reader(args[0]), origin)
    if origin is tuple:
        return _row_of(args, lambda *values: values)
    if origin is Mapping:
        return _table_of(reader(args[1]))
    if _is_record(hint):
        return _record(hint)
    if hasattr(hint, "_fields"):
        return _row_of([field.hint for field in fields_of(hint)], hint)
    raise TypeError(f"The codec reads no {hint!r}: say in {__name__} how.")


def at_least(least: int) -> Reader:
    """Accept whole numbers of at least `least`, and lists of at least that length.

    Raises:
        InvalidValue: (the decoder) it is smaller or shorter.
    """

    def check(value: Any) -> Any:
        whole = isinstance(value, int)
        if not least <= (value if whole else len(value)) <= LARGEST:
            raise InvalidValue("is not a count" if whole else "is too short")
        return value

    return check


def within_range(least: int, most: int) -> Reader:
    """Accept whole numbers in an inclusive range.

    Raises:
        InvalidValue: (the decoder) it is outside.
    """

    def check(value: Any) -> Any:
        if not least <= value <= most:
            raise InvalidValue(f"is not a count from {least:,} to {most:,}")
        return value

    return check


Count = Annotated[int, at_least(0)]
"""A whole number >= 0."""


def measurement(value: Any) -> Any:
    """Accept a device's measurement: a finite number, yes or no, or a word.

    Raises:
        InvalidValue: it is none.
    """
    number = isinstance(value, int | float) and abs(value) <= sys.float_info.max
    if not (number or isinstance(value, str)):
        raise InvalidValue("is not a measurement")
    return value


def one_of(*words: str) -> Reader:
    """Return a decoder that accepts one of these words.

    Raises:
        InvalidValue: (the decoder) it is another word; with the nearest one.
    """

    def take(value: Any) -> Any:
        if _text(value) not in words:
            raise InvalidValue(f"is {value[:40]!r} ({nearest(value, words).rstrip('.')})")
        return value

    return take


def _typed(kinds: type | UnionType, but: type | tuple[()], wrong: str) -> Reader:
    def take(value: Any) -> Any:
        if not isinstance(value, kinds) or isinstance(value, but):
            raise InvalidValue(wrong)
        return value

    return take


def _within_measure(value: Any) -> Any:
    if not abs(value) <= LARGEST:  # also rejects NaN
        raise InvalidValue("is beyond all measure")
    return value


def _in_turn(readers: list[Reader]) -> Reader:
    def take(value: Any) -> Any:
        for one in readers:
            value = one(value)
        return value

    return take


_text, _table = _typed(str, (), "is not text"), _typed(dict, (), "is not a table")
_list = _typed(list, (), "is not a list")
_PLAIN: Mapping[Any, Reader] = {
    str: _text,
    int: _typed(int, bool, "is not a whole number"),
    float: _in_turn([_typed(int | float, bool, "is not a number"), _within_measure]),
    bool: _typed(bool, (), "is neither yes nor no"),
    Any: lambda value: value,
}


def _union(kinds: list[Any], may_be_none: bool) -> Reader:
    """Return the decoder for an optional value; records are distinguished by their first field."""
    if len(kinds) == 1:
        inner = reader(kinds[0])
    elif all(map(is_dataclass, kinds)):
        inner = _tagged(kinds)
    else:
        raise TypeError(f"The codec cannot tell {kinds!r} apart.")
    return lambda value: None if may_be_none and value is None else inner(value)


def _tagged(kinds: list[Any]) -> Reader:
    tag = fields_of(kinds[0])[0].key.name
    tagged = {fields_of(kind)[0].default: reader(kind) for kind in kinds}
    known = one_of(*tagged)
    return lambda value: tagged[_of_key(tag, known, _table(value))](value)


def _list_of(inner: Reader, made: Callable[[Any], Any]) -> Reader:
    return lambda value: made([_held(inner, one) for one in _list(value)])


def _row_of(each: Any, made: Callable[..., Any]) -> Reader:
    inner = [reader(one) for one in each]

    def take(value: Any) -> Any:
        if not isinstance(value, list) or len(value) != len(inner):
            raise InvalidValue(f"is not a list of {len(inner)}")
        return made(*[_held(test, one) for test, one in zip(inner, value, strict=True)])

    return take


def _table_of(inner: Reader) -> Reader:
    return lambda value: {key: _held(inner, one) for key, one in _table(value).items()}


def _record(kind: Any) -> Reader:
    """Return the decoder for a record's table; it also runs the record's own checks."""
    parts = [(*field, reader(field.hint)) for field in fields_of(kind)]
    only = keys_of(kind) if getattr(kind, "ONLY", False) else None  # None: other keys are allowed
    invalid_reason, decode_quickly = (
        getattr(kind, "invalid_reason", None),
        getattr(kind, "decode_quickly", None),
    )

    def take(value: Any) -> Any:
        if decode_quickly is not None and (seen := decode_quickly(value)) is not None:
            return seen
        found: dict[str, Any] = {}
        for name, key, _, default, inner in parts:
            if key.flat:
                found[name] = inner(value)
            elif key.name in _table(value) or default is MISSING:
                found[name] = _of_key(key.name, inner, value)
        if only is not None and (others := _table(value).keys() - only):
            raise InvalidValue(f"has {min(others)[:40]!r}, which is not known")
        _table(value)
        made = kind(**found)
        if invalid_reason is not None and (why := invalid_reason(made)):
            raise InvalidValue(why)
        return made

    return take


def _of_key(key: str, inner: Reader, table: Mapping[str, Any]) -> Any:
    if key not in table:
        raise InvalidValue(f"has no {key!r}")
    try:
        return inner(table[key])
    except InvalidValue as why:
        raise InvalidValue(f"has {key!r} that {why}") from None


def _held(inner: Reader, value: Any) -> Any:
    try:
        return inner(value)
    except InvalidValue as why:
        raise InvalidValue(f"holds one that {why}") from None
