"""`tangy cards`: print the cards that Tangy can read, and list their numbers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.card_face import LAST_CARD, USUAL_SEED
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_tui.text.command_line import PRINTING
from tangy_tui.verbs.common import ActivityName, Json, print_json

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity

app = typer.Typer(help="Print cards that Tangy can read, and list their numbers.")

Count = Annotated[int, typer.Option(min=1, max=LAST_CARD, help="How many cards.")]
First = Annotated[int, typer.Option(min=1, max=LAST_CARD, help="The number of the first card.")]
DeckSeed = Annotated[
    int, typer.Option("--deck-seed", min=0, help="Another deck: other numbers on the same cards.")
]


@app.command("print")
def cards_print(
    count: Count = 40,
    first: First = 1,
    pdf: Annotated[
        Path | None, typer.Option(help="Write the cards and the call sheet to this PDF.")
    ] = None,
    png: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write a picture of each card, cards.json.")
    ] = None,
    dpi: Annotated[float, typer.Option(min=40, max=600, help="Dots per inch of pictures.")] = 150,
    paper: Annotated[
        str,
        typer.Option(help="The paper of the PDF: a4 or letter (two cards to a sheet), or a5."),
    ] = "a4",
    deck_seed: DeckSeed = USUAL_SEED,
    activity: ActivityName = DEFAULT_ACTIVITY,
    as_json: Json = False,
) -> None:
    """Write cards as a PDF to print, or as pictures.

    The PDF has a call sheet for staff.

    A card's number and the deck's seed always give the same card: print a lost one again with
    `--first 17 --count 1`. Print in full size ("100 %") and cut along the marks.
    """
    from tangy_profiles.activity import load_activity
    from tangy_tui.pages.card_sheets import PAPERS, card_sheets

    if pdf is None and png is None:
        raise TangyError("Say where the cards go: --pdf FILE to print them, or --png DIR.")
    if paper not in PAPERS:
        raise TangyError(plain(f"--paper {paper[:40]!r} is not known; {nearest(paper, PAPERS)}"))
    loaded = load_activity(activity)
    loaded.need_cards()
    cards = _cards(first, count)
    written: dict[str, Any] = {"cards": len(cards), "first": first, "deck_seed": deck_seed}
    try:
        if pdf is not None:
            pdf.write_bytes(card_sheets(loaded, cards, deck_seed, paper))
            written["pdf"] = str(pdf)
        if png is not None:
            png.mkdir(parents=True, exist_ok=True)
            _draw(loaded, cards, deck_seed, dpi, png)
            written["png"] = str(png)
    except OSError as error:
        place = plain(str(error.filename or pdf or png))
        raise TangyError(f"{place}: cannot be written ({error.strerror}).") from None
    if as_json:
        print_json(written)
        return
    which = f"Card {first}" if count == 1 else f"Cards {first} to {cards[-1]}"
    where = plain(" and ".join(str(path) for path in (pdf, png) if path is not None))
    print(f"{which} of deck {deck_seed}: {where}")
    if pdf is not None:
        print(PRINTING)


@app.command("list")
def cards_list(
    count: Count = 40,
    first: First = 1,
    deck_seed: DeckSeed = USUAL_SEED,
    activity: ActivityName = DEFAULT_ACTIVITY,
    as_json: Json = False,
) -> None:
    """List the numbers on cards."""
    from tangy_profiles.activity import load_activity
    from tangy_profiles.card_face import rows_of, tag_ids

    loaded = load_activity(activity)
    loaded.need_cards()
    deck = loaded.deck
    cards = _cards(first, count)
    if as_json:
        listed = [
            {"id": card, "numbers": rows_of(deck, card, deck_seed), "tags": list(tag_ids(card))}
            for card in cards
        ]
        print_json({"deck_seed": deck_seed, "cards": listed})
        return
    for card in cards:
        print(f"card {card}")
        cell = iter(range(deck.rows * len(deck.columns)))
        for row in rows_of(deck, card, deck_seed):
            print("".join(f"{'-' if deck.free >> next(cell) & 1 else n:>5}" for n in row))


def _cards(first: int, count: int) -> Sequence[int]:
    if first + count - 1 > LAST_CARD:
        raise TangyError(f"There are {LAST_CARD} cards: fewer than {count} from card {first} on.")
    return range(first, first + count)


def _draw(activity: Activity, cards: Sequence[int], seed: int, dpi: float, folder: Path) -> None:
    """Write a picture of each card, and `cards.json` with its numbers and their positions."""
    from PIL import Image

    from tangy_profiles.card_face import CardLayout, rows_of
    from tangy_profiles.card_picture import draw_face

    face = CardLayout(activity.deck)
    scale = dpi / 25.4
    grid = [face.grid.left, face.grid.top, face.grid.right, face.grid.bottom]
    listed = []
    for card in cards:
        name = f"card-{card:03}.png"
        grey = draw_face(face, card, seed, activity.title, scale)
        picture = Image.fromarray(grey).convert("RGB")  # as cameras see it
        picture.save(folder / name, dpi=(dpi, dpi))
        listed.append(
            {
                "id": card,
                "file": name,
                "numbers": rows_of(activity.deck, card, seed),
                "grid": [round(edge * scale, 3) for edge in grid],
            }
        )
    document = json.dumps({"cards": listed}, indent=2)
    (folder / "cards.json").write_text(document + "\n", encoding="utf-8")
