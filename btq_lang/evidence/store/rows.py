"""The findings in a log as rows of text, written while the log is judged.

One invariant: the rows depend on the findings alone, not on the name of the log, so a log that is judged again has the
same rows unless there is a new finding.

The names of nodes do not depend on their numbers: two trees have a name in common only if both have equally many nodes
that it could mean.
"""

from __future__ import annotations

import csv
import hashlib
import os
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from btq_lang.evidence.clause_findings import marks_of
from btq_lang.evidence.identity import Joined, without_number
from btq_lang.evidence.model import Activation, LoggedTree
from btq_lang.evidence.outline import open_clauses, open_reason
from btq_lang.evidence.store.tables import ROWS
from btq_lang.evidence.verdicts import OPEN, OUTCOMES, SATISFIED, UNKNOWN, VIOLATED
from btq_lang.util.record import replace

if TYPE_CHECKING:
    from btq_lang.evidence.clause import JudgedClause
    from btq_lang.evidence.pools import Pool
    from btq_lang.evidence.verbs import Judgement
    from btq_lang.evidence.verdicts import ClauseVerdict
    from btq_lang.requirements.model import Quantity, ResolvedRequirement


class Rows(ExitStack):
    """The rows of a log, in a file for each table until they are closed.

    Attributes:
        run: the number of the open run.
    """

    def __init__(self, folder: str) -> None:
        super().__init__()
        self.write: Final[dict[str, Callable[[Sequence[object]], object]]] = {}
        for name in ROWS:
            path = file_of(folder, name)
            file = open(path, "w", encoding="utf-8", errors="replace", newline="")  # noqa: SIM115 - the stack closes it
            self.enter_context(file)
            self.write[name] = csv.writer(file, lineterminator="\n").writerow
        self.run = 1
        self.clauses = 0  # how many the parts have

    def part(self, mission: str, robot: str) -> MissionRows:
        """The rows of a mission and a robot in the log."""
        return MissionRows(self, mission, robot)


