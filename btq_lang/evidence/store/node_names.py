"""Names of the nodes of a tree that do not depend on their numbers.

One invariant: two trees have a name in common only if both have equally many nodes that it could mean.
"""

from __future__ import annotations

from btq_lang.evidence.identity import without_number
from btq_lang.evidence.model import LoggedTree


def node_names(tree: LoggedTree) -> dict[int, str]:
    """The names of all nodes, by uid: their paths without numbers.

    Where several nodes below one path would have the same, it says which of them: `Move (2 of 3)`.
    """
    alike: dict[tuple[str, str], dict[tuple[str, int], None]] = {}  # by the path above and the own name
    paths: dict[int, tuple[str, int]] = {}  # each with how many nodes before have the same
    known: dict[str, int] = {}
    for uid, node in tree.nodes.items():
        known[node.path] = known.get(node.path, -1) + 1
        paths[uid] = node.path, known[node.path]
        parts = node.path.split("/")
        above = ("/".join(parts[:end]) for end in range(1, len(parts)))
        for path in (*((each, 0) for each in above), paths[uid]):
            parent, _, own = path[0].rpartition("/")
            alike.setdefault((parent, without_number(own)), {})[path] = None
    names: dict[tuple[str, int], str] = {}
    for (parent, own), found in alike.items():  # parents before what is below them
        before = f"{names[parent, 0]}/" if (parent, 0) in names else ""
        for place, path in enumerate(found, start=1):
            names[path] = f"{before}{own} ({place} of {len(found)})" if len(found) > 1 else f"{before}{own}"
    return {uid: names[path] for uid, path in paths.items()}
