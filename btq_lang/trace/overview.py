"""The contents of an overview: small frozen records that writers print without looking anything up.

One invariant: rows refer to each other by keys (`n3` a node, `r1` a requirement, `q2` a quality, `h1` a hazard), which
are the same for the same missions.  Lines and columns count from 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from btq_lang.evidence.verdicts import NEVER, OPEN
from btq_lang.graph.figure import Figure
from btq_lang.requirements.model import by_people
from btq_lang.util.reach import reached
from btq_lang.util.record import Record

if TYPE_CHECKING:
    from btq_lang.btcpp.enforceability import Way
    from btq_lang.catalog.qualities import Edition
    from btq_lang.evidence.verdicts import Verdict
    from btq_lang.requirements.approval import State

    # Whether a node carries a quality or a requirement: itself, through a node above it, or not at all.
    Carries: TypeAlias = Literal["own", "above", "none"]

WAYS: Final[tuple[Way, ...]] = ("enforced", "monitored", "reviewed")


class At(Record):
    """A place in a source file."""

    path: str
    line: int
    column: int

    @property
    def file(self) -> str:
        """The name of the file, without its folders."""
        return self.path.rpartition("/")[2]

    def __str__(self) -> str:
        return f"{self.path}:{self.line}"


class Clause(Record):
    """A clause applied to a subject.

    Attributes:
        why: why it is not covered better; empty if there is nothing to explain.
        is_demanded: the mission demands that the engine enforces it.
        is_measurable: whether it is one, and not the title of a requirement without any.
    """

    text: str
    way: Way
    why: str = ""
    is_demanded: bool = False
    is_measurable: bool = True

    @property
    def is_by_people(self) -> bool:
        """Whether people verify it although it could be measured."""
        return self.way == "reviewed" and self.is_measurable


class AppliedRequirement(Record):
    """A requirement applied to a subject.

    Attributes:
        subject: in words: `MoveBase ToCharger`, `from Pick starts to Place succeeds`.
        nodes: the keys of its nodes.
        how: `subject`: the claim names it; `satisfies` and `apply`: attached; `link`: the node satisfies a requirement
            whose claims name their subjects themselves.
        arguments: `(limit = 5 min)`.
    """

    subject: str
    nodes: tuple[str, ...]
    how: Literal["subject", "satisfies", "apply", "link"]
    arguments: str
    at: At
    clauses: tuple[Clause, ...]


class ClauseEvidence(Record):
    """What logs show of a clause at a node.

    Attributes:
        mission: by whose logs; empty if the overview is of one mission.
        clause, path: as in `ClauseVerdict`.
        result: the counts, in words.
        is_suspect: whether the requirement meant something else when it was judged.
    """

    mission: str
    clause: str
    path: str
    verdict: Verdict
    result: str
    is_suspect: bool = False


class ApprovalRow(Record):
    """An approval of a requirement.

    Attributes:
        on: the date, as written.
        of: the fingerprint of what was approved; empty if none is given.
    """

    by: str
    on: str
    of: str


class VerificationRow(Record):
    """A way to verify a requirement.

    Attributes:
        id: of the test case or the report, empty if none is named; of a scenario, its title.
        at: the place of the scenario; None for any other way.
        expects: which verdict on the requirement the scenario expects, other than satisfied; empty: none.
        fingerprint: of the text of the scenario.
        outcome: of the scenario, if its results were given: `passed`, `failed`, `unknown`, `error` or `not run`.
        is_stale: whether its text has changed since it ran.
    """

    method: str
    id: str
    at: At | None = None
    expects: str = ""
    fingerprint: str = ""
    outcome: str = ""
    is_stale: bool = False

    @property
    def shows_it_holds(self) -> bool:
        """Whether it is a test or a report that shows that the requirement is kept, as far as that is known."""
        return bool(self.id or self.at) and not self.expects and self.outcome in ("", "passed")


class RequirementRow(Record):
    """A requirement.

    Attributes:
        quality: as written; None without one.
        quality_key: of the quality's row.
        clauses: all of them, as typed.
        uses: what it holds for; empty if it is attached to nothing.
        loose: the clauses without a node, if other clauses have one.
        is_hard: the engine must enforce it.
        evidence: what logs show of its clauses, the worst verdict first.
        further_qualities: as written, after the first one; `further_quality_keys`: of their rows.
        sources: where it is from.
        refines: the IDs of the requirements of which it is a part; `mitigates`: those of hazards.
        priority: empty without one.
        verification: the ways to verify it, with the scenarios that do; without others, by monitor.
        refined_by: the keys of those that refine it.
        state: of its approval; `fingerprint`: of what it means now.
    """

    key: str
    name: str
    title: str
    quality: str | None
    quality_key: str | None
    clauses: tuple[str, ...]
    at: At
    uses: tuple[AppliedRequirement, ...]
    loose: tuple[str, ...]
    is_hard: bool
    evidence: tuple[ClauseEvidence, ...]
    further_qualities: tuple[str, ...] = ()
    further_quality_keys: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    refines: tuple[str, ...] = ()
    mitigates: tuple[str, ...] = ()
    priority: str = ""
    verification: tuple[VerificationRow, ...] = ()
    approvals: tuple[ApprovalRow, ...] = ()
    refined_by: tuple[str, ...] = ()
    state: State = "open"
    fingerprint: str = ""

    @property
    def verdict(self) -> Verdict | None:
        """The worst by logs; None without any."""
        return self.evidence[0].verdict if self.evidence else None

    @property
    def is_suspect(self) -> bool:
        """Whether it, or what it refines, has changed since it was approved, or it since it was judged."""
        return self.state == "suspect" or any(clause.is_suspect for clause in self.evidence)

    @property
    def is_judged(self) -> bool:
        """Whether logs show how it is kept, or it names the test or the report that does, or a scenario does."""
        return self.verdict not in (None, NEVER, OPEN) or any(way.shows_it_holds for way in self.verification)

    @property
    def scenarios(self) -> tuple[VerificationRow, ...]:
        """The scenarios that verify it."""
        return tuple(way for way in self.verification if way.at is not None)

    @property
    def untitled(self) -> tuple[str, ...]:
        """Of the tests beside its scenarios that it names, that no scenario is called so: a title may be mistyped."""
        ways = [way for way in self.verification if way.method == "test" and way.id and way.at is None]
        return tuple(f'no scenario has the title "{way.id}"' for way in (ways if self.scenarios else ()))

    @property
    def ways(self) -> tuple[str, ...]:
        """How it is covered: one way, or `enforced` and `monitored` or `not attached` if clauses differ, or that."""
        covered = {clause.way for use in self.uses for clause in use.clauses}
        ways: list[str] = [way for way in WAYS if way in covered] or (["linked"] if self.uses else [])
        return (*ways, *(["not attached"] if self.loose or not ways else []))

    @property
    def way(self) -> str:
        """The same in one text, joined by commas."""
        return ", ".join(self.ways)

    @property
    def ways_in_words(self) -> tuple[str, ...]:
        """The same, with how people verify it."""
        return tuple(map(self.in_words, self.ways))

    def in_words(self, way: str) -> str:
        """A way in words: what people verify is `by test TC-12`, and `by test` if scenarios do."""
        if way != "reviewed":
            return way
        ways = [(each.method, each.id) for each in self.verification if each.at is None]
        is_tested = any(method == "test" for method, _ in ways) or not self.scenarios
        return by_people(ways if is_tested else [*ways, ("test", "")])

    @property
    def whys(self) -> tuple[str, ...]:
        """Why its clauses are not covered better, each reason once, and which tests are not among its scenarios."""
        reasons = [
            clause.why for use in self.uses for clause in use.clauses if clause.way == "monitored" and clause.why
        ]
        loose = (f"`{clause}` applies to no node" for clause in self.loose)
        return tuple(dict.fromkeys((*reasons, *loose, *self.untitled)))


class HazardRow(Record):
    """A hazard.

    Attributes:
        title, severity: empty without one.
        requirements: the keys of those that mitigate it.
    """

    key: str
    name: str
    title: str
    severity: str
    sources: tuple[str, ...]
    reasons: tuple[str, ...]
    at: At
    requirements: tuple[str, ...]


class ExternalRow(Record):
    """A requirement or a hazard that another tool keeps.

    Attributes:
        title, status, url: empty without one.
        requirements: the keys of those that refine or mitigate it.
        scenarios: those that verify it.
    """

    key: str
    name: str
    title: str
    status: str
    url: str
    at: At
    requirements: tuple[str, ...]
    scenarios: tuple[VerificationRow, ...] = ()


class QualityRow(Record):
    """A quality that the missions name.

    Attributes:
        name: as first written.
        id: in the quality model, or the declared name; None: unknown.
        characteristic: that of the ISO standard; None: it belongs to none.
        concerns: the keys of the nodes that satisfice it.
        requirements: the keys of those that make it, or a part of it, measurable.
    """

    key: str
    name: str
    id: str | None
    characteristic: str | None
    definition: str
    at: At
    concerns: tuple[str, ...]
    requirements: tuple[str, ...]


class NodeRow(Record):
    """A written node.

    Attributes:
        name: its kind and its instance name.
        is_skill: it is an action or a condition that is not built in: a skill of the robot.
    """

    key: str
    name: str
    tree: str
    category: str | None
    is_skill: bool
    carries: Carries
    at: At


class TreeRow(Record):
    """A tree; nodes: the keys of its nodes; figure: its drawing."""

    name: str
    at: At
    nodes: tuple[str, ...]
    is_bare: bool
    figure: Figure


class CharacteristicTotals(Record):
    """The totals of one characteristic; the last row is for what belongs to none.

    Attributes:
        concerns: nodes that satisfice it.
        enforced, monitored, reviewed: clauses, counted for every subject; reviewed: by people, and so the texts of
            requirements without clauses.
    """

    id: str
    name: str
    concerns: int
    requirements: int
    enforced: int
    monitored: int
    reviewed: int

    @property
    def numbers(self) -> tuple[int, ...]:
        return self.concerns, self.requirements, self.enforced, self.monitored, self.reviewed


class BuildVerdicts(Record):
    """What the logs of a build show.

    Attributes:
        label: of its runs in the store; empty if they have none.
        verdicts: on requirements, by the keys of their rows.
        suspect: the keys of those that meant something else when they were judged.
    """

    label: str
    verdicts: tuple[tuple[str, Verdict], ...]
    suspect: tuple[str, ...] = ()


class JudgedRuns(Record):
    """The runs by which requirements are judged: how many, and the date of the last one; empty if it is unknown."""

    runs: int
    last: str


class Overview(Record):
    """The whole overview.

    Attributes:
        edition: of the quality model in which the totals are counted.
        files: the missions.
        totals: of each characteristic of the edition, including unused ones.
        has_evidence: whether logs, or verdicts on them, were given.
        errors: how many errors the missions have; with any, rows may be missing.
        builds: in the order of their first runs; empty unless the evidence is a store with labels.
        external: what requirements refine or mitigate and other tools keep.
        wants_sources: whether a requirement without a source is a gap.
        is_selection: whether it has some requirements only, so that what others concern is not a gap.
        judged: the runs of the evidence; None if they are not known.
    """

    edition: Edition
    files: tuple[str, ...]
    requirements: tuple[RequirementRow, ...]
    qualities: tuple[QualityRow, ...]
    nodes: tuple[NodeRow, ...]
    trees: tuple[TreeRow, ...]
    totals: tuple[CharacteristicTotals, ...]
    has_evidence: bool = False
    errors: int = 0
    builds: tuple[BuildVerdicts, ...] = ()
    hazards: tuple[HazardRow, ...] = ()
    external: tuple[ExternalRow, ...] = ()
    wants_sources: bool = False
    is_selection: bool = False
    judged: JudgedRuns | None = None

    @property
    def by_build(self) -> Iterator[tuple[RequirementRow, tuple[tuple[str, bool], ...]]]:
        """The requirements that logs of any build judge, each with its verdict of every build, empty without one, and
        whether that is suspect.
        """
        of_builds = [(dict(build.verdicts), build.suspect) for build in self.builds]
        for requirement in self.requirements:
            key = requirement.key
            verdicts = tuple((of_build.get(key, ""), key in suspect) for of_build, suspect in of_builds)
            if any(verdict for verdict, _ in verdicts):
                yield requirement, verdicts

    @property
    def unmeasured(self) -> tuple[QualityRow, ...]:
        """Qualities without a requirement."""
        return tuple(quality for quality in self.qualities if not (quality.requirements or self.is_selection))

    @property
    def unmitigated(self) -> tuple[HazardRow, ...]:
        """Hazards without a requirement."""
        return tuple(hazard for hazard in self.hazards if not hazard.requirements)

    @property
    def unjudged(self) -> tuple[RequirementRow, ...]:
        """Requirements that are not judged and that no judged requirement refines, although there is evidence."""
        return self._lacking(lambda row: row.is_judged) if self.has_evidence else ()

    @property
    def not_passed(self) -> tuple[tuple[RequirementRow | ExternalRow, VerificationRow], ...]:
        """Requirements, each with a scenario that verifies it and has not passed, by the results that were given."""
        rows: tuple[RequirementRow | ExternalRow, ...] = (*self.requirements, *self.external)
        return tuple((row, way) for row in rows for way in row.scenarios if way.outcome not in ("", "passed"))

    @property
    def sourceless(self) -> tuple[RequirementRow, ...]:
        """Requirements that have no source and refine none, in projects that ask for sources."""
        rows = self.requirements if self.wants_sources else ()
        return tuple(row for row in rows if not (row.sources or row.refines))

    @property
    def unattached(self) -> tuple[RequirementRow, ...]:
        """Requirements without a node or another subject, also through those that refine them."""
        return self._lacking(lambda row: bool(row.uses))

    def _lacking(self, has_it: Callable[[RequirementRow], bool]) -> tuple[RequirementRow, ...]:
        """The requirements that lack something, as do all that refine them."""
        refined_by = {row.key: row.refined_by for row in self.requirements}
        having = {row.key for row in self.requirements if has_it(row)}
        lacking: list[RequirementRow] = []
        for row in self.requirements:
            refining: Iterator[str] = reached([row.key], lambda key: refined_by[key])
            lacking += [row] if having.isdisjoint(refining) else []
        return tuple(lacking)

    @property
    def loose(self) -> tuple[tuple[RequirementRow, str], ...]:
        """Clauses without a node, of requirements whose other clauses have one."""
        return tuple((requirement, clause) for requirement in self.requirements for clause in requirement.loose)

    @property
    def unenforced(self) -> tuple[RequirementRow, ...]:
        """Hard requirements with a clause that is only monitored for some subject, or has no node."""
        return tuple(
            requirement
            for requirement in self.requirements
            if (requirement.is_hard and requirement.loose)
            or any(
                clause.is_demanded and clause.way == "monitored" for use in requirement.uses for clause in use.clauses
            )
        )

    @property
    def bare_nodes(self) -> tuple[NodeRow, ...]:
        """Skills that neither carry anything themselves nor are below a node that does."""
        nodes = () if self.is_selection else self.nodes
        return tuple(node for node in nodes if node.is_skill and node.carries == "none")

    @property
    def bare_trees(self) -> tuple[TreeRow, ...]:
        """Trees without a node that carries anything itself."""
        return tuple(tree for tree in self.trees if tree.is_bare and not self.is_selection)

    def coverage(self) -> dict[str, int]:
        """How many skills carry something themselves, through a node above them, or not at all."""
        skills = [node.carries for node in self.nodes if node.is_skill]
        return {carries: skills.count(carries) for carries in ("own", "above", "none")}
