"""Children that run over several ticks under reactive nodes, and conditions that nodes with memory do not recheck.

A Sequence or Fallback goes on with the child that is running; a reactive one begins with its first child at every tick
and halts what it does not reach.
"""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.names import is_xml_name, model_name_problem
from btq_lang.catalog.nodes import BUILTINS, NodeKind, inspects_children
from btq_lang.catalog.versions import NO_EXPLICIT_CHILD, ONE_ASYNC_SEQUENCE
from btq_lang.checks.results import result
from btq_lang.checks.statuses import GOES_ON, RUNNING, SKIPPED
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Place, Related, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Node, Word, quote
from btq_lang.workspace.resolved import ResolvedNode

_APART = "put it in a Sequence of its own"


def reactive_multiple_async(view: View) -> Iterator[Diagnostic]:
    """A running child of a reactive node after another one that runs: a warning if the other one certainly takes more
    than one tick, a hint if only a custom action in it may."""
    for resolved in view.seen.of_flow("sequence", "fallback"):
        if resolved.kind is None or not resolved.kind.reactive:
            continue
        refused = _second_async_sequence(resolved, view.target)
        if refused is not None:
            yield refused
            continue
        goes_on = SKIPPED | GOES_ON[resolved.flow]
        first: Node | None = None
        surely = False
        pausing: Node | None = None
        for below in resolved.children:
            child, results = below.node, result(view, below.node)
            pauses = _pauses(view, below)
            restarts = not _resumes(below)
            if pausing is not None and restarts and not surely and (pauses or results.first == RUNNING):
                yield _pauses_again(resolved, pausing, child)
                break
            if first is not None and restarts and results.ever & RUNNING:
                yield _never_gets_further(view, resolved, first, child, surely)
                break
            if first is None and not results.usual & goes_on and results.ever & goes_on:
                first = child
                surely = not results.first & goes_on
            if pausing is None and pauses and results.ever & goes_on:
                pausing = child


def explicit_in_reactive(view: View) -> Iterator[Diagnostic]:
    """An explicit form directly below a ReactiveSequence.  For a `.btq` file a build writes the compact form, if the
    name can be a tag.

    Source: BehaviorTree.CPP 4.7 to 4.10, xml_parsing.cpp, where the tags of these children are looked up as nodes.
    """
    target = view.target
    nodes = view.seen
    if not any(inspects_children(tag) for tag in nodes.by_tag) or not NO_EXPLICIT_CHILD.holds(target):
        return
    for resolved in nodes.all:
        parent, category, name = resolved.parent, resolved.node.category, resolved.id
        if parent is None or parent.kind is None or not parent.kind.inspects_children or resolved.is_subtree:
            continue
        is_forbidden = name is not None and model_name_problem(name.text, target) is not None
        can_be_tag = name is None or (is_xml_name(name.text) and not is_forbidden)
        if category is not None and view.is_xml:
            shown = (
                f"write <{name.text}/>" if name is not None and can_be_tag else "write the node's own name as its tag"
            )
            note = (
                f"its message `Unknown node type: {category.raw}` refers to the tag: {shown if can_be_tag else _APART}"
            )
            message = f"the engine refuses <{category.raw}> directly below a {parent.kind.tag}"
            older = view.pin_note(lambda version: not NO_EXPLICIT_CHILD.holds(version))
            yield Diagnostic("explicit-in-reactive", category.span, message, notes=(note, *older))
        elif name is None or can_be_tag or resolved.kind is not None or resolved.is_placeholder:
            continue
        elif category is not None or not is_forbidden:  # else forbidden-name reports it
            message = f"the engine refuses `{name.text}` directly below a {parent.kind.tag}"
            note = f"the name is not a valid XML tag, and the engine accepts no other form here: {_APART}"
            yield Diagnostic("explicit-in-reactive", name.span, message, notes=(note,))


def condition_without_recheck(view: View) -> Iterator[Diagnostic]:
    """A Fallback at the top of a mission that chooses by a condition and then keeps its choice."""
    choices = [
        resolved
        for resolved in view.seen.of_flow("fallback")
        if _is_at_the_top(resolved) and not _begins_again(resolved)
    ]
    if not choices or not view.is_main:
        return
    for resolved in choices:
        guard: ResolvedNode | None = None
        for child in resolved.children:
            if guard is not None and result(view, child.node).usual & RUNNING:
                yield _not_asked_again(view, resolved, guard, child.node, fixable=_can_be_asked_again(view, resolved))
                break
            guard = guard or _guard(child)


def _second_async_sequence(resolved: ResolvedNode, version: str) -> Diagnostic | None:
    """The diagnostic for a second asynchronous sequence: the engine checks only this kind, and only its children."""
    if resolved.kind is None or not resolved.kind.inspects_children or not ONE_ASYNC_SEQUENCE.holds(version):
        return None
    sequences = [child for child in resolved.children if child.kind is not None and _is_async_sequence(child.kind)]
    if len(sequences) < 2:
        return None
    first, second, *_ = sequences
    message = f"the engine refuses a second {second.tag} in {resolved.shown_kind}"
    related = (Related(Place(first.node.head.span), "first one"),)
    severity = Severity.ERROR
    return Diagnostic("reactive-multiple-async", second.node.head.span, message, related=related, severity=severity)


