"""Skills with a change, and the interval of a difference."""

from __future__ import annotations

from math import exp, log

import pytest

from btq_lang.prediction.changed import ChangedSkill, SkillChange
from btq_lang.prediction.comparing import interval_of
from btq_lang.prediction.declared import DeclaredSkill
from btq_lang.prediction.measured import MeasuredActivation, MeasuredSkill
from btq_lang.prediction.skill import AssumedSkill, Skill
from btq_lang.prediction.streams import Stream
from btq_lang.simulator.nodes import FAILURE, RUNNING, SUCCESS
from btq_lang.workspace.project_simulation import Spread

RUNS = 4000


def measured() -> MeasuredSkill:
    """Eight of ten succeed, after 1 s; the others fail after 5 s."""
    ends = [(SUCCESS, 1.0)] * 8 + [(FAILURE, 5.0)] * 2
    return MeasuredSkill([(MeasuredActivation("Pick", "Pick", result, seconds), 1) for result, seconds in ends])


def drawn(skill: Skill) -> list[tuple[int, int]]:
    activations = [skill.draw(Stream(1, "Pick", run).activation(0)) for run in range(RUNS)]
    return [(each.result, each.takes) for each in activations]


@pytest.mark.parametrize("share", [0.97, 0.5, 1.0, 0.0])
@pytest.mark.parametrize(
    "skill",
    [
        measured(),
        DeclaredSkill(Spread("uniform", 1, 2), 0.8),
        DeclaredSkill(Spread("fixed", 1, 1), None, base=measured()),
    ],
)
def test_a_share_turns_as_few_results_as_it_can(skill: Skill, share: float) -> None:
    changed = ChangedSkill(skill, SkillChange("Pick", succeeds=share))
    assert changed.success() == pytest.approx(share)
    before, after = drawn(skill), drawn(changed)
    number = sum(result == SUCCESS for result, _ in after)
    assert abs(number - share * RUNS) <= 4 * (share * (1 - share) * RUNS) ** 0.5
    turned = {(old[0], new[0]) for old, new in zip(before, after, strict=True) if old[0] != new[0]}
    assert turned == {(FAILURE, SUCCESS) if share > 0.8 else (SUCCESS, FAILURE)}
    assert all(old == new for old, new in zip(before, after, strict=True) if old[0] == new[0])


def test_a_success_takes_as_long_as_successes_do() -> None:
    assert set(drawn(ChangedSkill(measured(), SkillChange("Pick", succeeds=0.97)))) == {
        (SUCCESS, 1000),
        (FAILURE, 5000),
    }
    assert set(drawn(ChangedSkill(measured(), SkillChange("Pick", spares=1.0)))) == {(SUCCESS, 1000)}


def test_durations() -> None:
    half = drawn(ChangedSkill(measured(), SkillChange("Pick", factor=0.5)))
    assert half == [(result, takes // 2) for result, takes in drawn(measured())]
    even = drawn(ChangedSkill(measured(), SkillChange("Pick", is_even=True)))
    assert even == [(result, 1800) for result, _ in drawn(measured())]
    other = drawn(
        ChangedSkill(DeclaredSkill(Spread("uniform", 1, 2), 0.8), SkillChange("Pick", takes=Spread("uniform", 3, 4)))
    )
    assert other == drawn(DeclaredSkill(Spread("uniform", 3, 4), 0.8))
    lognormal = DeclaredSkill(Spread("lognormal", 18, 27), 1.0)
    mean = 18_000 * exp((log(1.5) / 1.6448536269514722) ** 2 / 2)
    assert lognormal.average() == pytest.approx(mean)
    assert sum(takes for _, takes in drawn(lognormal)) / RUNS == pytest.approx(mean, rel=0.02)


def test_one_that_was_halted_runs_on() -> None:
    halted = MeasuredActivation("Pick", "Pick", RUNNING, 9.0)
    skill = MeasuredSkill([*((MeasuredActivation("Pick", "Pick", SUCCESS, 1.0), 1) for _ in range(3)), (halted, 1)])
    assert (skill.success(), skill.average(), skill.beyond) == (1.0, 1000.0, 0.25)
    assert drawn(ChangedSkill(skill, SkillChange("Pick", factor=0.5, spares=0.5))) == [
        (result, takes if result == RUNNING else takes // 2) for result, takes in drawn(skill)
    ]
    ended = ChangedSkill(skill, SkillChange("Pick", takes=Spread("fixed", 2, 2)))
    assert set(drawn(ended)) == {(SUCCESS, 2000)}


def test_what_is_assumed_is_declared_by_the_change() -> None:
    changed = ChangedSkill(AssumedSkill(), SkillChange("Pick", takes=Spread("fixed", 2, 2), succeeds=0.0))
    assert changed.source == "declared"
    assert set(drawn(changed)) == {(FAILURE, 2000)}


def test_the_interval_of_a_difference_holds_it() -> None:
    """Of 1 000 paired samples of ten blocks 930 to 970 intervals hold the true difference, 0.1; unpaired ones would be
    three times as wide.
    """
    holding = 0
    widths: list[float] = []
    for sample in range(1000):
        blocks = []
        for block in range(10):
            numbers = [Stream(sample, "pairs", block * 100 + run).next() for run in range(100)]
            blocks.append((sum(number < 0.6 for number in numbers), sum(number < 0.7 for number in numbers)))
        low, high = interval_of(([(k, 100) for k, _ in blocks], []), ([(k, 100) for _, k in blocks], [])) or (0, 0)
        holding += low <= 0.1 <= high
        widths.append(high - low)
    assert 930 <= holding <= 970
    assert sum(widths) / 1000 < 0.05  # 0.085 by two independent samples


def test_an_interval_without_a_difference() -> None:
    same = [(90, 100)] * 10
    low, high = interval_of((same, []), (same, [])) or (0, 0)
    assert -low == high == pytest.approx(1 - 0.025**0.001)
    assert interval_of((same[:1], []), (same[:1], [])) is None


def test_skills_that_might_have_been_measured_as_well_widen_it() -> None:
    before, after = [(80, 100), (82, 100)] * 5, [(90, 100), (92, 100)] * 5
    narrow = interval_of((before, []), (after, [])) or (0, 0)
    other_before, other_after = [(80, 100)] * 3, [(85, 100), (90, 100), (95, 100)]
    wide = interval_of((before, other_before), (after, other_after)) or (0, 0)
    assert wide[1] - wide[0] > 10 * (narrow[1] - narrow[0])
