"""What requirements with `on violation fail` and `halt` add to the XML, and how each clause is enforced.

One invariant: without the added elements, which `wrappers` marks, the XML is the export's; and a clause that is not
enforced has a reason.  An included file is a part of several missions, so only requirements that it sees itself add
wrappers to its nodes, and the mission's own file initializes the variables of all of them.  Whether a clause makes
sense is for `checks`.

    btq_init   a Sequence around the main tree's root: first values, the mission, and the test whether to halt it
    btq_first  a RunOnce in it: the values of signals whose entries are unwritten
    btq_start  a Script in it: the variables of guards
    btq_stop   a ReactiveSequence in it, where a clause halts: ends the mission at the tick after
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Final

from btq_lang.btcpp.conditions import all_of
from btq_lang.btcpp.document import Document, Element, XmlComment
from btq_lang.btcpp.enforceability import Elsewhere, Enforceability, Way, way_instead, where_else
from btq_lang.btcpp.export import Export, is_mission
from btq_lang.btcpp.guards import NotEnforced
from btq_lang.btcpp.keys import Keys
from btq_lang.btcpp.marks import GUARDS_NOTE
from btq_lang.btcpp.wrappers import START, Wrapper, first_values, leaf, wrapped
from btq_lang.catalog.name_kinds import Kind
from btq_lang.diagnostics.model import Place
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.model import ResolvedClaim, ResolvedRequirement
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.util.record import Record, replace
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class ClauseEnforcement(Record):
    """How a clause is enforced.

    Attributes:
        requirement: its name.
        clause: as typed.
        place: of the clause.
        node: that it applies to, if any.
        way: by the engine, from logs, or by people.
        why: the reason why the engine does not enforce it, or a note on how it does; mostly empty.
        asked: whether the requirement wants it enforced.
        subject: how the claim names the node: as itself, as its tree, or as the mission.
        by_people: if it is people who verify it, how: `by test TC-12`.
    """

    requirement: str
    clause: str
    place: Place
    node: ResolvedNode | None
    way: Way
    why: str = ""
    asked: bool = False
    subject: str = ""
    by_people: str = ""

    @property
    def in_words(self) -> tuple[str, str]:
        """The way, and the reason if that says more."""
        if self.way == "reviewed":
            return self.by_people, ""
        return "not enforced, monitored" if self.asked and self.way == "monitored" else self.way, self.why


class Enforcement(Record):
    """A file's export with what its requirements add.

    Attributes:
        clauses: for each of `requirements(…).applied`, in its order, its clauses.
        loose: `requirements(…).about_no_node()`.
    """

    export: Export
    clauses: tuple[tuple[ClauseEnforcement, ...], ...]
    loose: tuple[tuple[ResolvedRequirement, ResolvedClaim], ...] = ()


def enforced(workspace: Workspace, path: str, export: Export, bundled: bool = False) -> Enforcement:
    """Add what a file's requirements need to its export, in place.  The export may have all that the file includes."""
    if not _has_requirements(workspace, path):
        return Enforcement(export, ())
    resolved = requirements(workspace, path)
    files = _written(workspace, path, bundled)
    plan, others = _plans(workspace, resolved, path, files)
    wrappers: dict[int, Sequence[Wrapper]] = {**plan.wrappers}
    mission = resolved.mission
    if mission is not None and _begins(workspace, resolved, path, files) and (start := _start([plan, *others])):
        key = id(mission.node)
        wrappers[key] = (*start, *wrappers.get(key, ()))
    document = export.document
    if wrappers:
        _put(document, {id(export.elements[key]): each for key, each in wrappers.items()})
        document = Document([XmlComment(GUARDS_NOTE), *document.contents])
    return Enforcement(replace(export, document=document), plan.clauses, resolved.about_no_node())


