"""The positions of a tree's nodes: a tidy tree of boxes of any size, in linear time.

The algorithm is that of A. van der Ploeg, "Drawing non-layered tidy trees in linear time", Software: Practice and
Experience 44 (12), 2014, pp. 1467-1484: Reingold and Tilford's contours and threads, as C. Buchheim, M. Jünger and S.
Leipert ("Improving Walker's Algorithm to Run in Linear Time", Graph Drawing 2002) made them linear for any number of
children, with boxes of any height.  Nodes here have layers all the same, but what hangs below a leaf pushes no layer
down; and a box has an anchor, the point placed over the middle of its children.

One invariant: no two boxes overlap, and a parent's anchor is midway between those of its first and last child.
`breadth` is the direction in which siblings are next to each other, `depth` that in which children follow parents.
"""

from __future__ import annotations

from collections.abc import Sequence

from btq_lang.util.record import Record


class Size(Record):
    """A box: its breadth and depth, and where in its breadth its anchor is."""

    breadth: int
    depth: int
    anchor: int


def layout(sizes: Sequence[Size], parents: Sequence[int | None], gap: int, level_gap: int) -> list[tuple[int, int]]:
    """The smallest breadth and depth coordinate of each box; the smallest of all are 0.

    Args:
        parents: the index of each box's parent; parents come before their children.
        gap: between siblings.
        level_gap: between a layer's inner boxes and the next layer.
    """
    if not sizes:
        return []
    top = _Node(0, 0, 0)
    nodes = [_Node(size.breadth + gap, size.depth, size.anchor) for size in sizes]
    for node, parent in zip(nodes, parents, strict=True):
        (nodes[parent] if parent is not None else top).children.append(node)
    _layers(nodes, parents, level_gap)
    order = [top, *nodes]
    for node in reversed(order):  # children before their parents, the first child's subtree complete before the next
        _first_walk(node)
    _second_walk(order)
    least = min(node.at for node in nodes)
    return [(round(node.at - least), node.start) for node in nodes]


class _Node:
    """A box during placement.  The names are the paper's, written out.

    Attributes:
        breadth: with the gap to the next sibling.
        start, end: its depth; an inner box reaches to its children, so that contours have no holes.
        preliminary: its position, relative to the place that `modifier` moves.
        modifier: what is added to the positions of the whole subtree.
        shift, change: what to spread over the siblings between two that were moved apart.
        thread_left, thread_right: for a leaf, the next node of the contour.
        extreme_left, extreme_right: the lowest nodes of the contours, and the sums of modifiers down to them.
    """

    __slots__ = (
        "anchor",
        "at",
        "breadth",
        "change",
        "children",
        "end",
        "extreme_left",
        "extreme_left_sum",
        "extreme_right",
        "extreme_right_sum",
        "modifier",
        "preliminary",
        "shift",
        "start",
        "thread_left",
        "thread_right",
    )

    def __init__(self, breadth: int, depth: int, anchor: int) -> None:
        self.breadth = breadth
        self.start = 0
        self.end = depth
        self.anchor = anchor
        self.children: list[_Node] = []
        self.at = self.preliminary = self.modifier = self.shift = self.change = 0.0
        self.thread_left: _Node | None = None
        self.thread_right: _Node | None = None
        self.extreme_left = self.extreme_right = self
        self.extreme_left_sum = self.extreme_right_sum = 0.0


def _layers(nodes: Sequence[_Node], parents: Sequence[int | None], level_gap: int) -> None:
    """Put each node in its layer: below the deepest inner box of the previous layer."""
    levels: list[int] = []
    for parent in parents:
        levels.append(0 if parent is None else levels[parent] + 1)
    deepest = [0] * (max(levels) + 1)
    for node, level in zip(nodes, levels, strict=True):
        if node.children:
            deepest[level] = max(deepest[level], node.end)
    starts = [0]
    for depth in deepest:
        starts.append(starts[-1] + depth + level_gap)
    for node, level in zip(nodes, levels, strict=True):
        node.start = starts[level]
        node.end = starts[level + 1] if node.children else starts[level] + node.end


