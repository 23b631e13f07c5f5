"""The inputs of the query store (queries.py): what several packages read in the workspace.

Each is a function of the workspace and of a *viewpoint*, which names the scope in which names are looked up: all that
one program registers before it creates a tree.  That is a file with what it includes, named by its path; in the
workspace of a factory, all files have one scope.  An item has a key of its own, so that one file can be looked at from
several viewpoints.

One invariant: a result refers to syntax nodes only through the facts of their items, which are equal only to
themselves, and has no offsets that an edit elsewhere would move; equal results are interchangeable, for queries keep
what they computed from the first.  An item is identified by its facts, which live as long as it does.  What only checks
look up is in checks/lookups.py.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from functools import wraps
from typing import TYPE_CHECKING, Concatenate, ParamSpec, TypeAlias, TypeVar

from btq_lang.catalog.kinds import NodeKind
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import FILES, distribution_among
from btq_lang.catalog.nodes import BUILTINS, available
from btq_lang.catalog.versions import VERSION_3
from btq_lang.syntax.tree import Apply, Entry, Item, Model, Tree, Verbatim
from btq_lang.workspace.config import Project
from btq_lang.workspace.engine_version import written_for
from btq_lang.workspace.file import File
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store, input_of
from btq_lang.workspace.symbols import Symbol
from btq_lang.workspace.workspace import Scope, Workspace

if TYPE_CHECKING:
    from btq_lang.workspace.factories import Factory

P = ParamSpec("P")
T = TypeVar("T")

Placed: TypeAlias = tuple[str, Facts]  # an item, and the path of its file
# The category of a model, if there is one; what the node does, if it is of a library that btq knows; and whether it is
# the program's own node in place of a built-in that the engine lacks.
Declared: TypeAlias = "tuple[str | None, NodeKind | None, bool]"

# ---- topics: what an edit has to touch to invalidate an input ----


# May change with an edit of any file that is linked with the viewpoint by includes, or in which XML that is linked with
# it looks up names.
of_viewpoint = input_of(lambda viewpoint, *_: viewpoint)
# Depends only on the items that define a name, in any file.
of_name = input_of(lambda viewpoint, kind, name: (kind, name))
of_model = input_of(lambda viewpoint, name: (Kind.MODEL, name))
# Never changes, for an edited item is a new one.
of_item = input_of(lambda path, facts: facts)
of_project = input_of(lambda: "project")


def advance(before: Workspace, after: Workspace) -> None:
    """Pass cached answers on to the workspace after an edit; nothing if its files or its project differ."""
    if (before.project, before.factory, [*before.files]) != (after.project, after.factory, [*after.files]):
        return
    edited = [(file, after.files[path]) for path, file in before.files.items() if after.files[path] is not file]
    if any(old.inclusion != new.inclusion or not old.is_parsed for old, new in edited):
        before.pass_on(after, [topic for topic in before.store.topics if not isinstance(topic, Facts)])
    else:
        before.pass_on(after, {topic for old, new in edited for topic in _touched(after, old, new)})


def _touched(after: Workspace, old: File, new: File) -> Iterator[Hashable]:
    """The topics in which an edit of one file may change something."""
    looking = after.xml if after.project.pools else ()  # for what it lacks
    yield from after.linked(new.path, *looking)
    for item in old.facts.keys() ^ new.facts.keys():
        for symbol in (old.facts.get(item) or new.facts[item]).summary.symbols:
            yield symbol.kind, symbol.name
    if old.is_cpp:  # more is known of nodes than their models say
        before, now = old.cpp_nodes, new.cpp_nodes
        yield from ((Kind.MODEL, name) for name in before.keys() | now.keys() if before.get(name) != now.get(name))


@of_project
def project(workspace: Workspace) -> Project:
    """The project of the files."""
    return workspace.project


@of_project
def factory(workspace: Workspace) -> Factory | None:
    """The factory whose files these are; None: each file is a factory of its own."""
    return workspace.factory


@of_project
def representative(workspace: Workspace) -> str | None:
    """The file that the queries `of_scope` are asked for in a factory; None without one."""
    return (
        next((path for path in workspace.factory.files if path in workspace.files), None) if workspace.factory else None
    )


def of_scope(
    query: Callable[Concatenate[Store[Workspace], str, P], T],
) -> Callable[Concatenate[Store[Workspace], str, P], T]:
    """Declare a query that depends on nothing but the scope of its viewpoint: it is computed once for a factory, whose
    files have one scope."""

    @wraps(query)
    def ask(store: Store[Workspace], viewpoint: str, /, *key: P.args, **named: P.kwargs) -> T:
        common = store.ask(representative)
        if common is None or common == viewpoint:
            return query(store, viewpoint, *key, **named)
        return store.ask(ask, common, *key, **named)

    return ask


@of_viewpoint
def everything(workspace: Workspace, viewpoint: str) -> Workspace:
    """The workspace itself: a query that reads it runs again after every edit of a linked file."""
    return workspace


# ---- items ----


@of_viewpoint
def trees(workspace: Workspace, viewpoint: str) -> tuple[Placed, ...]:
    """The trees in scope, in the order of the files and of their text."""
    return _items(workspace, viewpoint, Tree)


@of_viewpoint
def applies(workspace: Workspace, viewpoint: str) -> tuple[Placed, ...]:
    """The `apply` items in scope, in the same order."""
    return _items(workspace, viewpoint, Apply)


@of_viewpoint
def attaching(workspace: Workspace, viewpoint: str) -> tuple[Placed, ...]:
    """Both, in the same order: all items that attach requirements."""
    return _items(workspace, viewpoint, Tree, Apply)


@of_viewpoint
def has_xml(workspace: Workspace, viewpoint: str) -> bool:
    """Whether an item of a file in scope is verbatim XML."""
    return bool(_items(workspace, viewpoint, Verbatim))


@of_viewpoint
def main_tree(workspace: Workspace, viewpoint: str) -> Placed | None:
    """The tree that runs when the engine loads the file."""
    main = workspace.main_tree(viewpoint)
    if main is None or not isinstance(main.entry.item, Tree):
        return None
    return main.path, workspace.files[main.path].facts[id(main.entry.item)]


@of_item
def entry(workspace: Workspace, path: str, facts: Facts) -> Entry:
    """An item of a file with its syntax diagnostics, as it would be at the start of the file."""
    original = workspace.files[path].entry_of(facts.item)
    return Entry(0, original.item, original.in_root, original.diagnostics)


@of_item
def text(workspace: Workspace, path: str, facts: Facts) -> str:
    """The text from the origin of an item's offsets up to the next item."""
    return workspace.files[path].text_of(facts.item)


