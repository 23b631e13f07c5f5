"""Trees that are missing, duplicate, recursive, unused, or without exactly one root."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import TYPE_CHECKING, Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nodes import BUILTINS
from btq_lang.catalog.versions import DEEP_TREES
from btq_lang.checks import calls, cpp_lookups, lookups
from btq_lang.checks.includes import NOWHERE, include_fix
from btq_lang.checks.lookups import VisibleMeaning
from btq_lang.checks.misplaced_children import indent_below_fixes, outdented, wrap_in_sequence_fixes
from btq_lang.checks.missing_ids import missing_id
from btq_lang.checks.view import View, is_first_tree, near_names
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, Tag, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.grammar.nodes import OF_ITS_OWN
from btq_lang.syntax.suggestions import CHILDREN
from btq_lang.syntax.tree import Model, Node, Root, Tree, written
from btq_lang.util.record import replace
from btq_lang.util.spelling import did_you_mean
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.symbols import Use

if TYPE_CHECKING:
    from btq_lang.workspace.factories import Factory

_MOST_NAMES = 5  # in one message
_DEEPEST_OF_4_6 = 97  # below a BehaviorTree: its XML reader (tinyxml2 8.0) stops at 100 open elements
_LAST_WINS = "the engine does not report this: it runs the last one that it reads"


def unknown_tree(view: View) -> Iterator[Diagnostic]:
    """A SubTree, or a Root, whose tree does not exist."""
    for resolved in view.seen.subtrees:
        word = resolved.node.category
        is_nameless = resolved.id is None or resolved.id.text == ""
        if word is not None and is_nameless and not view.is_torn(resolved.node.start, resolved.node.end):
            what, pairs = "missing tree of this SubTree", resolved.node.attributes
            yield missing_id(view, "unknown-tree", word.span, what, "SubTree", pairs)
    for use in view.uses(Kind.TREE):
        if use.name == "" or view.ask(lookups.is_defined, Kind.TREE, use.name) or view.is_pooled(Kind.TREE, use.name):
            continue
        if use.name in view.project.external:
            continue
        if not view.ask(inputs.is_complete) or view.ask(lookups.has_torn_tree):
            return
        if view.is_xml and view.ask(lookups.is_tree_of_mission, use.name):
            continue  # the engine reads all files before it creates a tree, and other projects' XML gets no include
        elsewhere = view.ask(lookups.elsewhere, Kind.TREE, use.name)
        fixes = tuple(include_fix(view, path) for path in elsewhere[:3])
        likely = view.ask(near_names, Kind.TREE, use.name)
        if not likely and not elsewhere and isinstance(view.item, Root):
            tops = tuple([name for name in view.ask(lookups.own_trees) if not view.ask(calls.callers, name)])
            likely = tops if len(tops) == 1 else ()
        fixes += tuple(replace_fix(f"Replace `{use.name}` with `{name}`", use.span, written(name)) for name in likely)
        message = f"unknown tree `{use.name}`{_nowhere(view) if elsewhere or not likely else did_you_mean(likely)}"
        model = view.ask(lookups.meaning, Kind.MODEL, use.name)
        if use.node is not None and (use.name in BUILTINS or (model is not None and not _is_subtree_model(model))):
            message = f"`{use.name}` is a node, not a tree"
            fixes = _as_node(use)
        elif view.project.product:
            if likely:
                notes = (f"unless {view.project.product} provides a tree of this name",)
                yield Diagnostic("unknown-tree", use.span, message, notes=notes, fixes=fixes, severity=Severity.HINT)
            continue
        yield Diagnostic("unknown-tree", use.span, message, fixes=fixes)


def _nowhere(view: View) -> str:
    """The end of a message about an unknown tree: where it was looked for."""
    if view.factory is not None:
        return "; no file of its factory defines it"
    is_pooled = view.is_xml and view.project.pool_of(view.path) is not None
    return "; no file of the project defines it" if is_pooled else NOWHERE


def nested_too_deep(view: View) -> Iterator[Diagnostic]:
    """A node deeper than 4.6 reads; the parser reports one deeper than any version reads."""
    nodes = view.nodes
    if len(nodes) <= _DEEPEST_OF_4_6 or DEEP_TREES.holds(view.engines[0]):
        return
    levels: dict[int, int] = {}
    for resolved in nodes:
        level = levels[id(resolved)] = 1 if resolved.parent is None else levels[id(resolved.parent)] + 1
        if level <= _DEEPEST_OF_4_6:
            continue
        pin = f'if you run a later version, set `engine = "{view.target}"` in btq.toml'
        message = f"BehaviorTree.CPP 4.6 reads at most {_DEEPEST_OF_4_6} levels of nodes"
        notes = (OF_ITS_OWN,) if view.is_pinned else (OF_ITS_OWN, pin)
        severity = None if view.is_pinned else Severity.WARNING
        yield Diagnostic("nested-too-deep", resolved.node.head.span, message, notes=notes, severity=severity)
        return


def duplicate_tree(view: View) -> Iterator[Diagnostic]:
    """A tree whose ID another tree has already: the engine silently takes the last one."""
    for first, second in view.clashes(Kind.TREE):
        both = (Related(first.place, "first one"), Related(second.place, "second one"))
        message = f"this file includes a second tree `{second.symbol.name}`"
        yield Diagnostic("duplicate-tree", view.head, message, both, (_LAST_WINS,))
    for symbol, other, counts in view.repeated(Kind.TREE):
        related = (Related(other.place, "first one" if counts else "second one"),)
        message = f"duplicate tree `{symbol.name}`"
        yield Diagnostic("duplicate-tree", view.head, message, related=related, notes=(_LAST_WINS,))


def recursive_tree(view: View) -> Iterator[Diagnostic]:
    """A tree that contains itself, reported where the circle begins in the first of its trees."""
    if view.tree_name is None:
        return
    name = view.tree_name.text
    circle = view.ask(calls.circle, name)
    if circle is None or not view.defines_here(Kind.TREE, name):
        return
    places = [(use.name, use.span) for use in view.uses(Kind.TREE)]
    places += [(resolved.id.text, resolved.id.span) for resolved in view.seen.subtrees if resolved.id is not None]
    span = next(span for called, span in places if called == circle[1])
    way = " → ".join(f"`{step}`" for step in circle)
    message = f"the tree `{name}` contains itself" + (f": {way}" if len(circle) > 2 else "")
    notes = ("BehaviorTree.CPP 4.9 and later refuse it, earlier versions crash; use Repeat or Retry instead",)
    yield Diagnostic("recursive-tree", span, message, notes=notes)


def unused_tree(view: View) -> Iterator[Diagnostic]:
    """A tree that the main trees of a mission do not reach: nothing refers to it, or only unreached trees do."""
    name = view.tree_name
    if (
        name is None
        or (view.ask(inputs.is_included) and view.factory is None)
        or not view.ask(calls.is_missed, name.text)
    ):
        return
    mains = view.ask(lookups.main_trees)
    main = f"main tree{'s are' if len(mains) > 1 else ' is'} {', '.join(f'`{tree}`' for tree in mains)}"
    if not view.defines_here(Kind.TREE, name.text):
        return  # another tree of that name counts, which is reported
    users = view.ask(calls.callers, name.text)
    if not users:
        message = f"unused tree `{name.text}`: nothing refers to it, and the {main}"
        yield Diagnostic("unused-tree", name.span, message, tags=(Tag.UNNECESSARY,))
        return
    related = view.declared_at(Kind.TREE, users[0], "used here, but the mission does not reach this tree either")
    reaching = f"the main tree `{mains[0]}` never reaches" if len(mains) == 1 else "no main tree ever reaches"
    message = f"unreachable tree `{name.text}`: {reaching} it"
    yield Diagnostic("unreachable-tree", name.span, message, related=related, tags=(Tag.UNNECESSARY,))


def unknown_main_tree(view: View) -> Iterator[Diagnostic]:
    """Several trees without a mark of the main one, reported at the first; or a factory's missing main tree."""
    if not view.ask(is_first_tree, view.facts):
        return
    if view.factory is not None:
        yield from _missing_main_trees(view, view.factory)
        return
    if view.ask(inputs.is_included):
        return
    if view.ask(calls.has_gaps) or not view.is_read:
        return  # the tree that runs the others may be misspelt
    if posixpath.dirname(view.path) in view.project.served:
        return
    if view.main_tree or view.ask(lookups.has_root_of_tree):
        return
    tops = [name for name in view.ask(lookups.own_trees) if not view.ask(calls.callers, name)]
    if len(tops) < 2:
        return  # without one at the top they run in circles, which is reported
    shown = [f"`{name}`" for name in tops[:_MOST_NAMES]]
    names = f"{', '.join(shown[:-1])} or {shown[-1]}" if len(tops) <= _MOST_NAMES else f"{', '.join(shown)}, …"
    way = '`main_tree_to_execute="…"` of <root>' if view.is_xml else "a line `Root <tree>`"
    message = f"ambiguous main tree: no other tree refers to {names}"
    notes: tuple[str, ...] = (f"name the main tree with {way}",)
    created = [name for name in tops if name in view.project.created or view.ask(cpp_lookups.is_in_cpp, name)]
    if len(created) == 1:
        return
    if created:
        notes = (*notes, f"C++ of the project has the name `{created[0]}`, and may create that tree")
    others = [view.declared_at(Kind.TREE, name, "another tree without a reference") for name in tops[1:_MOST_NAMES]]
    fixes = tuple(_main_tree_fix(view, name) for name in tops[:3])
    severity = Severity.HINT if created else None
    yield Diagnostic("unknown-main-tree", view.head, message, tuple(chain(*others)), notes, fixes, severity=severity)


