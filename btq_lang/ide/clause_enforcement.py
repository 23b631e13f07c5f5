"""What `btq build` does about the clauses of a requirement, for a hover.

One invariant: it reports the plan of the build itself, in its words.
"""

from __future__ import annotations

from btq_lang.btcpp.enforceability import way_instead
from btq_lang.btcpp.enforcement import ClauseEnforcement, clause_enforcements
from btq_lang.requirements.definitions import requirement
from btq_lang.syntax.tree import Claim, Requirement
from btq_lang.workspace.file import Definition
from btq_lang.workspace.inputs import everything
from btq_lang.workspace.queries import Store
from btq_lang.workspace.workspace import Workspace

MOST_MISSIONS = 4  # that are looked at: resolving one takes long, and a library may be in hundreds
_MOST_NODES = 4


def enforcement_lines(workspace: Workspace, path: str, definition: Definition, *, is_attached: bool) -> str:
    """A line for each clause: enforced, monitored or by people, with the node if that differs between nodes, and why;
    empty if the requirement applies to nothing.  If the file `path` is a part of missions, some of those are planned.
    """
    item = definition.symbol.target
    assert isinstance(item, Requirement), "a requirement's symbol defines one"
    ways: dict[str, dict[tuple[str, str], dict[str, None]]] = {}
    resolved, _ = workspace.store.ask(requirement, definition.path, definition.symbol.name)
    way = way_instead(resolved) if resolved is not None and not resolved.classic else None
    if resolved is not None and way is not None:  # and for a large mission a plan takes long
        outcome = (resolved.by_people, "") if way[0] == "reviewed" else way
        file = workspace.files[definition.path]
        for claim in item.clauses:
            if isinstance(claim, Claim) and (is_attached or claim.subject is not None):
                ways[file.on_one_line(definition.entry, claim)] = {outcome: {}}
        return _lines(ways)
    for mission in _missions(workspace, path, definition):
        for enforcement in workspace.store.ask(_plan, mission):
            if (enforcement.requirement, enforcement.place.path) == (definition.symbol.name, definition.path):
                nodes = ways.setdefault(enforcement.clause, {}).setdefault(enforcement.in_words, {})
                if enforcement.subject:
                    nodes[enforcement.subject] = None
    return _lines(ways)


def _missions(workspace: Workspace, path: str, definition: Definition) -> tuple[str, ...]:
    """The missions for which the requirement is planned: the file itself, or some that it is a part of."""
    missions = (one for one in missions_of(workspace, path) if definition.path in workspace.scope(one).paths)
    return tuple(missions)[:MOST_MISSIONS]


def missions_of(workspace: Workspace, path: str) -> tuple[str, ...]:
    """The file itself, or the missions that it is a part of."""
    if path not in workspace.included_files:
        return (path,) if workspace.files[path].is_btq else ()
    tops = (other for other in workspace.files.values() if other.path not in workspace.included_files)
    missions = (other.path for other in tops if other.is_btq)
    return tuple(one for one in missions if path in workspace.closure(one))


def _plan(store: Store[Workspace], mission: str) -> tuple[ClauseEnforcement, ...]:
    workspace = store.ask(everything, mission)
    return tuple([each for clauses in clause_enforcements(workspace, mission) for each in clauses])


def _lines(ways: dict[str, dict[tuple[str, str], dict[str, None]]]) -> str:
    return "\n".join(f"- `{clause}`: {_shown(nodes_by_way)}" for clause, nodes_by_way in ways.items())


def _shown(nodes_by_way: dict[tuple[str, str], dict[str, None]]) -> str:
    return "; ".join(
        f"**{way}**{_at(nodes) if len(nodes_by_way) > 1 else ''}{f': {why}' if why else ''}"
        for (way, why), nodes in nodes_by_way.items()
    )


def _at(nodes: dict[str, None]) -> str:
    named = [*nodes][:_MOST_NODES]
    more = [f"{len(nodes) - _MOST_NODES} more"] if len(nodes) > _MOST_NODES else []
    return f" at {', '.join([*named, *more])}" if named else ""