class MissionRows:
    """The rows of one mission that one robot ran."""

    def __init__(self, rows: Rows, mission: str, robot: str) -> None:
        self._rows: Final = rows
        self._whose: Final = (mission, robot)
        self._clauses: Final[list[_Clause]] = []
        self._open: Sequence[ResolvedRequirement] = ()
        self._fingerprints: Mapping[str, str] = {}
        self._tree: tuple[object, ...] = ()
        self._nodes: dict[int, tuple[object, ...]] = {}
        self._names: Final[dict[str, dict[str, None]]] = {}  # of all nodes by their paths, in all trees of the log
        self._activations = 0

    def join(self, joined: Joined, clauses: Sequence[JudgedClause]) -> None:
        """Begin a session."""
        tree = joined.tree
        named = "\n".join(f"{node.uid} {node.kind} {node.path}" for node in tree.nodes.values())
        self._tree = hashlib.sha256(named.encode()).hexdigest()[:_DIGITS], len(tree.nodes), joined.number
        names = node_names(tree)
        self._nodes = {
            uid: (uid, node.path, names[uid], node.kind, uid in tree.leaves) for uid, node in tree.nodes.items()
        }
        for uid, node in tree.nodes.items():
            self._names.setdefault(node.path, {})[names[uid]] = None
        if not self._clauses:
            self._clauses.extend(_Clause(self._rows.clauses + index) for index in range(len(clauses)))
            self._rows.clauses += len(clauses)
            for written, clause in zip(self._clauses, clauses, strict=True):
                odds = clause.requirement.odds
                of_runs = odds is not None and odds.experiments == "runs"
                clause.record(partial(self._judged, written, of_runs))
            self._fingerprints = joined.mission.fingerprints
            self._open = [
                requirement for requirement in joined.mission.requirements.all.values() if open_reason(requirement)
            ]

    def see(self, activation: Activation) -> None:
        """Write an activation that has ended."""
        self._activations += 1
        each = activation
        row_start = (*self._whose, self._rows.run, *self._nodes[each.uid])
        row_end = each.begin, each.end, OUTCOMES[each.outcome], each.timing, each.earliest
        self._rows.write["activations"]((*row_start, *row_end))

    def end_run(self, root: Activation, retries: int, recoveries: int, failure: int | None) -> None:
        """Write the open run, which has ended.

        Args:
            failure: the node where its failure began, if it failed.
        """
        for clause in self._clauses:
            if clause.open:
                decisive = min(clause.open, key=lambda row: _DECISIVE.index(row[_VERDICT]))
                for row in clause.open:
                    self._rows.write["verdicts"](_counted(row, row is decisive))
                clause.open.clear()
        counts = self._activations, retries, recoveries, self._nodes[failure][_NAME] if failure is not None else None
        row_start = (*self._whose, self._rows.run)
        self._rows.write["runs"]((*row_start, root.begin, root.end, OUTCOMES[root.outcome], *counts, *self._tree))
        self._rows.run += 1
        self._activations = 0

    def end(self, clauses: Sequence[JudgedClause]) -> None:
        """Write the clauses, when the log has been read."""
        times_seen: Counter[tuple[str, str, str]] = Counter()
        for written, clause in zip(self._clauses, clauses, strict=True):
            findings, verdict, requirement = clause.findings, clause.verdict(), clause.requirement
            paths = [self._names.get(path, {without_number(path): None}) for path in findings.paths]
            node = ", ".join(dict.fromkeys(name for names in paths for name in names))
            same = requirement.name, verdict.text, node
            times_seen[same] += 1  # a requirement with parameters may be applied to a node twice
            text = verdict.text if times_seen[same] == 1 else f"{verdict.text} ({times_seen[same]})"
            row = replace(verdict, text=text, path=node)
            if findings.pool is not None:
                written.unit = findings.pool.demanded.unit.symbol
            self._write(
                written, requirement, row, findings.has_run, findings.missing, marks_of(clause.demand), findings.pool
            )
        for requirement in self._open:
            for verdict in open_clauses(requirement):
                self._write(_Clause(self._rows.clauses), requirement, verdict, False, verdict.why, {})
                self._rows.clauses += 1

    def _write(
        self,
        clause: _Clause,
        requirement: ResolvedRequirement,
        verdict: ClauseVerdict,
        has_run: bool,
        missing: str,
        marks: Mapping[str, Quantity],
        pool: Pool | None = None,
    ) -> None:
        """Write a clause.

        Args:
            has_run, missing: as in `ClauseFindings`.
            marks: as in `Histogram`.
            pool: as of `ClauseFindings`.
        """
        odds, window = requirement.odds, requirement.window
        named = (requirement.name, " ".join((requirement.title or "").split()), verdict.text, verdict.path)
        of_odds = (odds.probability, odds.relation, odds.experiments) if odds is not None else (None, None, None)
        of_window = (window.count, window.experiments, window.seconds) if window is not None else (None, None, None)
        counts = OPEN if verdict.verdict == OPEN else verdict.unit
        means = (verdict.of, counts, clause.unit, *of_odds, requirement.confidence, *of_window)
        marked = (marks[kind].si if kind in marks else None for kind in ("lower bound", "upper bound", "goal"))
        state = has_run, verdict.cut_off, missing
        rate: tuple[float | None, ...] = (None,) * 7
        if pool is not None:
            *bounds, seconds = pool.demanded.columns
            rate = (*bounds, seconds, None, None, None) if seconds else (None, None, None, None, *bounds)
        meant = self._fingerprints.get(requirement.name)
        self._rows.write["clauses"]((*self._whose, clause.index, *named, *means, *state, *marked, *rate, meant))

    def _judged(self, clause: _Clause, of_runs: bool, judgement: Judgement, begin: int, end: int, path: str) -> None:
        verdict = UNKNOWN if judgement.holds is None else SATISFIED if judgement.holds else VIOLATED
        measure = judgement.measure if judgement.holds is not None else None
        numbers = (None, None) if measure is None else (measure.si, measure.bound.si)
        if measure is not None and clause.unit is None and measure.unit is not None:
            clause.unit = measure.unit.symbol
        why = None if judgement.holds else judgement.sentence
        violated_at = judgement.at if verdict == VIOLATED else None
        most = judgement.most.si if judgement.most is not None else None
        amounts: tuple[float | None, ...] = (None,) * 4
        if judgement.amounts is not None:
            least_number, most_number, exposure, longest = judgement.amounts
            amounts = least_number, most_number, exposure / 1e6, longest / 1e6
        row = (
            clause.index,
            self._rows.run,
            path,
            begin,
            end,
            verdict,
            True,
            violated_at,
            *numbers,
            why,
            most,
            *amounts,
        )
        if of_runs:
            clause.open.append(row)
        else:
            self._rows.write["verdicts"](row)


