"""What changed in the trees: from two matched forests, the changes that turn one into the other.

One invariant: without changes the trees mean the same, and each node is reported at most once as `added`, `removed`,
`moved` or `changed`.  A node that was put around others moves none of them: a node has moved if its nearest ancestor
that is in both missions is another one, or if it has changed sides with one of its siblings there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal

from btq_lang.diff.changes import Change, Detail, details
from btq_lang.diff.contents import SUBTREE, TREE, VERBATIM, TreePart, Values
from btq_lang.diff.matching import Forest, common, renamed_aspect


def tree_changes(old: Forest, new: Forest, renamed: Mapping[tuple[str, str], str]) -> Iterator[Change]:
    """The changes of trees and nodes, in the order of the new mission, then what was removed."""
    moved = _moved(old, new)
    for other, one in enumerate(new.match):
        if one < 0:
            if not _is_part_of_one(new, other):
                yield _one_sided("added", new, other)
            continue
        part, before = new.parts[other], old.parts[one]
        thing: Literal["tree", "node"] = "tree" if part.kind == TREE else "node"
        if part.kind == TREE and part.name != before.name:
            yield Change("renamed", "tree", _path(new, other), before.place, part.place, earlier=_path(old, one))
        if other in moved:
            yield Change("moved", "node", _path(new, other), before.place, part.place, earlier=_path(old, one))
        if differences := tuple(_differences(before, part, renamed)):
            yield Change("changed", thing, _path(new, other), before.place, part.place, differences)
    for one, other in enumerate(old.match):
        if other < 0 and not _is_part_of_one(old, one):
            yield _one_sided("removed", old, one)


# ---- added and removed ----


def _is_part_of_one(forest: Forest, index: int) -> bool:
    """Whether its parent is only in this mission as well: then the parent is reported."""
    parent = forest.parents[index]
    return parent >= 0 and forest.match[parent] < 0


def _one_sided(what: Literal["added", "removed"], forest: Forest, index: int) -> Change:
    part = forest.parts[index]
    alone, surviving = 0, []
    requirements: dict[str, None] = {}
    waiting = [index]
    while waiting:
        current = waiting.pop()
        if forest.match[current] >= 0:
            surviving.append(current)
            continue
        alone += 1
        requirements.update(dict.fromkeys(forest.parts[current].requirements))
        waiting += reversed(forest.children[current])
    attached = tuple(
        Detail(f"requirement {name}", *((None, "attached") if what == "added" else ("attached", None)))
        for name in requirements
    )
    return Change(
        what,
        "tree" if part.kind == TREE else "node",
        _path(forest, index),
        part.place if what == "removed" else None,
        part.place if what == "added" else None,
        attached,
        below=alone - 1,
        around=tuple(shown(forest.parts[current]) for current in surviving),
    )


# ---- moved ----


def _moved(old: Forest, new: Forest) -> frozenset[int]:
    """The nodes that have moved, by their index in the new forest."""
    above_old, above_new = _nearest(old), _nearest(new)
    moved: set[int] = set()
    groups: dict[int, list[int]] = {}
    for one, other in enumerate(old.match):  # in the order of the old mission
        if other < 0 or old.parents[one] < 0:
            continue
        before, after = above_old[one], above_new[other]
        if before < 0 or after < 0 or old.match[before] != after:
            # The nodes of a tree that was removed or added as a whole have moved, for the tree has no match.
            moved.add(other)
        else:
            groups.setdefault(after, []).append(other)
    for group in groups.values():
        # As many as possible have not changed sides.
        in_order = {group[position] for position, _ in common(group, sorted(group))}
        moved.update(set(group) - in_order)
    return frozenset(moved)


def _nearest(forest: Forest) -> list[int]:
    """For each part the nearest above it that is in both missions, -1 if there is none."""
    nearest = [-1] * len(forest.parts)
    for index, parent in enumerate(forest.parents):
        if parent >= 0:
            nearest[index] = parent if forest.match[parent] >= 0 else nearest[parent]
    return nearest


# ---- changed ----


def _differences(old: TreePart, new: TreePart, renamed: Mapping[tuple[str, str], str]) -> Iterable[Detail]:
    if renamed.get(("node model", old.kind), old.kind) != new.kind:
        yield Detail("kind", old.word, new.word)
    elif old.category is not None and new.category is not None and old.category != new.category:
        yield Detail("category", old.category, new.category)
    target = renamed.get(("tree", old.target), old.target) if old.target is not None else None
    if None not in (target, new.target) and target != new.target:
        yield Detail("tree", old.target, new.target)
    if old.kind != TREE and old.name != new.name:
        yield Detail("name", old.name, new.name)
    before: Values = {renamed_aspect(aspect, renamed): value for aspect, value in old.values.items()}
    yield from details(before, new.values)


# ---- names ----


def shown(part: TreePart) -> str:
    """A node as it is shown: by its name, else by the tree that it calls or its kind."""
    if part.kind == VERBATIM:
        return part.values["element"].text
    return part.name or part.target or part.word


def _path(forest: Forest, index: int) -> str:
    """The tree, the named nodes above, and the node: as requirements name nodes."""
    part = forest.parts[index]
    names = [f"SubTree {part.target}" if part.kind == SUBTREE and part.name is None else shown(part)]
    above = forest.parents[index]
    while above >= 0:
        part = forest.parts[above]
        if part.name is not None:
            names.append(part.name)
        above = forest.parents[above]
    return "/".join(reversed(names))
