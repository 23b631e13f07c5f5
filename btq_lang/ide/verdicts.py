"""What logs show of the requirements of a text: above them, in a hover, and as diagnostics at their nodes.

One invariant: nothing is read here.  The verdicts come from a summary of `btq verify`; those of clauses whose bound or
odds have been edited since are judged again by what was measured, and those on other trees are called earlier ones.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Final
from weakref import ReferenceType, ref

from btq_lang.diagnostics.model import Diagnostic, Place, Related
from btq_lang.diagnostics.rules import RULES
from btq_lang.evidence.boxes import measured_of
from btq_lang.evidence.json_document import WrittenMission
from btq_lang.evidence.outline import Demand, open_clauses, open_reason, outline
from btq_lang.evidence.rejudging import Shown, shown_now
from btq_lang.evidence.sentences import explained, result, worst_violation
from btq_lang.evidence.verdicts import (
    NEVER,
    OPEN,
    SATISFIED,
    UNDECIDED,
    UNKNOWN,
    VIOLATED,
    WORST_FIRST,
    ClauseVerdict,
    RequirementVerdict,
)
from btq_lang.graph.missions import MeasuredBy
from btq_lang.ide.clause_enforcement import MOST_MISSIONS, missions_of
from btq_lang.ide.meaning import Subject, definition
from btq_lang.render.gfm import code, escaped, table
from btq_lang.requirements.model import ResolvedRequirement
from btq_lang.requirements.resolve import requirements
from btq_lang.util.record import Record
from btq_lang.util.text import Span, counted
from btq_lang.workspace.config import configured
from btq_lang.workspace.findings import Reported
from btq_lang.workspace.resolved import ResolvedNode
from btq_lang.workspace.workspace import Workspace


class Judged(Record):
    """A mission of the present text with the verdicts of logs.

    Attributes:
        shown: its clauses.
        open: its requirements that no log can show.
        is_earlier: the logs were judged by, or are of, other trees.
    """

    written: WrittenMission
    shown: tuple[Shown, ...]
    open: tuple[ResolvedRequirement, ...]
    is_earlier: bool


class ProjectVerdicts:
    """The verdicts of a project's logs.

    It keeps the verdicts on the last text of a mission itself.  The query store would take more: its inputs are read
    from a workspace, and this comes from a process of its own, to a session, at any time between two revisions.

    Attributes:
        root: the folder that paths of logs are relative to.
        missions: by the paths of their files.
        reported: the diagnostics of the last text of each file.
    """

    def __init__(self, root: str, missions: Mapping[str, WrittenMission]) -> None:
        self.root: Final = root
        self.missions: Final = missions
        self.reported: Final[dict[str, tuple[Reported, ...]]] = {}
        self._judged: dict[str, tuple[ReferenceType[Workspace], Judged]] = {}  # of the last text

    def verdicts_of(self, mission: str) -> Sequence[RequirementVerdict]:
        """The verdicts on a mission as it was when the logs were judged."""
        written = self.missions.get(mission)
        return written.requirements if written is not None else ()

    def on(self, workspace: Workspace, mission: str) -> Judged | None:
        """The verdicts on a mission; None: there are no runs of it."""
        written = self.missions.get(mission)
        if written is None:
            return None
        cached = self._judged.get(mission)
        if cached is not None and cached[0]() is workspace:
            return cached[1]
        resolved = requirements(workspace, mission)
        is_whole = all(source.is_whole for source in written.sources)
        is_earlier = not is_whole or outline(resolved) != written.outline
        shown = tuple(shown_now(resolved, written.requirements))
        judged = Judged(written, shown, tuple(each for each in resolved.all.values() if open_reason(each)), is_earlier)
        self._judged[mission] = ref(workspace), judged
        return judged


def verdict_titles(
    workspace: Workspace, path: str, evidence: ProjectVerdicts
) -> Iterator[tuple[Span, str, tuple[tuple[str, Span], ...]]]:
    """For each requirement in a file whose mission has logs: the place of its name, its worst verdict in a few words,
    and its nodes.
    """
    by_place: dict[Place, list[tuple[Shown, Judged]]] = {}
    unseen: dict[Place, str] = {}
    for judged in _on_missions(workspace, path, evidence):
        for shown in judged.shown:
            if shown.demand.requirement.place.path == path:
                by_place.setdefault(shown.demand.requirement.place, []).append((shown, judged))
        for requirement in judged.open:
            if requirement.place.path == path:
                unseen[requirement.place] = f"{OPEN}: {open_reason(requirement)}"
    for place, clauses in by_place.items():
        shown, judged = min(clauses, key=lambda each: _rank(each[0]))
        nodes = [node for each, _ in clauses for node in _nodes(each.demand)]
        places = [(node.path, workspace.files[node.path].span_of(node.place)) for node in nodes]
        yield workspace.files[path].span_of(place), _title(shown, judged), tuple(dict.fromkeys(places))
    for place, title in unseen.items():
        yield workspace.files[path].span_of(place), title, ()


def verdict_table(workspace: Workspace, path: str, referent: Subject, evidence: ProjectVerdicts) -> str:
    """What logs show of a requirement, in Markdown; empty without any."""
    place = definition(workspace, path, referent)
    lines: list[str] = []
    for judged in _on_missions(workspace, path, evidence):
        if place is None:
            break
        defined = referent.name, place.path
        shown = [each for each in judged.shown if _defined(each.demand.requirement) == defined]
        rows = [_row(each) for each in sorted(shown, key=_rank)]
        unseen = (clause for each in judged.open if _defined(each) == defined for clause in open_clauses(each))
        rows += [(OPEN, code(clause.text) if clause.text else "", escaped(clause.why)) for clause in unseen]
        if rows:
            runs, logs = judged.written.runs, judged.written.sources
            seen = f"{counted(runs, 'run')} in {logs[0].file if len(logs) == 1 else counted(len(logs), 'log')}"
            lines += ["", f"**{escaped(seen)}**" + (f", {_EARLIER}" if judged.is_earlier else ""), ""]
            lines += table(("Verdict", "Clause", "Result"), rows[:_ROWS])
            lines += ["", f"and {len(rows) - _ROWS} more"] if len(rows) > _ROWS else []
    return "\n".join(lines).strip()


def verdict_findings(workspace: Workspace, path: str, evidence: ProjectVerdicts) -> tuple[Reported, ...]:
    """Violated requirements and such that were never exercised, at their nodes in a file."""
    by_node: dict[int, tuple[ResolvedNode, dict[tuple[str, str], Diagnostic]]] = {}
    for judged in _on_missions(workspace, path, evidence):
        for shown in judged.shown:
            node = next(iter(_nodes(shown.demand)), None)
            if node is not None and node.path == path and (diagnostic := _finding(shown, node, judged, evidence.root)):
                of_item = by_node.setdefault(id(node.item), (node, {}))[1]
                of_item.setdefault((diagnostic.message, str(diagnostic.span)), diagnostic)
    before = evidence.reported.get(path, ())
    reported: list[Reported] = []
    for node, of_item in by_node.values():
        current = Reported(configured(workspace.project, path, of_item.values()), (path, node.item))
        reported.append(next((each for each in before if each == current), current))  # it has its text for the editor
    evidence.reported[path] = tuple(reported)
    return evidence.reported[path]


def is_outdated(workspace: Workspace, mission: str, evidence: ProjectVerdicts) -> bool:
    """Whether the summary does not say what the logs show of the present text."""
    judged = evidence.on(workspace, mission)
    if judged is None:
        return False
    was_edited = judged.written.outline != outline(requirements(workspace, mission))
    return was_edited or any(each.verdict is None for each in judged.shown)


def measured_in(workspace: Workspace, path: str, evidence: ProjectVerdicts) -> MeasuredBy:
    """A function from a requirement at what it applies to, to what logs of the file's missions show of it."""
    return measured_of(shown for judged in _on_missions(workspace, path, evidence) for shown in judged.shown)


