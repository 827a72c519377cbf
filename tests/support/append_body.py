"""Writing events as JSON, including events that the program does not write."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tangy_profiles.events import EventRecord, Unknown
from tangy_profiles.store import Store


def append_body(
    store: Store, kind: str | type[EventRecord], body: Mapping[str, Any], **row: Any
) -> int:
    """Append an event of a kind by its body; `row` names its person."""
    name = kind if isinstance(kind, str) else kind.KIND
    return store.append(Unknown(name, body), **row)
