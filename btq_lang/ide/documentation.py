"""The documentation of a completion, computed when an editor requests it."""

from __future__ import annotations

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks.includes import include_line
from btq_lang.checks.lookups import head
from btq_lang.ide import describe
from btq_lang.ide.meaning import defined_elsewhere, own_quality, quality_match
from btq_lang.ide.ports import ports_of_kind, ports_of_tree
from btq_lang.util.text import Edit, Span
from btq_lang.workspace.file import Definition
from btq_lang.workspace.workspace import Workspace


def documentation(workspace: Workspace, path: str, kind: str, name: str) -> str | None:
    """A description of a proposal in Markdown, if there is one.

    Args:
        path: of the file in which it is offered.
        kind, name: the proposal's own.
    """
    if kind == "node":
        found = _definition(workspace, path, Kind.MODEL, name)
        return describe.node_kind(workspace, found.path if found else path, name)
    if kind == "tree":
        return describe.tree(workspace, path, name)
    if kind == "requirement":
        found = _definition(workspace, path, Kind.REQUIREMENT, name)
        return describe.requirement(workspace, path, found) if found else None
    if kind in ("signal", "context"):
        found = _definition(workspace, path, Kind.SIGNAL if kind == "signal" else Kind.CONTEXT, name)
        return describe.declared(workspace, found) if found else None
    if kind == "quality":
        own = own_quality(workspace, path, name) or _definition(workspace, path, Kind.QUALITY, name)
        match = quality_match(workspace, path, name)
        if own is not None:
            return describe.own_quality(workspace, own)
        return describe.quality(workspace, path, match.quality) if match.quality else None
    if kind == "keyword":
        return describe.words(name)
    if kind == "rule":
        return describe.rule(name)
    if kind == "port":
        node, _, port = name.rpartition("/")
        category, _, called = node.rpartition(" ")
        known = ports_of_tree(workspace, path, called) if category == "SubTree" else ()
        known = known or ports_of_kind(workspace, path, called)
        return next((describe.port(one) for one in known if one.name == port), None)
    return None


def include_edits(workspace: Workspace, path: str, other: str) -> tuple[Edit, ...]:
    """The edits that add a proposal to the file's scope.

    Args:
        other: the file that defines it; empty if it is in scope.
    """
    if other not in workspace.files:
        return ()
    at, line = include_line(head(workspace.store, path), path, other)
    return (Edit(Span(at, at), line),)


def _definition(workspace: Workspace, path: str, kind: Kind, name: str) -> Definition | None:
    return workspace.scope(path).find(kind, name) or next(defined_elsewhere(workspace, kind, name), None)
