"""What a comparison finds, and what it does not: drawn campaigns, SciPy's permutation test, the logs of a robot."""

from __future__ import annotations

import random
import shutil
from math import sqrt
from pathlib import Path

import pytest
from drawn_campaigns import LEAVES, Activation, Tree, keep
from in_process import run_btq
from seeds import seeds

from btq_lang.evidence.compare.comparison import compare
from btq_lang.evidence.compare.lines import certain
from btq_lang.evidence.compare.model import RunComparison
from btq_lang.evidence.store import engine

RUNS = 45

# scipy.stats.permutation_test of SciPy 1.17.1 with NumPy 2.4.6: 99 999 resamples with the seed of the case, of the mean
# rank of each run's activations, and the difference of the sums of both sides without its sign.
SCIPY = (
    0.25653,
    0.50632,
    0.891197,
    0.85414,
    0.55016,
    0.00036,
    0.00087,
    0.01155,
    3e-05,
    0.81665,
    0.31525,
    1e-05,
    0.00475,
    0.00607,
    0.00289,
    0.896015,
    0.0216,
    1e-05,
    0.03978,
    0.6192,
)


def compared(store: Path, before: list[list[Activation]], after: list[list[Activation]]) -> RunComparison:
    """Two sides, each of one log."""
    keep(store, "a", before)
    keep(store, "b", after)
    (found,) = compare(engine.asked(str(store)), "label", ("a", "b"))
    return found


def campaign(store: Path, seed: int, factor: float) -> tuple[str, list[tuple[str, str]]]:
    """The name of a leaf that takes longer by a factor on the second side, and what is found."""
    chance = random.Random(seed)
    tree = Tree(chance)
    leaf = seed % LEAVES
    before = [tree.run(chance) for _ in range(RUNS)]
    after = [tree.run(chance, leaf, factor) for _ in range(RUNS)]
    return f"Leaf{leaf}", [(line.finding, line.name) for line in certain(compared(store, before, after))]


def number_found(folder: Path, number: int) -> int:
    """In how many campaigns the node that takes 1.2 times as long is found."""
    found = 0
    for seed in seeds(number):
        name, lines = campaign(folder / str(seed), seed, 1.2)
        found += ("slower", name) in lines
        shutil.rmtree(folder / str(seed))
    return found


def number_wrong(folder: Path, number: int) -> int:
    """In how many campaigns of one version something is found."""
    found = 0
    for seed in seeds(number):
        found += bool(campaign(folder / str(seed), seed, 1.0)[1])
        shutil.rmtree(folder / str(seed))
    return found


def test_one_slower_node_of_75(tmp_path: Path) -> None:
    assert number_found(tmp_path, 6) >= 4


@pytest.mark.scheduled
def test_one_slower_node_of_75_in_90_of_100_campaigns(tmp_path: Path) -> None:
    assert number_found(tmp_path, 100) >= 90


def test_a_version_with_itself(tmp_path: Path) -> None:
    assert number_wrong(tmp_path, 6) <= 2


@pytest.mark.scheduled
def test_a_version_with_itself_in_70_of_1000_campaigns(tmp_path: Path) -> None:
    assert number_wrong(tmp_path, 1000) <= 70


def drawn_case(seed: int) -> tuple[list[list[float]], list[list[float]]]:
    """The seconds of the activations in each run of both sides: of 5 to 40 runs, up to 25 % slower on the second."""
    chance = random.Random(seed)
    first, second = chance.randint(5, 40), chance.randint(5, 40)
    factor = 1 + chance.uniform(0, 0.25)
    sides = [
        [
            [chance.choice((1.0, 1.5)) * chance.gauss(1, 0.1) * scale for _ in range(chance.randint(1, 3))]
            for _ in range(runs)
        ]
        for runs, scale in ((first, 1.0), (second, factor))
    ]
    return sides[0], sides[1]


