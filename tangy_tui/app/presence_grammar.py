"""The grammar of who has come and who has left: "left Ida and Otto", "Ida and Otto have left"."""

from __future__ import annotations

import re
from dataclasses import dataclass

_IS = r"(?: (?:is|are)|['\u2019]s|['\u2019]re)"
_HAS = r"(?: (?:has|have)|['\u2019]s|['\u2019]ve)"
_NOT = r"(?: (?:is|are)(?: not| no longer|n['\u2019]t)|['\u2019]s not)"
_COMES = (
    rf"{_IS} (?:here|back|in)|{_HAS} (?:come|arrived|returned)"
    r"| (?:came|comes|come|arrived|arrives|arrive|returned|returns|return)"
)
_GOES = (
    rf"{_IS} (?:gone|going|leaving|away|out)|{_NOT} here|{_HAS} (?:gone|left)"
    r"| (?:(?:has|have|had|needs?|wants?) to|must) (?:go|leave)| (?:left|leaves|leave|went|goes|go)"
    r"| (?:comes?|joins?|(?:will|is going to|are going to) (?:come|join)|(?:is|are) coming)"
    r"(?: in| back)? (?:later|afterwards|another time|next time)"
    r"| needs? (?:the|a) (?:toilet|bathroom|loo|restroom|lavatory|wc)"
)
_SOON = r"(?: both| all| just| already)?"
_WHERE = (
    r"(?: (?:back|in|out|home|away|now|too|again|already|early|to bed|to sleep|for a (?:walk|while"
    r"|moment)|for today|to the (?:toilet|bathroom|loo|doctor|therapy)"
    r"|(?:to|into) (?:his|her|their) rooms?))*"
)
_NAMES_FIRST = re.compile(rf"(.+?),?{_SOON}(?:({_COMES})|{_GOES}){_WHERE}", re.I)
_NAMES_LAST = re.compile(r"(?:(here)(?: comes?| is| are)?|left) (.+)", re.I)
_AND = re.compile(r",(?: and| &)? | (?:and|&) ", re.I)


@dataclass(frozen=True, slots=True)
class ComesOrGoes:
    """Words that tell who has come (`comes`) or left; the names stand first or last in them."""

    names: str
    comes: bool
    names_first: bool


def read_moved(said: str) -> ComesOrGoes | None:
    """Parse words that tell who has come or left; None if they do not."""
    if last := _NAMES_LAST.fullmatch(said):
        return ComesOrGoes(last[2], bool(last[1]), names_first=False)
    if first := _NAMES_FIRST.fullmatch(said):
        return ComesOrGoes(first[1], bool(first[2]), names_first=True)
    return None


def one_person_each(said: str) -> list[str]:
    """Return a line for each person if a line says of several that they are here or have left."""
    moved = read_moved(said.strip(" ."))
    names = [] if moved is None else [one.strip() for one in _AND.split(moved.names)]
    if moved is None or len(names) < 2:
        return [said]
    return [f"{'here' if moved.comes else 'left'} {one}" for one in names if one]
