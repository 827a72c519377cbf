"""Ears: a microphone and the recogniser behind it, giving commands as a teacher would type them."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from typing import TypeAlias

from tangy_tui.learning.demonstrating import Say

Ears: TypeAlias = Callable[[], AsyncIterator[Say]]
"""Opens a source of spoken commands."""