def _on_missions(workspace: Workspace, path: str, evidence: ProjectVerdicts) -> Iterator[Judged]:
    for mission in missions_of(workspace, path)[:MOST_MISSIONS]:
        if (judged := evidence.on(workspace, mission)) is not None:
            yield judged


def _finding(shown: Shown, node: ResolvedNode, judged: Judged, root: str) -> Diagnostic | None:
    verdict = shown.verdict
    if verdict is None or verdict.verdict not in _RULES:
        return None
    name = shown.demand.requirement.name
    said = f"`{name}` is violated: {_result(shown, verdict)}" if verdict.verdict == VIOLATED else ""
    message = said or f"`{name}` was never exercised in {counted(judged.written.runs, 'run')}: {verdict.why}"
    related = [Related(shown.demand.requirement.place, f"`{name}` demands: {shown.demand.claim.text}")]
    notes: tuple[str, ...] = ()
    if verdict.violations:
        worst = worst_violation(verdict)
        log = worst.source if os.path.isabs(worst.source) else f"{root}/{worst.source}"
        related.append(Related(Place(Span(0, 0), log), f"run {worst.run} is in this log"))
        notes = (explained(verdict, worst, {}),)
    rule = _RULES[verdict.verdict]
    assert rule in RULES, "the rules of evidence have pages"
    if judged.is_earlier:
        message += f", {_EARLIER}"
    return Diagnostic(rule, node.node.head.span, message, tuple(related), notes)