def as_activations(run: list[float]) -> list[Activation]:
    """A run of one leaf."""
    found: list[Activation] = []
    now = 0
    for seconds in run:
        found.append(Activation(2, "Leaf", True, now, now + round(seconds * 1e6), "succeeded"))
        now = found[-1].end + 1_000_000
    return [*found, Activation(1, "Root", False, 0, now, "succeeded")]


@pytest.mark.parametrize(("seed", "expected"), [*enumerate(SCIPY)])
def test_the_test_is_scipys(seed: int, expected: float, tmp_path: Path) -> None:
    before, after = drawn_case(seed)
    found = compared(tmp_path, [*map(as_activations, before)], [*map(as_activations, after)])
    (leaf,) = (each for each in found.changes if each.node == "Leaf" and each.what == "mean")
    drawn = min(10_000, 500 / expected)  # 500 shuffles that differ as much are enough
    error = sqrt(expected * (1 - expected) * (1 / drawn + 1 / 100_000))
    assert leaf.p_alone == pytest.approx(expected, abs=4 * error)


@pytest.fixture
def lift(shared: Path, tmp_path: Path) -> Path:
    """A folder with the logs of a robot: in v3 its LiftUp takes 1.4 times as long as in v2, and nothing else does."""
    robot = shared / "field" / "verdicts" / "robot"
    if not robot.is_dir():
        pytest.skip("the shared inputs have no field/verdicts")
    shutil.copytree(robot / "cmp_lift40", tmp_path / "cmp_lift40")
    shutil.copy(robot / "fetch.btq", tmp_path)
    return tmp_path


LIFT = [
    "  slower  LiftUp  mean 96.4 ms → 135 ms (+38.5 ms, +40 %; 95 % interval +24.3 ms to +52.8 ms) over 41 and 41 runs,"
    " p = 0.001",
    "                  and 3 nodes above it: LiftRetry; LiftLimit; ForceSuccess (3 of 5), and in requirements q08; q19",
    "",
    "what differs most where chance may explain it:",
    "  newly violated  q08 Lift alive                                 was satisfied; violated in 13 of 41 → 20 of 41,"
    " p = 1",
    "                                                                 includes what changed at LiftUp, so more runs may"
    " show it",
    "  newly violated  q16 mission                                    was satisfied; violated in 0 of 45 → 1 of 45,"
    " p = 1",
    "                  q19: every Lift takes at most 90 ms at LiftUp  violated in 27 of 41 runs → 36 of 41, p = 1,"
    " alone 0.035",
    "",
    "1 of 103 comparisons differ by more than chance explains",
]


def test_a_node_of_a_robot_that_takes_longer(lift: Path) -> None:
    kept = ("--mission", "fetch.btq", "--store", "S", "--label-by", "folder", "-o", "verdicts.json")
    assert run_btq("verify", "cmp_lift40", *kept, cwd=lift)[0] == 1
    code, output, errors = run_btq("compare", "S", "v2", "v3", cwd=lift)
    assert (code, errors, output.splitlines()[2:12]) == (1, "", LIFT)
    assert run_btq("compare", "S", "v1", "v2", cwd=lift)[0] == 0


def test_two_folders_of_logs_without_a_store(lift: Path) -> None:
    code, output, errors = run_btq("compare", "cmp_lift40/v2", "cmp_lift40/v3/", cwd=lift)
    assert (code, errors, output.splitlines()[2:12]) == (1, "", LIFT)
    assert output.startswith(
        "fetch: 45 runs of cmp_lift40/v2 (2026-11-28 18:31–18:32 UTC), 45 runs of cmp_lift40/v3/ ("
    )
    (lift / "fetch.btq").unlink()
    code, output, _ = run_btq("compare", "cmp_lift40/v2", "cmp_lift40/v3", cwd=lift)
    assert (code, output.splitlines()[2]) == (1, LIFT[0].replace("p = 0.001", "p = 0.00083"))
    assert sorted(path.name for path in lift.iterdir()) == ["cmp_lift40"]
