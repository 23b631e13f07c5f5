"""Trees that are missing, doubled, recursive, never used, or not exactly one node."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks.includes import behind_includes, include_fix
from btq_lang.checks.kinds import include_place, is_torn, written
from btq_lang.checks.view import View
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, Related, Tag, replace_fix
from btq_lang.symbols import Kind, Use
from btq_lang.syntax import Entry, Model, Node, Root, Tree
from btq_lang.text import Span
from btq_lang.workspace import Definition

_MOST_NAMES = 5  # in one message
_LAST_WINS = "the engine does not complain: it runs the last one it reads"


def unknown_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A SubTree, or a Root, whose tree does not exist."""
    for seen in view.nodes(entry):
        word = seen.node.category
        is_nameless = seen.node.id is None or seen.node.id.text == ""
        if seen.is_subtree and word is not None and is_nameless and not is_torn(entry, seen):
            yield Diagnostic("unknown-tree", word.span, "this SubTree names no tree: `SubTree <ID>`")
    if not isinstance(entry.item, Tree | Root) or not view.scope.complete or view.has_torn_tree:
        return
    for use in view.uses(entry, Kind.TREE):
        if use.name == "" or view.scope.find(Kind.TREE, use.name) is not None:
            continue
        elsewhere = view.workspace.defined_anywhere(Kind.TREE, use.name)
        fixes = tuple(include_fix(view, definition.path) for definition in elsewhere[:3])
        fixes += tuple(
            replace_fix(f"Replace `{use.name}` by `{name}`", use.span, written(name))
            for name in view.near(use.name, Kind.TREE)
        )
        message = f"there is no tree `{use.name}` in this file or in those it includes"
        model = view.scope.find(Kind.MODEL, use.name)
        if use.node is not None and (use.name in BUILTINS or (model is not None and not _is_subtree_model(model))):
            message = f"`{use.name}` is a node, not a tree"
            fixes = _as_node(use)
        yield Diagnostic("unknown-tree", use.span, message, fixes=fixes)


def duplicate_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree whose ID another tree has already: the engine silently takes the last one."""
    for first, second in view.clashes(entry, Kind.TREE):
        yield Diagnostic(
            "duplicate-tree",
            include_place(entry),
            f"this file brings a second tree `{second.symbol.name}`",
            related=(view.defined_at(first, "the first one"), view.defined_at(second, "the second one")),
            notes=(_LAST_WINS,),
        )
    if not isinstance(entry.item, Tree) or entry.item.name is None:
        return
    name = entry.item.name
    first_one = view.scope.find(Kind.TREE, name.text)
    if first_one is not None and not view.is_this(first_one, entry):
        yield Diagnostic(
            "duplicate-tree",
            name.span,
            f"there are two trees `{name.text}`",
            related=(view.defined_at(first_one, "the first one"),),
            notes=(_LAST_WINS,),
        )


def recursive_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree that contains itself, told where the circle begins in the first of its trees."""
    if not isinstance(entry.item, Tree) or entry.item.name is None:
        return
    name = entry.item.name.text
    circle = view.calls.circle(name)
    definition = view.scope.find(Kind.TREE, name)
    if circle is None or definition is None or not view.is_this(definition, entry):
        return
    use = next(use for use in view.uses(entry, Kind.TREE) if use.name == circle[1])
    way = " → ".join(f"`{step}`" for step in circle)
    yield Diagnostic(
        "recursive-tree",
        use.span,
        f"the tree `{name}` contains itself" + (f": {way}" if len(circle) > 2 else ""),
        notes=("the engine refuses it from 4.9 on and crashes before; repeat with Repeat or Retry instead",),
    )


def unused_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree that nothing refers to, or that only such trees refer to, in a file with a mission."""
    if not isinstance(entry.item, Tree) or entry.item.name is None or view.path in view.workspace.included_files:
        return
    name = entry.item.name
    main = view.main_tree
    definition = view.scope.find(Kind.TREE, name.text)
    if (
        main is None
        or view.calls.has_gaps
        or not view.is_read
        or name.text in view.calls.reached_from(main.symbol.name)
    ):
        return
    if definition is None or not view.is_this(definition, entry):
        return  # another tree of that name counts, which is told
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
    if not view.trees or entry is not view.trees[0] or view.path in view.workspace.included_files:
        return
    if view.calls.has_gaps or not view.is_read:
        return  # the tree that runs the others may be what is misspelt
    roots = [other for other in view.file.parsed.entries if isinstance(other.item, Root)]
    if view.main_tree or any(use.kind is Kind.TREE for root in roots for use in view.file.summary_of(root).uses):
        return
    tops: dict[str, Related] = {}
    for other in view.trees:
        name = other.item.name if isinstance(other.item, Tree) else None
        if name is not None and not view.calls.callers(name.text) and name.text not in tops:
            place = Place(name.span.shifted(other.start), view.path)
            tops[name.text] = Related(place, "another tree that no tree refers to")
    if len(tops) < 2 or not isinstance(entry.item, Tree):
        return  # without one at the top they run in circles, and that is told
    names = ", ".join(f"`{name}`" for name in tuple(tops)[:_MOST_NAMES])
    span = entry.item.name.span if entry.item.name else Span(entry.item.start, entry.item.end)
    is_xml = view.file.origin is not None
    way = '`main_tree_to_execute="…"` of <root>' if is_xml else "a line `Root <tree>`"
    yield Diagnostic(
        "unknown-main-tree",
        span,
        f"nothing says which tree is the mission: no tree refers to {names}{' …' if len(tops) > _MOST_NAMES else ''}",
        related=tuple(tops.values())[1:_MOST_NAMES],
        notes=(f"{way} names the main tree",),
        fixes=tuple(_main_tree_fix(view, roots, name) for name in tuple(tops)[:3]),
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
    first, extra = (
        child.head.span if isinstance(child, Node) else Span(child.start, child.end) for child in tree.children[:2]
    )
    second = tree.children[1]
    if isinstance(second, Node) and second.head.text == "BehaviorTree":
        message = "a BehaviorTree begins where the one before it begins: this one is indented"
        yield Diagnostic("tree-root-count", extra, message)
        return
    yield Diagnostic(
        "tree-root-count",
        extra,
        f"a tree has one node at its top, this one has {len(tree.children)}",
        related=(Related(Place(first), "the first one"),),
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


def _as_node(use: Use) -> tuple[Fix, ...]:
    """`SubTree MoveBase`, where MoveBase is a node: without the word."""
    node = use.node
    if node is None or node.category is None or node.kind is None:
        return ()
    span = Span(node.category.start, node.kind.start)
    return (replace_fix(f"Write `{node.kind.raw}` alone", span, ""),)


def _main_tree_fix(view: View, roots: list[Entry], name: str) -> Fix:
    """Name the main tree: in the Root that is there, or in a line of its own behind the includes."""
    if roots and isinstance(roots[0].item, Root):
        at = roots[0].start + roots[0].item.start + len("Root")
        change = Change(Place(Span(at, at), view.path), f" {written(name)}")
    else:
        at, margin = behind_includes(view)
        change = Change(Place(Span(at, at), view.path), f"{margin}Root {written(name)}\n")
    return Fix(f"Make `{name}` the main tree", (change,))


def _is_subtree_model(definition: Definition) -> bool:
    target = definition.symbol.target
    return isinstance(target, Model) and target.category.raw == "SubTree"
