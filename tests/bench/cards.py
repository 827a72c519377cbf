"""How well printed cards are read, on rendered frames with known truth.

Run by hand: `python -m tests.bench.cards --frames 1000` prints a table of each kind of frame;
`--method paper` adds the paper's design on the same frames (fewer of them, by `--paper`).
The seeds differ from those of `card_training`. A rendered frame is no photograph: take
differences seriously, not the last per cent, and count your own with `tangy read-card --bench`.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import cv2
import numpy as np
from numpy.typing import NDArray

from tangy_hw.perception.cards.reader import CardReader, CardReading
from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.cards import judge, judge_partly
from tangy_sim.rendering.card_backgrounds import background
from tangy_sim.rendering.card_frames import CardCamera, RenderedFrame, some_view

QUOTED = 150_000  # seed; no parameter was chosen on its frames
Picture: TypeAlias = NDArray[Any]
Read = Callable[[Picture], CardReading]


@dataclass
class Count:
    """The results of frames of one kind."""

    frames: int = 0
    claimed: int = 0
    full: int = 0
    wrong_cells: int = 0
    wrong_states: int = 0
    wrong_ids: int = 0
    needless: int = 0
    clear: int = 0
    seconds: list[float] = field(default_factory=list)
    worst: list[str] = field(default_factory=list)

    def line(self, name: str) -> str:
        """Return a row of the table."""
        frames = max(1, self.frames)
        cpu = f"{np.median(self.seconds) * 1e3:4.0f} {np.percentile(self.seconds, 95) * 1e3:4.0f}"
        return (
            f"{name:<22}{self.frames:>6}{self.claimed / frames:>9.1%}{self.full / frames:>9.1%}"
            f"{self.wrong_cells:>7}{self.wrong_states:>7}{self.wrong_ids:>7}"
            f"{self.needless / max(1, self.clear):>10.1%}   {cpu}"
        )


HEAD = (
    f"{'frames':<22}{'count':>6}{'card':>9}{'all':>9}{'wrong':>7}{'wrong':>7}{'wrong':>7}"
    f"{'needless':>10}   CPU ms\n"
    f"{'':<22}{'':>6}{'read':>9}{'cells':>9}{'cells':>7}{'state':>7}{'id':>7}"
    f"{'unread':>10}    50%  95%"
)


class Bench:
    """Counts over frames of an activity's cards."""

    def __init__(self, activity: Activity, camera: CardCamera | None = None) -> None:
        self.activity = activity
        self.deck = activity.deck
        self.camera = camera or CardCamera(activity.deck, title=activity.title)

    def called(self, frame: RenderedFrame, random: np.random.Generator) -> set[int]:
        """Draw the called numbers so that every user state occurs."""
        numbers = numbers_of(self.deck, frame.card or 1)
        marked = [n for cell, n in enumerate(numbers) if frame.marked >> cell & 1]
        others = [n for n in self.deck.numbers if n not in numbers]
        open_ = [n for n in numbers if n not in marked]
        called = {*marked, *(int(n) for n in random.choice(others, 15))}
        kind = random.integers(4)
        if kind == 1 and marked:
            called -= {int(n) for n in random.choice(marked, min(2, len(marked)))}
        if kind == 2 and open_:
            called |= {int(n) for n in random.choice(open_, min(2, len(open_)))}
        return called

    def judged(self, frame: RenderedFrame, called: set[int]) -> tuple[str, bool]:
        """Return the true state, and whether the hand leaves enough in sight to tell it."""
        numbers = numbers_of(self.deck, frame.card or 1)
        cells = called_cells(self.deck, numbers, called)
        states = self.activity.user_states
        true = judge(states, self.deck, frame.marked, cells)
        there = judge_partly(states, self.deck, frame.marked, frame.unknown(), cells)
        return true, there == true

    def count(
        self, into: Count, frame: RenderedFrame, reading: CardReading, called: set[int]
    ) -> None:
        """Add one reading."""
        into.frames += 1
        true, tellable = self.judged(frame, called)
        into.clear += tellable
        if reading.card is None:
            into.needless += tellable
            return
        into.claimed += 1
        into.wrong_ids += reading.card != frame.card
        told = ~reading.hidden & ((1 << len(reading.cells)) - 1)
        off = (reading.marked ^ frame.marked) & told & ~self.deck.free
        into.wrong_cells += bool(off)
        if off:
            cells = [
                f"{c}:{reading.cells[c]:.3f}" for c in range(len(reading.cells)) if off >> c & 1
            ]
            into.worst.append(f"{frame.view} {cells}")
        into.full += not reading.hidden & ~frame.between and not off
        reader = CardReader(self.deck)
        state = reader.state(reading, self.activity.user_states, called)
        unread = next(s.name for s in self.activity.user_states if s.checker == "unread")
        into.wrong_states += state not in (true, unread)
        into.needless += tellable and state == unread

    def scenes(self, seed: int, count: int, frames: int) -> Iterator[list[RenderedFrame]]:
        """Yield scenes: the same card and chips from nearly the same place, with a moving hand."""
        for number in range(count):
            random = np.random.default_rng([seed, number])
            view = some_view(random, pixels=24.0 + 20 * random.random())
            cells = self.deck.rows * len(self.deck.columns)
            share = random.uniform(0, 0.65)
            marked = sum(1 << c for c in range(cells) if random.random() < share) & ~self.deck.free
            chips, card = self.camera.chips(random, marked), int(random.integers(1, 250))
            shown = []
            for _ in range(frames):
                now = replace(
                    view,
                    tilt=max(0.0, view.tilt + random.normal(0, 2)),
                    spin=view.spin + random.normal(0, 2),
                    pixels=view.pixels * random.normal(1, 0.02),
                    hand=view.hand if random.random() < 0.7 else "",
                )
                look = int(random.integers(1 << 30))
                shown.append(self.camera.take(card, chips, now, np.random.default_rng(look)))
            yield shown


