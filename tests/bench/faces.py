"""How well faces are recognised, in a folder of pictures that is not part of this tree.

Run by hand: `python -m tests.bench.faces DIR [--widths 200 80] [--draws 50] [--half 1|2]`, where
DIR has a folder for each person. In each draw four people are enrolled with ten pictures each;
their other pictures, and all pictures of everybody else, are classified, one by one. People with
fewer than 15 pictures are always strangers. `--half` takes every second person: features and
limits were chosen on the first half only.

`seen`: pictures in which a face passes the gate. Of those: `right at 1%`: of the enrolled, with
the threshold at which one stranger in a hundred is accepted; then, with the threshold that the
enrolment itself sets, `right`, `confused` (taken for another person) and `strangers` accepted.
`all` is the share of right ones among all pictures of the enrolled, gate included. `vote`: right
and strangers when three of a person's pictures vote. CPU is of one thread, per picture.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from tangy_hw.perception.faces.enrolment import one_face
from tangy_hw.perception.faces.face_votes import vote
from tangy_hw.perception.faces.gallery import FaceMatch, Gallery
from tangy_hw.perception.faces.reader import HaarReader

LEAST = 15
VOTES = 3
SEED = 500_000
COLUMNS = ("seen", "right at 1%", "right", "confused", "strangers", "all", "vote", "strangers")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--widths", type=int, nargs="*", default=[0], help="pixels; 0: as it is")
    parser.add_argument("--probes", type=int, nargs="*", help="other widths of what is asked")
    parser.add_argument("--draws", type=int, default=50)
    parser.add_argument("--half", type=int, choices=(1, 2))
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--enrol", type=int, default=4, help="so many people")
    parser.add_argument("--pictures", type=int, default=10, help="so many of each of them")
    asked = parser.parse_args()
    cv2.setNumThreads(1)
    people = chosen(asked.folder, asked.half)
    print(f"{len(people)} people, {sum(map(len, people.values()))} pictures, {asked.draws} draws")
    print(f"{'enrolled':>8} {'asked':>6}" + "".join(f"{name:>12}" for name in COLUMNS) + "  CPU ms")
    read: dict[int, tuple[dict[str, list[Any]], float]] = {}
    for width in dict.fromkeys([*asked.widths, *(asked.probes or [])]):
        read[width] = _read(people, width)
    for width in asked.widths:
        for probe in asked.probes or [width]:
            rows = [
                draw(
                    read[width][0],
                    read[probe][0],
                    np.random.default_rng((asked.seed, number)),
                    asked.enrol,
                    asked.pictures,
                )
                for number in range(asked.draws)
            ]
            mean: Any = np.nanmean(np.array(rows), axis=0)
            sizes = f"{width or 'as is':>8} {probe or 'as is':>6}"
            print(sizes + "".join(f"{v:>12.2%}" for v in mean) + f"{read[probe][1]:>8.1f}")


def chosen(folder: Path, half: int | None) -> dict[str, list[Path]]:
    """Return everybody's pictures, or every second person's: halves people with many separately."""
    there = {
        one.name: sorted(path for path in one.iterdir() if path.is_file())
        for one in sorted(folder.iterdir())
        if one.is_dir()
    }
    if half is None:
        return there
    many = [name for name, files in there.items() if len(files) >= LEAST]
    few = [name for name in there if name not in many]
    taken = {*many[half - 1 :: 2], *few[half - 1 :: 2]}
    return {name: files for name, files in there.items() if name in taken}


def draw(
    enrol: dict[str, list[Any]],
    probe: dict[str, list[Any]],
    rng: np.random.Generator,
    people: int,
    pictures: int,
) -> list[float]:
    """Enrol some people with some pictures, and classify everything else."""
    able = [n for n, rows in enrol.items() if sum(v is not None for v in rows) >= LEAST]
    known = [str(name) for name in rng.permutation(able)[:people]]
    kept: dict[str, Any] = {}
    used: dict[str, set[int]] = {}
    for name in known:
        there = [number for number, v in enumerate(enrol[name]) if v is not None]
        used[name] = {int(number) for number in rng.permutation(there)[:pictures]}
        kept[name] = np.array([enrol[name][number] for number in sorted(used[name])])
    gallery = Gallery(kept)
    own: list[tuple[str, FaceMatch | None]] = []
    strangers: list[FaceMatch] = []
    seen = total = 0
    voted: list[tuple[str | None, str | None]] = []
    for name, rows in probe.items():
        asked = [v for number, v in enumerate(rows) if number not in used.get(name, ())]
        matches = [None if v is None else gallery.compare(v) for v in asked]
        well = [match for match in matches if match is not None]
        seen, total = seen + len(well), total + len(matches)
        if name in known:
            own += [(name, match) for match in matches]
        else:
            strangers += well
        for first in range(0, len(well) - VOTES + 1, VOTES):
            answer = vote(well[first : first + VOTES]).person
            voted.append((name if name in known else None, answer))
    limit = float(np.quantile([match.likeness for match in strangers], 0.99))
    well_seen = [(name, match) for name, match in own if match is not None]
    right = sum(match.person == name for name, match in well_seen)
    votes = [person == name for name, person in voted if name is not None]
    false = [person is not None for name, person in voted if name is None]
    return [
        seen / total,
        _share([match.nearest == name and match.likeness > limit for name, match in well_seen]),
        right / len(well_seen),
        _share([match.person not in (None, name) for name, match in well_seen]),
        _share([match.person is not None for match in strangers]),
        right / len(own),
        _share(votes),
        _share(false),
    ]


def _share(outcomes: list[bool]) -> float:
    return float(np.mean(outcomes)) if outcomes else float("nan")


def _read(people: dict[str, list[Path]], width: int) -> tuple[dict[str, list[Any]], float]:
    """Describe the single face in every picture at a width; None if it does not pass the gate."""
    reader = HaarReader()
    began = time.process_time()
    found = {
        name: [one_face(reader.read(_picture(path, width)))[1] for path in files]
        for name, files in people.items()
    }
    spent = time.process_time() - began
    return found, 1000 * spent / max(1, sum(map(len, people.values())))


def _picture(path: Path, width: int) -> Any:
    picture: Any = cv2.imread(str(path))
    if width and width < picture.shape[1]:
        size = (width, round(picture.shape[0] * width / picture.shape[1]))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
        picture = cv2.imdecode(cv2.imencode(".jpg", picture, [1, 90])[1], 1)
    return picture


if __name__ == "__main__":
    main()
