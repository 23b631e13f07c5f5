"""Which nodes of two missions correspond: tree matching by hashes.

The method is that of GumTree (Falleri et al., "Fine-grained and accurate source code differencing", ASE 2014), whose
two phases it keeps, with the hashes and the bounded search upwards of XyDiff (Cobéna, Abiteboul, Marian, "Detecting
changes in XML documents", ICDE 2002), so that the time is linear in the number of nodes, not quadratic:

0. trees of one name match; then renamed ones, by their contents;
1. subtrees that are identical, and occur once on either side, match, the largest first; 2. nodes of one kind that share
half of their contents match, those that share most first; 3. children of two matched nodes are aligned by longest
common subsequences: of identical subtrees, then
   of nodes' own values, then of kind and name, kind, name;
4. what is left is matched elsewhere: identical subtrees, then nodes of one kind and one name.

One invariant: no node is matched twice, and descendants of identical nodes are matched in order.  The changes of
matched nodes are for `nodes`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Final, TypeAlias

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.diff.contents import TREE, TreePart
from btq_lang.util.grouping import grouped

Ids: TypeAlias = dict[Hashable, int]
Key: TypeAlias = "Callable[[Forest, int], Hashable]"

_UPWARDS: Final = 4  # how many levels above an identical subtree its holder is looked for
_TABLE: Final = 1_000_000  # cells of the largest table that is filled for a longest common subsequence
_FEW: Final = 20  # trees that are compared in full
_SAME: Final = 0.5  # how much two must share to match: as GumTree requires of nodes, and git of files


class Forest:
    """The trees of a mission as one list.

    Attributes:
        parts: trees and nodes, depth first, in document order.
        parents: the index of each part's parent, -1 of trees.
        depths: number of parts above each.
        sizes: number of parts in each, itself included.
        children: indices.
        kinds: the kind of each part and, for a SubTree, the tree it calls.
        own: a number for each part's own values; equal if they are.
        whole: a number for the part and all below it.
        match: the index of each part's match in the other forest, -1 if there is none.
    """

    def __init__(self, trees: Sequence[TreePart]) -> None:
        self.parts: Final[list[TreePart]] = []
        self.parents: Final[list[int]] = []
        stack = [(tree, -1) for tree in reversed(trees)]
        while stack:
            part, parent = stack.pop()
            stack += [(child, len(self.parts)) for child in reversed(part.children)]
            self.parts.append(part)
            self.parents.append(parent)
        self.children: Final[list[list[int]]] = [[] for _ in self.parts]
        self.depths: Final[list[int]] = []
        for parent in self.parents:
            self.depths.append(self.depths[parent] + 1 if parent >= 0 else 0)
        self.sizes: Final = [1] * len(self.parts)
        for index in range(len(self.parts) - 1, -1, -1):
            if (parent := self.parents[index]) >= 0:
                self.sizes[parent] += self.sizes[index]
                self.children[parent].append(index)
        for below in self.children:
            below.reverse()
        self.kinds: list[Hashable] = []
        self.own: list[int] = []
        self.whole: list[int] = []
        self.match: list[int] = [-1] * len(self.parts)

    @property
    def tops(self) -> Iterator[int]:
        return (index for index, parent in enumerate(self.parents) if parent < 0)

    def number(self, ids: Ids, renamed: Mapping[tuple[str, str], str]) -> None:
        """Give parts their numbers; `renamed`: new names of the other mission's things, by thing and name."""

        def id_of(content: Hashable) -> int:
            return ids.setdefault(content, len(ids))

        self.kinds = [_kind(part, renamed) for part in self.parts]
        self.own = [id_of(_content(part, kind, renamed)) for part, kind in zip(self.parts, self.kinds, strict=True)]
        self.whole = [0] * len(self.parts)
        for index in range(len(self.parts) - 1, -1, -1):
            self.whole[index] = id_of((self.own[index], *(self.whole[child] for child in self.children[index])))


