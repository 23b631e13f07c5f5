"""The positions of a tree's nodes: a tidy tree of boxes of any size, in linear time.

The algorithm is that of A. van der Ploeg, "Drawing non-layered tidy trees in linear time", Software: Practice and
Experience 44 (12), 2014, pp. 1467-1484, with contours as lists: of two that are joined, the deeper one is kept and the
other written into it, so that the time is linear without the threads of Reingold and Tilford.

Nodes here have layers all the same, but what hangs below a leaf pushes no layer down; and a box has an anchor, the
point placed over the middle of its children.

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
        _place_children(node)
    _add_up(order)
    least = min(node.position for node in nodes)
    return [(round(node.position - least), node.start) for node in nodes]


class _Contour:
    """One side of a subtree, or of several next to each other.

    Attributes:
        boxes: where each box on it ends in depth, and its side; the lowest first.
        moved: what to add to the sides.
    """

    __slots__ = ("boxes", "moved")

    def __init__(self) -> None:
        self.boxes: list[tuple[int, float]] = []
        self.moved = 0.0

    @property
    def bottom(self) -> int:
        return self.boxes[0][0]

    def begin(self, end: int, side: float) -> None:
        """Put a box above the others."""
        self.boxes.append((end, side - self.moved))

    def continued(self, other: _Contour) -> _Contour:
        """This contour, and below it the other one; neither can be used any more."""
        if other.bottom <= self.bottom:
            return self
        while other.boxes[-1][0] <= self.bottom:
            other.boxes.pop()
        moved = self.moved - other.moved
        other.boxes += [(end, side + moved) for end, side in self.boxes]
        return other


class _Node:
    """A box during placement.

    Attributes:
        breadth: with the gap to the next sibling.
        start, end: its depth; an inner box reaches to its children, so that contours have no holes.
        preliminary: its position, relative to the place that `modifier` moves.
        modifier: what is added to the positions of the whole subtree.
        shift, change: what to spread over the siblings between two that were moved apart.
        left, right: the contours of the subtree.
    """

    def __init__(self, breadth: int, depth: int, anchor: int) -> None:
        self.breadth = breadth
        self.start = 0
        self.end = depth
        self.anchor = anchor
        self.children: list[_Node] = []
        self.position = self.preliminary = self.modifier = self.shift = self.change = 0.0
        self.left, self.right = _Contour(), _Contour()


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


def _place_children(node: _Node) -> None:
    """Place the children of a node, whose own subtrees are already placed, next to each other."""
    if node.children:
        first, last = node.children[0], node.children[-1]
        left, right = first.left, first.right
        lows = [(left.bottom, 0)]  # the siblings whose subtrees reach deeper than all after them, and how deep
        for index, child in enumerate(node.children[1:], start=1):
            _separate(node.children, index, right, lows)
            bottom = child.left.bottom
            while lows and lows[-1][0] <= bottom:
                lows.pop()
            lows.append((bottom, index))
            left, right = left.continued(child.left), child.right.continued(right)
        anchors = first.preliminary + first.modifier + first.anchor + last.preliminary + last.modifier + last.anchor
        node.preliminary = anchors / 2 - node.anchor
        node.left, node.right = left, right
    node.left.begin(node.end, node.preliminary)
    node.right.begin(node.end, node.preliminary + node.breadth)


def _separate(children: list[_Node], index: int, before: _Contour, lows: Sequence[tuple[int, int]]) -> None:
    """Move a child's subtree away from those before it, along the contours between them."""
    child = children[index]
    before_index, child_index, low = len(before.boxes) - 1, len(child.left.boxes) - 1, len(lows) - 1
    while before_index >= 0 and child_index >= 0:
        (end, side), (own_end, own_side) = before.boxes[before_index], child.left.boxes[child_index]
        while end > lows[low][0]:
            low -= 1
        distance = (side + before.moved) - (own_side + child.left.moved)
        if distance > 0:
            child.modifier += distance
            child.left.moved += distance
            child.right.moved += distance
            sibling = lows[low][1]
            if sibling != index - 1:  # the siblings between share the distance
                share = distance / (index - sibling)
                children[sibling + 1].shift += share
                child.shift -= share
                child.change -= distance - share
        before_index -= end <= own_end
        child_index -= end >= own_end


def _add_up(order: Sequence[_Node]) -> None:
    """Add up the modifiers from the top."""
    sums = {id(order[0]): 0.0}
    for node in order:
        total = sums.pop(id(node)) + node.modifier
        node.position = node.preliminary + total
        shift = change = 0.0
        for child in node.children:
            shift += child.shift
            change += shift + child.change
            child.modifier += change
            sums[id(child)] = total
