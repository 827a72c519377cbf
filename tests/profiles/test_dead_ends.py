"""Dead ends of games, compared with a search from every state."""

from __future__ import annotations

from random import Random

from tangy_profiles.declared.dead_ends import loop_in, without_end
from tangy_profiles.declared.search_way import Node


def reached(later: dict[Node, list[Node]], begin: Node) -> set[Node]:
    found, waiting = {begin}, [begin]
    while waiting:
        for one in later.get(waiting.pop(), []):
            if one not in found:
                found.add(one)
                waiting.append(one)
    return found


def test_the_loop_is_the_first_set_of_states_without_exit() -> None:
    draw, several = Random(5), 0
    for _ in range(300):
        nodes: list[Node] = [(True, number) for number in range(draw.randint(1, 9))]
        later = {node: draw.choices(nodes, k=draw.randint(1, 2)) for node in nodes}
        earlier = {one: [n for n in nodes if one in later[n]] for one in nodes}
        sinks = [
            part
            for part in (reached(later, node) for node in nodes)
            if all(reached(later, one) == part for one in part)
        ]
        assert set(loop_in(nodes, earlier)) == sinks[0]
        several += len({frozenset(one) for one in sinks}) > 1
    assert several > 20


def test_states_from_which_an_end_can_be_reached_are_left_out() -> None:
    a: Node = (True, "a")
    b: Node = (True, "b")
    c: Node = (True, "c")
    end: Node = (True, "end")
    earlier = {b: [a], c: [a, c], end: [b]}
    assert without_end([a, b, c, end], earlier, [end]) == [c]
