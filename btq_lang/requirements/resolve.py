"""All requirements of a file and of what it includes, resolved."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from btq_lang.catalog.name_kinds import Kind
from btq_lang.requirements import nodes
from btq_lang.requirements.applied import Applied, Attachment, Trace
from btq_lang.requirements.attach import applied_in, attached_by, claimed, uses_in
from btq_lang.requirements.definitions import requirement
from btq_lang.requirements.model import Condition, ResolvedClaim, ResolvedRequirement, ResolvedSignal
from btq_lang.requirements.nodes import Nodes
from btq_lang.requirements.paths import Problem
from btq_lang.requirements.reader import Problems, context, signal
from btq_lang.syntax.tree import Apply, Tree
from btq_lang.util.record import Record
from btq_lang.workspace import inputs
from btq_lang.workspace.item_index import Facts
from btq_lang.workspace.queries import Store
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


def requirements(workspace: Workspace, path: str) -> Requirements:
    """The requirements of a file and what it includes, resolved.

    Raises:
        KeyError: the file does not exist.
    """
    if path not in workspace.files:
        raise KeyError(path)
    store = workspace.store
    signals = {name: store.ask(signal, path, name) for name in store.ask(inputs.names, path, Kind.SIGNAL)}
    contexts = {name: store.ask(context, path, name)[0] for name in store.ask(inputs.names, path, Kind.CONTEXT)}
    defined = {name: store.ask(requirement, path, name) for name in store.ask(inputs.names, path, Kind.REQUIREMENT)}
    uses: dict[str, list[Attachment]] = {}
    for item in store.ask(inputs.attaching, path):
        for use in store.ask(uses_in, path, *item)[0]:
            uses.setdefault(use.requirement, []).append(use)
    applied: list[Applied] = []
    traces: list[Trace] = []
    for name in defined:
        attached = attached_by(store, path, name, uses.get(name, ()))
        applied += (*store.ask(claimed, path, name), *attached.applied)
        traces += attached.traces
    return Requirements(
        store,
        path,
        {name: resolved for name, (resolved, _) in signals.items() if resolved is not None},
        contexts,
        {name: resolved for name, (resolved, _) in defined.items() if resolved is not None},
        tuple(applied),
        tuple(traces),
        store.ask(nodes.nodes, path),
        store.ask(nodes.mission, path),
    )


def problems_in(store: Store[Workspace], viewpoint: str, path: str, facts: Facts) -> Problems:
    """What is wrong with the requirements, signals and contexts that an item defines, and with what it attaches."""
    all_problems: list[Problem] = []
    names = dict.fromkeys((symbol.kind, symbol.name) for symbol in facts.summary.symbols)
    for kind, name in names:
        if kind in _DEFINING and store.ask(inputs.definition, viewpoint, kind, name) == (path, facts):
            all_problems += store.ask(_DEFINING[kind], viewpoint, name)[1]
    if isinstance(facts.item, Tree | Apply):
        uses, problems = store.ask(uses_in, viewpoint, path, facts)
        all_problems += problems
        trees = dict.fromkeys((use.target.node.path, use.target.node.facts) for use in uses)
        ambiguous = [problem for tree in trees for problem in store.ask(applied_in, viewpoint, *tree).problems]
        all_problems += [problem for problem in ambiguous if problem.place.anchor is facts.item]
    return tuple(all_problems)


_DEFINING: Final[dict[Kind, Callable[[Store[Workspace], str, str], tuple[object, Problems]]]] = {
    Kind.SIGNAL: signal,
    Kind.CONTEXT: context,
    Kind.REQUIREMENT: requirement,
}


class Requirements(Record):
    """All requirements that a file sees.

    Attributes:
        store, viewpoint: for further queries, for instance of budgets.
        signals: by name.
        contexts: by name; None if not understood.
        all: every requirement by name, in the order of their definitions, with parameters.
        applied: what applies to what, with arguments.
        traces: `satisfies` at nodes, for requirements whose claims name their own subjects.
        nodes: the written nodes.
        mission: the main tree's root; None if it is unknown which tree runs.
    """

    store: Store[Workspace]
    viewpoint: str
    signals: dict[str, ResolvedSignal]
    contexts: dict[str, Condition | None]
    all: dict[str, ResolvedRequirement]
    applied: tuple[Applied, ...]
    traces: tuple[Trace, ...]
    nodes: Nodes
    mission: ResolvedNode | None

    def about_no_node(self) -> tuple[tuple[ResolvedRequirement, ResolvedClaim], ...]:
        """The claims that apply to nothing, of requirements whose other claims apply to something; a requirement that
        applies to nothing at all is unused, which is reported separately."""
        used = {each.requirement.name for each in self.applied}
        # Claims with equal text have the same subject, or none.
        applied = {(each.requirement.name, claim.text) for each in self.applied for claim in each.requirement.claims}
        return tuple(
            (requirement, claim)
            for requirement in self.all.values()
            if requirement.name in used
            for claim in requirement.claims
            if (requirement.name, claim.text) not in applied
        )
