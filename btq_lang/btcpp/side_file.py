"""`<name>.qreq.json`: what a mission says beyond its XML, for tools that read logs, and for restoring the mission.

The engine's logs drop descriptions and know nodes by number and path only; so the file lists for each node of the
running tree where it is written, and which requirements and qualities apply to it.  `qreq.schema.json` is its format.
One invariant: it describes one XML file, byte for byte, whose SHA-256 it holds.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from functools import cache, partial
from typing import Final, TypeAlias

from btq_lang.btcpp.document import Document, Element
from btq_lang.btcpp.enforcement import ClauseEnforcement
from btq_lang.btcpp.instances import Instance, instances
from btq_lang.btcpp.manual_edits import node_guards
from btq_lang.btcpp.marks import MARK
from btq_lang.catalog.units import Unit
from btq_lang.diagnostics.model import Place
from btq_lang.requirements import model
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import InContext, NodeTarget, ResolvedRequirement, ResolvedSignal
from btq_lang.requirements.nodes import Nodes
from btq_lang.requirements.resolve import requirements
from btq_lang.syntax.tree import (
    Apply,
    Context,
    Entry,
    Given,
    Hazard,
    Qualities,
    QualityDecl,
    Satisfices,
    Scenario,
    Tree,
)
from btq_lang.syntax.tree import Requirement as RequirementItem
from btq_lang.syntax.tree import Signal as SignalItem
from btq_lang.util.record import Record, fields_of
from btq_lang.workspace.file import SIDE_SUFFIX
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"

FORMAT: Final = "btq-requirements"
VERSION: Final = 2  # 1: each condition had its contexts in it
VERSIONS: Final = (1, 2)  # that are read


class BuiltFile(Record):
    """An XML file that was built.

    Attributes:
        path: of the mission.
        place: of the XML file.
        text: of the XML file.
        documents: the mission's and those of all that it includes, included ones first; a bundle has one.
        elements: of every node, by `id(node)`.
        clauses: how the clauses of each applied requirement are enforced, in order; empty if enforcement is off.
    """

    path: str
    place: str
    text: str
    documents: tuple[Document, ...]
    elements: Mapping[int, Element]
    clauses: tuple[tuple[ClauseEnforcement, ...], ...] = ()


def side_path(xml: str) -> str:
    """The place of the side file of an XML file."""
    return f"{posixpath.splitext(xml)[0]}{SIDE_SUFFIX}"


def xml_path(side: str) -> str:
    """The place of the XML file of a side file."""
    return f"{side.removesuffix(SIDE_SUFFIX)}.xml"


def is_side_file(text: str) -> bool:
    """Whether a file looks like a side file, without parsing it."""
    return text.startswith(f'{{\n"format": "{FORMAT}",\n')


def side_file(workspace: Workspace, built: BuiltFile) -> str | None:
    """The text of the side file; None if the mission says nothing beyond its XML."""
    paths = workspace.registered_with(built.path)
    if not any(_says_more(entry) for path in paths for entry in workspace.files[path].parsed.entries):
        return None
    import hashlib

    resolved = requirements(workspace, built.path)
    loose: dict[str, list[Json]] = {}
    for requirement, claim in resolved.about_no_node():
        loose.setdefault(requirement.name, []).append(claim.text)
    place = _Places(workspace, posixpath.dirname(built.place))
    main = built.documents[-1].root.get("main_tree_to_execute")
    running = RunningTree(built, resolved.nodes, main)
    return _text(
        {
            "format": FORMAT,
            "version": VERSION,
            "xml": {
                "file": posixpath.basename(built.place),
                "sha256": hashlib.sha256(built.text.encode("utf-8")).hexdigest(),
            },
            "mission": {"file": place.name(built.path), "text": workspace.files[built.path].text},
            "files": [place.name(path) for path in paths],
            **({"sources": _sources(workspace, paths)} if len(built.documents) < len(paths) else {}),
            "main_tree": main,
            "signals": [_plain(signal, place) for signal in resolved.signals.values()],
            "contexts": [
                {"name": name, "condition": _plain(condition, place)}
                for name, condition in resolved.contexts.items()
                if condition is not None
            ],
            "requirements": [_requirement(each, loose.get(each.name), place) for each in resolved.all.values()],
            "applied": [
                _applied(applied, built.clauses[index] if built.clauses else (), running, place)
                for index, applied in enumerate(resolved.applied)
            ],
            "traces": [
                {"requirement": trace.requirement, "nodes": running.uids(NodeTarget(trace.node))}
                for trace in resolved.traces
            ],
            **_guards(built.documents[-1].root),
            "concerns": list(_concerns(resolved.nodes, running)),
            "nodes": [_node(instance, node, place) for instance, node in running.all],
        }
    )


def _sources(workspace: Workspace, paths: tuple[str, ...]) -> list[Json]:
    """The files that a bundle was made of beside the mission: its XML does not name them."""
    *others, mission = paths
    folder = posixpath.dirname(mission) or "."
    return [{"file": posixpath.relpath(path, folder), "text": workspace.files[path].source} for path in others]


def _says_more(entry: Entry) -> bool:
    """Whether an item says something that has no element."""
    item = entry.item
    if isinstance(item, Tree):
        return bool(item.clauses) or any(node.clauses for node in item.walk())
    return isinstance(
        item, Qualities | QualityDecl | SignalItem | Context | RequirementItem | Apply | Hazard | Given | Scenario
    )


def _text(data: dict[str, Json]) -> str:
    """JSON with a line for each item of a list, so that differences are readable."""
    import json

    def one_line(value: Json) -> str:
        return json.dumps(value, ensure_ascii=False, allow_nan=False)

    def lines(value: Json) -> str:
        if isinstance(value, list) and value:
            return "[\n" + ",\n".join(f" {one_line(each)}" for each in value) + "\n]"
        return one_line(value)

    return "{\n" + ",\n".join(f'"{key}": {lines(value)}' for key, value in data.items()) + "\n}\n"


# ---- the tree that runs ----


class RunningTree:
    """The nodes of the running tree.

    Attributes:
        all: each with the written node; None if that is not a node of a mission.
        documents: from which the engine makes them.
    """

    def __init__(self, built: BuiltFile, nodes: Nodes, main: str | None) -> None:
        written = {id(built.elements[id(node.node)]): node for node in nodes.all if id(node.node) in built.elements}
        self._written = written
        self.documents = built.documents
        self._of: dict[int, list[Instance]] = {}
        self.all = [
            (instance, written.get(id(instance.element)))
            for instance in (instances(built.documents, main) if main is not None else ())
        ]
        for instance, node in self.all:
            if node is not None:
                self._of.setdefault(id(node), []).append(instance)

    def uids(self, target: NodeTarget) -> list[Json]:
        """The numbers of a node's instances that the path leads through."""
        return [each.uid for each in self.instances(target)]

    def instances(self, target: NodeTarget) -> list[Instance]:
        """A node's instances that the path leads through."""
        return [each for each in self._of.get(id(target.node), ()) if self._leads_to(each, target.through)]

    def _leads_to(self, instance: Instance, through: tuple[str, ...]) -> bool:
        """Whether the way to an instance passes the names, in order."""
        remaining = list(through)
        for caller in reversed(instance.callers):
            node = self._written.get(id(caller))
            while remaining and node is not None:
                if remaining[-1] in node.names or (node.parent is None and remaining[-1] == node.tree):
                    remaining.pop()
                node = node.parent
        return not remaining