def _missing_main_trees(view: View, factory: Factory) -> Iterator[Diagnostic]:
    """The main trees that the files of a factory lack, reported at the first tree that it registers."""
    is_sure = (
        view.ask(lookups.is_first_registered) and view.ask(inputs.is_complete) and not view.ask(lookups.has_torn_tree)
    )
    for main in factory.main if is_sure else ():
        if not view.ask(lookups.is_defined, Kind.TREE, main):
            likely = did_you_mean(view.ask(near_names, Kind.TREE, main))
            message = f"the factory `{factory.name}` has no tree `{main}`, which is its main tree{likely}"
            notes = ("this is the first tree that it registers; `main` is in the project file",)
            yield Diagnostic("unknown-main-tree", view.head, message, notes=notes, severity=Severity.ERROR)


def nothing_to_load(view: View) -> Iterator[Diagnostic]:
    """Files that a factory registers and that are not here, reported at the first tree that it registers."""
    factory = view.factory
    if factory is None or not factory.lost or not view.ask(is_first_tree, view.facts):
        return
    for pattern in factory.lost if view.ask(lookups.is_first_registered) else ():
        note = "what it defines is unknown"
        if pattern.startswith("package://"):
            note = f"btq looks for packages in this workspace, and in AMENT_PREFIX_PATH; {note}"
        message = f"no file matches `{pattern}`, a pattern of the factory `{factory.name}`"
        yield Diagnostic("missing-include", view.head, message, notes=(note,), severity=Severity.HINT)