def clause_enforcements(
    workspace: Workspace, path: str, bundled: bool = False
) -> tuple[tuple[ClauseEnforcement, ...], ...]:
    """For each of `requirements(workspace, path).applied`, in its order, how its clauses are enforced in the build.

    Raises:
        KeyError: there is no such file.
    """
    if not _has_requirements(workspace, path):
        return ()
    resolved = requirements(workspace, path)
    return _plans(workspace, resolved, path, _written(workspace, path, bundled))[0].clauses


def _has_requirements(workspace: Workspace, path: str) -> bool:
    """Whether a file may have requirements at all; most have none."""
    return any(True for _ in workspace.scope(path).names(Kind.REQUIREMENT))


def _begins(workspace: Workspace, resolved: Requirements, path: str, files: frozenset[str]) -> bool:
    """Whether the mission begins in one of these files."""
    return resolved.mission is not None and resolved.mission.path in files and path not in workspace.included_files


def _written(workspace: Workspace, path: str, bundled: bool) -> frozenset[str]:
    """The files that are written into one document with this one."""
    return frozenset(workspace.registered_with(path)) if bundled else frozenset((path,))


# ---- what is done about each clause ----


def _plans(
    workspace: Workspace, resolved: Requirements, path: str, files: frozenset[str]
) -> tuple[_Plan, tuple[_Plan, ...]]:
    """The plans for a file, and for the files that it includes and that are built too."""
    others = tuple(
        _Plan(workspace, requirements(workspace, each), each, frozenset((each,)), ()).whole()
        for each in workspace.closure(path)
        if each not in files and is_mission(workspace, each)
    )
    return _Plan(workspace, resolved, path, files, others).whole(), others


class _Plan:
    """What is to be put around the nodes of some of the files that a file sees, given the plans of the others.

    Attributes:
        wrappers: by `id(node)` of the syntax.
        enforced: the keys of enforced clauses (clause, node, arguments), for the files that include these.
        initial_values: the entries that a mission initializes, each with its value.
        first: those of signals, each with its value before the first sample.
        stops: the entries that halt it.
    """

    def __init__(
        self, workspace: Workspace, resolved: Requirements, path: str, files: frozenset[str], others: Sequence[_Plan]
    ) -> None:
        self.wrappers: Final[dict[int, list[Wrapper]]] = {}
        self.enforced: Final[dict[object, ClauseEnforcement]] = {}
        self.initial_values: Final[dict[str, str]] = {}
        self.first: Final[dict[str, str]] = {}
        self.stops: Final[dict[str, None]] = {}
        self._workspace: Final = workspace
        self._requirements: Final = resolved
        self._path: Final = path
        self._files: Final = files
        self._others: Final = others
        self._keys: Final = Keys()
        is_shared = path in workspace.included_files
        mission = resolved.mission if _begins(workspace, resolved, path, files) else None
        store, viewpoint = resolved.store, resolved.viewpoint
        self._enforceability: Final = Enforceability(
            store, viewpoint, lambda: mission, files=files, is_shared=is_shared
        )
        self.clauses: tuple[tuple[ClauseEnforcement, ...], ...] = ()

    def whole(self) -> _Plan:
        """The plan with all clauses in it."""
        self.clauses = tuple(
            tuple([self.enforce(applied, claim) for claim in applied.requirement.claims])
            for applied in self._requirements.applied
        )
        return self

    def enforce(self, applied: Applied, claim: ResolvedClaim) -> ClauseEnforcement:
        """How a clause is enforced; records the wrappers it needs."""
        requirement = applied.requirement
        unenforced = way_instead(requirement)
        monitored = ClauseEnforcement(
            requirement.name,
            claim.text,
            claim.place,
            applied.node,
            *(unenforced or ("monitored", "")),
            asked=unenforced is None,
            subject=applied.shown,
            by_people=requirement.by_people,
        )
        if unenforced is not None:
            return monitored
        try:
            node = self._enforceability.node(applied, claim)
            identity = (requirement.name, claim.text, id(node.node), applied.arguments)
            enforcement = self.enforced.get(identity)
            if enforcement is None and node.path not in self._files:
                enforcement = next((each for other in self._others if (each := other.enforced.get(identity))), None)
                if enforcement is None:
                    raise Elsewhere(node)
            if enforcement is None:
                enforcement = replace(monitored, way="enforced", why=self._guard(requirement, claim, node))
                self.enforced[identity] = enforcement
        except Elsewhere as elsewhere:
            bundled = self._bundled.enforce(applied, claim)
            is_helped = bundled.way == "enforced"
            is_xml = self._workspace.files[elsewhere.node.path].is_foreign
            return replace(monitored, why=where_else(elsewhere.node, is_xml=is_xml) if is_helped else bundled.why)
        except NotEnforced as reason:
            return replace(monitored, why=str(reason))
        return enforcement

    @cached_property
    def _bundled(self) -> _Plan:
        """The plan for a bundle: if a bundle could not enforce a clause either, its file is not the reason."""
        files = _written(self._workspace, self._path, True)
        return _Plan(self._workspace, self._requirements, self._path, files, ())

    def _guard(self, requirement: ResolvedRequirement, claim: ResolvedClaim, node: ResolvedNode) -> str:
        """Record what a clause needs, and return the note on it.

        Raises:
            NotEnforced: the engine cannot do it.
        """
        name = self._keys.next(requirement.name)
        guard, first = self._enforceability.needs(requirement, claim, node, name, self._keys.stop(requirement.name))
        self._keys.take(name)
        self.initial_values.update(guard.initial_values)
        self.first.update(first)
        if guard.stop is not None:
            self.stops[guard.stop] = None
        for guarded_node, wrapper in guard.wrappers:
            self.wrappers.setdefault(id(guarded_node.node), []).append(wrapper)
        notes = [*guard.notes]
        if unset := [*(signal.name for signal in guard.signals if signal.initially is None), *guard.entries]:
            notes.append(f"the mission ends if a guard reads {_listed(unset)} before anything writes it")
        if aging := [signal.name for signal in guard.signals if signal.fresh is not None]:
            notes.append(f"guards read the latest value of {_listed(aging)}, whatever its age")
        return "; ".join(notes)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


