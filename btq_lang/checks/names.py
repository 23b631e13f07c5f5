"""Names that the engine refuses, names that two nodes share, and empty names and texts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import instance_name_problem, legal_name, model_name_problem, port_name_problem
from btq_lang.catalog.nodes import lookup
from btq_lang.catalog.versions import ID_OF_EACH_TREE, UNIQUE_SUBTREES
from btq_lang.checks import lookups
from btq_lang.checks.kinds import likely_category
from btq_lang.checks.missing_ids import missing_id
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, FixEdit, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.tree import Include, Model, Models, Tree, Verbatim, Word, is_name, models_in, written
from btq_lang.util.record import replace
from btq_lang.util.spelling import did_you_mean
from btq_lang.util.text import Span
from btq_lang.workspace import inputs
from btq_lang.workspace.resolved import ResolvedNode

_NO_NAMESPACES = ("it does not support XML namespaces: the prefix is part of the name",)


def forbidden_name(view: View) -> Iterator[Diagnostic]:
    """The name of a tree, a node, an instance or a SubTree's port that the engine refuses at load."""
    version = view.target
    item = view.item
    if isinstance(item, Tree):
        if item.name is None:
            yield from _nameless(view, item) if ID_OF_EACH_TREE.holds(version) else ()
        elif reason := model_name_problem(item.name.text, version):
            yield _tree_name(view, item.name, reason, _renamed(view, item.name))
        nodes = view.seen
        for resolved in nodes.all:
            if resolved.id is not None and (reason := model_name_problem(resolved.id.text, version)):
                yield from _of_id(view, resolved, resolved.id, reason)
        for resolved in nodes.named:
            if resolved.name is not None:
                yield from _of_instance(view, resolved, resolved.name, version)
        return
    for model in models_in(item):
        for port in model.ports if model.category.raw == "SubTree" else ():
            if port.id is not None and (reason := port_name_problem(port.id.text, version)):
                yield _refused("port name", port.id, reason)


def duplicate_instance_name(view: View) -> Iterator[Diagnostic]:
    """Two nodes of a tree with one name: their paths are one path, in logs and in Groot."""
    first: dict[tuple[bool, str], Word] = {}
    for resolved in view.seen.named:
        name = resolved.name
        if name is None or (name.text == "" and not resolved.is_subtree):
            continue
        text = name.text
        is_subtree = resolved.is_subtree and UNIQUE_SUBTREES.holds(view.target)
        if resolved.id is not None and text == resolved.id.text and not is_subtree:
            continue  # the engine distinguishes such nodes by number
        if resolved.is_placeholder and legal_name(text) == text:
            continue  # the name becomes the ID, and no instance name remains
        other = first.setdefault((is_subtree, text), name)
        if other is name:
            continue
        related = (Related(Place(other.span), "the first one"),)
        if is_subtree:
            message = f"the engine refuses two SubTrees with the name `{text}` in one tree"
            severity = Severity.ERROR if view.is_xml else Severity.WARNING
            renames = ("`btq build` writes the second one under another name",)
            older = view.pin_note(lambda version: not UNIQUE_SUBTREES.holds(version))
            notes = older if view.is_xml else renames
            yield Diagnostic("duplicate-instance-name", name.span, message, related, notes, severity=severity)
        else:
            message = f"two nodes of this tree have the name `{text}`: logs show the same path for both"
            yield Diagnostic("duplicate-instance-name", name.span, message, related=related)


def _of_id(view: View, resolved: ResolvedNode, name: Word, reason: str) -> Iterator[Diagnostic]:
    if (
        resolved.is_subtree
        and name.text
        and not view.ask(inputs.is_complete)
        and not view.ask(lookups.is_defined, Kind.TREE, name.text)
    ):
        yield _tree_name(view, name, reason, ())  # else it is reported at the tree, or as a missing tree
    elif not resolved.is_subtree and resolved.node.category is None and resolved.kind is None:
        refused = _refused("node ID", name, reason, _explicit(resolved, name))
        older: tuple[str, ...] = ()
        if _is_prefixed(name.text):
            older = _NO_NAMESPACES
            bare = name.text.partition(":")[2]
            if lookup(bare) is not None or view.ask(lookups.is_defined, Kind.MODEL, bare):
                fix = replace_fix(f"Replace `{name.text}` with `{bare}`", name.span, bare)
                message = f"{refused.message}{did_you_mean((bare,))}"
                refused = replace(refused, message=message, fixes=(fix, *refused.fixes))
        elif name.text.casefold() == "root":
            older = ("<BehaviorTree> is the root: put its node directly into it, or several into a <Sequence>",)
        elif resolved.is_defined:  # else no version knows it
            older = view.pin_note(lambda version: model_name_problem(name.text, version) is None)
        yield replace(refused, notes=older)


def _is_prefixed(name: str) -> bool:
    """Whether a name is in a namespace of XML: `x:Foo`."""
    prefix, _, rest = name.partition(":")
    return is_name(prefix) and is_name(rest)


def _of_instance(view: View, resolved: ResolvedNode, label: Word, version: str) -> Iterator[Diagnostic]:
    if reason := instance_name_problem(label.text, version):
        notes = view.pin_note(lambda version: instance_name_problem(label.text, version) is None)
        yield replace(_refused("instance name", label, reason), notes=notes)
    if label.text == "" and resolved.is_subtree and UNIQUE_SUBTREES.holds(version) and view.is_main:
        refused = _refused("instance name", label, "it is empty, like the name of the main tree")
        if view.is_xml:
            yield replace(refused, notes=view.pin_note(lambda older: not UNIQUE_SUBTREES.holds(older)))
        else:
            yield replace(refused, severity=Severity.WARNING, notes=("`btq build` leaves it out",))


