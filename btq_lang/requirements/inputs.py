"""What queries about requirements read in the workspace, each a function of the store and of a viewpoint: the path of
the file from which names are looked up.

One invariant: an answer holds no syntax nodes but through the facts of their items, which are equal to nothing but
themselves, and no offsets in files.  Every function answers for files that are gone, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.syntax.tree import Apply, Item, Model, Tree, Verbatim
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.symbols import Symbol
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from typing import Concatenate, ParamSpec, TypeVar

    from btq_lang.workspace.file import File

    P = ParamSpec("P")
    T = TypeVar("T")

Placed: TypeAlias = tuple[str, Facts]  # an item, and the path of its file


def _of_viewpoint(
    read: Callable[Concatenate[Workspace, str, P], T],
) -> Callable[Concatenate[Store[Workspace], str, P], T]:
    """An input that an edit of any file may change that the viewpoint is linked with by includes."""

    def ask(store: Store[Workspace], viewpoint: str, /, *key: P.args, **_: P.kwargs) -> T:
        return store.read(viewpoint, read, viewpoint, *key)

    return ask


def _of_item(
    read: Callable[Concatenate[Workspace, str, Facts, P], T],
) -> Callable[Concatenate[Store[Workspace], str, Facts, P], T]:
    """An input that never changes, for an item that is edited is another one."""

    def ask(store: Store[Workspace], path: str, facts: Facts, /, *key: P.args, **_: P.kwargs) -> T:
        return store.read(facts, read, path, facts, *key)

    return ask


# ---- items ----


@_of_viewpoint
def trees(workspace: Workspace, viewpoint: str) -> tuple[Placed, ...]:
    """The trees in scope, in the order of the files and of their text."""
    return _items(workspace, viewpoint, Tree)


@_of_viewpoint
def applies(workspace: Workspace, viewpoint: str) -> tuple[Placed, ...]:
    """The `apply` items in scope, in the same order."""
    return _items(workspace, viewpoint, Apply)


@_of_viewpoint
def attaching(workspace: Workspace, viewpoint: str) -> tuple[Placed, ...]:
    """Both, in the same order: all items that attach requirements."""
    return _items(workspace, viewpoint, Tree, Apply)


@_of_viewpoint
def has_xml(workspace: Workspace, viewpoint: str) -> bool:
    """Whether any file in scope has XML of its own among its items."""
    return bool(_items(workspace, viewpoint, Verbatim))


@_of_viewpoint
def main_tree(workspace: Workspace, viewpoint: str) -> Placed | None:
    """The tree that runs when the engine loads the file."""
    main = workspace.main_tree(viewpoint) if viewpoint in workspace.files else None
    if main is None or not isinstance(main.entry.item, Tree):
        return None
    return main.path, workspace.files[main.path].facts[id(main.entry.item)]


@_of_item
def text(workspace: Workspace, path: str, facts: Facts) -> str:
    """The text from where the offsets of an item count up to the next item."""
    file = workspace.files.get(path)
    if file is None or id(facts.item) not in file.facts:
        return ""
    return file.text_of(facts.item)


@_of_item
def unknown_units(workspace: Workspace, path: str, facts: Facts) -> tuple[int, ...]:
    """Where the words begin in an item that its diagnostics call unknown units."""
    file = workspace.files.get(path)
    if file is None or id(facts.item) not in file.facts:
        return ()
    problems = file.entry_of(facts.item).diagnostics
    return tuple(sorted([problem.span.start for problem in problems if problem.rule == "unknown-unit"]))


# ---- names ----


def definition(store: Store[Workspace], viewpoint: str, kind: Kind, name: str) -> Placed | None:
    """The item that defines what a name means."""
    return store.read((kind, name), _definition, viewpoint, kind, name)


def category(store: Store[Workspace], viewpoint: str, name: str) -> str | None:
    """The category of a node, as its model has it."""
    return store.read((Kind.MODEL, name), _category, viewpoint, name)


def symbol(facts: Facts, kind: Kind, name: str) -> Symbol:
    """How an item defines a name."""
    return next(each for each in facts.summary.symbols if each.kind is kind and each.name == name)


@_of_viewpoint
def names(workspace: Workspace, viewpoint: str, kind: Kind) -> tuple[str, ...]:
    """All names of a kind in scope, in the order of their definitions."""
    return _names(workspace, viewpoint, kind)


@_of_viewpoint
def claiming(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The requirements in scope whose claims may name their own subjects, in the order of their definitions."""
    found: frozenset[str] = frozenset().union(*[file.claiming for file in _files(workspace, viewpoint)])
    return tuple([name for name in _names(workspace, viewpoint, Kind.REQUIREMENT) if name in found]) if found else ()


@_of_viewpoint
def asked_for(workspace: Workspace, viewpoint: str) -> frozenset[str]:
    """The names in all clauses in scope, and those by which `apply` selects nodes."""
    asked: set[str] = set()
    for file in _files(workspace, viewpoint):
        asked |= file.asked_for
        for apply in file.of_type(Apply):
            for selector in (*apply.targets, *apply.exceptions):
                words = selector.path.names if selector.path is not None else ()
                asked.update(word.text for word in (selector.every, selector.tag, *words) if word is not None)
    return frozenset(asked)


# ---- the scope ----


@_of_viewpoint
def paths(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    """The file and those that it includes, included ones first."""
    return _paths(workspace, viewpoint)


@_of_viewpoint
def is_complete(workspace: Workspace, viewpoint: str) -> bool:
    """Whether a name that is not in scope is nowhere."""
    return viewpoint in workspace.files and workspace.scope(viewpoint).complete


@_of_viewpoint
def is_included(workspace: Workspace, viewpoint: str) -> bool:
    """Whether another file includes this one."""
    return viewpoint in workspace.included_files


@_of_viewpoint
def is_well_formed(workspace: Workspace, viewpoint: str) -> bool:
    """Whether nothing is wrong with the syntax of the files in scope."""
    return not any(file.problems for file in _files(workspace, viewpoint))


def _files(workspace: Workspace, viewpoint: str) -> Iterator[File]:
    return (workspace.files[path] for path in _paths(workspace, viewpoint))


def _paths(workspace: Workspace, viewpoint: str) -> tuple[str, ...]:
    return workspace.scope(viewpoint).paths if viewpoint in workspace.files else ()


def _names(workspace: Workspace, viewpoint: str, kind: Kind) -> tuple[str, ...]:
    return workspace.scope(viewpoint).names(kind) if viewpoint in workspace.files else ()


def _items(workspace: Workspace, viewpoint: str, *kinds: type[Item]) -> tuple[Placed, ...]:
    found: list[Placed] = []
    for file in _files(workspace, viewpoint):
        if any(map(file.of_type, kinds)):
            found += [(file.path, facts) for facts in file.facts.values() if type(facts.item) in kinds]
    return tuple(found)


def _definition(workspace: Workspace, viewpoint: str, kind: Kind, name: str) -> Placed | None:
    for file in _files(workspace, viewpoint):
        if found := file.names.found.get((kind, name)):
            return file.path, file.facts[id(found[0][0])]
    return None


def _category(workspace: Workspace, viewpoint: str, name: str) -> str | None:
    found = _definition(workspace, viewpoint, Kind.MODEL, name)
    model = symbol(found[1], Kind.MODEL, name).target if found is not None else None
    return model.category.raw if isinstance(model, Model) else None
