"""Trees that are missing, doubled, recursive, never used, or not exactly one node."""

from __future__ import annotations

from btq_lang.blocks import OF_ITS_OWN
from btq_lang.catalog.kinds import at_least
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.checks import calls, lookups
from btq_lang.checks.includes import include_fix
from btq_lang.checks.kinds import include_place, is_torn, written
from btq_lang.diagnostics import Change, Diagnostic, Fix, Place, Related, Tag, replace_fix
from btq_lang.name_kinds import Kind
from btq_lang.rules import Severity
from btq_lang.symbols import Use
from btq_lang.syntax import Entry, Model, Node, Tree
from btq_lang.text import Span

TYPE_CHECKING = False  # True for type checkers: `typing` is slow to import, see record.py
if TYPE_CHECKING:
    from collections.abc import Iterator

    from btq_lang.checks.view import View
    from btq_lang.file import Definition

_MOST_NAMES = 5  # in one message
_DEEPEST_OF_4_6 = 97  # below a BehaviorTree: its reader of XML (tinyxml2 8.0) ends where 100 elements are open
_LAST_WINS = "the engine does not complain: it runs the last one it reads"


def unknown_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A SubTree, or a Root, whose tree does not exist."""
    for seen in view.seen(entry).subtrees:
        word = seen.node.category
        is_nameless = seen.id is None or seen.id.text == ""
        if word is not None and is_nameless and not is_torn(entry, seen):
            yield Diagnostic("unknown-tree", word.span, "this SubTree names no tree: `SubTree <ID>`")
    for use in view.uses(entry, Kind.TREE):
        if use.name == "" or view.defines(Kind.TREE, use.name):
            continue
        if not view.scope.complete or view.has_torn_tree:
            return
        if view.is_xml and view.look_up(lookups.is_tree_of_mission, use.name):
            continue  # the engine has read all files before it makes a tree, and nobody adds an include to others' XML
        fixes = tuple(include_fix(view, path) for path in view.elsewhere(Kind.TREE, use.name)[:3])
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


def nested_too_deep(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A node further down than 4.6 reads; what no version reads the parser tells."""
    nodes, project = view.nodes(entry), view.project
    if len(nodes) <= _DEEPEST_OF_4_6 or at_least(project.engines[0], "4.7"):
        return
    levels: dict[int, int] = {}
    for seen in nodes:
        level = levels[id(seen)] = 1 if seen.parent is None else levels[id(seen.parent)] + 1
        if level <= _DEEPEST_OF_4_6:
            continue
        pin = f'if you run a later one, say `engine = "{project.target}"` in btq.toml'
        yield Diagnostic(
            "nested-too-deep",
            seen.node.head.span,
            f"more than {_DEEPEST_OF_4_6} levels of nodes: BehaviorTree.CPP 4.6 reads no more",
            notes=(OF_ITS_OWN,) if project.pinned else (OF_ITS_OWN, pin),
            severity=None if project.pinned else Severity.WARNING,
        )
        return


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
    if not view.scope.is_repeated(Kind.TREE, name.text):
        return
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
    circle = view.look_up_in(calls.circles, name)
    definition = view.scope.find(Kind.TREE, name)
    if circle is None or definition is None or not view.is_this(definition, entry):
        return
    places = [(use.name, use.span) for use in view.uses(entry, Kind.TREE)]
    places += [(seen.id.text, seen.id.span) for seen in view.seen(entry).subtrees if seen.id is not None]
    span = next(span for called, span in places if called == circle[1])
    way = " → ".join(f"`{step}`" for step in circle)
    yield Diagnostic(
        "recursive-tree",
        span,
        f"the tree `{name}` contains itself" + (f": {way}" if len(circle) > 2 else ""),
        notes=("the engine refuses it from 4.9 on and crashes before; repeat with Repeat or Retry instead",),
    )


def unused_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A tree that nothing refers to, or that only such trees refer to, in a file with a mission."""
    if not isinstance(entry.item, Tree) or entry.item.name is None or view.is_included:
        return
    name = entry.item.name
    definition = view.scope.find(Kind.TREE, name.text)
    if not view.look_up_in(calls.missed, name.text):
        return
    main = view.main_tree
    if definition is None or not view.is_this(definition, entry):
        return  # another tree of that name counts, which is told
    users = calls.callers(view, name.text)
    if not users:
        message = f"nothing refers to the tree `{name.text}`, and the mission is `{main}`"
        yield Diagnostic("unused-tree", name.span, message, tags=(Tag.UNNECESSARY,))
        return
    user = view.scope.find(Kind.TREE, users[0])
    related = (view.defined_at(user, "it is used here, but this tree is not reached either"),) if user else ()
    message = f"the mission `{main}` never reaches the tree `{name.text}`"
    yield Diagnostic("unreachable-tree", name.span, message, related=related, tags=(Tag.UNNECESSARY,))


def unknown_main_tree(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """Several trees, and nothing says which of them is the mission; told at the first."""
    if not isinstance(entry.item, Tree) or not view.is_first_tree(entry) or view.is_included:
        return
    if view.ask(calls.has_gaps) or not view.is_read:
        return  # the tree that runs the others may be what is misspelt
    if view.main_tree or view.look_up(lookups.has_root_of_tree):
        return
    tops = [name for name in view.look_up(lookups.own_trees) if not calls.callers(view, name)]
    if len(tops) < 2:
        return  # without one at the top they run in circles, and that is told
    names = ", ".join(f"`{name}`" for name in tops[:_MOST_NAMES])
    span = entry.item.name.span if entry.item.name else Span(entry.item.start, entry.item.end)
    way = '`main_tree_to_execute="…"` of <root>' if view.is_xml else "a line `Root <tree>`"
    yield Diagnostic(
        "unknown-main-tree",
        span,
        f"nothing says which tree is the mission: no tree refers to {names}{' …' if len(tops) > _MOST_NAMES else ''}",
        related=tuple(
            view.defined_at(other, "another tree that no tree refers to")
            for name in tops[1:_MOST_NAMES]
            if (other := view.scope.find(Kind.TREE, name)) is not None
        ),
        notes=(f"{way} names the main tree",),
        fixes=tuple(_main_tree_fix(view, name) for name in tops[:3]),
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


def _main_tree_fix(view: View, name: str) -> Fix:
    """Name the main tree: in the Root that is there, or in a line of its own behind the includes."""
    root = view.look_up(lookups.root)
    at, margin = root or view.look_up(lookups.head)
    text = f" {written(name)}" if root else f"{margin}Root {written(name)}\n"
    change = Change(Place(Span(at, at), view.path), text)
    return Fix(f"Make `{name}` the main tree", (change,))


def _is_subtree_model(definition: Definition) -> bool:
    target = definition.symbol.target
    return isinstance(target, Model) and target.category.raw == "SubTree"
