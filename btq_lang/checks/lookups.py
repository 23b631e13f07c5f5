"""What checks look up in the files: one function a question, of the workspace and the path of the file at hand.

One invariant: an answer holds no offsets that an edit elsewhere would move, and two that compare as equal are as good
as each other, for whoever has asked keeps what he made of it (see answers.py).  An item is known by its facts, which
stay the same object for as long as the item does.
"""

from __future__ import annotations

import posixpath
from math import inf
from typing import TYPE_CHECKING

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import legal_name, model_name_problem
from btq_lang.catalog.nodes import BUILTINS, lookup
from btq_lang.catalog.qualities import EDITIONS
from btq_lang.diagnostics.rules import UNREADABLE, Severity
from btq_lang.syntax.tree import Include, Model, Models, Qualities, Root, Tree

if TYPE_CHECKING:
    from btq_lang.util.text import Span
    from btq_lang.workspace.custom_nodes import LikelyPort
    from btq_lang.workspace.file import Origin
    from btq_lang.workspace.item_index import Facts
    from btq_lang.workspace.workspace import Workspace

# ---- a name: what these say depends on nothing but the items that define it ----


def is_defined(workspace: Workspace, path: str, kind: Kind, name: str) -> bool:
    """Whether a name means something."""
    return workspace.scope(path).defines(kind, name)


def meaning(workspace: Workspace, path: str, kind: Kind, name: str) -> object:
    """All that others see of what a name means: of a tree its ports, of a node its model; what else there is only
    those look at who define it, too, and so it matters which one it is."""
    found = workspace.scope(path).find(kind, name)
    target = found.symbol.target if found is not None else None
    if isinstance(target, Tree):
        return target.ports
    return target if isinstance(target, Model) else owner(workspace, path, kind, name)


def owner(workspace: Workspace, path: str, kind: Kind, name: str) -> Facts | None:
    """The item that defines what a name means."""
    found = workspace.scope(path).find(kind, name)
    return workspace.files[found.path].facts[id(found.entry.item)] if found is not None else None


def is_torn(workspace: Workspace, path: str, kind: Kind, name: str) -> bool:
    """Whether something could not be read in the tree or model that a name means, which may be a port."""
    found = workspace.scope(path).find(kind, name)
    if found is None or not found.entry.diagnostics:
        return False
    target, item = found.symbol.target, found.entry.item
    if not isinstance(target, Tree | Model):
        return False
    starts = [each.start for each in item.models if isinstance(each, Model)] if isinstance(item, Models) else []
    end = min([start for start in starts if start > target.start], default=inf)
    return any(each.rule in UNREADABLE and target.start <= each.span.start < end for each in found.entry.diagnostics)


def place(workspace: Workspace, path: str, kind: Kind, name: str) -> tuple[str, Facts, Span] | None:
    """Where a name is defined: the file, the item, and the name in it."""
    found = workspace.scope(path).find(kind, name)
    if found is None:
        return None
    return found.path, workspace.files[found.path].facts[id(found.entry.item)], found.symbol.span


def owners(workspace: Workspace, path: str, kind: Kind, name: str) -> tuple[Facts, ...]:
    """The items that define a name."""
    found = workspace.scope(path).all(kind, name)
    return tuple([workspace.files[each.path].facts[id(each.entry.item)] for each in found])


# ---- the scope ----


def is_complete(workspace: Workspace, path: str) -> bool:
    """Whether a name that is not in scope is nowhere."""
    return workspace.scope(path).complete


def names(workspace: Workspace, path: str, kind: Kind) -> tuple[str, ...]:
    """All names of a kind, in the order of their definitions."""
    return workspace.scope(path).names(kind)


def has_palette(workspace: Workspace, path: str) -> bool:
    """Whether the models in scope are meant to be all there are."""
    for each in workspace.scope(path).paths:
        for entry in workspace.files[each].parsed.entries:
            if isinstance(entry.item, Models) and any(_is_of_node(model) for model in entry.item.models):
                return True
            if each != path and _is_of_node(entry.item):
                return True
    return False


# ---- the file ----


def first_tree(workspace: Workspace, path: str) -> Facts | None:
    """The file's first tree."""
    return next((each for each in workspace.files[path].facts.values() if isinstance(each.item, Tree)), None)