def _guards(root: Element) -> dict[str, Json]:
    """The checksums of the guards in the file, by the nodes that they are at."""
    found: list[Json] = [{"node": node, "guards": {**guards}} for node, guards in node_guards(root).items()]
    return {"guards": found} if found else {}


def _node(instance: Instance, node: ResolvedNode | None, place: _Places) -> Json:
    record: dict[str, Json] = {"uid": instance.uid, "path": instance.path}
    if (generated := instance.element.get(MARK)) is not None:
        record["enforces"] = generated
    return {**record, **place.of(node.place)} if node is not None else record


def _requirement(requirement: ResolvedRequirement, loose: list[Json] | None, place: _Places) -> Json:
    plain = _plain(requirement, place)
    assert isinstance(plain, dict), "a requirement has fields"
    if requirement.ways:
        plain["verified_by"] = requirement.method
    return {**plain, "clauses_without_nodes": loose} if loose else plain


def _applied(applied: Applied, clauses: tuple[ClauseEnforcement, ...], running: RunningTree, place: _Places) -> Json:
    subject = applied.subject
    record: dict[str, Json] = {"requirement": applied.requirement.name, "how": applied.how}
    if applied.arguments:
        record["arguments"] = {each.name: _plain(each.value, place) for each in applied.arguments}
        record["claims"] = [_plain(each, place) for each in applied.requirement.claims]
    if isinstance(subject, NodeTarget):
        record["nodes"] = running.uids(subject)
    else:
        record["subject"] = _plain(subject, place)
        if applied.node is not None:
            record["nodes"] = running.uids(NodeTarget(applied.node))
    if clauses:
        record["clauses"] = [
            {"clause": each.clause, "held": each.way, **({"why": each.why} if each.why else {})} for each in clauses
        ]
    return record


