"""Dead ends of a search: states from which no game ends, and the loops in which games stay."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence

from tangy_profiles.declared.search_way import Node

Earlier = Mapping[Node, Sequence[Node]]
"""The predecessors of each node of a search."""


def without_end(nodes: Iterable[Node], earlier: Earlier, ends: Iterable[Node]) -> list[Node]:
    """Return the nodes from which no end is reachable, in the order of the search.

    Args:
        nodes: every node of the search.
        earlier: the predecessors of each node.
        ends: the nodes in which a game is over.
    """
    can = set(ends)
    waiting = deque(can)
    while waiting:
        for one in earlier.get(waiting.popleft(), ()):
            if one not in can:
                can.add(one)
                waiting.append(one)
    return [node for node in nodes if node not in can]


def loop_in(stuck: Sequence[Node], earlier: Earlier) -> list[Node]:
    """Return a set of nodes that a game can never leave, and in which each is reachable again.

    It is the strongly connected component (by Kosaraju's algorithm) without outgoing edges that the
    search reaches first.

    Args:
        stuck: nodes from which no end is reachable, in the order of the search; at least one.
        earlier: the predecessors of each node.
    """
    later: dict[Node, list[Node]] = {}
    for node in stuck:
        for one in earlier.get(node, ()):
            later.setdefault(one, []).append(node)
    place = {node: number for number, node in enumerate(stuck)}
    part_of: dict[Node, int] = {}
    sinks: list[list[Node]] = []
    for root in reversed(_finished(stuck, earlier)):
        if root in part_of:
            continue
        part_of[root] = place[root]
        part, waiting, leaves = [root], [root], False
        while waiting:
            for one in later.get(waiting.pop(), ()):
                if one not in part_of:
                    part_of[one] = place[root]
                    part.append(one)
                    waiting.append(one)
                leaves = leaves or part_of[one] != place[root]
        if not leaves:
            part.sort(key=lambda one: place[one])
            sinks.append(part)
    return min(sinks, key=lambda nodes: place[nodes[0]])


def _finished(stuck: Sequence[Node], earlier: Earlier) -> list[Node]:
    """Return the nodes in the finishing order of a depth-first search on the reversed graph."""
    left, finished = set(stuck), list[Node]()
    for root in stuck:
        path = [(root, iter(earlier.get(root, ())))] if root in left else []
        left.discard(root)
        while path:
            one = next((one for one in path[-1][1] if one in left), None)
            if one is None:
                finished.append(path.pop()[0])
            else:
                left.discard(one)
                path.append((one, iter(earlier.get(one, ()))))
    return finished