@of_item
def unknown_units(workspace: Workspace, path: str, facts: Facts) -> tuple[int, ...]:
    """The starts of the words of an item that its diagnostics call unknown units."""
    problems = workspace.files[path].entry_of(facts.item).diagnostics
    return tuple(sorted([problem.span.start for problem in problems if problem.rule == "unknown-unit"]))


# ---- names ----


@of_name
def definition(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> Placed | None:
    """The item with the definition of a name that counts."""
    for file in workspace.scope(viewpoint).files(kind):
        if definers := file.names.definitions.get((kind, name)):
            return file.path, file.facts[id(definers[0][0])]
    return None


@of_model
def declared(workspace: Workspace, viewpoint: str, name: str) -> Declared:
    """The declaration of a custom node by its model; empty if it has none."""
    scope = workspace.scope(viewpoint)
    for file in scope.files(Kind.MODEL):
        if definers := file.names.definitions.get((Kind.MODEL, name)):
            model = definers[0][1].target
            category = model.category.raw if isinstance(model, Model) else None
            known_node = _of_library(scope, name) if scope.node_paths else None
            return category, known_node, _replaces_builtin(workspace, scope, file, name, model)
    pooled = workspace.find(viewpoint, Kind.MODEL, name)
    target = pooled.symbol.target if pooled is not None else None
    if pooled is None or not isinstance(target, Model) or target.category.raw == "SubTree":  # of a tree of that name
        return None, None, False
    return target.category.raw, None, _replaces_builtin(workspace, scope, workspace.files[pooled.path], name, target)


def _replaces_builtin(workspace: Workspace, scope: Scope, file: File, name: str, model: object) -> bool:
    """Whether a model is of a node of the program with the name of a built-in that its version of the engine lacks: it
    is made of C++, or has other ports.  Groot writes models of built-ins, too."""
    kind = BUILTINS.get(name)
    if kind is None or not isinstance(model, Model) or kind.since == VERSION_3:
        return False
    if available(kind, written_for(workspace.project, distribution_among(scope.node_paths), None)[-1]):
        return False
    ports = {port.id.text for port in model.ports if port.id is not None}
    return file.is_cpp or ports != {port.name for port in kind.ports}


def _of_library(scope: Scope, name: str) -> NodeKind | None:
    """The behavior of a node, if the model that counts is of a library that btq knows."""
    model, distribution = scope.find(Kind.MODEL, name), distribution_among(scope.node_paths)
    if model is None or distribution is None or model.path != FILES[distribution]:
        return None
    from btq_lang.catalog.nav2.nodes import nodes_of  # few projects have these models

    return nodes_of(distribution).get(name)


def symbol(facts: Facts, kind: Kind, name: str) -> Symbol:
    """The symbol with which an item defines a name."""
    return next(each for each in facts.summary.symbols if each.kind is kind and each.name == name)


@of_viewpoint
def names(workspace: Workspace, viewpoint: str, kind: Kind) -> tuple[str, ...]:
    """All names of a kind in scope, in the order of their definitions."""
    return workspace.scope(viewpoint).names(kind)


@of_viewpoint
def claiming(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The requirements in scope whose claims may name their own subjects, in the order of their definitions."""
    claimers: frozenset[str] = frozenset().union(
        *[file.names_used("claiming") for file in _files(workspace, viewpoint)]
    )
    names = workspace.scope(viewpoint).names(Kind.REQUIREMENT) if claimers else ()
    return tuple([name for name in names if name in claimers])


@of_viewpoint
def asked_for(workspace: Workspace, viewpoint: str) -> frozenset[str]:
    """The names in all clauses in scope, and those by which `apply` selects nodes."""
    asked: set[str] = set()
    for file in _files(workspace, viewpoint):
        asked |= file.names_used("asked_for")
        for apply in file.of_type(Apply):
            for selector in (*apply.targets, *apply.exceptions):
                words = selector.path.names if selector.path is not None else ()
                asked.update(word.text for word in (selector.every, selector.tag, *words) if word is not None)
    return frozenset(asked)


# ---- the scope ----


@of_viewpoint
def paths(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The file and those that it includes, included ones first."""
    return workspace.scope(viewpoint).paths


@of_viewpoint
def is_complete(workspace: Workspace, viewpoint: str) -> bool:
    """Whether a name that is not in scope does not exist."""
    return workspace.scope(viewpoint).complete


@of_viewpoint
def is_included(workspace: Workspace, viewpoint: str) -> bool:
    """Whether another file includes this one."""
    return viewpoint in workspace.included_files


@of_viewpoint
def is_well_formed(workspace: Workspace, viewpoint: str) -> bool:
    """Whether the files in scope have no syntax errors."""
    return not any(file.problems for file in _files(workspace, viewpoint))


def _files(workspace: Workspace, viewpoint: str) -> Iterator[File]:
    return (workspace.files[path] for path in workspace.scope(viewpoint).paths)


def _items(workspace: Workspace, viewpoint: str, *kinds: type[Item]) -> tuple[Placed, ...]:
    placed: list[Placed] = []
    for file in _files(workspace, viewpoint):
        if any(map(file.of_type, kinds)):
            placed += [(file.path, facts) for facts in file.facts.values() if type(facts.item) in kinds]
    return tuple(placed)