class _Clause:
    """A clause of a part.

    Attributes:
        unit: of what is measured.
        open: the rows of the open run, if runs are counted.
    """

    __slots__ = ("index", "open", "unit")

    def __init__(self, index: int) -> None:
        self.index: Final = index
        self.unit: str | None = None
        self.open: Final[list[tuple[Any, ...]]] = []


def file_of(folder: str, table: str) -> str:
    """The file with the rows of a table."""
    return os.path.join(folder, f"{table}.csv")


def digest(folder: str) -> str:
    """The SHA-256 of all rows."""
    digest_of_rows = hashlib.sha256()
    for name in ROWS:
        hash_file(digest_of_rows, file_of(folder, name))
        digest_of_rows.update(b"\0")
    return digest_of_rows.hexdigest()


def hash_file(hashed: hashlib._Hash, path: str) -> None:
    """Add the bytes of a file to a hash."""
    with open(path, "rb") as file:
        while block := file.read(_BLOCK):
            hashed.update(block)


def _counted(row: tuple[Any, ...], is_counted: bool) -> tuple[Any, ...]:
    return (*row[: _VERDICT + 1], is_counted, *row[_VERDICT + 2 :])


def node_names(tree: LoggedTree) -> dict[int, str]:
    """The names of all nodes, by uid: their paths without numbers.

    Where several nodes below one path would have the same, it says which of them: `Move (2 of 3)`.
    """
    alike: dict[tuple[str, str], dict[tuple[str, int], None]] = {}  # by the path above and the own name
    paths: dict[int, tuple[str, int]] = {}  # each with how many nodes before have the same
    numbers: dict[str, int] = {}
    for uid, node in tree.nodes.items():
        numbers[node.path] = numbers.get(node.path, -1) + 1
        paths[uid] = node.path, numbers[node.path]
        parts = node.path.split("/")
        above = ("/".join(parts[:end]) for end in range(1, len(parts)))
        for path in (*((path_above, 0) for path_above in above), paths[uid]):
            parent, _, own = path[0].rpartition("/")
            alike.setdefault((parent, without_number(own)), {})[path] = None
    names: dict[tuple[str, int], str] = {}
    for (parent, own), places in alike.items():  # parents before what is below them
        before = f"{names[parent, 0]}/" if (parent, 0) in names else ""
        for place, path in enumerate(places, start=1):
            names[path] = f"{before}{own} ({place} of {len(places)})" if len(places) > 1 else f"{before}{own}"
    return {uid: names[path] for uid, path in paths.items()}


_NAME: Final = 2  # its column, of a node
_VERDICT: Final = 5  # its column
_DECISIVE: Final = (VIOLATED, UNKNOWN, SATISFIED)  # what a run is, if it has such a judgement
_DIGITS: Final = 16  # enough to tell trees apart
_BLOCK: Final = 1 << 20