def match(old: Forest, new: Forest, renamed: dict[tuple[str, str], str]) -> None:
    """Match two forests; `renamed`: new names of the old mission's things, to which trees are added."""
    ids: Ids = {}
    old.number(ids, renamed)
    new.number(ids, {})
    for one, other in _same_trees(old, new):
        _pair(old, new, one, other)
        before, after = old.parts[one].name, new.parts[other].name
        if before != after and before is not None and after is not None:
            renamed["tree", before] = after
    old.number(ids, renamed)
    tops = [(top, old.match[top]) for top in old.tops if old.match[top] >= 0]
    for one, other in tops:
        _identical(old, new, range(one, one + old.sizes[one]), range(other, other + new.sizes[other]))
    _holders(old, new)
    _line_up(old, new)
    for one, other in tops:
        _leftovers(old, new, range(one, one + old.sizes[one]), range(other, other + new.sizes[other]))
    _leftovers(old, new, range(len(old.parts)), range(len(new.parts)), elsewhere=True)
    _line_up(old, new)


def _kind(part: TreePart, renamed: Mapping[tuple[str, str], str]) -> Hashable:
    target = renamed.get(("tree", part.target), part.target) if part.target is not None else None
    return renamed.get(("node model", part.kind), part.kind), target


def _content(part: TreePart, kind: Hashable, renamed: Mapping[tuple[str, str], str]) -> Hashable:
    values = frozenset((renamed_aspect(aspect, renamed), value.key) for aspect, value in part.values.items())
    return kind, None if part.kind == TREE else part.name, values


def renamed_aspect(aspect: str, renamed: Mapping[tuple[str, str], str]) -> str:
    """An aspect of an old part under the name that it has in the new mission."""
    thing, _, name = aspect.partition(" ")
    new = renamed.get((thing, name)) if thing == "requirement" else None
    return aspect if new is None else f"{thing} {new}"


def _pair(old: Forest, new: Forest, one: int, other: int) -> None:
    old.match[one], new.match[other] = other, one


# ---- 0: trees ----


def _same_trees(old: Forest, new: Forest) -> Iterator[tuple[int, int]]:
    """Pairs of trees: of one name, then of equal contents, then of mostly equal contents."""
    left, right = dict.fromkeys(old.tops), dict.fromkeys(new.tops)
    steps: tuple[Key, ...] = (lambda forest, top: forest.parts[top].name, lambda forest, top: forest.whole[top])
    for key in steps:
        waiting = grouped((key(new, top), top) for top in reversed(right))
        for top in list(left):
            if candidates := waiting.get(key(old, top)):
                other = candidates.pop()
                del left[top], right[other]
                yield top, other
    # The trees of the new mission with a node of these values.
    holders = grouped((own, other) for other in right for own in set(_nodes(new, other)))
    for top in list(left):
        votes: Counter[int] = Counter()
        for own in _nodes(old, top):
            if len(holders.get(own, ())) <= _FEW:  # values that many trees have distinguish none
                votes.update(other for other in holders.get(own, ()) if other in right)
        shares = {other: _share(old, new, top, other) for other, _ in votes.most_common(_FEW)}
        best = max(shares, key=lambda other: shares[other], default=None)
        if best is not None and shares[best] >= _SAME:
            del left[top], right[best]
            yield top, best


def _share(old: Forest, new: Forest, one: int, other: int) -> float:
    """How much two trees share, from 0 to 1: the coefficient of Dice of their nodes' values."""
    mine, yours = _nodes(old, one), _nodes(new, other)
    total = len(mine) + len(yours)
    return 2 * (Counter(mine) & Counter(yours)).total() / total if total else 0.0


def _nodes(forest: Forest, top: int) -> list[int]:
    """The nodes of a tree, by their own values."""
    return forest.own[top + 1 : top + forest.sizes[top]]


# ---- 1: identical subtrees ----


def _identical(old: Forest, new: Forest, left: range, right: range) -> None:
    """Pair subtrees that are identical and occur once on either side; a larger one precedes what is in it."""
    numbers = Counter(old.whole[index] for index in left)
    others = Counter(new.whole[index] for index in right)
    places = {new.whole[index]: index for index in right}
    for index in left:
        whole = old.whole[index]
        if old.match[index] < 0 and numbers[whole] == 1 and others.get(whole) == 1 and new.match[places[whole]] < 0:
            _pair_all(old, new, index, places[whole])


def _pair_all(old: Forest, new: Forest, one: int, other: int) -> None:
    """Pair two identical subtrees node by node, in order."""
    for offset in range(old.sizes[one]):
        if old.match[one + offset] < 0 and new.match[other + offset] < 0:
            _pair(old, new, one + offset, other + offset)


