"""Mutants of the shipped activities: each is read, or refused with its mistakes in words.

`python -m tests.bench.file_mutants [NUMBER] [SEED]` counts the mutants that are read, that
are refused, and that end in any other error; for keys with a missing letter or two swapped
letters it counts refusals that do not name the right key.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections import Counter
from pathlib import Path
from random import Random

from tangy_profiles import activity as shipped
from tangy_profiles.activity import load_activity, read_activity, shipped_activities
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.errors import ProfileError

FOLDER = Path(shipped.__file__).parent / "activities"
KEY = re.compile(r"(?m)(?:^|[{,]\s*)([a-z_]{4,})(?=\s*=)")
SIGNS = "\"'[]{}=,.#\n\\ ax0-<>\x00é"


def misspelt(word: str, random: Random) -> str:
    """Leave a letter out, or swap two neighbours."""
    place = random.randrange(len(word) - 1)
    if random.random() < 0.5 or word[place] == word[place + 1]:
        return word[:place] + word[place + 1 :]
    return word[:place] + word[place + 1] + word[place] + word[place + 2 :]


def any_mutant(text: str, random: Random) -> str:
    """Delete, insert, double or move a piece of a text."""
    begin = random.randrange(len(text))
    end = min(len(text), begin + random.choice((1, 1, 2, 8, 60)))
    piece = text[begin:end]
    match random.randrange(4):
        case 0:
            return text[:begin] + text[end:]
        case 1:
            return text[:begin] + random.choice(SIGNS) + text[begin:]
        case 2:
            return text[:end] + piece + text[end:]
        case _:
            rest = text[:begin] + text[end:]
            place = random.randrange(len(rest) + 1)
            return rest[:place] + piece + rest[place:]


def main() -> None:
    """Print the results of a number of mutants."""
    number, seed = (int(one) for one in (*sys.argv[1:3], "2000", "1")[:2])
    random, found = Random(seed), Counter[str]()
    names = [n for n in shipped_activities() if isinstance(load_activity(n), DeclaredActivity)]
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for table in FOLDER.glob("*.csv"):
            (folder / table.name).write_bytes(table.read_bytes())
        for _ in range(number):
            name = random.choice(names)
            text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
            of_key, key = random.random() < 0.5, ""
            if of_key:
                match = random.choice(list(KEY.finditer(text)))
                key = match[1]
                mutant = text[: match.start(1)] + misspelt(key, random) + text[match.end(1) :]
            else:
                mutant = any_mutant(text, random)
            file = folder / f"{name}.toml"
            file.write_text(mutant, encoding="utf-8")
            try:
                read_activity(file)
                found["key: read" if of_key else "text: read"] += 1
            except ProfileError as error:
                named = not of_key or key in str(error)
                kind = "key" if of_key else "text"
                found[f"{kind}: refused" + ("" if named else ", right key not named")] += 1
                if not named and found["shown"] < 8:
                    found["shown"] += 1
                    print(f"{name}: {key}: {error}", flush=True)
            except Exception as error:
                found["OTHER ERROR"] += 1
                print(f"{name}: {error!r}: {mutant!r}"[:2000], flush=True)
    print(number, "mutants, seed", seed, dict(found))


if __name__ == "__main__":
    main()
