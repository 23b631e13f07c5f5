"""Collects the overview of workspaces.

One invariant: each node, requirement and quality is one row, however many missions contain it, because it is written
once.  Errors of missions are not reported here: an overview has all valid parts.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import chain
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.btcpp.enforceability import way_instead
from btq_lang.catalog.qualities import Edition, get, qualities
from btq_lang.diagnostics.model import Place
from btq_lang.evidence.boxes import measured_by
from btq_lang.evidence.meanings import fingerprints, is_suspect
from btq_lang.evidence.sentences import result
from btq_lang.evidence.verdicts import WORST_FIRST, RequirementVerdict, worst_of
from btq_lang.graph.figure import Box, MeasuredClause, Note
from btq_lang.graph.missions import by_tree, concerns, figure, requirement_note
from btq_lang.requirements.applied import Applied
from btq_lang.requirements.approval import approval_state
from btq_lang.requirements.model import MissionRun, NodeTarget, ResolvedRequirement
from btq_lang.requirements.resolve import Requirements, requirements
from btq_lang.requirements.verifying import RequirementKey, verifying_scenarios
from btq_lang.syntax.tree import Hazard, QualityDecl, written
from btq_lang.trace.chain import chained
from btq_lang.trace.meanings import Meanings, NameMeaning
from btq_lang.trace.metadata import hazard_row, metadata_fields, mitigated
from btq_lang.trace.overview import (
    WAYS,
    AppliedRequirement,
    At,
    BuildVerdicts,
    ClauseEvidence,
    HazardRow,
    NodeRow,
    Overview,
    QualityRow,
    RequirementRow,
    TreeRow,
    VerificationRow,
)
from btq_lang.trace.overview import CharacteristicTotals as TotalRow
from btq_lang.trace.ways import declared_ways
from btq_lang.util.grouping import grouped
from btq_lang.util.record import replace
from btq_lang.util.text import Span as TextSpan
from btq_lang.workspace.node_names import is_placeholder
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.evidence.verdicts import Verdict
    from btq_lang.trace.overview import Carries
    from btq_lang.trace.ways import Ways

    BoxDetails: TypeAlias = Callable[[ResolvedNode], tuple[tuple[str, ...], str]]
    VerdictsOf: TypeAlias = Callable[[str], Sequence[RequirementVerdict]]
    BuildsOf: TypeAlias = Callable[[str], Sequence[tuple[str, Sequence[RequirementVerdict]]]]
    _Key: TypeAlias = tuple[int, int]  # where a requirement is defined


def collect(
    parts: Sequence[tuple[Workspace, Sequence[str]]],
    ways: Ways = declared_ways,
    shown: Callable[[str], str] = str,
    details_of: BoxDetails | None = None,
    verdicts_of: VerdictsOf | None = None,
    builds_of: BuildsOf | None = None,
) -> Overview:
    """The overview of missions.

    Args:
        parts: workspaces, each with the requested paths in it; a file included by another of them is a part of that
            mission.  Its scenarios count, and those in files that include one of these.
        ways: determines how clauses are covered.
        shown: gives a path as people read it.
        details_of: gives further lines for the box of a node, and its class in the drawing.
        verdicts_of: gives the verdicts on the mission with a path; None: there is no evidence.
        builds_of: gives them by the labels of builds, in the order of time; None: builds are not known apart.
    """
    scenarios = _scenarios(parts, shown)
    collector = _Collector(ways, shown, details_of, verdicts_of, builds_of, scenarios)
    files: list[str] = []
    for workspace, requested in parts:
        included = {path for each in requested for path in workspace.closure(each) if path != each}
        for path in [each for each in requested if each not in included] or requested:
            files.append(shown(path))
            collector.add(workspace, path)
    overview = collector.overview(tuple(files))
    return chained(overview, (workspace.project for workspace, _ in parts), shown, scenarios)


def _scenarios(
    parts: Sequence[tuple[Workspace, Sequence[str]]], shown: Callable[[str], str]
) -> dict[RequirementKey, list[VerificationRow]]:
    """The scenarios that verify each requirement, each once, as several workspaces may have them."""
    pairs: dict[tuple[RequirementKey, VerificationRow], None] = {}
    for workspace, requested in parts:
        place = _places(workspace, shown)
        for key, scenarios in verifying_scenarios(workspace, requested).items():
            for one in scenarios:
                row = VerificationRow("test", one.title, place(one.place), one.expects, one.fingerprint)
                pairs[key, row] = None
    return grouped(pairs)


class _Collector:
    """The rows so far, by what they represent, and what is added to them at the end."""

    def __init__(
        self,
        ways: Ways,
        shown: Callable[[str], str],
        details_of: BoxDetails | None,
        verdicts_of: VerdictsOf | None,
        builds_of: BuildsOf | None,
        scenarios: Mapping[RequirementKey, Sequence[VerificationRow]],
    ) -> None:
        self._ways = ways
        self._scenarios = scenarios
        self._details_of = details_of
        self._verdicts_of = verdicts_of
        self._builds_of = builds_of
        self._shown = shown
        self._edition: Edition | None = None
        self._nodes: dict[int, NodeRow] = {}  # by `id` of the syntax, which all missions share
        self._sources: dict[int, ResolvedNode] = {}  # of these nodes
        self._notes: defaultdict[int, dict[object, Note]] = defaultdict(dict)  # at them, by what they represent
        self._places: dict[int, At] = {}  # of trees
        self._requirements: dict[_Key, RequirementRow] = {}
        self._meanings: dict[_Key, list[NameMeaning]] = {}  # of their qualities
        self._uses: defaultdict[_Key, dict[AppliedRequirement, None]] = defaultdict(dict)
        self._loose: dict[_Key, list[str]] = {}  # without a node in every mission in which other clauses have one
        self._verdicts: defaultdict[_Key, list[ClauseEvidence]] = defaultdict(list)
        self._builds: defaultdict[str, defaultdict[_Key, list[tuple[Verdict, bool]]]] = defaultdict(
            lambda: defaultdict(list)
        )
        self._qualities: dict[str, QualityRow] = {}
        self._hazards: dict[int, HazardRow] = {}  # by `id` of the syntax
        self._concerned: defaultdict[str, dict[str, None]] = defaultdict(dict)  # the nodes that satisfice a quality

    def add(self, workspace: Workspace, path: str) -> None:
        """Add a mission: a file and all its includes."""
        resolved = requirements(workspace, path)
        meanings = Meanings(workspace, path)
        self._edition = self._edition or meanings.edition
        place = _places(workspace, self._shown)
        for source in resolved.nodes.all:
            if id(source.node) not in self._nodes:
                self._sources[id(source.node)] = source
                self._places.setdefault(id(source.item), place(_tree_place(source)))
                self._nodes[id(source.node)] = _node(f"n{len(self._nodes) + 1}", source, place(source.place))
        self._declared(workspace, path, meanings, place)
        self._concerns(resolved, meanings, place)
        self._definitions(resolved, meanings, place)
        self._evidence(workspace, path, resolved)
        own = self._add_uses(workspace, path, resolved, place)
        for source in resolved.nodes.all:
            node = self._nodes[id(source.node)]
            carries: Carries = "own" if id(source) in own else "above" if _is_below(resolved, source, own) else "none"
            if _CARRIES.index(carries) > _CARRIES.index(node.carries):
                self._nodes[id(source.node)] = replace(node, carries=carries)  # of several missions, the weakest

    def overview(self, files: tuple[str, ...]) -> Overview:
        """All rows, linked with each other."""
        edition = self._edition or "2023"
        measured: defaultdict[str, dict[str, None]] = defaultdict(dict)
        for key, row in self._requirements.items():
            names = (row.quality or "", *row.further_qualities)
            for name, meaning in zip(names, self._meanings[key], strict=True):
                for id_ in (meaning.id or name, *meaning.ancestors):
                    measured[id_][row.key] = None
        rows = tuple(self._linked(key, row, len(files) == 1) for key, row in self._requirements.items())
        quality_rows = tuple(
            replace(row, concerns=tuple(self._concerned[row.key]), requirements=tuple(measured[id_]))
            for id_, row in self._qualities.items()
        )
        characteristics = [frozenset(one.characteristic for one in each) for each in self._meanings.values()]
        trees = tuple(sorted(self._trees(), key=lambda tree: tree.at.path not in files))  # included trees last
        return Overview(
            edition,
            files,
            rows,
            quality_rows,
            tuple(self._nodes.values()),
            trees,
            _totals(edition, rows, quality_rows, characteristics),
            self._verdicts_of is not None,
            builds=tuple(
                BuildVerdicts(
                    label,
                    tuple(
                        (self._requirements[key].key, worst_of(verdict for verdict, _ in own))
                        for key, own in verdicts.items()
                    ),
                    tuple(self._requirements[key].key for key, own in verdicts.items() if any(old for _, old in own)),
                )
                for label, verdicts in self._builds.items()
            ),
            hazards=tuple(mitigated(row, rows) for row in self._hazards.values()),
        )

    def _linked(self, key: _Key, row: RequirementRow, is_of_one_mission: bool) -> RequirementRow:
        evidence = sorted(self._verdicts[key], key=lambda one: WORST_FIRST.index(one.verdict))
        return replace(
            row,
            uses=tuple(self._uses[key]),
            loose=tuple(self._loose.get(key, ())),
            evidence=tuple(replace(one, mission="") if is_of_one_mission else one for one in evidence),
        )

    def _declared(self, workspace: Workspace, path: str, meanings: Meanings, place: Callable[[Place], At]) -> None:
        """Add user-defined qualities and hazards, whether used or not."""
        for other in workspace.scope(path).paths:
            for item in workspace.files[other].of_type(QualityDecl):
                if item.name is not None:
                    self._quality(item.name.text, meanings, place(Place(item.name.span, other, item)))
            for hazard in workspace.files[other].of_type(Hazard):
                if hazard.name is not None and id(hazard) not in self._hazards:
                    key, location = f"h{len(self._hazards) + 1}", place(Place(hazard.name.span, other, hazard))
                    self._hazards[id(hazard)] = hazard_row(key, hazard.name.text, hazard, location)

    def _concerns(self, resolved: Requirements, meanings: Meanings, place: Callable[[Place], At]) -> None:
        for source in resolved.nodes.all:
            for name, path in concerns(source):
                location = place(Place(path.span, source.path, source.item))
                key = self._quality(name, meanings, location)
                self._concerned[key][self._nodes[id(source.node)].key] = None
                note = Note("quality", key, name, text=f"satisfices {name}", link=f"#{key}")
                self._notes[id(source.node)][name] = note

    def _definitions(self, resolved: Requirements, meanings: Meanings, place: Callable[[Place], At]) -> None:
        for requirement in resolved.all.values():
            key, name, location = _place_of(requirement), requirement.quality, place(requirement.place)
            quality = self._quality(name, meanings, location) if name is not None else None
            further = [self._quality(each, meanings, location) for each in requirement.further_qualities]
            approval = resolved.store.ask(approval_state, resolved.viewpoint, requirement.name)
            scenarios = self._scenarios.get((requirement.place.path or "", requirement.name), ())
            if key not in self._requirements:
                self._meanings[key] = [meanings.of(each) for each in requirement.qualities] or [_NO_MEANING]
                self._requirements[key] = RequirementRow(
                    f"r{len(self._requirements) + 1}",
                    requirement.name,
                    " ".join((requirement.title or "").split()),
                    name,
                    quality,
                    tuple(_stated(requirement)),
                    location,
                    uses=(),
                    loose=(),
                    is_hard=way_instead(requirement) is None,
                    evidence=(),
                    further_qualities=requirement.further_qualities,
                    further_quality_keys=tuple(further),
                    **metadata_fields(requirement, approval, scenarios),
                )

    def _evidence(self, workspace: Workspace, path: str, resolved: Requirements) -> None:
        meanings = fingerprints(workspace, resolved) if self._verdicts_of is not None else {}

        def is_outdated(verdicts: RequirementVerdict) -> bool:
            now = meanings.get(verdicts.id)
            return is_suspect(verdicts.fingerprints, {now} if now is not None else None)

        for verdicts in self._verdicts_of(path) if self._verdicts_of is not None else ():
            if (requirement := resolved.all.get(verdicts.id)) is not None:
                self._verdicts[_place_of(requirement)] += [
                    ClauseEvidence(
                        *(self._shown(path), clause.text, clause.path, clause.verdict, result(clause)),
                        is_suspect=is_outdated(verdicts),
                    )
                    for clause in verdicts.clauses
                ]
        for label, of_build in self._builds_of(path) if self._builds_of is not None else ():
            for verdicts in of_build:
                if (requirement := resolved.all.get(verdicts.id)) is not None:
                    self._builds[label][_place_of(requirement)].append((verdicts.verdict, is_outdated(verdicts)))

    def _quality(self, name: str, meanings: Meanings, location: At) -> str:
        """The key of a quality, which is added if it is new."""
        meaning = meanings.of(name)
        id_ = meaning.id or name
        if id_ not in self._qualities:
            key, characteristic = f"q{len(self._qualities) + 1}", meaning.characteristic
            definition = meaning.definition
            self._qualities[id_] = QualityRow(key, name, meaning.id, characteristic, definition, location, (), ())
        return self._qualities[id_].key

    def _add_uses(
        self, workspace: Workspace, path: str, resolved: Requirements, place: Callable[[Place], At]
    ) -> dict[int, None]:
        """Add what requirements hold for; returns the nodes that carry something themselves, by `id`."""
        own = {id(source): None for source in resolved.nodes.all if any(True for _ in concerns(source))}
        places = {each.name: _place_of(each) for each in resolved.all.values()}
        loose = {(requirement.name, claim.text) for requirement, claim in resolved.about_no_node()}
        for name in dict.fromkeys(each.requirement.name for each in resolved.applied):
            clauses_left = self._loose.get(places[name], [claim.text for claim in resolved.all[name].claims])
            self._loose[places[name]] = [text for text in clauses_left if (name, text) in loose]
        measured = measured_by(resolved, self._verdicts_of(path)) if self._verdicts_of is not None else lambda _: ()
        for applied, clauses in zip(resolved.applied, self._ways(workspace, path, resolved), strict=True):
            definition_key = places[applied.requirement.name]
            sources = applied.nodes
            own.update((id(source), None) for source in sources)
            use = AppliedRequirement(
                _subject(applied),
                tuple(dict.fromkeys(self._nodes[id(source.node)].key for source in sources)),
                applied.how,
                applied.argument_list,
                place(applied.place),
                tuple(clauses),
            )
            self._uses[definition_key][use] = None
            note = _note(self._requirements[definition_key], applied, use, measured(applied))
            for source in sources:
                self._notes[id(source.node)].setdefault((note.key, use.arguments, tuple(note.lines)), note)
        for trace in resolved.traces:
            own[id(trace.node)] = None
            definition_key, node, name = places[trace.requirement], id(trace.node.node), trace.requirement
            use = AppliedRequirement(
                _name(trace.node), (self._nodes[node].key,), "link", "", place(trace.node.place), ()
            )
            self._uses[definition_key][use] = None
            key, notes = self._requirements[definition_key].key, self._notes[node]
            if all(note.key != key for note in notes.values()):
                notes[key] = Note("requirement", key, name, link=f"#{key}")
        return own

    def _trees(self) -> Iterator[TreeRow]:
        sources = list(self._sources.values())
        keys = {id(source): self._nodes[id(source.node)].key for source in sources}
        notes = {
            id(source): tuple(dict.fromkeys(self._notes[id(source.node)].values()))
            for source in sources
            if id(source.node) in self._notes
        }
        groups = list(by_tree(sources))
        links = {group[0].tree or "": f"#{keys[id(group[0])]}" for group in reversed(groups)}
        for group in groups:
            rows = [self._nodes[id(source.node)] for source in group]
            is_bare = all(row.carries != "own" for row in rows)
            drawn = figure(group, keys, notes, links)
            if self._details_of is not None:
                drawn = replace(drawn, boxes=tuple(map(_with_details, drawn.boxes, map(self._details_of, group))))
            location = self._places[id(group[0].item)]
            yield TreeRow(group[0].tree or "", location, tuple(row.key for row in rows), is_bare, drawn)


def _with_details(box: Box, details: tuple[tuple[str, ...], str]) -> Box:
    lines, state = details
    return replace(box, lines=(*box.lines, *lines), text="; ".join((box.text, *lines)), state=state)


# ---- single rows ----


def _places(workspace: Workspace, shown: Callable[[str], str]) -> Callable[[Place], At]:
    shown_once = cache(shown)  # a file has thousands of places

    def location_of(place: Place) -> At:
        assert place.path is not None, "places of nodes and requirements have a path"
        file = workspace.files[place.path]
        position = file.source_lines.position(file.on_disk(file.span_of(place)).start)
        return At(shown_once(place.path), position.line + 1, position.column + 1)

    return location_of


def _place_of(requirement: ResolvedRequirement) -> _Key:
    """The place where a requirement is defined: the same in all missions that use it."""
    return id(requirement.place.anchor), requirement.place.span.start


def _tree_place(source: ResolvedNode) -> Place:
    tree = source.item
    name = tree.name.span if tree.name is not None else TextSpan(tree.start, tree.start)
    return Place(name, source.path, tree)


def _is_below(resolved: Requirements, source: ResolvedNode, own: dict[int, None]) -> bool:
    """Whether, on each path to a node through SubTree nodes, a node above carries something."""
    waiting = [source]
    seen: set[int] = set()
    is_below = False
    while waiting:
        node = waiting.pop()
        above = node.parent
        while above is not None and id(above) not in own:
            above = above.parent
        if above is not None:
            is_below = True
            continue
        callers = resolved.nodes.callers(node.tree)
        if not callers:
            return False
        for caller in callers:
            is_below = is_below or id(caller) in own
            if id(caller) not in own and id(caller) not in seen:
                seen.add(id(caller))
                waiting.append(caller)
    return is_below


def _subject(applied: Applied) -> str:
    subject = applied.subject
    if isinstance(subject, NodeTarget):
        return "/".join((*subject.through, applied.tree or _name(subject.node)))
    if isinstance(subject, MissionRun):
        return "mission"
    return applied.requirement.claims[0].subject_text


def _node(key: str, source: ResolvedNode, location: At) -> NodeRow:
    is_skill = source.kind is None and source.category != "SubTree" and not source.children
    return NodeRow(key, _name(source), source.tree or "", source.category, is_skill, _CARRIES[0], location)


def _name(source: ResolvedNode) -> str:
    """Its kind and its instance name; for a placeholder of a skill, those of the skill."""
    if is_placeholder(source.node) and source.node.name is not None:
        return source.node.name.text
    return source.shown.removeprefix("`").removesuffix("`")


def _note(row: RequirementRow, applied: Applied, use: AppliedRequirement, measured: tuple[MeasuredClause, ...]) -> Note:
    """The note at a node; its state is that of the weakest clause."""
    ways = {clause.way for clause in use.clauses}
    state = next((way for way in ("reviewed", "monitored", "enforced") if way in ways), "")
    return replace(requirement_note(row.key, applied, measured, state, row.in_words(state)), link=f"#{row.key}")


def _stated(requirement: ResolvedRequirement) -> Iterator[str]:
    yield from (claim.text for claim in requirement.claims)
    yield from (scope.text for scope in (*requirement.scopes, *requirement.assumptions))
    if requirement.span is not None:
        yield requirement.span.text
    if requirement.odds is not None:
        yield requirement.odds.text
    if requirement.confidence is not None:
        yield f"confidence {round(requirement.confidence * 100, 9):g} %"
    if requirement.window is not None:
        yield requirement.window.text
    if requirement.action is not None and not requirement.classic:
        yield f"on violation {requirement.action}"
    if requirement.goal is not None:
        yield f"goal {requirement.goal.text}"
    if requirement.ways:
        yield requirement.verification
    yield from (f'because "{" ".join(reason.split())}"' for reason in requirement.reasons)
    yield from (f'source "{" ".join(source.split())}"' for source in requirement.sources)
    for head, names in (("refines", requirement.refines), ("mitigates", requirement.mitigates)):
        if names:
            yield f"{head} {', '.join(map(written, names))}"
    if requirement.priority is not None:
        yield f"priority {written(requirement.priority)}"


def totals_of(overview: Overview) -> tuple[TotalRow, ...]:
    """The totals of the requirements and qualities that an overview has."""
    characteristics = {quality.key: quality.characteristic for quality in overview.qualities}
    keys = ((row.quality_key, *row.further_quality_keys) for row in overview.requirements)
    by_requirement = [frozenset(characteristics.get(key or "") for key in of_row) for of_row in keys]
    return _totals(overview.edition, overview.requirements, overview.qualities, by_requirement)


def _totals(
    edition: Edition,
    rows: Sequence[RequirementRow],
    quality_rows: Sequence[QualityRow],
    by_requirement: Sequence[frozenset[str | None]],
) -> tuple[TotalRow, ...]:
    """A total for each product characteristic, each characteristic in use that is named, and the rest.

    Args:
        by_requirement: the characteristics of each requirement, None for a quality that belongs to none.
    """
    characteristics = [each.id for each in qualities(edition) if each.parent is None and each.kind == "product"]
    named = (*chain.from_iterable(by_requirement), *(each.characteristic for each in quality_rows if each.concerns))
    characteristics += [each for each in dict.fromkeys(named) if each is not None and each not in characteristics]
    totals: list[TotalRow] = []
    for id_ in (*characteristics, None):
        own = [row for row, its_own in zip(rows, by_requirement, strict=True) if id_ in its_own]
        concerns = {key for each in quality_rows if each.characteristic == id_ for key in each.concerns}
        if id_ is None and not own and not concerns:
            continue
        quality = get(id_, edition) if id_ is not None else None
        name = quality.name if quality is not None else id_ or "without a characteristic"
        ways = [clause.way for row in own for use in row.uses for clause in use.clauses]
        totals.append(TotalRow(id_ or "", name, len(concerns), len(own), *map(ways.count, WAYS)))
    return tuple(totals)


_NO_MEANING: Final = NameMeaning(None, (), None, "")
_CARRIES: Final[tuple[Carries, ...]] = ("own", "above", "none")