# ---- 2: nodes that hold identical subtrees ----


def _holders(old: Forest, new: Forest) -> None:
    """Pair nodes of one kind that hold the same: those that hold most of it first, then the most similar."""
    votes: Counter[tuple[int, int]] = Counter()
    for index, other in enumerate(old.match):
        parent = old.parents[index]
        if other < 0 or parent < 0 or old.match[parent] >= 0:
            continue  # not the top of an identical subtree
        holders = tuple(_above(new, other))
        for one in _above(old, index):
            for holder in holders:
                if old.kinds[one] == new.kinds[holder]:
                    votes[one, holder] += old.sizes[index]
    for one, other in sorted(votes, key=lambda pair: (-votes[pair], *_difference(old, new, *pair), *pair)):
        below = old.sizes[one] + new.sizes[other] - 2
        if old.match[one] < 0 and new.match[other] < 0 and 2 * votes[one, other] >= _SAME * below:
            _pair(old, new, one, other)


def _difference(old: Forest, new: Forest, one: int, other: int) -> tuple[bool, bool, int]:
    other_name = old.parts[one].name != new.parts[other].name
    return old.own[one] != new.own[other], other_name, abs(old.depths[one] - new.depths[other])


def _above(forest: Forest, index: int) -> Iterator[int]:
    for _ in range(_UPWARDS):
        index = forest.parents[index]
        if index < 0 or forest.parts[index].kind == TREE:
            return
        if forest.match[index] < 0:
            yield index


# ---- 3: children ----


def _line_up(old: Forest, new: Forest) -> None:
    for one, other in enumerate(old.match):  # pairs found on the way are children, and come later
        other = old.match[one]
        if other >= 0 and old.whole[one] != new.whole[other]:
            _line_up_children(old, new, old.children[one], new.children[other])


def _line_up_children(old: Forest, new: Forest, left: list[int], right: list[int]) -> None:
    for key, anywhere in _KEYS:
        if not any(old.match[one] < 0 for one in left) or not any(new.match[other] < 0 for other in right):
            return
        # Children that are matched already keep the others on their side of them.
        mine = [("pair", old.match[one]) if old.match[one] >= 0 else ("key", key(old, one)) for one in left]
        yours = [("pair", other) if new.match[other] >= 0 else ("key", key(new, other)) for other in right]
        for index, other_index in common(mine, yours):
            _pair_if_free(old, new, left[index], right[other_index])
        if anywhere:
            _pair_equal(old, new, left, right, key)
    _replaced(old, new, left, right)


def _pair_equal(old: Forest, new: Forest, left: Iterable[int], right: Sequence[int], key: Key) -> None:
    """Pair unmatched parts of equal keys, in order."""
    waiting = grouped((key(new, other), other) for other in reversed(right) if new.match[other] < 0)
    for one in left:
        candidates = waiting.get(key(old, one), []) if old.match[one] < 0 else []
        while candidates and new.match[candidates[-1]] >= 0:  # in an identical subtree that was paired before
            candidates.pop()
        if candidates:
            _pair_if_free(old, new, one, candidates.pop())


def _pair_if_free(old: Forest, new: Forest, one: int, other: int) -> None:
    if old.match[one] < 0 and new.match[other] < 0:
        if old.whole[one] == new.whole[other]:
            _pair_all(old, new, one, other)
        else:
            _pair(old, new, one, other)


def _replaced(old: Forest, new: Forest, left: list[int], right: list[int]) -> None:
    """A node in the place of another, with its children or ports, is that node with a new kind."""
    gaps: dict[int, tuple[list[int], list[int]]] = {}
    for forest, children, side in ((old, left, 0), (new, right, 1)):
        previous = -1
        for child in children:
            if forest.match[child] >= 0:
                previous = child if side else forest.match[child]
            else:
                gaps.setdefault(previous, ([], []))[side].append(child)
    for mine, yours in gaps.values():
        if len(mine) == len(yours) == 1 and _takes_its_place(old, new, mine[0], yours[0]):
            _pair(old, new, mine[0], yours[0])


