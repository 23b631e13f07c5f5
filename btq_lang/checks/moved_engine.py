"""What changes for a tree when its robot moves on to another version of the engine.

One invariant: a fact is in the catalog; here is only where in a tree it holds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final

from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import FILES
from btq_lang.catalog.versions import ENTRIES_OF_SUBTREE, LAST_TREE_COUNTS, at_least, last_of
from btq_lang.checks import lookups
from btq_lang.checks.entries import mentions
from btq_lang.checks.isolated import isolated_node
from btq_lang.checks.mixed_types import entry_with_two_types
from btq_lang.checks.moved_nodes import changed
from btq_lang.checks.pointers import pointed_at
from btq_lang.checks.results import result
from btq_lang.checks.statuses import RUNNING, SKIPPED
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import is_name
from btq_lang.util.record import replace
from btq_lang.workspace import inputs
from btq_lang.workspace.resolved import ResolvedNode

Check = Callable[[View], Iterator[Diagnostic]]


def engine_changes(view: View, origin: str, target: str) -> Iterator[Diagnostic]:
    """What nodes of a tree do otherwise in the target.

    Args:
        origin: the version that the tree is for; a line such as 4.8 means any of its releases.
        target: the version that it moves to.
    """
    rows = [row for row in ENGINE_CHANGES if is_between(row.since, row.until, row.after, origin, target)]
    for resolved in view.nodes:
        kind = resolved.kind.tag if resolved.kind is not None else None
        for row in rows if kind is not None and resolved.id is not None else ():
            if kind is not None and row.concerns(kind) and (not row.when or _WHEN[row.when](view, resolved)):
                yield from changed(view, resolved, resolved.node.head, row)
        if resolved.is_subtree and is_between(ENTRIES_OF_SUBTREE.since, "", "", origin, target):
            yield from _entries(resolved)
    yield from _first_tree(view) if is_between(LAST_TREE_COUNTS.since, "", "", origin, target) else ()


def is_between(since: str, until: str, after: str, origin: str, target: str) -> bool:
    """Whether a change is met on the way from one version to a later one."""
    if origin == target or at_least(origin, since) or not at_least(last_of(target), since):
        return False
    return (not until or not at_least(target, until)) and (not after or at_least(last_of(origin), after))


def new_in_target(view: View, checks: tuple[Check, ...], diagnostics: list[Diagnostic]) -> Iterator[Diagnostic]:
    """What the target refuses, or reads otherwise, and the version that the tree is for does not."""
    workspace = view.ask(inputs.everything).moved
    moved = View(workspace.store, view.path, view.facts)
    reported = {(diagnostic.rule, diagnostic.span) for diagnostic in diagnostics if is_severe(diagnostic)}
    in_engine = [diagnostic for check in checks for diagnostic in check(moved)]
    for diagnostic in in_engine:
        if (diagnostic.rule, diagnostic.span) not in reported and is_severe(diagnostic):
            yield of_target(diagnostic, workspace.project.target)
    target = view.project.moves_to
    if target is None or target not in FILES or view.ask(lookups.distribution) is None:
        return
    reported.update((diagnostic.rule, diagnostic.span) for diagnostic in in_engine)
    moved = View(view.ask(inputs.everything).moved_nodes.store, view.path, view.facts)
    for diagnostic in (*entry_with_two_types(moved), *isolated_node(moved)):  # all else that changes is in a table
        if (diagnostic.rule, diagnostic.span) not in reported:
            yield of_target(diagnostic, target.capitalize())


def is_severe(diagnostic: Diagnostic) -> bool:
    """Whether it is more than a hint."""
    return diagnostic.effective_severity in (Severity.ERROR, Severity.WARNING)


def of_target(diagnostic: Diagnostic, target: str) -> Diagnostic:
    """What is found for a target alone, as a finding of the rules about moving on."""
    breaks = diagnostic.effective_severity is Severity.ERROR or diagnostic.rule == "not-an-engine-node"
    notes = (*diagnostic.notes, f"in {target} this is {diagnostic.rule}: `btq explain {diagnostic.rule}`")
    return replace(diagnostic, rule="target-breaks" if breaks else "target-differs", notes=notes, severity=None)


def _entries(resolved: ResolvedNode) -> Iterator[Diagnostic]:
    """The values of a SubTree's ports that are names of entries before version 4."""
    for pair in resolved.node.attributes:
        if pair.value is not None and is_port_name(pair.key.text) and not is_pointer(pair.value.text):
            text, since = pair.value.text, ENTRIES_OF_SUBTREE.since
            fix = replace_fix(f"Replace `{text}` with `{{{text}}}`", pair.value.span, f"{{{text}}}")
            yield Diagnostic(
                "target-differs",
                pair.value.span,
                f"from {since} on `{text}` is a text that the SubTree gets, no longer the name of an entry",
                notes=(f"write `{{{text}}}` if it is one",),
                fixes=(fix,) if is_name(text) else (),  # `0` was hardly meant as a name
            )


def _first_tree(view: View) -> Iterator[Diagnostic]:
    """A tree whose ID another one before it has."""
    name = view.tree_name
    if name is not None and not view.defines_here(Kind.TREE, name.text):
        what = f"from {LAST_TREE_COUNTS.since} on this tree `{name.text}` counts, no longer the first one"
        yield Diagnostic("target-differs", name.span, what, notes=("write another ID for one of them",))


def _count_running(view: View, resolved: ResolvedNode) -> int:
    """How many children may take several ticks."""
    return sum(bool(result(view, child).ever & RUNNING) for child in resolved.node.nodes)


def _skipped_in_the_end(view: View, resolved: ResolvedNode) -> bool:
    """Whether all children may be skipped, one of them after it has run."""
    statuses = [result(view, child).ever for child in resolved.node.nodes]
    return all(ever & SKIPPED for ever in statuses) and any(ever & RUNNING for ever in statuses)


def _queue_of_script(view: View, resolved: ResolvedNode) -> bool:
    """Whether a script of the tree writes the queue."""
    value = resolved.node.attribute("queue")
    name = pointed_at("queue", value.text) if value is not None else None
    names = [
        mention.name for mention in view.ask(mentions, view.path, view.facts) if mention.in_script and mention.writes
    ]
    return name in names


_WHEN: Final[Mapping[str, Callable[[View, ResolvedNode], bool]]] = {
    "runs on": lambda view, resolved: _count_running(view, resolved) > 0,
    "completes at once": lambda view, resolved: bool(resolved.node.nodes) and not _count_running(view, resolved),
    "restarts": lambda view, resolved: _count_running(view, resolved) > 1,  # one of them is before another one
    "skipped in the end": _skipped_in_the_end,
    "queue of a script": _queue_of_script,
}
