"""What kind of node a word stands for: unknown, not the engine's, too new, or used as something it is not."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.nodes import BUILTINS, KNOWN_WORDS, NodeKind, available, spellings
from btq_lang.checks.view import View
from btq_lang.clauses import HEADS, VERBS
from btq_lang.diagnostics import Diagnostic, Fix, Related, replace_fix
from btq_lang.near import near
from btq_lang.rules import Severity
from btq_lang.symbols import Kind
from btq_lang.syntax import Entry, Model, Models, is_name, quote


def unknown_node(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A kind that nobody knows: where a palette of models is in scope, or where a known name is so near that this must
    be a slip.  Without a palette any other name is a custom node that the robot's program registers."""
    for seen in view.nodes(entry):
        name = seen.node.id
        if name is None or seen.kind or seen.definition or seen.is_subtree or name.text in KNOWN_WORDS:
            continue
        likely = near(name.text, (*_names_of_builtins(), *view.scope.names(Kind.MODEL)))
        if not likely and not (_has_palette(view) and view.scope.complete):
            continue
        if seen.node.category is not None and not _has_palette(view):
            continue  # written as a declaration: `Action Foo` says that there is such a node
        fixes = tuple(replace_fix(f"Replace `{name.text}` by `{meant}`", name.span, written(meant)) for meant in likely)
        notes = () if likely else ("its model is in no file that this one includes",)
        yield Diagnostic("unknown-node", name.span, f"unknown node `{name.text}`", notes=notes, fixes=fixes)


def not_an_engine_node(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A word of the published language, or of an older engine, that no engine of today registers."""
    for seen in view.nodes(entry):
        name = seen.node.id
        if name is None or name.quoted or seen.kind or seen.definition or name.text not in KNOWN_WORDS:
            continue
        known = KNOWN_WORDS[name.text]
        fixes: tuple[Fix, ...] = ()
        if known.replacement:
            fixes = (replace_fix(f"Replace it by `{known.replacement}`", name.span, known.replacement, safe=True),)
        message = f"`{name.text}` is no node of the engine"
        yield Diagnostic("not-an-engine-node", name.span, message, notes=(known.why,), fixes=fixes)


def newer_engine_node(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A built-in that a version which the project is for does not have."""
    project = view.workspace.project
    for seen in view.nodes(entry):
        if seen.kind is None or seen.node.id is None:
            continue
        missing = [version for version in project.engines if not available(seen.kind, version)]
        if missing:
            pin = f'if that is what you run, say `engine = "{project.target}"` in btq.toml'
            yield Diagnostic(
                "newer-engine-node",
                seen.node.id.span,
                f"`{seen.kind.tag}` came with BehaviorTree.CPP {seen.kind.since}; {missing[0]} does not have it",
                notes=() if project.pinned else (pin,),
                severity=None if project.pinned else Severity.WARNING,
            )


def category_mismatch(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """`Condition MoveBase` where MoveBase is an action."""
    for seen in view.nodes(entry):
        written_as = seen.node.category
        if written_as is None or seen.is_subtree:
            continue
        related: tuple[Related, ...] = ()
        category: str
        if seen.kind is not None:
            category, who = seen.kind.category, "the engine has it as"
        elif seen.model is not None and seen.definition is not None:
            category, who = seen.model.category.raw, "its model says"
            related = (view.defined_at(seen.definition, "the model"),)
        else:
            continue
        if category != written_as.raw:
            fix = replace_fix(f"Replace it by `{category}`", written_as.span, category, safe=True)
            message = f"{seen.shown} is written as {written_as.raw}, {who} {category}"
            yield Diagnostic("category-mismatch", written_as.span, message, related=related, fixes=(fix,))


def clause_as_node(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """`takes at most 30 s` in the block of a node is a node called `takes`."""
    for seen in view.nodes(entry):
        name = seen.node.kind
        if name is None or name.quoted or seen.node.category or seen.node.children or seen.definition:
            continue
        if name.text in VERBS or name.text in HEADS:
            yield Diagnostic(
                "clause-as-node",
                name.span,
                f"`{name.text}` begins a clause of a requirement, but here it is a node",
                notes=("clauses stand in the block of a requirement: `satisfies QualityReq …` on a line of its own",),
                fixes=(replace_fix(f'Write "{name.text}" if a node is meant', name.span, quote(name.text)),),
            )


def duplicate_definition(view: View, entry: Entry) -> Iterator[Diagnostic]:
    """A second model, signal, context or quality of one name."""
    for symbol in view.file.summary_of(entry).symbols:
        if symbol.kind in (Kind.TREE, Kind.REQUIREMENT):
            continue
        first = view.scope.find(symbol.kind, symbol.name)
        if first is not None and first.symbol is not symbol:
            message = f"there are two definitions of the {symbol.kind.value} `{symbol.name}`"
            related = (view.defined_at(first, "the first one, which counts"),)
            yield Diagnostic("duplicate-definition", symbol.span, message, related=related)


def written(name: str) -> str:
    """A name as it is written in a file: in quotes where it must be."""
    return name if is_name(name) else quote(name)


def _names_of_builtins() -> Iterator[str]:
    return (spelling for kind in BUILTINS.values() for spelling in _words(kind))


def _words(kind: NodeKind) -> tuple[str, ...]:
    return tuple(spelling for spelling in spellings(kind) if is_name(spelling))


def _has_palette(view: View) -> bool:
    """Whether the models in scope are meant to be all there are: a TreeNodesModel, or models from another file."""
    for path in view.scope.paths:
        for other in view.workspace.files[path].parsed.entries:
            if isinstance(other.item, Models) and other.item.models:
                return True
            if isinstance(other.item, Model) and path != view.path and other.item.category.raw != "SubTree":
                return True
    return False