def _takes_its_place(old: Forest, new: Forest, one: int, other: int) -> bool:
    below, others = old.children[one], new.children[other]
    if bool(below) != bool(others):
        return False
    if below:
        # Its former children are still below it: in it, and not around it or in a part of it.
        inside = set(others)
        return all(old.match[child] < 0 or old.match[child] in inside for child in below) and any(
            old.match[child] in inside or old.own[child] in {new.own[each] for each in others} for child in below
        )
    mine, yours = old.parts[one], new.parts[other]
    return (mine.name is not None and mine.name == yours.name) or mine.values.keys() == yours.values.keys()


def common(left: Sequence[Hashable], right: Sequence[Hashable]) -> list[tuple[int, int]]:
    """A longest common subsequence, as pairs of positions; merely a long one if the table for it would be too large.

    The equal ends are cut off; between them the table of Wagner and Fischer is filled.
    """
    start, end, other_end = 0, len(left), len(right)
    while start < end and start < other_end and left[start] == right[start]:
        start += 1
    while end > start and other_end > start and left[end - 1] == right[other_end - 1]:
        end, other_end = end - 1, other_end - 1
    ends = [(index, index) for index in range(start)]
    ends += [(end + step, other_end + step) for step in range(len(left) - end)]
    mine, yours = left[start:end], right[start:other_end]
    between = _table(mine, yours) if len(mine) * len(yours) <= _TABLE else _rough(mine, yours)
    return sorted(ends + [(index + start, other + start) for index, other in between])


def _table(left: Sequence[Hashable], right: Sequence[Hashable]) -> list[tuple[int, int]]:
    rows = [[0] * (len(right) + 1) for _ in range(len(left) + 1)]
    for index in range(len(left) - 1, -1, -1):
        row, below, mine = rows[index], rows[index + 1], left[index]
        for other in range(len(right) - 1, -1, -1):
            row[other] = below[other + 1] + 1 if mine == right[other] else max(below[other], row[other + 1])
    pairs = []
    index = other = 0
    while index < len(left) and other < len(right):
        if left[index] == right[other]:
            pairs.append((index, other))
            index, other = index + 1, other + 1
        elif rows[index + 1][other] >= rows[index][other + 1]:
            index += 1
        else:
            other += 1
    return pairs


def _rough(left: Sequence[Hashable], right: Sequence[Hashable]) -> list[tuple[int, int]]:
    """Each one on the left with the next equal one on the right."""
    places = grouped((right[other], other) for other in range(len(right) - 1, -1, -1))
    pairs = []
    last = -1
    for index, key in enumerate(left):
        waiting = places.get(key, [])
        while waiting and waiting[-1] <= last:
            waiting.pop()
        if waiting:
            last = waiting.pop()
            pairs.append((index, last))
    return pairs


# How children are aligned, the surest way first; whether also those that changed places.
_KEYS: Final[tuple[tuple[Key, bool], ...]] = (
    (lambda forest, index: forest.whole[index], True),
    (lambda forest, index: forest.own[index], True),
    (lambda forest, index: (forest.kinds[index], forest.parts[index].name), True),
    (lambda forest, index: forest.kinds[index], False),
    (lambda forest, index: forest.parts[index].name or object(), False),  # unnamed nodes match no other
)


# ---- 4: what is left ----


def _leftovers(old: Forest, new: Forest, left: range, right: range, elsewhere: bool = False) -> None:
    """Pair unmatched parts: identical subtrees, then nodes of one kind and one name.

    Args:
        elsewhere: whether in other trees; there, only those that a reader would recognize.
    """
    candidates = [one for one in left if _is_recognizable(old, one)] if elsewhere else left
    _pair_equal(old, new, candidates, right, lambda forest, index: forest.whole[index])
    mine, yours = _by_name(old, left), _by_name(new, right)
    for key, indices in mine.items():
        others = yours.get(key, [])
        if len(indices) == len(others) == 1:
            _pair(old, new, indices[0], others[0])


def _by_name(forest: Forest, places: range) -> dict[Hashable, list[int]]:
    """The unmatched parts that have a name of their own, by kind and name."""
    free = ((index, forest.parts[index]) for index in places if forest.match[index] < 0)
    named = ((index, part) for index, part in free if part.name is not None and part.kind != TREE)
    return grouped(((forest.kinds[index], part.name), index) for index, part in named)


def _is_recognizable(forest: Forest, index: int) -> bool:
    part = forest.parts[index]
    return forest.sizes[index] > 1 or part.kind not in BUILTINS or part.name is not None or bool(part.values)
