"""Proposals for scenarios: what nodes do, and the names and values that its steps may have."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.catalog.name_kinds import Kind
from btq_lang.catalog.nav2.nodes import ASKING
from btq_lang.grammar.scenario_words import ANSWERS
from btq_lang.ide import node_proposals as of_nodes
from btq_lang.ide import proposals as offer
from btq_lang.ide.meaning import entry_at, id_meant
from btq_lang.ide.place import CursorPlace, LineNode
from btq_lang.ide.proposals import Proposal
from btq_lang.ide.scenario_words import ExpectedStep
from btq_lang.requirements import nodes
from btq_lang.syntax.tree import Signal, written
from btq_lang.util.record import replace
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def of_step(workspace: Workspace, path: str, place: CursorPlace, wanted: ExpectedStep) -> Iterator[Proposal]:
    """All that is expected at a place, but claims and conditions."""
    if wanted.values_of is not None:
        yield from _values(workspace, path, place, *wanted.values_of)
    if wanted.value_of:
        yield from _values_of_signal(workspace, path, wanted.value_of)
    if wanted.behaviors_of:
        yield from _behaviors(workspace, path, wanted.behaviors_of)
    yield from offer.words(wanted.words, "keyword")
    if wanted.ports_of:
        yield from _ports(workspace, path, place, wanted)
    if wanted.trees:
        yield from of_nodes.trees(workspace, path)
    if wanted.requirements:
        yield from (replace(one, snippet=None) for one in offer.requirements(workspace, path))
    if wanted.signals:
        for one in offer.signals(workspace, path):
            yield replace(one, insert=f"{one.insert} = ")
    if wanted.kinds:
        yield from offer.kinds(workspace, path)
    if wanted.nodes:
        yield from offer.node_names(workspace, path)


def _called(workspace: Workspace, path: str, name: str) -> tuple[ResolvedNode, ...]:
    """The nodes with a name."""
    targets = workspace.store.ask(nodes.find, path, (name,))
    return tuple(target.node for target in targets) or workspace.store.ask(nodes.every, path, name)


def _behaviors(workspace: Workspace, path: str, name: str) -> Iterator[Proposal]:
    """What a condition answers, and a decorator of Nav2 that is asked likewise; what any other node does."""
    called = _called(workspace, path, name)
    categories = {node.category for node in called}
    if categories != {"Condition"}:
        yield from offer.words(("succeeds", "fails", "does not end", "takes", "after", "skips"), "keyword")
    if categories <= {"Condition", None} or any(node.id is not None and node.id.text in ASKING for node in called):
        yield offer.keyword("answers", "answers ${0:false, true}")


def _ports(workspace: Workspace, path: str, place: CursorPlace, wanted: ExpectedStep) -> Iterator[Proposal]:
    node = LineNode(id_meant(workspace, path, wanted.ports_of), False, None)
    ports = of_nodes.ports_of_line(workspace, path, node)
    if wanted.has_bare_port:
        for port in ports:
            if port.direction != "output" and port.name not in place.given:
                yield Proposal(port.name, "port", "its values, in order", written(port.name))
    yield from of_nodes.ports(ports, place.given, node)


def _values(workspace: Workspace, path: str, place: CursorPlace, name: str, port: str) -> Iterator[Proposal]:
    """The values that a port has in the mission, and those that it may have; without a port, of the only input."""
    ports = of_nodes.ports_of_line(workspace, path, LineNode(id_meant(workspace, path, name), False, None))
    inputs = [each for each in ports if each.direction != "output"]
    if not port and len(inputs) == 1:
        port = inputs[0].name
    values = dict.fromkeys(
        pair.value.raw
        for node in _called(workspace, path, name)
        for pair in node.node.attributes
        if pair.key.text == port and pair.value is not None
    )
    for value in values:
        quoted = value if value[0] in "{\"'" or value[0].isdigit() or value in ANSWERS else f'"{value}"'
        yield Proposal(value.strip("\"'"), "enum", "in the mission", quoted)
    declared = next((each for each in ports if each.name == port), None)
    entry = entry_at(workspace, path, place.span.start)
    yield from (one for one in of_nodes.port_values(workspace, path, entry, declared) if one.label != "{=}")


def _values_of_signal(workspace: Workspace, path: str, name: str) -> Iterator[Proposal]:
    target = workspace.scope(path).target(Kind.SIGNAL, name)
    if isinstance(target, Signal) and target.unit is not None and target.unit.text == "bool":
        yield from offer.words(ANSWERS, "enum")
