"""Objects that people use instead of chips: paper, coins, beans, glass, washers."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

from tangy_sim.rendering.card_backgrounds import Tone, tone_of
from tangy_sim.rendering.card_chips import HUES, Chip, Outline

if TYPE_CHECKING:
    import numpy as np

SORTS = {
    "white paper": 0.24, "clear": 0.2, "coin": 0.12, "bean": 0.16, "washer": 0.1,
    "cut out": 0.08, "striped": 0.05, "pastel": 0.05,
}  # fmt: skip
"""Probability of each sort."""


def odd_chip(random: np.random.Generator) -> Chip:
    """Draw a random substitute for chips: see `SORTS`."""
    sort = str(random.choice(list(SORTS), p=list(SORTS.values())))
    uniform = random.uniform
    hue = float(random.choice([*HUES.values(), 180])) + random.normal(0, 8)
    turn = float(uniform(0, pi))
    flat = Chip(
        float(uniform(7.0, 10.8)), tone_of(hue, uniform(0.4, 1), uniform(0.3, 1)), 0, 0.05, 0
    )
    if sort == "white paper":
        shape = Outline(long=float(uniform(1, 1.4)), turn=turn, corners=4)
        outline = float(uniform(0.05, 0.35)) if random.random() < 0.6 else 0.0
        white = tone_of(uniform(20, 70), uniform(0, 0.07), uniform(0.86, 1))
        if random.random() < 0.5:
            return replace(flat, tone=white, outline=outline)
        return replace(flat, tone=white, shape=shape)
    if sort == "clear":
        tone = tone_of(hue, uniform(0, 0.5), uniform(0.85, 1))
        return replace(
            flat,
            tone=tone,
            clear=float(uniform(0.5, 0.9)),
            thick=float(uniform(0.3, 3)),
            outline=float(uniform(0.12, 0.6)),
            ring=float(uniform(-0.4, 0)) if random.random() < 0.3 else 0.0,
            washed=bool(random.random() < 0.4),
        )
    if sort == "coin":
        metal: Tone = tone_of(uniform(15, 50), uniform(0, 0.55), uniform(0.35, 0.95))
        return replace(
            flat,
            radius=float(uniform(8, 11.8)),
            tone=metal,
            thick=float(uniform(1, 2.2)),
            rim=float(uniform(-0.25, 0.35)),
            ring=float(uniform(-0.4, 0.3)) if random.random() < 0.5 else 0.0,
            relief=float(uniform(0.04, 0.3)),
        )
    if sort == "bean":
        brown = tone_of(uniform(5, 50), uniform(0.05, 0.8), uniform(0.12, 1))
        shape = Outline(long=float(uniform(1.1, 1.9)), turn=turn)
        rim, thick = float(uniform(-0.4, -0.05)), float(uniform(1.5, 5))
        radius = float(uniform(5, 8.5))
        return replace(flat, radius=radius, tone=brown, thick=thick, rim=rim, shape=shape)
    if sort == "washer":
        tone = tone_of(hue, uniform(0, 1) * (random.random() < 0.5), uniform(0.3, 0.95))
        shape = Outline(hole=float(uniform(0.3, 0.6)))
        return replace(flat, tone=tone, thick=float(uniform(0.3, 2)), shape=shape)
    if sort == "cut out":
        shape = Outline(long=float(uniform(1, 1.6)), turn=turn, corners=int(random.integers(3, 7)))
        thick = float(uniform(0.05, 3))
        return replace(flat, thick=thick, shape=shape, relief=float(uniform(0, 0.15)))
    if sort == "striped":
        return replace(flat, thick=3.0, stripes=int(random.integers(3, 9)))
    pale = tone_of(hue, uniform(0.05, 0.25), uniform(0.85, 1))
    return replace(flat, tone=pale, thick=float(uniform(0.05, 1)))


def sheer_chip(random: np.random.Generator) -> Chip:
    """Draw a film or a very clear chip: the print shows through it, dyed or paler."""
    uniform = random.uniform
    hue = float(random.choice([*HUES.values(), 180])) + random.normal(0, 10)
    dyed = random.random() < 0.75
    tone = tone_of(hue, uniform(0.25, 1.0) if dyed else uniform(0, 0.12), uniform(0.55, 1.0))
    clear = float(uniform(0.35, 0.88) if dyed else uniform(0.3, 0.75))
    cut = random.random() < 0.3
    corners = int(random.integers(3, 7)) if cut else 0
    plain = random.random() < 0.4
    return Chip(
        float(uniform(7.0, 10.8)),
        tone,
        clear,
        0.05 if plain else float(uniform(0.3, 2.5)),
        0.0 if plain else float(uniform(-0.3, 0.1)),
        outline=0.0 if (plain and dyed) or cut else float(uniform(0.1, 0.5)),
        washed=bool(random.random() < 0.35),
        shape=Outline(long=float(uniform(1, 1.5)), turn=float(uniform(0, pi)), corners=corners),
        sheer=True,
    )
