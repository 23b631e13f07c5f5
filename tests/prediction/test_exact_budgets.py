"""Budgets and the fold never contradict each other: of skills that meet their bounds, budgets say what may be, and the
fold how likely that is.
"""

from __future__ import annotations

from random import Random

from exact_trees import SKILLS, drawn_tree, fold_of, prepared_tree
from seeds import seeds

from btq_lang.prediction.exact import Folded, NotExact
from btq_lang.prediction.prepared import PreparedMission
from btq_lang.requirements.budget_parts import Budget
from btq_lang.requirements.budgets import Budgets
from btq_lang.requirements.durations import Range
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS

MISSIONS = 300
ROUNDING = 1e-9


def drawn_skills(random: Random) -> tuple[str, str]:
    """Bounds of skills, and skills that meet them."""
    bounds, skills = [], []
    for name in SKILLS:
        low = random.randint(0, 20) / 4
        high = low + random.randint(1, 20) / 4
        takes = random.choice((f'["{low} s", "{high} s"]', f'"{random.choice((low, high))} s"'))
        share = random.choice((0.3, 0.9, 0.99))
        skills.append(f'{name} = {{ takes = {takes}, succeeds = "{share * 100:g} %" }}')
        bounds.append(f'QualityReq of{name} "t"\n    every {name} takes between {low} s and {high} s')
        bounds[-1] += f"\n    every {name} succeeds within {high} s in at least {share * 100:g} % of activations"
    return "\n".join(bounds) + "\n", "[simulate.skills]\n" + "\n".join(skills) + "\n"


def assert_agree(prepared: PreparedMission, folded: Folded, context: str) -> tuple[bool, bool, bool]:
    """Whether the budget excludes a success, excludes a failure, and says how likely a success is."""
    mission = prepared.mission
    budgets = Budgets(mission.workspace.store, mission.path)
    root = mission.requirements.nodes.find(("Main",))[0].node
    budget: Budget = budgets.of(root)
    for result, allowed in ((SUCCESS, budget.success), (FAILURE, budget.failure)):
        if allowed is None:
            assert float(folded.probability(result)) <= folded.doubt + ROUNDING, context
        else:
            assert_within(folded, result, allowed, context)
    assert not folded.probability(RUNNING), context
    if budget.success is None and budget.skip is None:
        assert float(folded.probability(FAILURE)) >= 1 - folded.doubt - ROUNDING, context
    success = budgets.success(root)
    if success is not None:
        takes = folded.takes(SUCCESS)
        within = takes.below(round(success.seconds * 1000) + takes.error + 1) if takes is not None else 0
        assert float(folded.success) * within >= success.probability - folded.doubt - ROUNDING, context
    return budget.success is None, budget.failure is None, success is not None


def assert_within(folded: Folded, result: int, allowed: Range, context: str) -> None:
    """All durations are allowed: with probability 1."""
    takes = folded.takes(result)
    if takes is not None:
        assert allowed.low * 1000 - takes.error <= takes.points[0] + ROUNDING, context
        assert takes.points[-1] <= allowed.high * 1000 + takes.error + ROUNDING, context


def test_budgets_and_the_fold_never_contradict_each_other() -> None:
    seen = [0, 0, 0, 0]
    for seed in seeds(MISSIONS):
        random = Random(seed)
        tree = drawn_tree(random)
        bounds, skills = drawn_skills(random)
        prepared = prepared_tree(tree, skills, more=bounds)
        try:
            folded = fold_of(prepared)
        except NotExact:
            continue
        for number, is_so in enumerate((True, *assert_agree(prepared, folded, f"{tree}\n{bounds}{skills}"))):
            seen[number] += is_so
    assert seen[0] > MISSIONS * 0.9
    assert min(seen) > 5, seen
