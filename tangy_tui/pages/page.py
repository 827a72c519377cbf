"""A self-contained HTML page: text, tables and drawings, without external resources."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_profiles.saved_files import PAGE_MARK

STYLE = """
:root { color-scheme: light dark; --font: system-ui, sans-serif;
  --paper: #ffffff; --ink: #1b1f24; --dim: #5b6570; --line: #d9dee3; --shade: #f4f6f8;
  --series-1: #2166ac; --series-2: #c2410c; --series-3: #1b7837; --series-4: #7b3294;
  --series-5: #a16207; --series-6: #0e7490; }
@media (prefers-color-scheme: dark) { :root {
  --paper: #14181d; --ink: #e8ecf0; --dim: #9aa5b1; --line: #343c45; --shade: #1c2229;
  --series-1: #6cb0f0; --series-2: #fb923c; --series-3: #6ccf85; --series-4: #cf9ae8;
  --series-5: #e5c04b; --series-6: #56c8dc; } }
body { background: var(--paper); color: var(--ink); font: 16px/1.5 var(--font);
  max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin: 0 0 .2rem; } h2 { font-size: 1.2rem; margin: 2.2rem 0 .4rem; }
p { margin: .4rem 0; } .dim { color: var(--dim); }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; font-size: .9rem; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .35rem .6rem;
  border-bottom: 1px solid var(--line); }
th { background: var(--shade); font-weight: 600; }
td { font-variant-numeric: tabular-nums; }
svg { display: block; width: 100%; height: auto; }
figure { margin: 1rem 0; } figcaption { color: var(--dim); font-size: .9rem; }
@media print { :root { color-scheme: light;
  --paper: #ffffff; --ink: #1b1f24; --dim: #5b6570; --line: #d9dee3; --shade: #f4f6f8;
  --series-1: #2166ac; --series-2: #c2410c; --series-3: #1b7837; --series-4: #7b3294;
  --series-5: #a16207; --series-6: #0e7490; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  @page { size: A4; margin: 14mm; }
  body { margin: 0; padding: 0; max-width: none; font-size: 11pt; }
  .wide { overflow-x: visible; }
  h2, h3 { break-after: avoid; } tr, figure { break-inside: avoid; } }
"""


def document(title: str, subtitle: str, parts: Iterable[str], style: str = "") -> str:
    """Return a whole page, which is well-formed XML too; `style` is added to the common style."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8"/>\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1"/>\n'
        f"{PAGE_MARK}\n"
        f"<title>{escape(title)}</title>\n<style>{STYLE}{style}</style>\n</head>\n<body>\n"
        f'<h1>{escape(title)}</h1>\n<p class="dim">{escape(subtitle)}</p>\n'
        + "\n".join(parts)
        + "\n</body>\n</html>\n"
    )


def heading(text: str) -> str:
    """Return the heading of a part."""
    return f"<h2>{escape(text)}</h2>"


def paragraph(text: str) -> str:
    """Return a paragraph."""
    return f"<p>{escape(text)}</p>"


def figure(svg: str, caption: str) -> str:
    """Return a drawing with its caption."""
    label = f'<svg aria-label="{escape(caption)}"'
    drawing = svg.replace("<svg", label, 1)
    return f"<figure>{drawing}<figcaption>{escape(caption)}</figcaption></figure>"


def table(columns: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table, which scrolls by itself in a narrow window."""
    head = "".join(f'<th scope="col">{escape(column)}</th>' for column in columns)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>\n"
        for row in rows
    )
    return (
        f'<div class="wide"><table><thead><tr>{head}</tr></thead>\n'
        f"<tbody>{body}</tbody></table></div>"
    )


def check_place(path: Path, option: str = "--report") -> None:
    """Check, before long work begins, that a page can be written to a path.

    Args:
        path: the file to write.
        option: the command-line option that named it.

    Raises:
        TangyError: it cannot be written.
    """
    if path.is_dir():
        raise TangyError(plain(f"{option} {path}: that is a folder; name a file in it."))
    if not path.absolute().parent.is_dir():
        raise TangyError(plain(f"{option} {path}: there is no such folder to put it in."))


def write(path: Path, page: str, option: str = "--report") -> None:
    """Write a page; `option` is the command-line option that named the file.

    Raises:
        TangyError: it cannot be written.
    """
    try:
        path.write_text(page, encoding="utf-8")
    except OSError as error:
        raise TangyError(plain(f"{option} {path}: cannot be written ({error.strerror}).")) from None
