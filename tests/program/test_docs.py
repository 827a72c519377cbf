"""README, docs and CONTRIBUTING: every link has a target, and every shown command exists."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

from tangy_tui.verbs.program import app

HOUSE = Path(__file__).parents[2]
PAGES = sorted((HOUSE / "README.md", HOUSE / "CONTRIBUTING.md", *(HOUSE / "docs").rglob("*.md")))
LINK = re.compile(r"\]\(([^)\s]+)\)")
SPAN = re.compile(r"`(tangy(?: [^`]*)?)`")
BLOCK = re.compile(r"^( *)```sh\n(.*?)^\1```", re.DOTALL | re.MULTILINE)
HOLES = re.compile(r"^[A-Z][A-Z.*@,]*$|^\.\.\.$")
"""Placeholders, as in `--data DIR`."""


def anchors(page: Path) -> set[str]:
    """Return a page's anchors, as GitHub names headings."""
    titles = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title).strip().lower().replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_has_a_target(page: Path) -> None:
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        if re.match(r"\w+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


def commands(page: Path) -> Iterator[list[str]]:
    """Yield the words after `tangy` of every command that a page shows."""
    text = page.read_text(encoding="utf-8")
    lines = [
        line for _, block in BLOCK.findall(text) for line in block.replace("\\\n", " ").split("\n")
    ]
    lines += [span.replace("\n", " ") for span in SPAN.findall(re.sub(BLOCK, "", text))]
    for line in lines:
        for part in re.split(r"&&|\|", line):
            words = shlex.split(part, comments=True)
            at = next((n for n, word in enumerate(words) if word.split("/")[-1] == "tangy"), None)
            if at is not None and (at == 0 or words[0] in ("ssh",)):
                yield words[at + 1 :]


def refused(words: list[str]) -> str:
    """Return the first word of a command that the program does not know: a verb or an option."""
    known: Any = typer.main.get_command(app)
    context = typer.Context(known)
    options = {option for one in known.params for option in (*one.opts, *one.secondary_opts)}
    for word in words:
        if word.startswith("-") and word != "-":
            if word.split("=")[0] not in options | {"--help"}:
                return word
        elif hasattr(known, "get_command") and not HOLES.match(word):
            child = known.get_command(context, word)
            if child is None:
                return word if word in words[:1] else ""
            known = child
            options = {o for one in known.params for o in (*one.opts, *one.secondary_opts)}
    return ""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_shown_command_exists(page: Path) -> None:
    wrong = {" ".join(words): bad for words in commands(page) if (bad := refused(words))}
    assert not wrong


def test_commands_are_found_in_the_pages() -> None:
    assert sum(len(list(commands(page))) for page in PAGES) > 50
    assert refused(["teech"]) == "teech"
    assert refused(["teach", "--giuded"]) == "--giuded"
    assert refused(["people", "rename", "user1", "Rosa"]) == ""


def test_the_readme_is_short_and_names_the_other_pages() -> None:
    text = (HOUSE / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 200
    for page in PAGES:
        named = (
            text
            if page.parent.name != "decisions"
            else (HOUSE / "docs/architecture.md").read_text()
        )
        assert page.name in named or page.name == "README.md"


MODULE = re.compile(r"(?<![\w/.-])((?:[\w-]+/)*[a-z_]+\.(?:py|toml))\b")
HERE = {str(path.relative_to(HOUSE)) for path in HOUSE.rglob("*.*") if ".venv" not in path.parts}


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/architecture.md"])
def test_every_file_named_for_contributors_exists(page: str) -> None:
    text = (HOUSE / page).read_text(encoding="utf-8")
    named = set(MODULE.findall(text)) - {"lotto.toml"}  # of another package
    assert named
    missing = {one for one in named if not any(f"/{path}".endswith(f"/{one}") for path in HERE)}
    assert missing == set()
