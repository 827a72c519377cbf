"""How many spoken sentences that steer a live game are obeyed, and how much other talk is.

Run by hand: `python -m tests.bench.spoken_steering` (needs flite, festival and espeak-ng). Every
sentence of `steering.IN_GAMES` is said by some of the voices in turn; other talk is that of
`spoken_stops`. This bench sets no limit: those of `understanding` were set before these sentences
were written. A synthetic voice is not a person.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections import Counter
from pathlib import Path

from tangy_tui.language.steering import IN_GAMES, WAYS, steering_of
from tangy_tui.language.stop_phrases import stop_sets
from tangy_tui.learning.verification import Say
from tangy_tui.speech.decoder import make_decoder
from tangy_tui.speech.evidence import USUAL
from tangy_tui.speech.understanding import replied, wanted
from tests.bench.speech import BOOK
from tests.bench.spoken_stops import VOICES, Said, Voices, sayings

TALK = "talk"
OTHERS = "third"  # the set with the other sentences


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description="Count spoken sentences that steer a game.")
    options.add_argument("--voices", type=int, default=3, help="of each sentence")
    options.add_argument("--noises", nargs="*", default=("clean", "20"))
    options.add_argument("--show", action="store_true", help="list what went wrong")
    chosen = options.parse_args()
    decoder = make_decoder(wanted(BOOK, USUAL))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # the grammar's unfinished paths are printed there
    texts = [(way, text) for way in IN_GAMES for text in WAYS[way]]
    said = [
        Said(way, text, VOICES[(place + 5 * number) % len(VOICES)])
        for place, (way, text) in enumerate(texts)
        for number in range(chosen.voices)
    ]
    others = [one for one in sayings(stop_sets()[OTHERS], 1) if one.kind != "stops"]
    with tempfile.TemporaryDirectory() as folder:
        voices = Voices(Path(folder))
        voices.say([*said, *others])
        for noise in chosen.noises:
            of, right, wrong = Counter[str](), Counter[str](), Counter[str]()
            for one in (*said, *others):
                pcm = voices.heard(one, noise, others)
                evidence = decoder.decode(pcm, "answers")
                found, _ = replied(evidence, USUAL, steering=IN_GAMES, answers=False)
                way = steering_of(found.text) if isinstance(found, Say) else None
                family = "espeak" if "-" in one.voice else "flite, festival"
                kind = one.kind if one.kind in IN_GAMES else TALK
                name = f"{kind} by {family}"
                of[name] += 1
                right[name] += way == kind
                wrong[name] += way not in (kind, None)
                if chosen.show and way not in (kind, None):
                    print(f"  {one.kind} {one.voice}: {one.text!r} was {evidence.words!r}")
            print(noise)
            for name in sorted(of):
                print(
                    f"  {name:28}{right[name]:4} right, {wrong[name]} wrong of {of[name]}",
                    flush=True,
                )
    decoder.close()


if __name__ == "__main__":
    main()