def has_neighbours(workspace: Workspace, path: str) -> bool:
    """Whether more stands in the file that the engine reads than one tree."""
    items = [each.item for each in workspace.files[path].facts.values()]
    return len([item for item in items if isinstance(item, Tree | Model | Models | Include)]) > 1


def trees(workspace: Workspace, path: str) -> tuple[Facts, ...]:
    """The file's trees, in order."""
    return tuple([each for each in workspace.files[path].facts.values() if isinstance(each.item, Tree)])


def trees_in_scope(workspace: Workspace, path: str) -> tuple[tuple[str, Facts], ...]:
    """All trees in scope and their files, in order."""
    return tuple([(each, tree) for each in workspace.scope(path).paths for tree in trees(workspace, each)])


def is_tree_of_mission(workspace: Workspace, path: str, name: str) -> bool:
    """Whether a file that is linked with this one by includes, in whatever direction, has a tree of the name."""
    return name in trees_of_mission(workspace, path)


def trees_of_mission(workspace: Workspace, path: str) -> frozenset[str]:
    """The names of the trees in all files that are linked with this one by includes."""
    linked = workspace.linked(path)
    return frozenset(
        [name for each in linked for kind, name in workspace.files[each].defined_names if kind is Kind.TREE]
    )


def taken_names(workspace: Workspace, path: str, but: str) -> dict[str, str]:
    """The names that a tree of the mission cannot have in XML, as its other trees and its nodes have them: by what is
    written, what has it.

    Args:
        but: the tree that a name is wanted for.
    """
    target = workspace.project.target
    taken = dict.fromkeys(BUILTINS, "a built-in node")
    trees: dict[str, str] = {}
    for each in sorted(workspace.linked(path)):
        for kind, name in sorted(workspace.files[each].defined_names, key=lambda one: one[1]):
            if kind is Kind.TREE and name != but:
                is_refused = model_name_problem(name, target) is not None
                trees[legal_name(name) if is_refused else name] = f"the tree `{name}`"
            elif kind is Kind.MODEL:
                taken[name] = f"the node `{name}`"
    return taken | trees


def is_node_name(workspace: Workspace, path: str, name: str) -> bool:
    """Whether a path can name a node so."""
    return any(name in workspace.files[each].node_names for each in workspace.scope(path).paths)


def is_asked_for(workspace: Workspace, path: str, name: str) -> bool:
    """Whether a condition, a bound or an argument in the file names it."""
    return name in workspace.files[path].asked_for


def asked_for_in_vain(workspace: Workspace, path: str) -> frozenset[str]:
    """The names in the file's conditions, bounds and arguments that are neither signals nor contexts."""
    find = workspace.scope(path).find
    return frozenset(
        [name for name in workspace.files[path].asked_for if not (find(Kind.SIGNAL, name) or find(Kind.CONTEXT, name))]
    )


def own_trees(workspace: Workspace, path: str) -> tuple[str, ...]:
    """The names of the file's trees, in order."""
    return workspace.files[path].names.by_kind[Kind.TREE]


def has_root_of_tree(workspace: Workspace, path: str) -> bool:
    """Whether the file says which tree is the main one, even if there is none of that name."""
    facts = workspace.files[path].facts.values()
    return any(Kind.TREE in each.used for each in facts if isinstance(each.item, Root))


def root(workspace: Workspace, path: str) -> tuple[int, str] | None:
    """Where a name may be put in behind the word Root, if there is one: an offset in the file."""
    first = next((each for each in workspace.files[path].parsed.entries if isinstance(each.item, Root)), None)
    return (first.start + first.item.start + len("Root"), "") if first is not None else None


def has_pointers(workspace: Workspace, path: str) -> bool:
    """Whether any entry of a blackboard may be named in the file."""
    return "{" in workspace.files[path].text


def main_tree(workspace: Workspace, path: str) -> tuple[str, bool] | None:
    """The name of the tree that runs when the engine loads the file, and whether only this file's own can be it."""
    main = workspace.main_tree(path)
    if main is None:
        return None
    name = Kind.TREE, main.symbol.name
    return main.symbol.name, main.path == path and len(workspace.files[path].names.found[name]) == 1