# ---- what is put around nodes ----


def _start(plans: Iterable[_Plan]) -> tuple[Wrapper, ...]:
    """The nodes around the mission; empty if it has nothing to initialize."""
    initial_values: dict[str, str] = {}
    first: dict[str, str] = {}
    stops: dict[str, str] = {}
    for plan in plans:
        initial_values.update(plan.initial_values)
        first.update(plan.first)
        stops.update(dict.fromkeys(plan.stops, "false"))
    before = [first_values(_ALL, first)] if first else []
    if statements := [f"{key} := {value}" for key, value in (initial_values | stops).items()]:
        before.append(leaf("Script", _ALL, "btq_start", "; ".join(statements)))
    if not before:
        return ()
    if not stops:
        return (Wrapper(START, _ALL, "Sequence", "btq_init", before=tuple(before)),)
    code = all_of(f"({key} == false)" for key in stops)
    # The flags are set outside the reactive node, which would reset them at every tick; the condition after it catches
    # violations in the tree's last tick.
    after = (leaf("ScriptCondition", _ALL, "btq_end", code),)
    init = Wrapper(START, _ALL, "Sequence", "btq_init", before=tuple(before), after=after)
    guard = (leaf("ScriptCondition", _ALL, "btq_go_on", code),)
    return init, Wrapper(START, _ALL, "ReactiveSequence", "btq_stop", before=guard)


def _put(document: Document, wrappers: Mapping[int, Sequence[Wrapper]]) -> None:
    """Put wrappers around elements, by their `id`."""
    stack = [document.root]
    while stack:
        parent = stack.pop()
        for index, child in enumerate(parent.children):
            if isinstance(child, Element):
                stack.append(child)
                around = wrappers.get(id(child))
                if around:
                    parent.children[index] = wrapped(child, around)


_ALL: Final = "*"
