"""The scenarios of files, run one by one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final, TypeAlias

from btq_lang.catalog.name_kinds import Kind
from btq_lang.checks import check
from btq_lang.diagnostics.rules import Severity
from btq_lang.requirements.verifying import scenario_fingerprint
from btq_lang.scenarios.drawing import drawing
from btq_lang.scenarios.judging import judged
from btq_lang.scenarios.mission import NotRunnable, ScenarioMission, as_program, line_of, main_tree, with_named_tree
from btq_lang.scenarios.mutating import Mutant
from btq_lang.scenarios.plan import Plan
from btq_lang.scenarios.reading import ScenarioMistake, ScenarioMistakes, plan_of
from btq_lang.scenarios.results import ExpectationResult, Outcome, ScenarioResult
from btq_lang.scenarios.running import ScenarioRun, run
from btq_lang.scenarios.tape import Tape
from btq_lang.syntax.tree import Entry, Given, Scenario
from btq_lang.util.record import Record
from btq_lang.workspace.workspace import Workspace

if TYPE_CHECKING:
    from btq_lang.scenarios.installed_engine import InstalledEngine

_Head: TypeAlias = tuple[str, str, int, str, tuple[str, ...], str]  # of a result
# What a result begins with, the tree that a scenario runs, and what it says; its result if it cannot run.
_Prepared: TypeAlias = "ScenarioResult | tuple[_Head, ScenarioMission, Plan]"


class ScenarioPlace(Record):
    """A scenario by its place: the file, and its number among the scenarios there, from 0."""

    path: str
    number: int


class Suite:
    """The scenarios of a workspace; what several of them need is made once."""

    def __init__(self, workspace: Workspace, is_enforced: bool = True, engine: InstalledEngine | None = None) -> None:
        """Run nothing yet.

        Args:
            is_enforced: with the guards that enforce requirements.
            engine: in which scenarios run, too, and by whose runs they are judged; mutants run in the model alone.
        """
        self.workspace: Final = workspace
        self._engine: Final = engine
        self._is_enforced: Final = is_enforced
        self._named: Final[dict[str, Workspace]] = {}
        self._programs: Final[dict[tuple[str, str], _Program]] = {}
        self._missions: Final[dict[tuple[str, str], ScenarioMission]] = {}
        self._prepared: Final[dict[ScenarioPlace, _Prepared]] = {}

    def __reduce__(self) -> tuple[object, ...]:
        """How a process that does not share memory with this one makes it again: missions know nodes by identity."""
        return Suite, (self.workspace, self._is_enforced, self._engine)

    def places(self, path: str) -> Iterator[tuple[ScenarioPlace, str]]:
        """The scenarios of a file, each with its title."""
        for number, entry in enumerate(self._entries(path)):
            assert isinstance(entry.item, Scenario), "only these are listed"
            yield ScenarioPlace(path, number), _title(entry.item)

    def result(self, place: ScenarioPlace, is_drawn: bool) -> ScenarioResult:
        """Run a scenario; `is_drawn`: its run is drawn, also if all is as expected."""
        return self.ran(place, is_drawn).result

    def ran(self, place: ScenarioPlace, is_drawn: bool, mutant: Mutant | None = None) -> Ran:
        """Run a scenario.

        Args:
            is_drawn: its run is drawn, also if all is as expected.
            mutant: what is changed in the tree before.
        """
        planned = self.planned(place)
        if isinstance(planned, ScenarioResult):
            return Ran(planned, None, None)
        head, mission, plan = planned
        ran, outcome, why = self._run(mission, plan, mutant)
        expectations = judged(mission, plan, ran) if outcome == "passed" else ()
        outcome = _worst(expectations) if outcome == "passed" else outcome
        drawn = drawing(mission, ran) if (is_drawn or outcome != "passed") and mutant is None and ran.rows else ()
        ended = ran.end if ran.end not in ("unanswered", "unknown") else ""
        result = ScenarioResult(
            *head, outcome, ended, ran.now / 1000, why, expectations, ran.assumed, drawn, ran.unused
        )
        return Ran(result, mission, ran)

    def _run(self, mission: ScenarioMission, plan: Plan, mutant: Mutant | None) -> tuple[ScenarioRun, Outcome, str]:
        """A run, and what its end alone says."""
        if self._engine is None or mutant is not None:
            ran = run(mission, plan, mutant)
            return ran, *_of_end(ran)
        from btq_lang.scenarios.replay import NotRun, difference  # it starts processes, which others do without

        tape = Tape()
        ran = run(mission, plan, tape=tape)
        outcome, why = _of_end(ran)
        if outcome in ("error", "unknown"):
            return ran, outcome, why
        try:
            other = difference(self._engine, mission, plan, tape, ran)
        except NotRun as reason:
            return ran, "unknown", f"not run in the engine: {reason}"
        return (ran, "failed", f"the engine does not do what the model does: {other}") if other else (ran, outcome, why)

    def planned(self, place: ScenarioPlace) -> _Prepared:
        """A scenario, ready to be run; its result if it cannot run."""
        if place not in self._prepared:
            self._prepared[place] = self._prepare(place)
        return self._prepared[place]

    def mission(self, place: ScenarioPlace) -> ScenarioMission | None:
        """The tree that a scenario runs; None if it cannot be run."""
        planned = self.planned(place)
        return None if isinstance(planned, ScenarioResult) else planned[1]

    def _prepare(self, place: ScenarioPlace) -> _Prepared:
        entry = self._entries(place.path)[place.number]
        scenario = entry.item
        assert isinstance(scenario, Scenario), "only these are listed"
        file, line = line_of(self.workspace, place.path, scenario, scenario.start)
        tree = scenario.tree.text if scenario.tree is not None else self._main(place.path)
        verifies = tuple(word.text for word in scenario.verifies)
        head = _title(scenario), file, line, tree, verifies, scenario_fingerprint(self.workspace, place.path, scenario)
        if not tree:
            return _wrong(head, [self._without_tree(place.path, line)])
        if scenario.tree is not None and self.workspace.scope(place.path).find(Kind.TREE, tree) is None:
            return _wrong(head, [ScenarioMistake(line, f"unknown tree `{tree}`")])
        common = [each for each in self.workspace.files[place.path].parsed.entries if isinstance(each.item, Given)]
        program = self._program(place.path, tree)
        if program.refused:  # which may be why its nodes are unknown
            return _refused(head, program.refused)
        items = {id(each.item) for each in (*common, entry)}
        if mistakes := [mistake for item, mistake in program.mistakes if item in items]:
            return _wrong(head, mistakes)
        try:
            mission = self._mission(program, place.path, tree)
            plan = plan_of(mission, scenario, [each.item for each in common if isinstance(each.item, Given)])
        except NotRunnable as error:
            return _refused(head, str(error))
        except ScenarioMistakes as wrong:
            return _wrong(head, wrong.mistakes)
        return head, mission, plan

    def _entries(self, path: str) -> list[Entry]:
        return [entry for entry in self.workspace.files[path].parsed.entries if isinstance(entry.item, Scenario)]

    def _main(self, path: str) -> str:
        """The tree that scenarios of a file run if they name none."""
        if path not in self._named:
            self._named[path] = with_named_tree(self.workspace, path)
        return main_tree(self._named[path], path)

    def _without_tree(self, path: str, line: int) -> ScenarioMistake:
        """Why it is unknown which tree runs: an error in the file, or nothing names it."""
        scenarios = [(entry.start, entry.start + entry.item.end) for entry in self._entries(path)]
        errors = (each for each in check(self.workspace, path) if each.effective_severity is Severity.ERROR)
        others = (each for each in errors if not any(start <= each.span.start <= end for start, end in scenarios))
        if (error := next(others, None)) is not None:
            line_of_error = self.workspace.files[path].source.count("\n", 0, error.span.start) + 1
            return ScenarioMistake(line_of_error, error.message)
        return ScenarioMistake(line, 'it is unknown which tree runs; name it: `scenario "…" of Tree`')

    def _program(self, path: str, tree: str) -> _Program:
        if (path, tree) not in self._programs:
            program = as_program(self._named.get(path, self.workspace), path, tree)
            self._programs[path, tree] = _checked(program)
        return self._programs[path, tree]

    def _mission(self, program: _Program, path: str, tree: str) -> ScenarioMission:
        """The tree with all that its program registers."""
        if (path, tree) not in self._missions:
            self._missions[path, tree] = ScenarioMission(program.workspace, path, tree, self._is_enforced)
        return self._missions[path, tree]


class Ran(Record):
    """A scenario that has run; mission, run: None if it could not be run."""

    result: ScenarioResult
    mission: ScenarioMission | None
    run: ScenarioRun | None


class _Program(Record):
    """A program that registers files.

    Attributes:
        refused: the first error in these files, with its place; empty if there is none.
        mistakes: those in scenarios and in what is given for all of a file, each with the identity of its item.
    """

    workspace: Workspace
    refused: str
    mistakes: tuple[tuple[int, ScenarioMistake], ...]


def _checked(workspace: Workspace) -> _Program:
    refused = ""
    mistakes: list[tuple[int, ScenarioMistake]] = []
    for path in workspace.registered:
        file = workspace.files[path]
        own = [entry for entry in file.parsed.entries if isinstance(entry.item, Given | Scenario)]
        for diagnostic in check(workspace, path):
            if diagnostic.effective_severity is not Severity.ERROR:
                continue
            at = diagnostic.span.start
            line = file.source.count("\n", 0, at) + 1
            item = next((entry.item for entry in own if entry.start <= at <= entry.start + entry.item.end), None)
            if item is not None:
                mistakes.append((id(item), ScenarioMistake(line, diagnostic.message)))
            else:
                refused = refused or f"{workspace.project.shown(path)}:{line}: {diagnostic.message}"
    return _Program(workspace, refused, tuple(mistakes))


def _title(scenario: Scenario) -> str:
    return scenario.title.text if scenario.title is not None else ""


def _refused(head: _Head, why: str) -> ScenarioResult:
    """A scenario whose tree the engine refuses."""
    return ScenarioResult(*head, "failed", "is refused", 0.0, why, (), (), ())


def _wrong(head: _Head, mistakes: Sequence[ScenarioMistake]) -> ScenarioResult:
    """A scenario with mistakes."""
    by_line = sorted(mistakes, key=lambda mistake: mistake.line)
    why = "\n".join(f"line {mistake.line}: {mistake.message}" for mistake in by_line)
    return ScenarioResult(*head, "error", "", 0.0, why, (), (), ())


def _of_end(ran: ScenarioRun) -> tuple[Outcome, str]:
    """What the end of a run alone says: `passed` if that is nothing."""
    if ran.end == "unanswered":
        return "error", f"{ran.why} was asked at {ran.now / 1000:g} s; say what it answers"
    if ran.end == "unknown":
        return "unknown", ran.why
    if ran.end == "is refused":
        return "failed", f"the engine refuses the tree: {ran.why}"
    if ran.end == "throws":
        return "failed", f"the engine throws an exception after {ran.now / 1000:g} s: {ran.why}"
    return "passed", ""


def _worst(expectations: tuple[ExpectationResult, ...]) -> Outcome:
    outcomes = {expectation.outcome for expectation in expectations}
    return "failed" if "failed" in outcomes else "unknown" if "unknown" in outcomes else "passed"