def _first_walk(node: _Node) -> None:
    """Place the children of a node, whose own subtrees are already placed, next to each other."""
    children = node.children
    if not children:
        return
    lows = _Low(children[0].extreme_left.end, 0, None)
    for index in range(1, len(children)):
        low = children[index].extreme_right.end
        _separate(children, index, lows)
        lows = _Low(low, index, _above(lows, low))
    first, last = children[0], children[-1]
    anchors = first.preliminary + first.modifier + first.anchor + last.preliminary + last.modifier + last.anchor
    node.preliminary = anchors / 2 - node.anchor
    node.extreme_left, node.extreme_left_sum = first.extreme_left, first.extreme_left_sum
    node.extreme_right, node.extreme_right_sum = last.extreme_right, last.extreme_right_sum


class _Low:
    """The siblings whose subtrees reach deepest so far, the last one first: the ones that a new subtree can collide
    with.
    """

    __slots__ = ("index", "low", "next")

    def __init__(self, low: int, index: int, following: _Low | None) -> None:
        self.low = low
        self.index = index
        self.next = following


def _above(lows: _Low | None, low: int) -> _Low | None:
    while lows is not None and low >= lows.low:
        lows = lows.next
    return lows


def _separate(children: list[_Node], index: int, lows: _Low) -> None:
    """Move a child's subtree away from those before it, along the contours between them."""
    left: _Node | None = children[index - 1]
    right: _Node | None = children[index]
    left_sum, right_sum = children[index - 1].modifier, children[index].modifier
    while left is not None and right is not None:
        while left.end > lows.low and lows.next is not None:
            lows = lows.next
        distance = (left_sum + left.preliminary + left.breadth) - (right_sum + right.preliminary)
        if distance > 0:
            right_sum += distance
            _move(children, index, lows.index, distance)
        left_end, right_end = left.end, right.end
        if left_end <= right_end:
            left = left.children[-1] if left.children else left.thread_right
            left_sum += left.modifier if left is not None else 0
        if left_end >= right_end:
            right = right.children[0] if right.children else right.thread_left
            right_sum += right.modifier if right is not None else 0
    if left is None and right is not None:
        _thread_left(children, index, right, right_sum)
    elif right is None and left is not None:
        _thread_right(children, index, left, left_sum)


def _move(children: list[_Node], index: int, met: int, distance: float) -> None:
    child = children[index]
    child.modifier += distance
    child.extreme_left_sum += distance
    child.extreme_right_sum += distance
    if met != index - 1:  # the siblings between share the distance
        share = distance / (index - met)
        children[met + 1].shift += share
        child.shift -= share
        child.change -= distance - share


def _thread_left(children: list[_Node], index: int, node: _Node, total: float) -> None:
    first, child = children[0], children[index]
    lowest = first.extreme_left
    lowest.thread_left = node
    difference = (total - node.modifier) - first.extreme_left_sum
    lowest.modifier += difference
    lowest.preliminary -= difference
    first.extreme_left, first.extreme_left_sum = child.extreme_left, child.extreme_left_sum


def _thread_right(children: list[_Node], index: int, node: _Node, total: float) -> None:
    before, child = children[index - 1], children[index]
    lowest = child.extreme_right
    lowest.thread_right = node
    difference = (total - node.modifier) - child.extreme_right_sum
    lowest.modifier += difference
    lowest.preliminary -= difference
    child.extreme_right, child.extreme_right_sum = before.extreme_right, before.extreme_right_sum


def _second_walk(order: Sequence[_Node]) -> None:
    """Add up the modifiers from the top."""
    sums = {id(order[0]): 0.0}
    for node in order:
        total = sums.pop(id(node)) + node.modifier
        node.at = node.preliminary + total
        shift = change = 0.0
        for child in node.children:
            shift += child.shift
            change += shift + child.change
            child.modifier += change
            sums[id(child)] = total