def _nodes(demand: Demand) -> Sequence[ResolvedNode]:
    return demand.applied.nodes if demand.applied is not None else ()


def _defined(requirement: ResolvedRequirement) -> tuple[str, str | None]:
    return requirement.name, requirement.place.path


def _rank(shown: Shown) -> int:
    return WORST_FIRST.index(shown.verdict.verdict) if shown.verdict is not None else WORST_FIRST.index(UNKNOWN)


def _row(shown: Shown) -> tuple[str, ...]:
    if shown.verdict is None:
        return "", code(shown.demand.claim.text), "not measured yet"
    place = f" at {escaped(shown.verdict.path)}" if shown.verdict.path else ""
    return shown.verdict.verdict, f"{code(shown.demand.claim.text)}{place}", escaped(_result(shown, shown.verdict))


def _result(shown: Shown, verdict: ClauseVerdict) -> str:
    text = result(verdict)
    if shown.least == verdict.violated or verdict.interval is not None:
        return text
    return f"{shown.least} to {text}"


def _title(shown: Shown, judged: Judged) -> str:
    verdict = shown.verdict
    if verdict is None:
        return f"not measured yet: {shown.demand.claim.text}"
    held = verdict.counted - verdict.violated
    count = f"{shown.least} to {verdict.violated}" if shown.least != verdict.violated else str(verdict.violated)
    has_odds = verdict.interval is not None
    title = {
        VIOLATED: f"held in only {held} of {verdict.counted} {verdict.unit}"
        if has_odds
        else f"violated in {count} of {verdict.counted} {verdict.unit}",
        SATISFIED: f"held in {held} of {verdict.counted} {verdict.unit}",
        UNDECIDED: f"undecided: held in {held} of {verdict.counted} {verdict.unit}",
        UNKNOWN: f"unknown: {verdict.why}",
        NEVER: "never exercised",
    }[verdict.verdict]
    if verdict.worst is not None and not has_odds and verdict.verdict in (VIOLATED, SATISFIED):
        title += f" · worst {verdict.worst.text}"
    return f"{title} · {_EARLIER}" if judged.is_earlier else title


_RULES: Final = {VIOLATED: "requirement-violated", NEVER: "never-exercised"}
_EARLIER: Final = "measured on an earlier text"
_ROWS: Final = 8