def tree_root_count(view: View) -> Iterator[Diagnostic]:
    """A tree without exactly one root node."""
    tree = view.item
    if not isinstance(tree, Tree) or len(tree.children) == 1:
        return
    if not tree.children:
        if not view.entry.diagnostics:  # else its node may be on a line that could not be read
            note = "write one node in the tree's block"
            message = "a tree must have one node at its top, found none"
            yield Diagnostic("tree-root-count", view.head, message, notes=(note,))
        return
    first, extra = (
        child.head.span if isinstance(child, Node) else Span(child.start, child.end) for child in tree.children[:2]
    )
    second = tree.children[1]
    if isinstance(second, Node) and second.head.text == "BehaviorTree":
        message = "write every BehaviorTree in the same column: this one is indented"
        yield Diagnostic("tree-root-count", extra, message)
        return
    message = f"a tree must have one node at its top, found {len(tree.children)}"
    notes = (f"put them below one node, such as a Sequence{'' if view.is_xml else ' `->`'}",)
    related = (Related(Place(first), "first one"),)
    fixes = wrap_in_sequence_fixes(view, tree.children)
    beside = next((resolved for resolved in view.nodes if resolved.node is second), None)
    if beside is not None and len(tree.children) == 2 and (moved := outdented(view, beside)):
        notes, fixes = (f"{beside.shown_kind} takes no children: it goes where those below it are",), moved
    elif (top := _lacks_children(view)) is not None:
        fixes = indent_below_fixes(view, top, tree.children[1:])
        notes = (CHILDREN,) if fixes else notes
    yield Diagnostic("tree-root-count", extra, message, related, notes, fixes)