def _is_async_sequence(kind: NodeKind) -> bool:
    return kind.flow == "sequence" and kind.pauses and not kind.keeps_place


def _never_gets_further(view: View, resolved: ResolvedNode, first: Node, child: Node, surely: bool) -> Diagnostic:
    other, this, shown = first.shown, child.shown, resolved.shown_kind
    message = f"{this} never gets beyond its first tick: {other} restarts and halts it"
    if not surely:
        message = f"if {other} takes longer than one tick, it restarts whenever {this} is RUNNING, and halts it"
    apart = f"put the steps of a plan into a {view.spelt('->')}"
    notes = (
        f"{shown} starts with its first child at every tick, and halts all others when one returns RUNNING",
        f"only the last child of {shown} should run over several ticks; {apart}",
    )
    related = (Related(Place(first.head.span), "restarts"),)
    severity = None if surely else Severity.HINT
    return Diagnostic("reactive-multiple-async", child.head.span, message, related, notes, severity=severity)


def _resumes(resolved: ResolvedNode) -> bool:
    """Whether a node, or what it decorates, goes on where it was when it was halted."""
    while resolved.kind is not None and resolved.kind.category == "Decorator" and len(resolved.children) == 1:
        (resolved,) = resolved.children
    return resolved.kind is not None and resolved.kind.keeps_place


def _pauses(view: View, resolved: ResolvedNode) -> bool:
    """Whether a node returns RUNNING between its children.  One that begins with a condition does not count: it
    chooses, and is meant to interrupt its siblings."""
    if resolved.kind is None or not resolved.kind.pauses or len(resolved.node.children) < 2 or not resolved.children:
        return False
    return resolved.children[0].category != "Condition" and bool(
        result(view, resolved.children[0].node).ever & GOES_ON.get(resolved.kind.flow, 0)
    )


def _pauses_again(resolved: ResolvedNode, first: Node, child: Node) -> Diagnostic:
    """The finding for a child that is halted whenever another one pauses between its own children."""
    other, this, shown = first.shown, child.shown, resolved.shown_kind
    message = f"{other} returns RUNNING between its children: it restarts whenever {this} is RUNNING, and halts it"
    notes = (
        f"{shown} starts with its first child at every tick, and halts all others when one returns RUNNING",
        f"write {other} without `Async`, or put both into a node that resumes",
    )
    related = (Related(Place(first.head.span), "restarts"),)
    return Diagnostic("reactive-multiple-async", child.head.span, message, related, notes)


def _is_at_the_top(resolved: ResolvedNode) -> bool:
    """Whether only decorators and reactive nodes are above: elsewhere a choice is part of a longer plan, and meant to
    be made once."""
    return all(above.stated_category == "Decorator" or _begins_again(above) for above in resolved.ancestors())


def _begins_again(resolved: ResolvedNode) -> bool:
    """Whether a node is a sequence or a fallback that begins with its first child at every tick."""
    return resolved.kind is not None and resolved.kind.reactive and resolved.kind.flow in GOES_ON


def _guard(branch: ResolvedNode) -> ResolvedNode | None:
    """The condition that begins a branch `-> [condition, …]`.  A condition alone is not a branch: the next child of the
    Fallback achieves it.  One in `R->` is evaluated while its siblings run."""
    if not _is_resuming_sequence(branch) or len(branch.node.children) < 2:
        return None
    resolved: ResolvedNode | None = branch
    while resolved is not None and resolved.category != "Condition":
        inside = _is_resuming_sequence(resolved) or resolved.flow == "invert"
        resolved = next((child for child in resolved.children if inside and child.index == 0), None)
    return resolved


def _is_resuming_sequence(resolved: ResolvedNode) -> bool:
    return resolved.flow == "sequence" and not _begins_again(resolved)


def _can_be_asked_again(view: View, resolved: ResolvedNode) -> bool:
    """Whether `R?` would restart guarded children only.  Any other child that takes time and fails would restart at the
    next tick, and halt the next child."""
    return all(
        _guard(child) is not None or not result(view, child.node).ever & RUNNING for child in resolved.children[:-1]
    )


def _not_asked_again(
    view: View, resolved: ResolvedNode, guard: ResolvedNode, branch: Node, *, fixable: bool
) -> Diagnostic:
    kind, reactive = resolved.node.head, view.spelt("R?")
    message = f"while {branch.shown} runs, {guard.shown} is not checked again"
    notes = (
        f"{resolved.shown_kind} resumes the running child; {reactive} starts with the first child at every tick",
        f"keep {resolved.shown_kind} if the choice is to be made only once",
    )
    related = (
        Related(Place(guard.node.head.span), "checked once, and then not again until the Fallback has completed"),
        Related(Place(branch.head.span), "not interrupted"),
    )
    fixes = (replace_fix(f"Check at every tick: {reactive}", kind.span, _reactive(kind)),) if fixable else ()
    return Diagnostic("condition-without-recheck", kind.span, message, related=related, notes=notes, fixes=fixes)


def _reactive(kind: Word) -> str:
    """The reactive Fallback, spelt like the one that it replaces."""
    fallback = next(builtin for builtin in BUILTINS.values() if builtin.flow == "fallback" and builtin.reactive)
    if kind.quoted:
        return quote(fallback.tag)
    return fallback.tag if kind.text.isalpha() else fallback.symbols[0]
