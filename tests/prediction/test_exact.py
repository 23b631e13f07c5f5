"""What is folded agrees with runs, with published fractions, and says what cannot be folded and why."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from exact_trees import contradictions, drawn_settings, drawn_tree, fold_of, prepared_tree
from seeds import seeds
from test_published_numbers import FETCH, sequence, with_memory
from test_published_numbers import SKILLS as OF_FETCH

from btq_lang.prediction.declared import DeclaredSkill
from btq_lang.prediction.exact import Folded, NotExact, TreeFold, exact_success
from btq_lang.prediction.exact.times import MOST, Times, added, at, of_skill
from btq_lang.prediction.measured import MeasuredActivation, MeasuredSkill
from btq_lang.prediction.prepared import PreparedMission
from btq_lang.prediction.skill import Skill
from btq_lang.prediction.streams import Stream
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS
from btq_lang.workspace.project_simulation import Spread

TREES = 200
RUNS = 400
FIXED = """
[simulate.skills]
A = { takes = "4 s", succeeds = "90 %" }
B = { takes = "6 s", succeeds = "50 %" }
C = { takes = "1 s" }
D = { takes = "2 s", writes = { x = "1" } }
E = { takes = ["1 s", "3 s"], succeeds = "70.6 %" }
"""


def of_tree(tree: str, settings: str = FIXED) -> Folded:
    return fold_of(prepared_tree(tree, settings))


# ---- runs ----


def exact_ones() -> list[tuple[str, str, PreparedMission, Folded]]:
    trees = []
    for seed in seeds(TREES * 5 // 4):
        random = Random(seed)
        tree, settings = drawn_tree(random), drawn_settings(random)
        prepared = prepared_tree(tree, settings)
        try:
            trees.append((tree, settings, prepared, fold_of(prepared)))
        except NotExact:
            continue
    assert len(trees) >= TREES
    return trees[:TREES]


def test_drawn_trees_agree_with_runs_at_four_standard_deviations() -> None:
    for tree, settings, prepared, known in exact_ones():
        # Of so many comparisons one may be off by chance, and then agrees with more runs.
        if contradictions(prepared, known, RUNS) and (wrong := contradictions(prepared, known, 16 * RUNS)):
            pytest.fail(f"{wrong}\n{tree}\n{settings}")


# ---- probabilities ----


@pytest.mark.parametrize("attempts", range(1, 9))
def test_published_fractions_of_what_remembers(attempts: int) -> None:
    assert success_of_fetching("SequenceWithMemory", attempts) == with_memory(attempts)


def test_published_fractions_of_what_starts_again() -> None:
    assert success_of_fetching("Sequence", 1) == Fraction(294, 1000)
    assert success_of_fetching("Sequence", 5) == 1 - Fraction(706, 1000) ** 5


def success_of_fetching(kind: str, attempts: int) -> Fraction | float:
    tree = f"    Retry (num_attempts = {attempts})\n{sequence(kind, 8)}"
    robot = prepared_tree(tree, OF_FETCH, dict.fromkeys(FETCH)).loaded.robot
    success = exact_success(robot.machine.root, robot.skills)
    assert isinstance(success, Fraction)
    return success


def test_shares_are_fractions_where_durations_do_not_matter() -> None:
    assert of_tree("    Fallback\n        A\n        E\n").success == 1 - Fraction(1, 10) * Fraction(294, 1000)
    assert of_tree("    Inverter\n        A\n").success == Fraction(1, 10)
    assert of_tree("    Repeat (num_cycles = 3)\n        A\n").success == Fraction(9, 10) ** 3
    both = of_tree("    Parallel (success_count = 1, failure_count = 2)\n        A\n        B\n")
    assert both.success == 1 - Fraction(1, 10) * Fraction(1, 2)


def test_a_timeout_decides_by_the_durations() -> None:
    assert of_tree("    Timeout (msec = 4010)\n        A\n").success == Fraction(9, 10)
    assert of_tree("    Timeout (msec = 4000)\n        A\n").success == 0
    half = of_tree("    Timeout (msec = 2000)\n        E\n")
    assert half.success == pytest.approx(0.706 * 0.495, abs=1e-3)
    assert half.takes(FAILURE) is not None
    assert half.doubt == 0


def test_the_first_to_end_decides() -> None:
    first = of_tree("    Parallel (success_count = 1, failure_count = 1)\n        B\n        A\n")
    assert first.success == pytest.approx(0.9)  # A ends first
    assert first.takes() == Times((4000,), (1.0,))


# ---- durations ----


def test_durations_add_up_along_the_way() -> None:
    takes = of_tree("    Sequence\n        A\n        B\n").takes(SUCCESS, FAILURE)
    assert takes is not None
    assert (takes.points, takes.error) == ((4000, 10_000), 0)
    assert takes.masses == pytest.approx([0.1, 0.9])
    waits = of_tree("    Delay (delay_msec = 25)\n        C\n").takes()
    assert waits == Times((1025,), (1.0,))


def test_a_skill_ends_in_a_tick() -> None:
    assert of_skill(Spread("fixed", 0.004, 0.004), 10) == at(10)
    assert of_skill(Spread("fixed", 0.0, 0.0), 10) == at(0)
    assert of_skill({12: 0.5, 19: 0.25, 20: 0.25}, 10) == Times((20,), (1.0,))
    uniform = of_skill(Spread("uniform", 0.0, 0.02), 10)
    assert uniform.points == (0, 10, 20)
    assert uniform.masses == pytest.approx([0.025, 0.5, 0.475])


def test_sums_have_few_points_and_a_known_error() -> None:
    one = of_skill(Spread("lognormal", 18.0, 27.0), 10)
    total = at(0)
    for _ in range(20):
        total = added(total, one)
    assert len(total.points) <= MOST
    assert total.mean == pytest.approx(20 * one.mean, rel=1e-3)
    assert 0 < total.error < 0.05 * total.mean
    assert sum(total.masses) == pytest.approx(1)


# ---- measured skills ----


def test_a_skill_that_runs_on_never_ends_but_for_a_timeout() -> None:
    activations = [MeasuredActivation("A", "A", SUCCESS, 2.0), MeasuredActivation("A", "A", RUNNING, 5.0)]
    skill = MeasuredSkill([(each, 1) for each in activations])
    prepared = prepared_tree("    Timeout (msec = 8000)\n        A\n", FIXED)
    machine = prepared.loaded.robot.machine
    skills: dict[int, Skill] = dict.fromkeys(prepared.loaded.robot.skills, skill)
    assert TreeFold(skills).of(machine.root.child).probability(RUNNING) == pytest.approx(0.5)
    whole = TreeFold(skills).of(machine.root)
    assert not whole.is_endless
    assert whole.takes(FAILURE) == at(8000)
    assert whole.success == pytest.approx(0.5)


@pytest.mark.parametrize("takes", [None, Spread("uniform", 1.0, 4.0)])
@pytest.mark.parametrize("succeeds", [None, 0.7])
def test_outcomes_are_what_is_drawn(takes: Spread | None, succeeds: float | None) -> None:
    results = [(SUCCESS, 2.0), (FAILURE, 3.0), (SUCCESS, 3.0), (RUNNING, 2.5), (SUCCESS, 9.0), (RUNNING, 10.0)]
    measured = MeasuredSkill([(MeasuredActivation("A", "A", *each), 1) for each in results])
    skill = DeclaredSkill(takes, succeeds, base=measured)
    known = dict.fromkeys((SUCCESS, FAILURE, RUNNING), 0.0)
    for each in skill.outcomes():
        known[each.result] += float(each.probability)
    drawn = [skill.draw(Stream(1, "A", number)).result for number in range(4_000)]
    assert {result: drawn.count(result) / 4_000 for result in known} == pytest.approx(known, abs=0.03)


# ---- what cannot be folded ----


@pytest.mark.parametrize(
    ("tree", "reason"),
    [
        ("    ReactiveSequence\n        A\n", "it asks children again at each tick"),
        ("    Script (code = 'x := 1')\n", "what it does depends on entries, or entries depend on it"),
        ("    D\n", "scripts say what it writes, by entries"),
        ("    Retry (num_attempts = -1)\n        A\n", "it goes on without an end"),
        ("    Retry (num_attempts = '{n}')\n        A\n", "its num_attempts is an entry"),
        ("    RunOnce\n        A\n", "it remembers that it has run"),
        ("    KeepRunningUntilFailure\n        A\n", "it goes on without an end"),
        ("    A (_skipIf = 'true')\n", "scripts decide what it does, by entries"),
        (
            "    Timeout (msec = 5000)\n        SequenceWithMemory\n            A\n",
            "it halts a node that keeps its place",
        ),
        (
            "    Parallel (success_count = 1)\n        Timeout (msec = 5005)\n            A\n",
            "beside other nodes, only timers of whole multiples of 10 ms are exact",
        ),
        ("    Repeat (num_cycles = 3000)\n        A\n", "there are too many ways to come to it"),
    ],
)
def test_what_cannot_be_folded(tree: str, reason: str) -> None:
    prepared = prepared_tree(tree, FIXED)
    with pytest.raises(NotExact) as raised:
        fold_of(prepared)
    assert raised.value.reason == reason
    assert raised.value.node.path in str(raised.value)


def test_runs_tick_as_the_fold_supposes() -> None:
    prepared = prepared_tree(
        "    Sequence\n        A\n        E\n",
        FIXED.replace('"4 s"', '"0.012 s"').replace('"1 s", "3 s"', '"0.011 s", "0.019 s"'),
    )
    folded = fold_of(prepared)
    assert {prepared.loaded.run(1, number).now for number in range(100)} == {20, 40}
    assert {each.takes.points for each in folded.outcomes if each.takes is not None} == {(40,), (20, 40)}
