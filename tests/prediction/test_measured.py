"""What measured activations say of later ones: exact on small cases, unbiased where halts hide how long they took."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random
from statistics import mean, stdev

import pytest
from seeds import SEED

from btq_lang.prediction.measured import MeasuredActivation, MeasuredSkill, MeasuredSkills
from btq_lang.prediction.skill import DrawnActivation
from btq_lang.prediction.streams import Stream
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS

RESULTS = {"S": SUCCESS, "F": FAILURE, "H": RUNNING}


def activation(result: str, seconds: float, node: str = "Pick", kind: str = "Pick") -> MeasuredActivation:
    return MeasuredActivation(node, kind, RESULTS[result], seconds)


def skill(text: str) -> MeasuredSkill:
    """The skill that activations such as `3S 4H` show."""
    return MeasuredSkill([(activation(word[-1], float(word[:-1])), 1) for word in text.split()])


def drawn(one: MeasuredSkill, number: int = 4_000) -> list[DrawnActivation]:
    return [one.draw(Stream(1, "x", run).activation(0)) for run in range(number)]


def within_4_sigma(count: float, trials: int, p: float) -> bool:
    return abs(count - trials * p) <= 4 * math.sqrt(trials * p * (1 - p))


@pytest.mark.parametrize(
    ("activations", "succeeds", "fails", "runs_on"),
    [
        ("3S 4S 5F", Fraction(2, 3), Fraction(1, 3), 0),
        # A quarter at 3 s; after the halt at 4 s each of the other two has half of the rest.
        ("3S 4H 5F 6S", Fraction(1, 4) + Fraction(3, 8), Fraction(3, 8), 0),
        # The freed share of a halted one goes to all that are longer.
        ("1F 2H 3H 4S", Fraction(3, 4), Fraction(1, 4), 0),
        # What ends when another one is halted ended before: 1/3 at 3 s, and all that is left at 5 s.
        ("3S 3H 5F", Fraction(1, 3), Fraction(2, 3), 0),
        # The longest one was halted: 2/3 · 1/2 runs on.
        ("3S 5F 7H", Fraction(1, 3), Fraction(1, 3), Fraction(1, 3)),
        ("3S 3H", Fraction(1, 2), 0, Fraction(1, 2)),
        ("3S 3F 3S 9H", Fraction(1, 2), Fraction(1, 4), Fraction(1, 4)),
        ("2H 9H", 0, 0, 1),
    ],
)
def test_shares_by_hand(activations: str, succeeds: Fraction, fails: Fraction, runs_on: Fraction) -> None:
    one = skill(activations)
    shares = [one.probability(result) for result in (SUCCESS, FAILURE, RUNNING)]
    assert shares == pytest.approx([float(succeeds), float(fails), float(runs_on)], abs=1e-12)
    results = [each.result for each in drawn(one)]
    for result, share in zip((SUCCESS, FAILURE, RUNNING), shares, strict=True):
        assert within_4_sigma(results.count(result), len(results), share)


def test_an_activation_is_drawn_whole() -> None:
    assert {(each.result, each.takes) for each in drawn(skill("3S 4H 5F 6S 6F"))} == {
        (SUCCESS, 3_000),
        (FAILURE, 5_000),
        (SUCCESS, 6_000),
        (FAILURE, 6_000),
    }


def test_beyond_the_longest_that_ended_it_is_a_guess() -> None:
    one = skill("3S 5H 9H")
    assert (one.number, one.ended, one.longest) == (3, 1, 9_000)
    assert {*drawn(one)} == {DrawnActivation(SUCCESS, 3_000), DrawnActivation(RUNNING, 9_000, None, True)}


def measured(random: Random, number: int) -> MeasuredSkill:
    """Activations of which four of five succeed, after 1 s on average, and the others fail, after 5 s, as far as nobody
    halts them: half a second after the start, on average."""
    activations = []
    for _ in range(number):
        result, rate = ("S", 1.0) if random.random() < 0.8 else ("F", 0.2)
        seconds, halt = random.expovariate(rate), random.expovariate(HALTS)
        activations.append((activation("H", halt) if halt < seconds else activation(result, seconds), 1))
    return MeasuredSkill(activations)


HALTS = 1.0  # a second


def test_halts_bias_neither_results_nor_durations() -> None:
    random = Random(f"{SEED} halts")
    skills = [measured(random, 400) for _ in range(300)]
    for within in (0.3, 1.0, 2.0):
        truth = {SUCCESS: 0.8 * (1 - math.exp(-within)), FAILURE: 0.2 * (1 - math.exp(-within / 5))}
        for result, expected in truth.items():
            estimates = [one.probability(result, within) for one in skills]
            assert abs(mean(estimates) - expected) < 4 * stdev(estimates) / math.sqrt(len(estimates))


def test_without_the_halted_ones_success_is_overestimated() -> None:
    """Of those that end, 92 % succeed: failures take longer, and so are halted more often."""
    random = Random(f"{SEED} left out")
    left_out, kept = [], []
    for _ in range(100):
        one = measured(random, 400)
        ended = [each.result for each in one._drawn if each.result != RUNNING]
        left_out.append(ended.count(SUCCESS) / len(ended))
        kept.append(one.probability(SUCCESS))
    assert 0.90 < mean(left_out) < 0.94
    assert 0.76 < mean(kept) < 0.82


def test_the_share_is_that_of_each_activation() -> None:
    """Against the product over times, written as in the books."""
    random = Random(f"{SEED} books")
    activations = [activation(random.choice("SFH"), random.randrange(1, 6)) for _ in range(40)]
    one = MeasuredSkill([(each, 1) for each in activations])
    for within in range(1, 6):
        longer = 1.0
        for time in range(1, within + 1):
            at_risk = sum(each.seconds >= time for each in activations)
            ends = sum(each.seconds == time and each.result != RUNNING for each in activations)
            longer *= 1 - ends / at_risk
        ended = one.probability(SUCCESS, within) + one.probability(FAILURE, within)
        assert ended == pytest.approx(1 - longer, abs=1e-12)


NODES = {1: ("Main/Pick", "Pick"), 2: ("Main/Second", "Pick"), 3: ("Main/Never", "Never"), 4: ("Main/New", "Pick")}


def test_a_node_has_its_own_activations_from_30_on() -> None:
    often = [[activation("S", 1.0, "Main/Pick")] for _ in range(30)]
    seldom = [[activation("F", 2.0, "Main/Second")] for _ in range(29)]
    skills = MeasuredSkills([*often, *seldom]).of_nodes(NODES)
    assert {uid: (one.by, one.number) for uid, one in skills.items()} == {
        1: ("path", 30),
        2: ("kind", 59),
        4: ("kind", 59),
    }
    assert skills[2] is skills[4]
    assert skills[1].probability(SUCCESS) == pytest.approx(1)
    assert skills[2].probability(FAILURE) == pytest.approx(29 / 59)


def test_whole_runs_are_drawn_again() -> None:
    """In half of the runs all of ten activations fail, in half none: the share of failures is as uncertain as that of a
    coin that is tossed once a run."""
    runs = [[activation("F" if run % 2 else "S", 1.0, "Main/Pick")] * 10 for run in range(40)]
    skills = MeasuredSkills(runs)
    shares = [
        skills.resampled(NODES, Stream(SEED, "x", number).activation(0))[1].probability(FAILURE)
        for number in range(1_000)
    ]
    sigma = math.sqrt(0.25 / 40)
    assert abs(mean(shares) - 0.5) < 4 * sigma / math.sqrt(1_000)
    assert stdev(shares) == pytest.approx(sigma, rel=0.1)  # 4 sigma of a standard deviation of 1000 are 9 %


def test_a_skill_of_one_run_stays_measured() -> None:
    runs = [[activation("S", 1.0)]] + [[activation("S", 1.0, "Other", "Other")]] * 9
    for number in range(50):
        skills = MeasuredSkills(runs).resampled({1: ("Pick", "Pick")}, Stream(SEED, "x", number).activation(0))
        assert skills[1].draw(Stream(1, "x", 0)) == DrawnActivation(SUCCESS, 1_000)


def test_drawing_runs_again_gives_the_uncertainty_that_there_is() -> None:
    """The spread of the estimates over many logs is that which one log says, halts included."""
    random = Random(f"{SEED} spread")

    def log() -> MeasuredSkills:
        runs = []
        for _ in range(100):
            seconds, halt = random.expovariate(1.0), random.expovariate(HALTS)
            result = "H" if halt < seconds else "S"
            runs.append([activation(result, min(seconds, halt))])
        return MeasuredSkills(runs)

    nodes = {1: ("Pick", "Pick")}
    of_logs = [log().of_nodes(nodes)[1].probability(SUCCESS, 1.0) for _ in range(400)]
    spreads = []
    for _ in range(20):
        one = log()
        again = [one.resampled(nodes, Stream(SEED, "x", number).activation(0)) for number in range(100)]
        spreads.append(stdev(each[1].probability(SUCCESS, 1.0) for each in again))
    assert mean(spreads) == pytest.approx(stdev(of_logs), rel=0.15)
