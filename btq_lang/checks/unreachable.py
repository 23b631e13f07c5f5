"""Children that can never run, because of the results of earlier ones or because of their parent's attributes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from btq_lang.catalog.literals import is_pointer
from btq_lang.checks.results import UNKNOWN, result, results
from btq_lang.checks.statuses import FAILURE, GOES_ON, SKIPPED, SUCCESS
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, Tag
from btq_lang.syntax.tree import Node, Verbatim
from btq_lang.util.text import Span
from btq_lang.workspace.resolved import ResolvedNode


def unreachable_child(view: View) -> Iterator[Diagnostic]:
    """A child that can never run; reported once for all children after the cause."""
    for resolved in view.nodes:
        if len(resolved.node.children) < 2:
            continue
        flow = resolved.flow
        if flow in GOES_ON:
            diagnostic = _unreached_after(view, resolved.node.children, GOES_ON[flow])
        elif flow == "try":
            diagnostic = _in_try(view, resolved)
        elif flow == "choice":
            diagnostic = _by_condition(view, resolved)
        elif flow == "recover":
            diagnostic = _unreached_after(view, resolved.node.children[:2], FAILURE)
        elif flow == "switch":
            diagnostic = _in_switch(resolved)
        else:
            continue
        if diagnostic is not None:
            yield diagnostic


def _unreached_after(view: View, children: tuple[Node | Verbatim, ...], goes_on: int) -> Diagnostic | None:
    """The diagnostic for the child after one that always ends its parent."""
    by_node = results(view)
    for child, following in pairwise(children):
        if isinstance(child, Node) and not by_node.get(id(child), UNKNOWN).ever & (goes_on | SKIPPED):
            never = "succeeds" if goes_on == SUCCESS else "fails"
            return _unreachable(following, f"{_shown(child)} before it never {never}", child)
    return None


def _in_try(view: View, resolved: ResolvedNode) -> Diagnostic | None:
    """The diagnostic for the last child of a try, which cleans up after a failure and perhaps after a halt."""
    *tried, last = resolved.node.children
    diagnostic = _unreached_after(view, tuple(tried), SUCCESS)
    if diagnostic is not None or resolved.node.attribute("catch_on_halt") is not None:
        return diagnostic
    if any(result(view, child).ever & FAILURE for child in tried):
        return None
    return _unreachable(last, "nothing before it can fail", None)


def _by_condition(view: View, resolved: ResolvedNode) -> Diagnostic | None:
    condition, *branches = resolved.node.children
    possible = result(view, condition).ever
    if not isinstance(condition, Node) or not possible & (SUCCESS | FAILURE):
        return None
    if not possible & SUCCESS:
        return _unreachable(branches[0], f"the condition {_shown(condition)} never succeeds", condition)
    if not possible & FAILURE and len(branches) > 1:
        return _unreachable(branches[1], f"the condition {_shown(condition)} never fails", condition)
    return None


def _in_switch(resolved: ResolvedNode) -> Diagnostic | None:
    """A case that repeats an earlier one, or that a literal variable does not name."""
    variable = resolved.node.attribute("variable")
    if variable is None:
        reason = f"without a `variable` {resolved.shown_kind} runs its last child"
        return _unreachable(resolved.node.children[0], reason, None)
    first: set[str] = set()
    for number, child in enumerate(resolved.node.children[:-1], 1):
        case = resolved.node.attribute(f"case_{number}")
        if case is None or is_pointer(case.text):
            continue
        if case.text in first:
            return _unreachable(child, f"an earlier case already has the value `{case.text}`", None)
        first.add(case.text)
    return None


def _unreachable(child: Node | Verbatim, reason: str, culprit: Node | None) -> Diagnostic:
    span = child.head.span if isinstance(child, Node) else Span(child.start, child.end)
    message = f"{_shown(child)} can never run: {reason}"
    related = (Related(Place(culprit.head.span), "reason"),) if culprit is not None else ()
    return Diagnostic("unreachable-child", span, message, related=related, tags=(Tag.UNNECESSARY,))


def _shown(child: Node | Verbatim) -> str:
    return child.shown if isinstance(child, Node) else "this element"
