"""A run that answers a question about what can happen, as a scenario in which the same happens again.

One invariant: a scenario is only written if its run has shown that all leaves have the same statuses in the same order,
and that its expectations hold, or do not, as they should.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise, product
from typing import Final

from btq_lang.evidence.model import LoggedTree
from btq_lang.exploration.missions import ExploredMission
from btq_lang.exploration.witness import Deed, Tick, Written
from btq_lang.scenarios.judging import judged
from btq_lang.scenarios.mission import NotRunnable, ScenarioMission, as_program
from btq_lang.scenarios.reading import ScenarioMistakes, plan_of
from btq_lang.scenarios.running import ScenarioRun, run
from btq_lang.scenarios.suite import ScenarioPlace, Suite
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SUCCESS
from btq_lang.syntax.tree import Scenario, quote, written
from btq_lang.util.grouping import grouped
from btq_lang.util.record import Record, replace
from btq_lang.workspace.workspace import Workspace


class PossibleExpectation(Record):
    """What a scenario may expect.

    Attributes:
        line: after `expect`; empty: that the last leaf of the run starts.
        requirement: the claim of a requirement that it names, with its scope, a line each; empty: it names none.
        holds: whether it is to be so in the run.
        note: a comment.
    """

    line: str
    requirement: tuple[str, ...] = ()
    holds: bool = True
    note: str = ""


class Witness(Record):
    """A run to write.

    Attributes:
        title: of the scenario.
        ticks: of the run.
        is_endless: its last ticks are repeated for ever.
        expected: what the scenario may expect; the first one that is so is written.
        verifies: the requirement that it is about; empty: none.
        is_start: what was asked is that its last leaf starts, whatever comes of it.
    """

    title: str
    ticks: tuple[Tick, ...]
    is_endless: bool
    expected: tuple[PossibleExpectation, ...]
    verifies: str = ""
    is_start: bool = False


class WitnessedScenario(Record):
    """A scenario and its run.

    Attributes:
        requirement: the item that it expects something of; empty: there is none.
        text: of the scenario.
        drawing: the run in lines.
    """

    title: str
    requirement: str
    text: str
    mission: ScenarioMission
    run: ScenarioRun
    drawing: tuple[str, ...]


def as_scenario(explored: ExploredMission, witness: Witness, path: str, include: str) -> WitnessedScenario | None:
    """A run as a scenario; None: a scenario cannot say what happens in it.

    Args:
        path: of the file that is to have it.
        include: the path of the mission, seen from there.
    """
    scenario = _Writer(explored, witness, path, include).scenario()
    if scenario is None and witness.is_start and (started := _with_running_end(explored, witness)) is not None:
        return _Writer(explored, started, path, include).scenario()
    return scenario


def _with_running_end(explored: ExploredMission, witness: Witness) -> Witness | None:
    """The run, but its last leaf runs on, so that nothing comes after it; None: it never runs on."""
    *ticks, last = witness.ticks
    deed = last.deeds[-1] if last.deeds else None
    if deed is None or last.changes[-1:] != ((deed.uid, _STATUSES.get(deed.what)),):
        return None
    if explored.kinds[explored.build.tree().nodes[deed.uid].kind].is_condition:
        return None
    deeds, changes = (*last.deeds[:-1], replace(deed, what="runs")), (*last.changes[:-1], (deed.uid, RUNNING))
    return replace(witness, ticks=(*ticks, replace(last, deeds=deeds, changes=changes)))


class _Writer:
    def __init__(self, explored: ExploredMission, witness: Witness, path: str, include: str) -> None:
        self._explored: Final = explored
        self._witness: Final = witness
        self._path: Final = path
        self._include: Final = include
        self._tree: Final[LoggedTree] = explored.build.tree()
        main = explored.workspace.main_tree(explored.path)
        self._of: Final = (
            "" if main is not None and main.symbol.name == explored.tree else f" of {written(explored.tree)}"
        )

    def scenario(self) -> WitnessedScenario | None:
        """The first scenario whose run is that of the witness."""
        for is_timed, has_all in product((False, True), (False, True)):
            lines = [*self._givens(has_all), *self._leaves(is_timed, has_all)]
            tried = self._answered(lines)
            if tried is not None and self._is_same(tried.run):
                is_halted = tried.run.end == "is halted"
                for expected in map(self._named, self._witness.expected):
                    scenario = self._tried(tried.lines, expected, is_halted)
                    if scenario is not None and scenario.holds == expected.holds and self._is_same(scenario.run):
                        result = Suite(scenario.workspace).result(ScenarioPlace(self._path, 0), True)
                        if (result.outcome == "passed") != expected.holds or result.ended == "is refused":
                            continue
                        parts = self._witness.title, scenario.requirement, scenario.text, scenario.mission, scenario.run
                        return WitnessedScenario(*parts, result.drawing)
        return None

    def _named(self, expected: PossibleExpectation) -> PossibleExpectation:
        """With a line."""
        if expected.line:
            return expected
        changes = [change for tick in self._witness.ticks for change in tick.changes]
        paths = (self._path_of(uid) for uid, _ in reversed(changes))
        subject = next((path for path in paths if path), "mission")
        return replace(expected, line=f"{subject} starts at least 1 per run")

    def _is_same(self, ran: ScenarioRun) -> bool:
        """Whether the leaves have the statuses of the witness, in their order, and the mission its end."""
        result = self._witness.ticks[-1].result
        if result in ("succeeds", "fails") and ran.end != result:
            return False
        wanted = [change for tick in self._witness.ticks for change in tick.changes]
        leaves = {uid for uid in self._tree.leaves if self._is_custom(uid)}
        changes: list[tuple[int, int]] = []
        running: set[int] = set()
        for _, uid, status in ran.rows:
            if uid in leaves and (status != IDLE or uid in running):
                changes.append((uid, status))
            (running.add if status == RUNNING else running.discard)(uid)
        return changes[: len(wanted)] == wanted

    def _is_custom(self, uid: int) -> bool:
        return self._tree.nodes[uid].kind in self._explored.kinds

    def _answered(self, lines: Sequence[str]) -> _Tried | None:
        """A scenario in which conditions that are only asked after the run answer something, too."""
        lines = list(lines)
        uids = {node.path: uid for uid, node in self._tree.nodes.items()}
        asked: set[str] = set()
        while True:
            tried = self._tried(lines, PossibleExpectation("mission finishes at least 1 per run"), True)
            if tried is None or tried.run.end != "unanswered" or tried.run.why in asked:
                return tried
            asked.add(tried.run.why)
            kind = self._tree.nodes[uids[tried.run.why]].kind
            lines.append(f"given every {written(kind)} answers true")

    def _tried(self, lines: Sequence[str], expected: PossibleExpectation, is_halted: bool) -> _Tried | None:
        """The run of a scenario; None: it has a mistake."""
        steps = [*lines, *(self._halt() if is_halted else ()), f"expect {expected.line}"]
        verifies = f" verifies {written(self._witness.verifies)}" if self._witness.verifies else ""
        head = f"scenario {quote(self._witness.title)}{self._of}{verifies}"
        note = [f"# {expected.note}"] if expected.note else []
        text = "\n".join([*note, head, *(f"    {step}" for step in steps), ""])
        claims = "".join(f"    {line}\n" for line in expected.requirement)
        requirement = f"QualityReq {expected.line.split()[0]}\n{claims}" if claims else ""
        file = f"include {quote(self._include)}\n\n{requirement}\n{text}"
        workspace = self._explored.workspace.with_file(self._path, file)
        try:
            program = as_program(workspace, self._path, self._explored.tree)
            mission = ScenarioMission(program, self._path, self._explored.tree)
            (scenario,) = program.files[self._path].of_type(Scenario)
            plan = plan_of(mission, scenario, ())
        except (NotRunnable, ScenarioMistakes):
            return None
        ran = run(mission, plan)
        outcomes = {each.outcome for each in judged(mission, plan, ran)} if ran.end in _JUDGED else {"unknown"}
        if "unknown" in outcomes and ran.end != "unanswered":
            return (
                None if ran.end != "throws" else _Tried(workspace, tuple(lines), requirement, text, mission, ran, False)
            )
        return _Tried(workspace, tuple(lines), requirement, text, mission, ran, outcomes == {"passed"})

    def _halt(self) -> Iterator[str]:
        last = self._witness.ticks[-1]
        if last.result in ("", "runs") and not self._witness.is_endless:
            yield f"when {_time(last.at + self._explored.program.driver.period)} have passed: mission halts"

    # ---- entries ----

    def _givens(self, has_all: bool) -> Iterator[str]:
        for each in self._witness.ticks[0].given:
            if has_all or each.is_needed:
                yield f"given {{{each.name}}} = {_value(each)}"

    # ---- leaves ----

    def _leaves(self, is_timed: bool, has_all: bool) -> Iterator[str]:
        deeds = [(tick.at, deed) for tick in self._witness.ticks for deed in tick.deeds if self._is_custom(deed.uid)]
        changes: list[tuple[int, str]] = []
        for nodes, of_nodes in grouped((self._nodes(deed.uid), (at, deed)) for at, deed in deeds).items():
            kind = self._tree.nodes[of_nodes[0][1].uid].kind
            if not self._explored.kinds[kind].is_condition:
                yield f"given {nodes} {_behaviors(of_nodes, has_all)}"
            elif not is_timed:
                yield f"given {nodes} answers {', '.join(map(_answer, of_nodes))}"
            else:
                at_times = [(at, [*map(_answer, group)]) for at, group in groupby(of_nodes, lambda pair: pair[0])]
                yield f"given {nodes} answers {', '.join(at_times[0][1])}"
                for (_, before), (at, answers) in pairwise(at_times):
                    if answers != before[-1:]:
                        changes.append((at, f"{nodes} answers {', '.join(answers)}"))
        yield from (f"when {_time(at)} have passed: {change}" for at, change in sorted(changes))

    def _nodes(self, uid: int) -> str:
        """A path that names this node only; if one of its kind has none, all of the kind."""
        kind = self._tree.nodes[uid].kind
        paths = {each: self._path_of(each) for each in self._tree.leaves if self._tree.nodes[each].kind == kind}
        return f"every {written(kind)}" if "" in paths.values() else paths[uid]

    def _path_of(self, uid: int) -> str:
        nodes = self._tree.nodes
        for names in ((), *((nodes[above].name,) for above in self._tree.above(uid))):
            path = (*names, nodes[uid].name)
            if {each for target in self._explored.nodes.find(path) for each in self._explored.uids_of(target)} == {uid}:
                return "/".join(map(written, path))
        return ""


class _Tried(Record):
    """A scenario that was run; `holds`: all is as it expects."""

    workspace: Workspace
    lines: tuple[str, ...]
    requirement: str
    text: str
    mission: ScenarioMission
    run: ScenarioRun
    holds: bool


def _behaviors(deeds: Sequence[tuple[int, Deed]], has_all: bool) -> str:
    """Activations in the order of their starts."""
    texts: list[str] = []
    begun: dict[int, tuple[int, int]] = {}  # by the number of the node: the activation, and when it began
    for at, deed in deeds:
        if deed.what == "runs" and deed.uid in begun:
            continue
        number, begin = begun.pop(deed.uid, (len(texts), at))
        if number == len(texts):
            texts.append("does not end")
        if deed.what == "runs":
            begun[deed.uid] = number, begin
        elif deed.what != "is halted":
            after = f" after {_time(at - begin)}" if at > begin else ""
            writes = [f"{each.name} = {_value(each)}" for each in deed.writes if has_all or each.is_needed]
            texts[number] = f"{deed.what}{after}{' and writes ' if writes else ''}{', '.join(writes)}"
    groups = [(text, len([*equal])) for text, equal in groupby(texts)]
    *counted, last = [_counted(text, number) for text, number in groups[:-1]] + [groups[-1][0]]
    return ", then ".join([*counted, last])


def _counted(text: str, number: int) -> str:
    """A behavior of several activations."""
    what, of_writes, writes = text.partition(" and writes ")
    return f"{what}{f' {number} times' if number > 1 else ''}{of_writes}{writes}"


def _answer(deed: tuple[int, Deed]) -> str:
    return "true" if deed[1].what == "succeeds" else "false"


def _value(each: Written) -> str:
    return quote(each.value) if isinstance(each.value, str) else f"{each.value!r}"


def _time(milliseconds: int) -> str:
    return f"{milliseconds} ms"


_STATUSES: Final = {"succeeds": SUCCESS, "fails": FAILURE}
_JUDGED: Final = ("succeeds", "fails", "is skipped", "is halted", "does not end")
