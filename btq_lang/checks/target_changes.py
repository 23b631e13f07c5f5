"""What changes for a tree when its robot moves on to another version of the engine, or distribution of Nav2.

One invariant: a fact is in the catalog; this module knows only where in a tree it holds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Final, TypeVar

from btq_lang.catalog.engine_changes import ENGINE_CHANGES
from btq_lang.catalog.literals import is_pointer
from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.names import is_port_name
from btq_lang.catalog.nav2 import DISTRIBUTIONS, FILES
from btq_lang.catalog.nav2.changes import CHANGES, INSTEAD, RENAMED, RENAMED_PORTS
from btq_lang.catalog.versions import ENTRIES_OF_SUBTREE, LAST_TREE_COUNTS, BehaviorChange, at_least, last_of
from btq_lang.checks import lookups
from btq_lang.checks.entries import mentions
from btq_lang.checks.entry_effects import watcher_of_copy
from btq_lang.checks.mixed_types import entry_with_two_types
from btq_lang.checks.nav2_nodes import isolated_node
from btq_lang.checks.pointers import pointed_at
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.results import result
from btq_lang.checks.statuses import RUNNING, SKIPPED
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.diagnostics.rules import Severity
from btq_lang.syntax.tree import Word, is_name, written
from btq_lang.util.record import replace
from btq_lang.workspace import inputs
from btq_lang.workspace.resolved import ResolvedNode

Check = Callable[[View], Iterator[Diagnostic]]
Key = TypeVar("Key", bound=tuple[str, ...])


def engine_changes(view: View, origin: str, target: str) -> Iterator[Diagnostic]:
    """The nodes of a tree that act differently in the target.

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
    """The errors and warnings that only the target gives, and not the version that the tree is for."""
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
    """Whether a diagnostic is an error or a warning."""
    return diagnostic.effective_severity in (Severity.ERROR, Severity.WARNING)


def of_target(diagnostic: Diagnostic, target: str) -> Diagnostic:
    """A diagnostic that only a target gives, as one of the rules about moving on."""
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
    """A tree with the ID of an earlier one."""
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
    """Whether a script of the tree writes the entry of a node's queue."""
    value = resolved.node.attribute("queue")
    name = pointed_at("queue", value.text) if value is not None else None
    names = [
        mention.name for mention in view.ask(mentions, view.path, view.facts) if mention.in_script and mention.writes
    ]
    return name in names


def ports_in(view: View, distribution: str, node: str) -> frozenset[str] | None:
    """The names of the ports of a node in a distribution; None if it does not have the node."""
    return view.store.ask(lookups.ports_in_file, FILES[distribution], Kind.MODEL, node)


def changes_of(view: View, resolved: ResolvedNode, name: Word, steps: tuple[str, ...]) -> Iterator[Diagnostic]:
    """What changes for a node of Nav2 on the way through some distributions."""
    renamed = _first_in(RENAMED, ((step, name.text) for step in steps))
    ports_before, ports = ports_in(view, steps[0], name.text), ports_in(view, steps[-1], renamed or name.text)
    if ports_before is not None and ports is not None:
        yield from _without_ports(resolved, name.text, ports_before - ports, steps)
    is_forward = DISTRIBUTIONS.index(steps[-1]) > DISTRIBUTIONS.index(steps[0])
    differing = [
        diagnostic
        for change in (CHANGES if is_forward else ())
        if change.since in steps[1:] and change.concerns(name.text) and (not change.when or _collects(view, resolved))
        for diagnostic in changed(view, resolved, name, change)
    ]
    if ports_in(view, steps[-1], name.text) is None:
        yield _without_node(view, name, renamed, steps, [diagnostic.message for diagnostic in differing])
    else:
        yield from differing


def _collects(view: View, resolved: ResolvedNode) -> bool:
    """Whether bt_navigator may collect the error code of a node in the distribution that the tree is for."""
    value = resolved.node.attribute("error_code_id")
    name = pointed_at("error_code_id", value.text) if value is not None else None
    if view.factory is None or not view.factory.entries:
        return True
    return any(entry == name for entry, _ in view.ask(lookups.outside_entries))


def changed(view: View, resolved: ResolvedNode, name: Word, change: BehaviorChange) -> Iterator[Diagnostic]:
    """The diagnostic for a row about a node, if the row concerns the value of its port."""
    value = resolved.node.attribute(change.port) if change.port else None
    if not change.matches(value.text if value is not None else None):
        return
    fixes: tuple[Fix, ...] = ()
    notes = [change.instead] if change.instead else []
    if change.keeps is not None:
        keeping = (
            f'{change.port}="{change.keeps}"' if view.is_xml else f"{written(change.port)} = {written(change.keeps)}"
        )
        notes.append(f"write `{keeping}` to keep its meaning")
        fixes = adding_fix(view, resolved.node, "Keep its meaning", f"{written(change.port)} = {written(change.keeps)}")
    rule = "target-breaks" if change.breaks else "target-differs"
    message = f"from {change.since.title()} on `{name.text}` {change.what}"
    yield Diagnostic(rule, (value or name).span, message, notes=tuple(notes), fixes=fixes)


def _without_node(
    view: View, name: Word, renamed: str | None, steps: tuple[str, ...], differing: Iterable[str]
) -> Diagnostic:
    """The diagnostic for a node that is gone; its notes say what else changes on the way, for the node that replaces
    it."""
    first_without = next(step for step in steps if ports_in(view, step, name.text) is None)
    instead = INSTEAD.get((first_without, name.text))
    message = f"Nav2 has no `{name.text}` in {first_without.title()}" + _called(renamed)
    fixes = (replace_fix(f"Replace `{name.text}` with `{renamed}`", name.span, renamed),) if renamed else ()
    advice = instead or ("a node of your own, or remove it" if renamed is None else "")
    notes = (*([f"write {advice}"] if advice else ()), *differing)
    return Diagnostic("target-breaks", name.span, message, notes=notes, fixes=fixes)


def _without_ports(
    resolved: ResolvedNode, node: str, missing: frozenset[str], steps: tuple[str, ...]
) -> Iterator[Diagnostic]:
    for pair in resolved.node.attributes:
        port = pair.key.text
        if port not in missing:
            continue
        renamed = _first_in(RENAMED_PORTS, ((step, node, port) for step in steps))
        message = f"`{node}` has no port `{port}` in {steps[-1].title()}" + _called(renamed)
        fixes = (replace_fix(f"Replace `{port}` with `{renamed}`", pair.key.span, renamed),) if renamed else ()
        notes = () if renamed else ("remove it",)
        yield Diagnostic("target-breaks", pair.key.span, message, notes=notes, fixes=fixes)


def _called(renamed: str | None) -> str:
    return f": it is called `{renamed}`" if renamed else ""


def _first_in(table: Mapping[Key, str], keys: Iterable[Key]) -> str | None:
    return next((table[key] for key in keys if key in table), None)


_WHEN: Final[Mapping[str, Callable[[View, ResolvedNode], bool]]] = {
    "runs on": lambda view, resolved: _count_running(view, resolved) > 0,
    "completes at once": lambda view, resolved: bool(resolved.node.nodes) and not _count_running(view, resolved),
    "restarts": lambda view, resolved: _count_running(view, resolved) > 1,  # one of them is before another one
    "skipped in the end": _skipped_in_the_end,
    "queue of a script": _queue_of_script,
    "watched": lambda view, resolved: watcher_of_copy(view, resolved) is not None,
}