def _concerns(nodes: Nodes, running: RunningTree) -> Iterator[Json]:
    """The concerns that `satisfices` names, for a tree as for its node."""
    for tree in nodes.trees:
        parts = [(tree.root, tree.item.clauses), *[(node, node.node.clauses) for node in tree.all]]
        for node, clauses in parts:
            qualities: list[Json] = [
                quality.path.text
                for clause in clauses
                if isinstance(clause, Satisfices)
                for quality in clause.qualities
            ]
            if node is not None and qualities:
                yield {"qualities": qualities, "nodes": running.uids(NodeTarget(node))}


# ---- values ----


class _Places:
    """Places as the file writes them: the path of the file, relative to the side file, and the line."""

    def __init__(self, workspace: Workspace, folder: str) -> None:
        self._workspace = workspace
        self.name = cache(partial(posixpath.relpath, start=folder or "."))

    def of(self, place: Place) -> dict[str, Json]:
        if place.path is None:
            return {}
        file = self._workspace.files[place.path]
        if file.is_foreign:  # it was imported from XML, so its lines differ
            return {"file": self.name(place.path)}
        return {"file": self.name(place.path), "line": file.lines.position(file.span_of(place).start).line + 1}


def _plain(value: object, place: _Places) -> Json:
    """A value of the model: its fields, and its type as `is`; signals, contexts and nodes by name."""
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if isinstance(value, tuple):
        return [_plain(each, place) for each in value]
    if isinstance(value, Unit):
        return value.symbol
    if isinstance(value, ResolvedNode):
        return {"name": value.node.head.text, **place.of(value.place)}
    if isinstance(value, InContext):
        return {"is": "incontext", "name": value.name}
    record: dict[str, Json] = {}
    if not isinstance(value, ResolvedRequirement | ResolvedSignal):
        record["is"] = _KINDS[type(value)]
    for field in fields_of(value):
        part = getattr(value, field)
        if part is None or part == () or field in _LEFT_OUT or (field in ("every", "in_order") and not part):
            continue
        key = _RENAMED.get(field, field) if isinstance(value, ResolvedRequirement) else field
        record[key] = part.name if isinstance(part, ResolvedSignal) else _plain(part, place)
    if isinstance(value, ResolvedRequirement | ResolvedSignal):
        record |= place.of(value.place)
    return record


_LEFT_OUT: Final = frozenset(("place", "path", "item"))
_RENAMED: Final = {"name": "id", "action": "on_violation"}
# The format keeps these names, whatever the classes are called.
_KINDS: Final[dict[type, str]] = {
    model.NodeTarget: "target",
    model.MissionRun: "mission",
    model.Quantity: "value",
    model.Flag: "flag",
    model.TextValue: "text",
    model.SignalRead: "read",
    model.ResolvedParameter: "parameter",
    model.Aggregate: "aggregate",
    model.Age: "age",
    model.Minus: "minus",
    model.Arithmetic: "arithmetic",
    model.ResolvedCase: "case",
    model.ResolvedTable: "table",
    model.Compare: "compare",
    model.All: "all",
    model.Any: "any",
    model.Negation: "not",
    model.Running: "running",
    model.ClassicScript: "script",
    model.Limit: "limit",
    model.ResolvedEvent: "event",
    model.ResolvedAnyEvent: "any-event",
    model.Interval: "span",
    model.DurationSum: "total",
    model.ResolvedEachEvent: "each",
    model.EveryNode: "every",
    model.VisitedNode: "visited",
    model.Visit: "visit",
    model.ResolvedClaim: "claim",
    model.ResolvedScope: "scope",
    model.ResolvedSpan: "from-until",
    model.ResolvedOdds: "odds",
    model.ResolvedWindow: "window",
    model.ResolvedWay: "way",
    model.ResolvedApproval: "approval",
}