def _lacks_children(view: View) -> Node | None:
    """The first node of a tree, if it takes any number of children and has none."""
    first = next(iter(view.nodes), None)
    if first is None or first.behavior is None or first.index > 0:
        return None
    is_parent = first.behavior.children[0] > 0 and first.behavior.children[1] is None
    return first.node if is_parent and not (first.node.children or first.node.label) else None


def tree_named_like_node(view: View) -> Iterator[Diagnostic]:
    """A tree whose ID is the name of a node."""
    name = view.tree_name
    if name is None:
        return
    model = (
        view.ask(lookups.meaning, Kind.MODEL, name.text)
        if view.ask(lookups.is_defined, Kind.MODEL, name.text)
        else None
    )
    related: tuple[Related, ...] = ()
    if name.text in BUILTINS:
        owner = "a built-in node"
    elif model is not None and not _is_subtree_model(model):
        owner, related = "a node", view.declared_at(Kind.MODEL, name.text, "node declared here")
    elif inside := [
        resolved.id for resolved in view.seen.strangers if resolved.id is not None and resolved.id.text == name.text
    ]:
        owner, related = "a node in it", (Related(Place(inside[0].span), "the node"),)
    else:
        return
    message = f"a tree cannot have the name `{name.text}`: {owner} has it"
    yield Diagnostic("tree-named-like-node", name.span, message, related)


def as_uncreated(view: View, diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """The diagnostics of an item; errors become warnings if the engine never reaches their tree."""
    name = view.tree_name.text if view.tree_name is not None else ""
    factory = view.factory
    if factory is None or not view.ask(calls.is_uncreated, name):
        yield from diagnostics
        return
    note = f"no main tree of the factory `{factory.name}` reaches `{name}`; the engine would refuse to create it"
    for diagnostic in diagnostics:
        if diagnostic.rule in AT_CREATION and diagnostic.effective_severity is Severity.ERROR:
            yield replace(diagnostic, severity=Severity.WARNING, notes=(*diagnostic.notes, note))
        else:
            yield diagnostic


def _as_node(use: Use) -> tuple[Fix, ...]:
    """The fix for `SubTree MoveBase`, where MoveBase is a node: without the word."""
    node = use.node
    if node is None or node.category is None or node.kind is None:
        return ()
    span = Span(node.category.start, node.kind.start)
    return (replace_fix(f"Write only `{node.kind.raw}`", span, ""),)


def _main_tree_fix(view: View, name: str) -> Fix:
    """The fix that names the main tree: in the existing Root, or on a line of its own after the includes."""
    offset, margin = view.ask(lookups.head)
    text = f"{margin}Root {written(name)}\n"
    if (root := view.ask(lookups.root)) is not None:
        offset, text = root, f" {written(name)}"
    return Fix(f"Make `{name}` the main tree", (FixEdit(Place(Span(offset, offset), view.path), text),))


def _is_subtree_model(meaning: VisibleMeaning) -> bool:
    return isinstance(meaning.target, Model) and meaning.target.category.raw == "SubTree"


# 4.6.2 and 4.10.0 load a tree with these mistakes, and refuse it when it is created or ticked.  Other mistakes they
# refuse at once, with all trees of the file: wrong numbers of children, unknown nodes, forbidden names, a missing ID.
AT_CREATION: Final = frozenset(
    (
        "unknown-port",
        "missing-port",
        "invalid-literal",
        "number-for-text",
        "entry-with-two-types",
        "switch-cases",
        "parallel-threshold",
        "unknown-tree",
        "recursive-tree",
        "duplicate-instance-name",
        "script-error",
        "empty-script",
    )
)