def used(workspace: Workspace, path: str, kind: Kind) -> frozenset[str]:
    """The names of a kind that the file refers to."""
    return workspace.files[path].used(kind)


def first_user(workspace: Workspace, path: str, kind: Kind, name: str) -> Facts | None:
    """The first of the file's items that refers to a name."""
    return workspace.files[path].first_users(kind).get(name)


def names_unknown_requirements(workspace: Workspace, path: str) -> bool:
    """Whether the file refers to a requirement that is defined nowhere."""
    used = workspace.files[path].used(Kind.REQUIREMENT)
    return not used.issubset(workspace.scope(path).names(Kind.REQUIREMENT))


def custom_node(workspace: Workspace, path: str, name: str) -> tuple[str, tuple[LikelyPort, ...]]:
    """What the uses of a custom node suggest that it is: its category and its ports."""
    from btq_lang.workspace.custom_nodes import custom_node as found_in_uses  # few files have an unknown node

    found = found_in_uses(workspace, path, name)
    return found.category, found.ports


def most_have_models(workspace: Workspace, path: str) -> bool:
    """Whether of the custom nodes that a file knows or uses few have no model: a third at most."""
    known = workspace.scope(path).names(Kind.MODEL)
    unknown = workspace.files[path].used(Kind.MODEL).difference(known)
    return len(known) >= 2 and 2 * sum(lookup(name) is None for name in unknown) <= len(known)


def is_crowded(workspace: Workspace, path: str, kind: Kind) -> bool:
    """Whether so many of the names of a kind are unknown that nobody reads what each of them may mean."""
    known = workspace.scope(path).names(kind)
    unknown = workspace.files[path].used(kind).difference(known)
    if kind is Kind.MODEL:
        unknown = unknown.difference(BUILTINS)
    return len(unknown) * (len(known) + len(BUILTINS)) > _MOST_COMPARED


def edition(workspace: Workspace, path: str) -> str:
    """The edition of the quality model that holds for the file."""
    for each in workspace.files[path].of_type(Qualities):
        named = each.edition
        if named is not None and named.text in EDITIONS:
            return named.text
    return workspace.project.qualities


def is_read(workspace: Workspace, path: str) -> bool:
    """Whether the whole file could be read."""
    return all(problem.effective_severity is not Severity.ERROR for problem in workspace.files[path].problems)


def has_torn_tree(workspace: Workspace, path: str) -> bool:
    """Whether the name of one of the file's trees may be what could not be read."""
    return bool(workspace.files[path].problems) and any(
        problem.span.start <= entry.item.end
        for entry in workspace.files[path].parsed.entries
        if entry.diagnostics and isinstance(entry.item, Tree)
        for problem in entry.diagnostics
    )


def origin(workspace: Workspace, path: str) -> Origin | None:
    """What the file stands for, if it is written in another language."""
    return workspace.files[path].origin


def head(workspace: Workspace, path: str) -> tuple[int, str]:
    """Where a line may be put in that belongs to the head of the file, behind its includes, and what it is indented
    with: an offset in the file."""
    text = workspace.files[path].text
    includes = [entry for entry in workspace.files[path].parsed.entries if isinstance(entry.item, Include)]
    if includes:
        last = includes[-1]
        at = text.find("\n", last.start + last.item.end) + 1
        if at:
            return at, text[last.start : last.start + last.item.start]
    return (1 if text.startswith("\ufeff") else 0), ""


# ---- the project ----


def is_included(workspace: Workspace, path: str) -> bool:
    """Whether another file includes this one."""
    return path in workspace.included_files


def elsewhere(workspace: Workspace, path: str, kind: Kind, name: str) -> tuple[str, ...]:
    """The files that define a name, whether they are in scope or not."""
    return workspace.files_defining(kind, name)


def other_files(workspace: Workspace, path: str) -> tuple[str, ...]:
    """The project's other files, as an include in this one names them."""
    folder = posixpath.dirname(path) or "."
    return tuple(posixpath.relpath(other, folder) for other in workspace.files if other != path)


# How many names one file's misspelt ones are compared with: 30 ms of work, a second where all look alike (rq_0001 …).
_MOST_COMPARED = 20_000


def _is_of_node(item: object) -> bool:
    return isinstance(item, Model) and item.category.raw != "SubTree"
