"""How well pronunciations outside the dictionary are guessed, and how long a look-up takes.

Run: python tests/bench/pronouncing.py [WORDS]

A measured word is taken out of the dictionary first; words made of it stay ("rosary" for
rosa"), as they would for a new name. A guess is right if it is one of the dictionary's
own pronunciations; the error is counted in phones to the nearest of them.
"""

from __future__ import annotations

import re
import shutil
import sys
from collections.abc import Callable, Sequence
from random import Random
from time import perf_counter, process_time

from tangy_tui.language import pronunciation, spelling
from tangy_tui.language.espeak_phones import PROGRAM, espeak_phones

NAMES = """
ada agnes albert alice amelia andrea angela anita anna arthur audrey barbara beatrice bernard betty
brenda bruno carla carmen carol catherine charles charlotte christine clara claire conrad daphne
david deborah diana doris dorothy edith edna edward eileen elaine eleanor elizabeth ella elsie emil
emma eric ernest esther ethel eugene eva evelyn felix florence frances frank frederick gabriel
george gerald gertrude gladys gloria grace greta harold harriet harry hazel heinrich helen helga
henry herbert hilda howard hugo ida ingrid irene isabel ivan jacob james janet jean jeremy jessica
joan johanna john jose joseph joyce juan judith julia karen katharina keith kenneth klara laura
lawrence leon leonard leo lillian linda lionel lois louis louise lucia lucy ludwig luigi mabel
margaret maria marie marjorie mark martha martin mary maurice mavis maximilian mildred miriam monica
muriel nancy natalie nicholas nigel nora norman olga oliver oscar otto pablo pamela patricia paul
pauline pearl peter philip phyllis rachel ralph raymond rebecca regina richard rita robert roger
ronald rosa rose roy ruby rudolf ruth sally samuel sandra sarah sebastian shirley sidney simon
sophie stanley stella stephen susan sylvia teresa theodor thomas timothy ursula valerie vera
veronica victor vincent viola violet virginia walter wanda wilhelm william winifred yolanda yvonne
"""


def apart(one: Sequence[str], other: Sequence[str]) -> int:
    """Count the phones to insert, drop or replace."""
    row = list(range(len(other) + 1))
    for i, phone in enumerate(one, 1):
        last, row = row, [i]
        for j, wanted in enumerate(other, 1):
            row.append(min(last[j] + 1, row[-1] + 1, last[j - 1] + (phone != wanted)))
    return row[-1]


def by_spelling(word: str) -> str:
    """Guess from the dictionary without the word."""
    without = re.sub(rf"\n{word}(\(\d\))? [^\n]*", "", pronunciation.dictionary())
    return spelling.guess(word, without)


def measure(title: str, words: Sequence[str], guess: Callable[[str], str]) -> None:
    right = errors = phones = 0
    begun, used = perf_counter(), process_time()
    for word in words:
        guessed = guess(word).split()
        known = [way.split() for way in pronunciation.pronounce(word)]
        error, length = min((apart(guessed, way), len(way)) for way in known)
        right += error == 0
        errors += error
        phones += length
    each = 1000 / len(words)
    print(
        f"{title:28} {len(words):4} words  right {right / len(words):4.0%}  "
        f"phone errors {errors / phones:5.1%}  {(perf_counter() - begun) * each:5.1f} ms "
        f"({(process_time() - used) * each:.1f} ms CPU here)"
    )


def main() -> None:
    """Measure both guesses on words and on names, and the look-up."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    begun = process_time()
    lines = pronunciation.dictionary().split("\n")
    print(f"dictionary read in {(process_time() - begun) * 1000:.0f} ms CPU, {len(lines)} lines")
    usual = [w for line in lines if re.fullmatch("[a-z]{3,}", w := line.partition(" ")[0])]
    words = Random(5).sample(usual, count)
    names = [name for name in NAMES.split() if pronunciation.pronounce(name)]
    begun = process_time()
    for word in words:
        pronunciation.pronounce(word)
    print(f"a look-up takes {(process_time() - begun) / count * 1000:.2f} ms CPU")
    guesses: dict[str, Callable[[str], str]] = {"spelling": by_spelling}
    if shutil.which(PROGRAM):
        guesses = {PROGRAM: espeak_phones} | guesses
    for title, guess in guesses.items():
        measure(f"{title}, dictionary words", words, guess)
        measure(f"{title}, first names", names, guess)


if __name__ == "__main__":
    main()
