"""The shortest words with which a scenario names one node of a log alone.

One invariant: what is given of a node in these words is given of no other node of the tree that ran.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Final

from btq_lang.evidence.identity import Joined
from btq_lang.simulator.skills import is_value
from btq_lang.syntax.tree import quote, written
from btq_lang.workspace.resolved import ResolvedNode


def words_for(joined: Joined, uid: int) -> str | None:
    """A path, perhaps with the value of a port, that means only this node; None: there is none."""
    nodes = {number: joined.mission.requirements.nodes.all[index] for number, index in joined.written().items()}
    node = nodes[uid]
    heads = [word.text for word in (node.node.name, node.node.id) if word is not None]
    above = [*_names_above(joined, nodes, uid)]
    ways = [way for length in range(_MOST_ABOVE + 1) for way in combinations(above, length)]
    for way in ways:
        for head in heads:
            if _meant(joined, names := (*reversed(way), head)) == {uid}:
                return "/".join(map(written, names))
    for head in heads:
        others = [nodes[other] for other in _meant(joined, (head,)) if other is not None and other != uid]
        for port, value in _values(node).items():
            theirs = [_values(other).get(port) for other in others]
            if all(other is not None and not is_value(other, value) for other in theirs):
                return f"{written(head)} ({written(port)} = {quote(value)})"
    return None


def _meant(joined: Joined, names: Sequence[str]) -> set[int | None]:
    """The nodes of the log that a path means; None among them: one that is not in the log."""
    targets = joined.mission.requirements.nodes.find(tuple(names))
    return {uid for target in targets for _, uid in joined.instances(target)}


def _names_above(joined: Joined, nodes: Mapping[int, ResolvedNode], uid: int) -> Iterator[str]:
    """The names of the nodes and trees above a node, the nearest first."""
    own = nodes[uid]
    if own.parent is None and own.tree is not None:
        yield own.tree
    for above in joined.tree.above(uid):
        node = nodes.get(above)
        if node is None:
            continue
        if node.node.name is not None:
            yield node.node.name.text
        if node.is_subtree and node.node.id is not None:
            yield node.node.id.text
        if node.parent is None and node.tree is not None:
            yield node.tree


def _values(node: ResolvedNode) -> dict[str, str]:
    """The values of its ports that are texts, and no entries."""
    pairs = ((pair.key.text, pair.value) for pair in node.node.attributes if pair.value is not None)
    return {
        name: value.text
        for name, value in pairs
        if name not in ("ID", "name") and not name.startswith("_") and not value.text.startswith(("{", "$"))
    }


_MOST_ABOVE: Final = 2  # names above that a path has