def _nameless(view: View, tree: Tree) -> Iterator[Diagnostic]:
    """A tree without an ID: the engine accepts it only if it is alone."""
    elements = (Tree, Model, Models, Include, Verbatim)
    loaded = [facts for facts in view.ask(lookups.items) if isinstance(facts.item, elements)]
    if len(loaded) > 1 and not any(problem.span.start <= tree.end for problem in view.entry.diagnostics):
        span = Span(tree.start, tree.start + len("BehaviorTree"))
        notes = ("the engine accepts a tree without an ID only as the only tree of a file",)
        what = "missing ID of this tree"
        yield missing_id(view, "forbidden-name", span, what, "BehaviorTree", tree.attributes, notes)


def _tree_name(view: View, name: Word, reason: str, fixes: tuple[Fix, ...]) -> Diagnostic:
    """The diagnostic for the name of a tree: a warning if a build writes the tree and all references to it under a
    legal name, which must be free; else an error."""
    if view.is_xml:
        notes = view.pin_note(lambda version: model_name_problem(name.text, version) is None)
        return replace(_refused("tree ID", name, reason), notes=notes)
    legal = legal_name(name.text)
    owner = view.ask(lookups.taken_names, name.text, view.target).get(legal)
    note = f"`btq build` writes it as `{legal}`"
    if owner is not None:
        note = f"`btq build` cannot write it as `{legal}`, which is {owner}"
    message = f"the engine refuses the tree ID `{name.text}`: {reason}"
    severity = Severity.WARNING if owner is None else Severity.ERROR
    return Diagnostic("forbidden-name", name.span, message, notes=(note,), fixes=fixes, severity=severity)


def _refused(what: str, name: Word, reason: str, fixes: tuple[Fix, ...] = ()) -> Diagnostic:
    message = f"the engine refuses the {what} `{name.text}`: {reason}"
    return Diagnostic("forbidden-name", name.span, message, fixes=fixes)


def _renamed(view: View, name: Word) -> tuple[Fix, ...]:
    """The fix that gives a tree a legal name, wherever it is named."""
    declaration = view.ask(lookups.declaration, Kind.TREE, name.text)
    if declaration is None or declaration.owner is not view.facts:
        return ()
    legal = legal_name(name.text)
    taken_names = view.ask(lookups.taken_names, name.text, view.target)
    while legal in taken_names:
        legal += "_"
    places = (declaration.place, *view.ask(lookups.uses_of_tree, name.text))
    changes = tuple(FixEdit(place, written(legal)) for place in places)
    return (Fix(f"Rename it to `{legal}` everywhere", changes),)


def _explicit(resolved: ResolvedNode, name: Word) -> tuple[Fix, ...]:
    """`Action "my node"`: the ID of the explicit form is not checked."""
    if name.text in ("", "Root", "root"):
        return ()
    category = likely_category(resolved)
    title = f"Add its category: `{category} {written(name.text)}`"
    return (replace_fix(title, Span(name.start, name.start), f"{category} "),)


def empty_text(view: View) -> Iterator[Diagnostic]:
    """An empty name, to which nothing can refer; or an empty text for readers."""
    if view.is_xml or not any(sign in view.text for sign in _EMPTY):
        return
    searched: object = view.item
    if isinstance(view.item, syntax.Tree):
        searched = (view.item.clauses, *[resolved.node.clauses for resolved in view.seen.demanding])
    for part in syntax.walk(searched):
        for field, what in _NAMES.get(type(part), {}).items():
            value = getattr(part, field)
            for word in value if isinstance(value, tuple) else (value,):
                if word is not None and word.raw in _EMPTY and not _is_without_content(part, what):
                    severity = Severity.HINT if what in _FOR_PEOPLE else None
                    yield Diagnostic("empty-text", word.span, f"{what} is empty", severity=severity)


def _is_without_content(part: object, what: str) -> bool:
    """Whether a text is the title of a requirement that demands nothing; another rule reports that."""
    return what == _TITLE and isinstance(part, syntax.Requirement) and not part.clauses


_EMPTY: Final = ('""', "''", "{}")
_TITLE, _REASON = "this title", "this reason"
_FOR_PEOPLE: Final = (_TITLE, _REASON)
# Which fields of the syntax are names or such texts.
_NAMES: Final[dict[type, dict[str, str]]] = {
    syntax.Tags: {"names": "this tag"},
    syntax.QualityPath: {"names": "the quality's name"},
    syntax.QualityDecl: {"name": "the quality's name"},
    syntax.Requirement: {"name": "the requirement's ID", "text": _TITLE},
    syntax.Because: {"text": _REASON},
    syntax.Source: {"text": "this source"},
    syntax.Approval: {"by": "the name of who approved it"},
    syntax.Way: {"id": "the ID of the test or report"},
    syntax.Hazard: {"name": "the hazard's ID", "text": _TITLE},
    syntax.Model: {"name": "the node's ID"},
    syntax.Port: {"type": "the port's type"},
    syntax.Signal: {"source": "the blackboard entry"},
    syntax.Root: {"name": "the main tree's name"},
}