def timed(read: Read, picture: Picture, into: Count) -> CardReading:
    begun = time.process_time()
    reading = read(picture)
    into.seconds.append(time.process_time() - begun)
    return reading


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=QUOTED)
    parser.add_argument("--paper", type=int, default=100, help="how many for the paper's design")
    parser.add_argument("--method", choices=["tags", "paper"], default="tags")
    parser.add_argument("--worst", action="store_true", help="print the views that were misread")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    bench = Bench(load_activity("bingo"))
    reader = CardReader(bench.deck)
    read: Read = reader.read
    print(HEAD, flush=True)
    counts: dict[str, Count] = {}
    names = ("all", "no hand", "hand", "18 to 24 px", "24 px and more", "tilt over 40")
    for name in names:
        counts[name] = Count()
    papers = {"paper: all": Count()}
    if options.method == "paper":
        from tangy_hw.perception.cards.paper import PaperReader

        paper = PaperReader(bench.deck, bench.activity.title)
    for number, frame in enumerate(bench.camera.frames(options.seed, options.frames)):
        called = bench.called(frame, np.random.default_rng([options.seed, number, 1]))
        view = frame.view
        groups = [
            "all", "hand" if view.hand else "no hand",
            "18 to 24 px" if view.pixels < 24 else "24 px and more",
            *(["tilt over 40"] if view.tilt > 40 else []),
        ]  # fmt: skip
        reading = timed(read, frame.picture, counts["all"])
        for group in groups:
            if group != "all":
                counts[group].seconds.append(counts["all"].seconds[-1])
            bench.count(counts[group], frame, reading, called)
        if options.method == "paper" and number < options.paper:
            into = papers["paper: all"]
            bench.count(into, frame, timed(paper.read, frame.picture, into), called)
    for name, count in counts.items():
        print(count.line(name), flush=True)
    if options.worst:
        print("\n".join(counts["all"].worst))
    if options.method == "paper":
        print(papers["paper: all"].line("paper: the first"), flush=True)

    steep = Count()
    for number, frame in enumerate(
        bench.camera.frames(options.seed + 1, options.frames // 10, tilt=60.0, hand="")
    ):
        called = bench.called(frame, np.random.default_rng([options.seed, number, 1]))
        bench.count(steep, frame, timed(read, frame.picture, steep), called)
    print(steep.line("tilt 60"), flush=True)

    fused = Count()
    for number, scene in enumerate(bench.scenes(options.seed + 2, options.frames // 10, 5)):
        readings = [timed(read, frame.picture, fused) for frame in scene]
        called = bench.called(scene[0], np.random.default_rng([options.seed, number, 1]))
        least = tuple(min(parts) for parts in zip(*(f.covered for f in scene), strict=True))
        seen = replace(scene[-1], covered=least)
        bench.count(fused, seen, reader.fuse(readings), called)
    print(fused.line("five frames, 24 px"), flush=True)

    foreign, nothing = Count(), Count()
    other = CardCamera(bench.deck, deck_seed=2, title=bench.activity.title)
    for frame in other.frames(options.seed + 3, options.frames // 10):
        claim(foreign, timed(read, frame.picture, foreign))
    print(foreign.line("cards of another deck"), flush=True)
    for number in range(options.frames // 10):
        random = np.random.default_rng([options.seed + 4, number])
        room = background(1280, 720, random) + random.normal(0, 0.01, (720, 1280, 3))
        picture = np.clip(room * 255, 0, 255).astype(np.uint8)
        claim(nothing, timed(read, picture, nothing))
    print(nothing.line("no card"), flush=True)


def claim(into: Count, reading: CardReading) -> None:
    """Count a frame in which there is no card of the deck."""
    into.frames += 1
    into.claimed += reading.card is not None
    into.wrong_ids += reading.card is not None


if __name__ == "__main__":
    main()
