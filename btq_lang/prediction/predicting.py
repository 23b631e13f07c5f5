"""A prediction: blocks of runs, made and judged in one process or in several, and added up in their order.

One invariant: a block has the same runs whatever the number of processes and of blocks, and every look at the results
is at a number of runs that was fixed before.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from signal import SIG_IGN, SIGINT, signal
from typing import Final

from btq_lang.evidence.evaluate import MissionEvaluation
from btq_lang.evidence.odds import Limits, lower_limit, upper_limit
from btq_lang.evidence.verdicts import VIOLATED, RequirementVerdict
from btq_lang.prediction.causes import with_causes
from btq_lang.prediction.changed import ChangedSkill, SkillChange
from btq_lang.prediction.declared import DeclaredWorld, declared_world
from btq_lang.prediction.judging import Judge, JudgedBlock
from btq_lang.prediction.measured import MeasuredSkills
from btq_lang.prediction.measuring import actions_of
from btq_lang.prediction.prepared import PreparedMission, prepared
from btq_lang.prediction.report import WORST_FIRST, Ended, PredictedRequirement, Prediction, Word
from btq_lang.prediction.runs import DrawnRun
from btq_lang.prediction.skill import AssumedSkill, Skill
from btq_lang.prediction.streams import Stream
from btq_lang.prediction.words import Uncertainty, predicted_clause
from btq_lang.requirements import nodes
from btq_lang.requirements.simulation import Problem, is_condition, is_skill
from btq_lang.scenarios.mission import ScenarioMission
from btq_lang.simulator.skills import Unanswered
from btq_lang.util.processes import pool
from btq_lang.util.record import Record
from btq_lang.workspace.project_simulation import SimulationSettings
from btq_lang.workspace.workspace import Workspace


class Recipe(Record):
    """All that a prediction follows from; it refers to nothing else, so it may go to another process.

    Attributes:
        workspace: of the program that creates the tree.
        path: of the mission.
        measured: what skills did in logs; None: nothing was measured.
        changes: what is otherwise with skills.
    """

    workspace: Workspace
    path: str
    tree: str
    is_enforced: bool
    measured: MeasuredSkills | None
    seed: int
    changes: tuple[SkillChange, ...] = ()


class Unanswerable(Exception):
    """No run can be made: what some conditions answer is not given.

    Attributes:
        conditions: their paths.
    """

    def __init__(self, conditions: Sequence[str]) -> None:
        super().__init__(", ".join(conditions))
        self.conditions: Final = conditions


class Predictor:
    """Makes and judges the runs of a mission.

    Attributes:
        mission: as it is built.
        world: what is declared of it.
    """

    def __init__(self, recipe: Recipe) -> None:
        """Load the mission.

        Raises:
            NotRunnable: it cannot be built.
            EngineError: the engine refuses it.
            NotModelled: it has something whose effect is not known.
        """
        self.recipe: Final = recipe
        self.mission: Final = ScenarioMission(recipe.workspace, recipe.path, recipe.tree, recipe.is_enforced)
        self._actions: Final = actions_of(self.mission)
        own = recipe.measured.of_nodes(self._actions) if recipe.measured is not None else {}
        self.world: Final[DeclaredWorld] = self._world(own)
        self._skills: Final = self._changed({**own, **self.world.skills})
        self.prepared: Final[PreparedMission] = prepared(self.mission, self.world, self._skills)
        self._judge: Final = Judge(self.mission)

    @property
    def problems(self) -> Sequence[Problem]:
        """What is wrong with the settings of the project."""
        return self.world.problems

    @property
    def is_measured(self) -> bool:
        """Whether some skill does what was measured."""
        return any(source.source == "measured" for source in self.prepared.sources)

    def evaluation(self) -> MissionEvaluation:
        """One that has judged nothing yet."""
        return self._judge.evaluation()

    def block(self, number: int, most: int) -> JudgedBlock:
        """The runs of a block, with the skills as they were measured; `most`: the number of the last run."""
        first = number * BLOCK + 1
        return self._judge.block(self.prepared, self.recipe.seed, range(first, min(first + BLOCK, most + 1)))

    def resampled(self, number: int) -> JudgedBlock:
        """As many runs, others than those of blocks, with skills as they might have been measured as well."""
        measured = self.recipe.measured
        assert measured is not None, "something was measured"
        skills: dict[int, Skill] = {**measured.resampled(self._actions, Stream(self.recipe.seed, _RESAMPLING, number))}
        skills = self._changed({**skills, **self._world(skills).skills})
        self.prepared.loaded.robot.exchange(self._known(skills))
        try:
            first = _OTHERS + number * BLOCK
            return self._judge.block(self.prepared, self.recipe.seed, range(first, first + BLOCK))
        finally:
            self.prepared.loaded.robot.exchange(self._known(self._skills))

    def shares(self, block: JudgedBlock) -> list[tuple[int, int]]:
        """Of each clause, what holds in a block, of what was counted."""
        evaluation = self.evaluation()
        evaluation.findings.add(block.findings, 0)
        clauses = (clause for verdict in evaluation.verdicts() for clause in verdict.clauses)
        return [(clause.counted - clause.violated, clause.counted) for clause in clauses]

    @cached_property
    def full(self) -> PreparedMission:
        """The mission with all rows of its runs."""
        return prepared(self.mission, self.world, self._skills, with_all_rows=True)

    def again(self, numbers: Sequence[int]) -> Sequence[DrawnRun]:
        """Runs by their numbers, with all rows."""
        return [self.full.loaded.run(self.recipe.seed, number) for number in numbers]

    def skills(self) -> dict[str, Skill]:
        """The actions that run of which something is known, by the names under which they are registered; of several
        that do different things, the first.
        """
        running = self.prepared.loaded.robot.skills
        named = ((self.mission.written[uid].id, skill) for uid, skill in running.items() if uid in self._skills)
        skills: dict[str, Skill] = {}
        for name, skill in named:
            if name is not None:
                skills.setdefault(name.text, skill)
        return skills

    def assumes(self, change: SkillChange) -> bool:
        """Whether all that a change is about is assumed."""
        store = self.recipe.workspace.store
        targets = store.ask(nodes.find, self.recipe.path, tuple(change.path.split("/")))
        return not any(uid in self._skills for target in targets for uid in self.mission.uids(target))

    def _changed(self, skills: dict[int, Skill]) -> dict[int, Skill]:
        """Skills with the changes of the recipe."""
        store = self.recipe.workspace.store
        for change in self.recipe.changes:
            for target in store.ask(nodes.find, self.recipe.path, tuple(change.path.split("/"))):
                uids = self.mission.uids(target) if is_skill(target.node) and not is_condition(target.node) else ()
                skills |= {uid: ChangedSkill(skills.get(uid) or AssumedSkill(), change) for uid in uids}
        return skills

    def _known(self, skills: dict[int, Skill]) -> dict[int, Skill]:
        """Those of skills that are in the tree that runs."""
        return {uid: skill for uid, skill in skills.items() if uid in self.prepared.loaded.robot.skills}

    def _world(self, measured: Mapping[int, Skill]) -> DeclaredWorld:
        settings = self.recipe.workspace.project.simulation or SimulationSettings()
        return declared_world(settings, self.mission, measured)


def predicted(
    predictor: Predictor,
    runs: int,
    jobs: int = 1,
    stops_early: bool = False,
    label: str = "",
    made: Callable[[int], None] = lambda runs: None,
    judged: Callable[[bool, JudgedBlock], None] = lambda is_other, block: None,
) -> Prediction:
    """What is predicted of a mission.

    Args:
        runs: how many, at most.
        jobs: how many processes.
        stops_early: look after 200, 400, 800 … runs, and stop when each demand is decided.
        label: of the runs that were measured.
        made: called with the number of runs after each block.
        judged: called with each block, and whether its skills are others.

    A KeyboardInterrupt ends the runs after the first block, and what there is counts.

    Raises:
        Unanswerable: what some conditions answer is not given.
    """
    if predictor.prepared.unanswered:
        raise Unanswerable(predictor.prepared.unanswered)
    sum_of = _Sum(predictor)
    is_measured = predictor.is_measured and predictor.recipe.measured is not None
    work = _work(-(-runs // BLOCK), _RESAMPLES if is_measured else 0, runs)
    is_stopped = False
    looks = _looks(runs) if stops_early and not is_measured else ()
    try:
        for (is_other, _, _), block in zip(work, _blocks(predictor, work, jobs), strict=True):
            judged(is_other, block)
            if is_other:
                sum_of.add_resampled(block)
                continue
            sum_of.add(block)
            made(sum_of.runs)
            if sum_of.runs in looks and sum_of.is_decided():
                break
    except KeyboardInterrupt:
        if not sum_of.runs:
            raise
        is_stopped = True
    except Unanswered as error:
        raise Unanswerable((error.node.path,)) from None
    return sum_of.prediction(runs, label, is_stopped)


def _work(blocks: int, others: int, runs: int) -> list[tuple[bool, int, int]]:
    """What is to be made, blocks with other skills among the first ones: whether it is such a block, and its number."""
    work: list[tuple[bool, int, int]] = []
    for turn in range(max(blocks, others)):
        work += [(False, turn, runs)] if turn < blocks else []
        work += [(True, turn, runs)] if turn < others else []
    return work


def _looks(runs: int) -> Sequence[int]:
    looks = [_FIRST_LOOK]
    while looks[-1] < runs:
        looks.append(looks[-1] * 2)
    return looks


class _Sum:
    """The blocks so far, added up.

    Attributes:
        runs: how many.
    """

    def __init__(self, predictor: Predictor) -> None:
        self.runs = 0
        self._predictor: Final = predictor
        self._evaluation: Final = predictor.evaluation()
        self._numbers: Final[list[int]] = []  # of the judged runs
        self._ends: Final[Counter[str]] = Counter()
        self._why: Final[Counter[tuple[str, str]]] = Counter()
        self._guessed: Final[Counter[str]] = Counter()
        self._times: Final[list[int]] = []
        self._others: Final[list[list[tuple[int, int]]]] = []  # of each clause, by resampling

    def add(self, block: JudgedBlock) -> None:
        """Add the next block."""
        self._evaluation.findings.add(block.findings, len(self._numbers))
        self._numbers.extend(block.numbers)
        self.runs += block.runs
        self._ends.update(block.ends)
        self._why.update(block.why)
        self._guessed.update(block.guessed)
        self._times.extend(block.times)

    def add_resampled(self, block: JudgedBlock) -> None:
        """Add what came of other skills."""
        self._others.append(self._predictor.shares(block))

    def is_decided(self) -> bool:
        """Whether more runs would change no word, at every look with 95 %."""
        for verdict in self._evaluation.verdicts():
            odds = self._odds(verdict)
            for clause in verdict.clauses:
                held = clause.counted - clause.violated
                if clause.verdict == VIOLATED and odds is None:
                    continue
                if odds is None or clause.pooled is not None or not clause.counted or clause.unknown:
                    return False
                limits: Limits = "every look"
                low, high = (limit(held, clause.counted, 0.95, limits) for limit in (lower_limit, upper_limit))
                if low < odds <= high:
                    return False
        return True

    def _odds(self, verdict: RequirementVerdict) -> float | None:
        odds = self._predictor.mission.requirements.all[verdict.id].odds
        return odds.probability if odds is not None else None

    def prediction(self, wanted: int, label: str, is_stopped: bool) -> Prediction:
        """What the blocks say."""
        predictor = self._predictor
        unknown = next(
            (
                f"in {number} of {self.runs} runs: {why}"
                for (end, why), number in self._why.most_common()
                if end == "unknown"
            ),
            "",
        )
        measured = predictor.recipe.measured
        number = measured.runs if measured is not None and predictor.is_measured else 0
        requirements: list[PredictedRequirement] = []
        place = 0
        for verdict in self._evaluation.verdicts():
            clauses = []
            for clause in verdict.clauses:
                shares = [other[place] for other in self._others]
                prediction = predicted_clause(clause, self._odds(verdict), unknown, Uncertainty(number, shares))
                clauses.append((clause, prediction))
                place += 1
            with_cause = with_causes(predictor.mission, predictor.again, clauses, self._numbers)
            words: list[Word] = [each.word for each in with_cause]
            word = min(words, key=WORST_FIRST.index, default=_NO_CLAUSE)
            requirements.append(PredictedRequirement(verdict.id, verdict.title, word, tuple(with_cause)))
        reasons = {end: why for (end, why), _ in reversed(self._why.most_common())}
        ends = tuple(Ended(end, runs, reasons.get(end, "")) for end, runs in self._ends.most_common())
        times = sorted(self._times)
        return Prediction(
            predictor.recipe.path,
            predictor.mission.name,
            predictor.mission.dialect.version,
            predictor.recipe.is_enforced,
            self.runs,
            wanted,
            predictor.recipe.seed,
            predictor.prepared.sources,
            label,
            number,
            ends,
            times[(len(times) - 1) // 2] / 1000 if times else None,
            times[-(-len(times) * 95 // 100) - 1] / 1000 if times else None,
            tuple(self._guessed.most_common()),
            tuple(requirements),
            is_stopped,
        )


# ---- processes ----


def _blocks(predictor: Predictor, work: Sequence[tuple[bool, int, int]], jobs: int) -> Iterator[JudgedBlock]:
    """The blocks in their order."""
    if jobs > 1 and len(work) > 1:
        try:
            processes = pool(min(jobs, len(work)), _begin, (predictor.recipe,))
        except NotImplementedError:  # there are no processes in a browser
            pass
        else:
            with processes:
                try:
                    yield from processes.map(_block, work)
                finally:
                    processes.shutdown(cancel_futures=True)
            return
    yield from (_made(predictor, *each) for each in work)


def _begin(recipe: Recipe) -> None:
    signal(SIGINT, SIG_IGN)  # the process that adds up the blocks ends this one
    global _predictor
    _predictor = Predictor(recipe)


def _block(work: tuple[bool, int, int]) -> JudgedBlock:
    assert _predictor is not None, "every process begins with _begin"
    return _made(_predictor, *work)


def _made(predictor: Predictor, is_other: bool, number: int, most: int) -> JudgedBlock:
    return predictor.resampled(number) if is_other else predictor.block(number, most)


_predictor: Predictor | None = None
BLOCK: Final = 100  # runs
_RESAMPLES: Final = 40
_OTHERS: Final = 1 << 40  # the number of the first run with other skills
_RESAMPLING: Final = "which runs count"  # the name of a stream
_FIRST_LOOK: Final = 200
_NO_CLAUSE: Final[Word] = "unknown"
