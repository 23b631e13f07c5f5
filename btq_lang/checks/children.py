"""The number of children of a node, and what it must fit."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from btq_lang.catalog.kinds import CHILDREN
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.nodes import is_by_children
from btq_lang.catalog.versions import is_before_4
from btq_lang.checks.kinds import OF_SUBTREE, declared_category, model_related
from btq_lang.checks.known_ports import is_case
from btq_lang.checks.misplaced_children import (
    TOO_FAR,
    dedent_fixes,
    indent_below_fixes,
    label_as_child,
    most_children,
    outdented,
    wrap_in_sequence_fixes,
)
from btq_lang.checks.view import View, misspelt_clause
from btq_lang.diagnostics.model import Diagnostic, Fix, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.grammar.node_mistakes import CHILD
from btq_lang.syntax.suggestions import CHILDREN as BELOW
from btq_lang.syntax.tree import Node, Tree, is_name, written
from btq_lang.util.text import Span
from btq_lang.workspace.resolved import ResolvedNode

_NUMBERS = dict(enumerate(("two", "three", "four", "five", "six", "seven"), start=2))
_INTEGER = re.compile(r"-?[0-9]{1,18}")
_QUOTED = re.compile("'([^']*)'")


def child_count(view: View) -> Iterator[Diagnostic]:
    """More or fewer children than the node takes."""
    nodes = view.nodes
    for index, resolved in enumerate(nodes):
        numbers = wrong_number(resolved)
        if numbers is None or _is_of_another_line(view, resolved, nodes[index + 1 : index + 2]):
            continue
        least, most = numbers
        category, count = resolved.stated_category, len(resolved.node.children)
        declared = declared_category(resolved)
        if (
            resolved.kind is None
            and resolved.node.category is not None
            and declared not in (None, resolved.node.category.raw)
        ):
            continue  # the wrong one of the two is reported first
        if any(misspelt_clause(child) for child in resolved.node.nodes):
            continue  # a child that is meant as a clause is reported
        if (
            most is not None
            and count > most
            and any(view.is_torn(child.start, child.end) for child in resolved.node.children)
        ):
            continue  # a line that could not be read was taken for a child
        if count == 0 and view.entry.diagnostics:
            after = nodes[index + 1].node.start if index + 1 < len(nodes) else len(view.text)
            if view.is_torn(resolved.node.start, after - 1):
                continue  # its child may be on a line that could not be read
        notes: tuple[str, ...] = ()
        if resolved.behavior is not None and resolved.behavior.late_count and count:
            notes = ("the engine loads this and throws when the node is ticked",)
        if resolved.flow == "switch" and count == least - 1:
            notes += ("its last child is the default: add one, such as an AlwaysFailure",)
        if category == "Control" and most is not None and 1 < most < count and resolved.flow != "switch":
            notes += (_in_one(resolved, most),)
        notes += tuple(_remapped(view, resolved))
        related = model_related(view, resolved, "declared by its model") if resolved.node.category is None else ()
        if most is not None and count > most:
            extra = resolved.node.children[most]
            span = extra.head.span if isinstance(extra, Node) else Span(extra.start, extra.end)
            related += (Related(Place(span), "first extra child"),)
        message = f"{_called(resolved)} requires {_range(least, most)}, found {count or 'none'}"
        fixes = wrap_in_sequence_fixes(view, resolved.node.children) if most == 1 < count else ()
        if most is not None and count > most and (moved := dedent_fixes(view, resolved, resolved.node.children[most:])):
            notes, fixes = (*notes, TOO_FAR), moved + fixes
        fixes = outdented(view, resolved) + fixes
        if count == 0 and resolved.behavior is not None:
            as_child, fixes = label_as_child(view, resolved)
            beside, below_it = ((), ()) if as_child else _beside(view, resolved, most)
            notes, fixes = notes + as_child + beside, fixes + below_it
        yield Diagnostic("child-count", resolved.node.head.span, message, related=related, notes=notes, fixes=fixes)


def wrong_number(resolved: ResolvedNode) -> tuple[int, int | None] | None:
    """The least and the most children that a node takes, if it has fewer or more."""
    category, count = resolved.stated_category, len(resolved.node.children)
    if category is None or _is_by_children(resolved):
        return None
    least, most = resolved.behavior.children if resolved.behavior is not None else CHILDREN[category]
    return None if least <= count and (most is None or count <= most) else (least, most)


def _is_of_another_line(view: View, resolved: ResolvedNode, following: Sequence[ResolvedNode]) -> bool:
    """Whether a wrong number of children follows from a line that is not indented enough, which is reported there."""
    tree = view.item
    if isinstance(tree, Tree) and resolved.parent is None and len(tree.children) > 1:
        if resolved.node.children:
            return len(tree.children) == 2 and bool(outdented(view, resolved))
        if resolved.index == 0 and resolved.node.label is None and most_children(resolved) is None:
            return bool(indent_below_fixes(view, resolved.node, tree.children[1:]))
    is_beside = not resolved.node.children and bool(following) and following[0].parent is resolved.parent
    return is_beside and bool(outdented(view, following[0]))


def _in_one(resolved: ResolvedNode, most: int) -> str:
    """What to do with more children than a control node takes: one child of it takes several."""
    if resolved.flow == "choice":
        return "put the nodes of each branch below a Sequence"
    first = f"the first {most - 1}" if most > 2 else "the first one"
    return f"put those after {first} below one Sequence, or a RoundRobin, which takes turns"


def _beside(view: View, resolved: ResolvedNode, most: int | None) -> tuple[tuple[str, ...], tuple[Fix, ...]]:
    """The note and the fix for a node whose children are not indented below it, but beside it."""
    owner = resolved.parent.node if resolved.parent is not None else view.item
    siblings = owner.children[resolved.index + 1 :] if isinstance(owner, Node | Tree) else ()
    if not siblings or view.is_xml:
        return (), ()
    if most == 1:
        return (CHILD,), indent_below_fixes(view, resolved.node, siblings[:1])
    return (BELOW,), ()


def switch_cases(view: View) -> Iterator[Diagnostic]:
    """A Switch whose cases and children do not match: a child for each case, and one more for the default."""
    for resolved in view.seen.of_flow("switch"):
        if resolved.kind is None:
            continue
        node = resolved.node
        count = len(node.children)
        by_children = _is_by_children(resolved)
        if by_children and not 3 <= count <= 7:
            message = f"{resolved.shown_kind} has {count or 'no'} child{'ren' if count != 1 else ''}"
            note = "the engine supports 2 to 6 cases, each with a child, and one more child for the default"
            yield Diagnostic("switch-cases", node.head.span, message, notes=(note,))
            continue
        number = count - 1 if by_children else resolved.kind.children[0] - 1
        cases = [f"case_{case}" for case in range(1, number + 1)]
        keys = {pair.key.text: pair.key for pair in node.attributes}
        extra = [key for name, key in keys.items() if is_case(resolved, name) and name not in cases]
        # Without a variable no case counts, which is reported: the children that can never run.
        missing = [name for name in cases if name not in keys] if "variable" in keys else []
        if extra:
            message = f"{resolved.shown_kind} has no case `{extra[0].text}`"
            note = f"its cases are `case_1` to `{cases[-1]}`"
            if by_children:
                note = f"with {count} children {note}: one child for each, and the last for the default"
            elif (more := number + len(extra)) <= 6 and all(f"case_{case}" in keys for case in range(1, more + 1)):
                note = f"{_NUMBERS[more]} cases need `Switch{more}`, with {_NUMBERS[more + 1]} children"
            yield Diagnostic("switch-cases", extra[0].span, message, notes=(note,))
        elif missing:
            message = f"{resolved.shown_kind} lacks {' and '.join(f'`{name}`' for name in missing)}"
            note = "the engine does not report this and runs the default child"
            yield Diagnostic("switch-cases", node.head.span, message, notes=(note,), severity=Severity.WARNING)
        yield from _constants(resolved)


def _constants(resolved: ResolvedNode) -> Iterator[Diagnostic]:
    """A variable without braces, and cases in the quotes of scripts, which a Switch compares as they are."""
    for pair in resolved.node.attributes:
        key, value = pair.key.text, pair.value
        if value is None or is_pointer(value.text):
            continue
        if key == "variable" and value.text:
            message = f"{resolved.shown_kind} compares the text `{value.text}`, not the entry of that name"
            entry = f"{{{value.text}}}"
            fixes = (replace_fix(f"Write the entry `{entry}`", value.span, entry),) if is_name(value.text) else ()
            notes = () if fixes else ("write the entry that chooses the child, `{key}`",)
            yield Diagnostic("switch-cases", value.span, message, notes=notes, fixes=fixes, severity=Severity.WARNING)
        elif is_case(resolved, key) and (quoted := _QUOTED.fullmatch(value.text)):
            plain = quoted[1]
            message = f"{resolved.shown_kind} compares the quotes of `{value.text}` too: only scripts have quoted texts"
            fixes = (replace_fix(f"Write `{plain}`", value.span, written(plain)),) if plain else ()
            yield Diagnostic("switch-cases", value.span, message, fixes=fixes, severity=Severity.WARNING)


def parallel_threshold(view: View) -> Iterator[Diagnostic]:
    """A threshold that the children of a Parallel cannot reach: the engine throws when it is ticked."""
    for resolved in view.seen.of_flow("parallel", "parallel-all"):
        count = len(resolved.node.children)
        if resolved.kind is None or count == 0:
            continue  # the missing child is reported instead
        for port in resolved.kind.ports:
            value = resolved.node.attribute(port.name) if port.role in ("successes", "failures") else None
            threshold = int(value.text) if value is not None and _INTEGER.fullmatch(value.text) else 0
            if value is None or threshold <= count:
                continue
            message = f"`{port.name}` is {threshold}, but the node has only {count} child{'ren' if count > 1 else ''}"
            notes = ("the engine throws when the node is ticked; -1 means all children",)
            fixes = (replace_fix("Write `-1` for all children", value.span, "-1"),)
            yield Diagnostic("parallel-threshold", value.span, message, notes=notes, fixes=fixes)


def _remapped(view: View, resolved: ResolvedNode) -> Iterator[str]:
    """How a SubTree is written that has the elements of version 2."""
    for child in resolved.node.nodes if resolved.is_subtree else ():
        inside, outside = child.attribute("internal"), child.attribute("external")
        if child.head.text in OF_SUBTREE and inside is not None and outside is not None:
            entry = outside.text if is_before_4(view.target) else f"{{{outside.text}}}"
            yield f'<{child.head.text}> is of version 2 of the engine: write `{inside.text}="{entry}"` at the SubTree'


def _is_by_children(resolved: ResolvedNode) -> bool:
    """Whether its kind was chosen by the number of its children, as for a `Switch`."""
    kind = resolved.node.kind
    return kind is not None and is_by_children(kind.raw)


def _called(resolved: ResolvedNode) -> str:
    """A node with its category, if the number of its children follows only from that."""
    is_known = resolved.behavior is not None or resolved.is_placeholder or resolved.is_subtree
    return resolved.shown_kind if is_known else f"the {resolved.category} {resolved.shown_kind}"


def _range(least: int, most: int | None) -> str:
    if most == 0:
        return "no children"
    if least == most:
        return f"exactly {least} child{'ren' if least > 1 else ''}"
    if most is None:
        return f"{least} or more children"
    return f"{least} to {most} children"
