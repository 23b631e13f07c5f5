"""Trees that are missing, doubled, recursive, never used, or not exactly one node."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks.includes import include_fix
from btq_lang.checks.view import View
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, Related, Tag, replace_fix
from btq_lang.near import near
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, Model, Root, Tree, is_name, quote
from btq_lang.text import Span
from btq_lang.workspace import Definition


def unknown_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A SubTree, or a Root, whose tree does not exist."""
    if not isinstance(entry.item, Tree | Root):
        return
    for use in view.uses(entry, Kind.TREE):
        if view.scope.find(Kind.TREE, use.name) is not None or not view.scope.complete:
            continue
        elsewhere = view.workspace.defined_anywhere(Kind.TREE, use.name)
        fixes = tuple(
            replace_fix(f"Replace `{use.name}` by `{name}`", use.span, _written(name))
            for name in near(use.name, view.scope.names(Kind.TREE))
        )
        fixes += tuple(include_fix(view, definition.path) for definition in elsewhere[:3])
        yield Diagnostic("unknown-tree", use.span, f"there is no tree `{use.name}`", fixes=fixes)


def duplicate_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree whose ID another tree has already: the engine silently takes the last one."""
    if not isinstance(entry.item, Tree) or entry.item.name is None:
        return
    name = entry.item.name
    first = view.scope.find(Kind.TREE, name.text)
    if first is not None and not view.is_this(first, entry):
        yield Diagnostic(
            "duplicate-tree",
            name.span,
            f"there are two trees `{name.text}`",
            related=(view.defined_at(first, "the first one"),),
            notes=("the engine does not complain: it runs the last one it reads",),
        )


def recursive_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree that contains itself, told where the circle closes in this tree."""
    if not isinstance(entry.item, Tree) or entry.item.name is None:
        return
    name = entry.item.name.text
    for use in view.uses(entry, Kind.TREE):
        circle = view.calls.way(use.name, name)
        if circle is None or min((*circle, name), key=view.scope.names(Kind.TREE).index) != name:
            continue  # a circle is told once, at the first of its trees
        way = " → ".join(f"`{step}`" for step in (name, *circle))
        yield Diagnostic(
            "recursive-tree",
            use.span,
            f"the tree `{name}` contains itself" + (f": {way}" if len(circle) > 1 else ""),
            notes=("the engine refuses it from 4.9 on and crashes before; repeat with Repeat or Retry instead",),
        )
        return


def unused_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree that nothing refers to, or that only such trees refer to, in a file with a mission."""
    if not isinstance(entry.item, Tree) or entry.item.name is None or view.path in view.workspace.included_files:
        return
    main = view.workspace.main_tree(view.path)
    name = entry.item.name
    if main is None or name.text in view.calls.reached_from(main.symbol.name):
        return
    users = view.calls.callers(name.text)
    if not users:
        message = f"nothing refers to the tree `{name.text}`, and the mission is `{main.symbol.name}`"
        yield Diagnostic("unused-tree", name.span, message, tags=(Tag.UNNECESSARY,))
        return
    user = view.scope.find(Kind.TREE, users[0])
    related = (view.defined_at(user, "it is used here, but this tree is not reached either"),) if user else ()
    message = f"the mission `{main.symbol.name}` never reaches the tree `{name.text}`"
    yield Diagnostic("unreachable-tree", name.span, message, related=related, tags=(Tag.UNNECESSARY,))


def unknown_main_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """Several trees, and nothing says which of them is the mission; told at the first."""
    file = view.file
    if not isinstance(entry.item, Tree) or view.path in view.workspace.included_files:
        return
    if any(isinstance(other.item, Root) for other in file.parsed.entries) or view.workspace.main_tree(view.path):
        return
    trees = [(other, other.item.name) for other in file.parsed.entries if isinstance(other.item, Tree)]
    named = [(tree.start, name) for tree, name in trees if name is not None]
    if entry is not trees[0][0] or len(named) < 2:
        return
    if all(view.calls.callers(name.text) for _, name in named):
        return  # each is run by another, so they run in circles, and that is told
    tops = [name for _, name in named if not view.calls.callers(name.text)]
    start = Place(Span(0, 0), view.path)
    fixes = tuple(
        Fix(f"Make `{name.text}` the main tree", (Change(start, f"Root {_written(name.text)}\n"),)) for name in tops[:3]
    )
    names = ", ".join(f"`{name.text}`" for name in tops)
    yield Diagnostic(
        "unknown-main-tree",
        named[0][1].span,
        f"nothing says which tree is the mission: no tree refers to {names}",
        related=tuple(
            Related(Place(name.span.shifted(begin), view.path), "another tree of this file")
            for begin, name in named[1:4]
        ),
        notes=("a line `Root <tree>` names the main tree",),
        fixes=fixes,
    )


def tree_root_count(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree without exactly one node at its top."""
    tree = entry.item
    if not isinstance(tree, Tree) or len(tree.children) == 1:
        return
    place = tree.name.span if tree.name else Span(tree.start, tree.end)
    if not tree.children:
        if not entry.diagnostics:  # else its node may be what could not be read
            note = "a tree has one node at its top, in its block"
            yield Diagnostic("tree-root-count", place, "this tree has no node", notes=(note,))
        return
    extra = tree.children[1]
    yield Diagnostic(
        "tree-root-count",
        Span(extra.start, extra.end),
        f"a tree has one node at its top, this one has {len(tree.children)}",
        related=(Related(Place(Span(tree.children[0].start, tree.children[0].end)), "the first one"),),
        notes=("put them under one node, a Sequence `->` for example",),
    )


def tree_named_like_node(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree whose ID is the name of a node."""
    if not isinstance(entry.item, Tree) or entry.item.name is None:
        return
    name = entry.item.name
    model = view.scope.find(Kind.MODEL, name.text)
    if name.text in BUILTINS:
        message = f"`{name.text}` is a node of the engine: a tree cannot have its name"
        yield Diagnostic("tree-named-like-node", name.span, message)
    elif model is not None and not _is_subtree_model(model):
        yield Diagnostic(
            "tree-named-like-node",
            name.span,
            f"`{name.text}` is a node: a tree cannot have its name",
            related=(view.defined_at(model, "the node is declared here"),),
        )


def _written(name: str) -> str:
    return name if is_name(name) else quote(name)


def _is_subtree_model(definition: Definition) -> bool:
    target = definition.symbol.target
    return isinstance(target, Model) and target.category.raw == "SubTree"
