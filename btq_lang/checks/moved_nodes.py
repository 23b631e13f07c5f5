"""What changes for a node of Nav2 on the way from one distribution to another.

Sources: the files and tables of `catalog/nav2`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeVar

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2 import DISTRIBUTIONS, FILES
from btq_lang.catalog.nav2.changes import CHANGES, INSTEAD, RENAMED, RENAMED_PORTS
from btq_lang.catalog.versions import BehaviorChange
from btq_lang.checks import lookups
from btq_lang.checks.pointers import pointed_at
from btq_lang.checks.ports import adding_fix
from btq_lang.checks.view import View
from btq_lang.diagnostics.model import Diagnostic, Fix, replace_fix
from btq_lang.syntax.tree import Word, written
from btq_lang.workspace.resolved import ResolvedNode

Key = TypeVar("Key", bound=tuple[str, ...])


def ports_in(view: View, distribution: str, node: str) -> frozenset[str] | None:
    """The names of the ports of a node in a distribution; None if it does not have the node."""
    return view.store.ask(lookups.ports_in_file, FILES[distribution], Kind.MODEL, node)


def changes_of(view: View, seen: ResolvedNode, name: Word, steps: tuple[str, ...]) -> Iterator[Diagnostic]:
    """What changes for a node of Nav2 on some steps."""
    renamed = _first(RENAMED, ((step, name.text) for step in steps))
    before, ports = ports_in(view, steps[0], name.text), ports_in(view, steps[-1], renamed or name.text)
    if before is not None and ports is not None:
        yield from _without_ports(seen, name.text, before - ports, steps)
    is_forward = DISTRIBUTIONS.index(steps[-1]) > DISTRIBUTIONS.index(steps[0])
    differing = [
        found
        for change in (CHANGES if is_forward else ())
        if change.since in steps[1:] and change.concerns(name.text) and (not change.when or _collects(view, seen))
        for found in changed(view, seen, name, change)
    ]
    if ports_in(view, steps[-1], name.text) is None:
        yield _without_node(view, name, renamed, steps, [each.message for each in differing])
    else:
        yield from differing


def _collects(view: View, seen: ResolvedNode) -> bool:
    """Whether bt_navigator may collect the error code of a node in the distribution that the tree is for."""
    value = seen.node.attribute("error_code_id")
    name = pointed_at("error_code_id", value.text) if value is not None else None
    if view.factory is None or not view.factory.entries:
        return True
    return any(entry == name for entry, _ in view.ask(lookups.outside_entries))


def changed(view: View, seen: ResolvedNode, name: Word, change: BehaviorChange) -> Iterator[Diagnostic]:
    """A row about a node, if the value of its port is one that the row concerns."""
    value = seen.node.attribute(change.port) if change.port else None
    if not change.matches(value.text if value is not None else None):
        return
    fixes: tuple[Fix, ...] = ()
    notes = [change.instead] if change.instead else []
    if change.keeps is not None:
        keeping = (
            f'{change.port}="{change.keeps}"' if view.is_xml else f"{written(change.port)} = {written(change.keeps)}"
        )
        notes.append(f"write `{keeping}` to keep its meaning")
        fixes = adding_fix(view, seen.node, "Keep its meaning", f"{written(change.port)} = {written(change.keeps)}")
    rule = "target-breaks" if change.breaks else "target-differs"
    message = f"from {change.since.title()} on `{name.text}` {change.what}"
    yield Diagnostic(rule, (value or name).span, message, notes=tuple(notes), fixes=fixes)


def _without_node(
    view: View, name: Word, renamed: str | None, steps: tuple[str, ...], differing: Iterable[str]
) -> Diagnostic:
    """The finding for a node that is gone, with what else changes on the way: it is to be replaced in any case."""
    gone = next(step for step in steps if ports_in(view, step, name.text) is None)
    instead = INSTEAD.get((gone, name.text))
    message = f"Nav2 has no `{name.text}` in {gone.title()}" + _called(renamed)
    fixes = (replace_fix(f"Replace `{name.text}` with `{renamed}`", name.span, renamed),) if renamed else ()
    wanted = instead or ("a node of your own, or remove it" if renamed is None else "")
    notes = (*([f"write {wanted}"] if wanted else ()), *differing)
    return Diagnostic("target-breaks", name.span, message, notes=notes, fixes=fixes)


def _without_ports(seen: ResolvedNode, node: str, gone: frozenset[str], steps: tuple[str, ...]) -> Iterator[Diagnostic]:
    for pair in seen.node.attributes:
        port = pair.key.text
        if port not in gone:
            continue
        renamed = _first(RENAMED_PORTS, ((step, node, port) for step in steps))
        message = f"`{node}` has no port `{port}` in {steps[-1].title()}" + _called(renamed)
        fixes = (replace_fix(f"Replace `{port}` with `{renamed}`", pair.key.span, renamed),) if renamed else ()
        notes = () if renamed else ("remove it",)
        yield Diagnostic("target-breaks", pair.key.span, message, notes=notes, fixes=fixes)


def _called(renamed: str | None) -> str:
    return f": it is called `{renamed}`" if renamed else ""


def _first(table: Mapping[Key, str], keys: Iterable[Key]) -> str | None:
    return next((table[key] for key in keys if key in table), None)
