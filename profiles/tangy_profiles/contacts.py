"""Contacts for a robot: the expert for faults that staff cannot clear, and staff."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from tangy_profiles.reading import Table

Role = Literal["expert", "staff"]
EXPERT: Final = "expert"
STAFF_ROLE: Final = "staff"
ROLES: tuple[Role, ...] = (EXPERT, STAFF_ROLE)

SCHEMES = ("http://", "https://", "mqtt://", "mqtts://")


@dataclass(frozen=True)
class Contact:
    """A person to call: a name, and a telephone number ("": none).

    `command` is a program with its arguments that sends a message, and `url` an address that
    receives one: http, https or mqtt. Without either, Tangy itself cannot call.
    """

    name: str
    telephone: str = ""
    command: tuple[str, ...] = ()
    url: str = ""

    @property
    def reachable(self) -> bool:
        """Whether Tangy itself can send them a message."""
        return bool(self.command or self.url)


def read_contact(top: Table, key: Role) -> Contact | None:
    """Read the contact of a role from the robot's profile; None if there is none.

    Raises:
        ProfileError: a value is invalid, or there are both a command and a URL.
    """
    if key not in top:
        return None
    entry = top.table(key)
    name, telephone = entry.text("name"), entry.text("telephone", "")
    command, url = entry.words("command", default=()), entry.text("url", "")
    if command and url:
        raise entry.wrong("url", "give a command or a url, not both.")
    if url and not url.startswith(SCHEMES):
        raise entry.wrong("url", f"must begin with one of {', '.join(SCHEMES)}.")
    entry.close()
    return Contact(name, telephone, command, url)
