"""What changed between two missions.

contents    the contents of a mission, whatever their spelling, in a form that can be compared
matching    which nodes of the two missions correspond
nodes       the changes of the trees, given that
items       the changes of all else
changes     changes as data; `wording`: in words
comparison  two compared missions, with what shows where a change is
as_text, as_markdown, as_json   for a terminal, a pull request, a program

One invariant: the result is empty if and only if the missions mean the same.  Where the missions come from (two files,
two revisions of one, XML) is not known here.
"""

from __future__ import annotations

from collections.abc import Iterable

from btq_lang.diff.changes import TITLES, Change, Detail, section
from btq_lang.diff.contents import DiskPlace, contents
from btq_lang.diff.items import item_changes, renamed_items
from btq_lang.diff.matching import Forest, match
from btq_lang.diff.nodes import tree_changes
from btq_lang.workspace.workspace import Workspace

__all__ = ["Change", "Detail", "DiskPlace", "compare"]


def compare(old: Workspace, old_paths: Iterable[str], new: Workspace, new_paths: Iterable[str]) -> tuple[Change, ...]:
    """What changed between two missions.

    Args:
        old_paths: the files of the old mission, as `Workspace.closure` gives them: its own file is the last.
        new_paths: those of the new one.
    """
    (trees, items), (new_trees, new_items) = contents(old, old_paths), contents(new, new_paths)
    renamed = renamed_items(items, new_items)
    forests = Forest(trees), Forest(new_trees)
    match(*forests, renamed)
    of_items = item_changes(items, new_items, renamed, tuple(forest.parts for forest in forests))
    changes = [*of_items, *tree_changes(*forests, renamed)]
    return tuple(sorted(changes, key=lambda change: [*TITLES].index(section(change))))  # a stable sort
