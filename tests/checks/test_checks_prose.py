"""SuccessIf and FailureIf in descriptions: what can be checked, and the clause that a sentence says."""

from __future__ import annotations

import pytest
from check_asserts import findings, fixes, problems
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.catalog.units import Dimension, parse_unit
from btq_lang.checks.wording import as_clause
from btq_lang.parser import parse
from btq_lang.syntax.tree import Requirement, quote

MET, VIOLATED = False, True


def dimension(symbol: str) -> Dimension:
    unit = parse_unit(symbol)
    assert unit is not None
    return unit.dimension


SIGNALS = {
    "battery": dimension("%"),
    "cpu_load": dimension("%"),
    "speed": dimension("m/s"),
    "energy": dimension("Wh"),
    "force": dimension("N"),
}


@pytest.mark.parametrize(
    ("violates", "sentence", "clause"),
    [
        (MET, "the moving to charging station shall take at most 30 sec", "takes at most 30 s"),
        (VIOLATED, "the charging took longer than 30 sec", "takes at most 30 s"),
        (MET, "It shall\n        take no longer than 2 minutes", "takes at most 2 min"),
        (MET, "must not take longer than 45 seconds", "takes at most 45 s"),
        (MET, "takes less than 1.5 h", "takes less than 1.5 h"),
        (VIOLATED, "it takes less than 5 s", "takes at least 5 s"),
        (MET, "Each pump shall be reached within 90 sec", "succeeds within 90 s"),
        (VIOLATED, "the room is not reached within 10 minutes", "succeeds within 10 min"),
        (MET, "grasping is tried no more than 5 times", "tries at most 5"),
        (VIOLATED, "more than 3 attempts", "tries at most 3"),
        (MET, "at least a battery capacity of 3% left", "leaves battery >= 3 %"),
        (VIOLATED, "the battery falls below 10 percent", "keeps battery >= 10 %"),
        (MET, "the cpu load stays under 80%", "keeps cpu_load < 80 %"),
        (MET, "the speed shall not exceed 0.2 m/s", "keeps speed <= 0.2 m/s"),
        (VIOLATED, "The Speed exceeds 0.2 m/s", "keeps speed <= 0.2 m/s"),
        (MET, "uses at most 50 Wh of energy", "uses at most 50 Wh of energy"),
    ],
)
def test_a_plain_sentence_has_a_clause(violates: bool, sentence: str, clause: str) -> None:
    assert as_clause(sentence, violates=violates, signals=SIGNALS) == clause


QUALIFIERS = (
    "and or but if when whenever while unless except until after before since during per every between average"
    " averaged mean median percentile probability probably usually often"
)


@pytest.mark.parametrize("word", QUALIFIERS.split())
def test_a_sentence_with_a_word_that_may_change_its_bound_has_none(word: str) -> None:
    assert as_clause(f"takes at most 30 s {word} charging", violates=MET, signals=SIGNALS) is None


@pytest.mark.parametrize(
    ("violates", "sentence"),
    [
        (MET, "it is done quickly"),
        (MET, "it takes 30 s"),
        (MET, "it takes at most 30"),
        (MET, "it takes at most 30 apples"),
        (MET, "waits at least 5 s"),
        (MET, "at least 3 times"),
        (MET, "no more than 2.5 times"),
        (VIOLATED, "somebody comes within 2 s"),
        (MET, "it does not start within 2 s"),
        (MET, "takes at most 30 s and uses little"),
        (MET, "takes at most 30 s if nobody is near"),
        (MET, "takes at most 30 s on average"),
        (MET, "takes at most 30 s in 95 % of the runs"),
        (MET, "less than 3 falls per hour"),
        (MET, "moves less than 2 m"),
        (MET, "less than 0.2 m/s"),
        (MET, "the reading shall be off by at most 2 percent"),
        (MET, "the battery, or the cpu load, stays below 10 %"),
    ],
)
def test_a_sentence_that_is_not_plain_has_none(violates: bool, sentence: str) -> None:
    assert as_clause(sentence, violates=violates, signals=SIGNALS) is None


words = st.sampled_from(
    (
        *("at", "most", "least", "less", "than", "more", "longer", "within", "no", "not", "never", "exceed"),
        *("30", "5.5", "s", "m/s", "%", "times", "battery", "takes", "left"),
    )
)


@given(st.lists(words), st.booleans())
def test_what_is_proposed_is_a_clause(sentence: list[str], violates: bool) -> None:
    clause = as_clause(" ".join(sentence), violates=violates, signals=SIGNALS)
    parsed = parse(f"QualityReq r {clause or 'takes at most 1 s'}\n")
    assert parsed.diagnostics == ()
    requirement = parsed.entries[0].item
    assert isinstance(requirement, Requirement)
    assert len(requirement.clauses) == 1


def requirement(text: str, before: str = "") -> str:
    return f"{before}QualityReq rq1 {quote(text)}\n"


@pytest.mark.parametrize(
    "text",
    [
        "The robot should have at least a battery capacity of 3% left.",
        "What counts as success if all goes well",
        "SuccessIf battery > 20",
        "SuccessIf arrived",
        "FailureIf: (a < 3) || (b == 'x')",
        "SuccessIf takes at most 30 s.",
        "SuccessIf mission takes at most 30 s\n  in at least 98 % of runs FailureIf battery < 3",
        "SuccessIf Plan/MoveBase takes at most 30 s",
    ],
)
def test_what_can_be_checked(text: str) -> None:
    tree = "BehaviorTree Main\n    -> Plan\n        MoveBase\n\n"
    assert findings(requirement(text, tree), "prose-constraint") == []


@pytest.mark.parametrize(
    ("text", "keyword"),
    [
        ("SuccessIf all is fine.", "SuccessIf"),
        ("Time. failureIf it takes too long", "failureIf"),
        ("FailuerIf it takes too long", "FailuerIf"),
        ("SuccessIf battery > 20 FailureIf it rains", "FailureIf"),
        ("SuccessIf", "SuccessIf"),
        ('SuccessIf "takes at most 30 s"', "SuccessIf"),
        ("SuccessIf (a : s) takes at most 30 s", "SuccessIf"),
    ],
)
def test_prose_is_told_once_at_the_first_keyword(text: str, keyword: str) -> None:
    assert findings(requirement(text), "prose-constraint") == [
        f"1 hint «{keyword}» no tool can check the prose after `{keyword}`"
    ]


def test_a_keyword_behind_escapes_and_line_ends() -> None:
    text = 'QualityReq rq1 "\\"Soon\\"\r\n    FailureIf it takes longer than 5 s"\r\n'
    assert findings(text, "prose-constraint") == ["2 hint «FailureIf» no tool can check the prose after `FailureIf`"]


def test_the_fix_adds_the_clause_and_the_sentence_stays() -> None:
    text = 'QualityReq rq1 : time-behaviour "SuccessIf it takes at most 30 sec"  # soon\n'
    ((title, safe, mended),) = fixes(text, "prose-constraint")
    assert (title, safe) == ("Add `takes at most 30 s`", False)
    assert mended == text.replace('sec"', 'sec" takes at most 30 s')
    assert parse(mended).diagnostics == ()
    assert problems(mended, "prose-constraint") == []


def test_one_bound_said_twice_is_one_clause_and_two_bounds_are_two() -> None:
    same = "SuccessIf it takes at most 30 s. FailureIf it takes longer than 30 s."
    ((title, _, _),) = fixes(requirement(same), "prose-constraint")
    assert title == "Add `takes at most 30 s`"
    ((title, _, _),) = fixes(requirement(same.replace("longer than 30", "less than 5")), "prose-constraint")
    assert title == "Add `takes at most 30 s takes at least 5 s`"


def test_a_condition_needs_but_its_verb() -> None:
    for keyword, verb in (("SuccessIf", "keeps"), ("FailureIf", "never")):
        ((title, _, mended),) = fixes(requirement(f"{keyword} battery >= 3 % and not lost"), "prose-constraint")
        assert title == f"Add `{verb} battery >= 3 % and not lost`"
        assert parse(mended).diagnostics == ()


def test_signals_are_those_in_scope() -> None:
    text = 'include "signals.btq"\n' + requirement("FailureIf the battery falls below 10 %")
    ((title, _, _),) = fixes(text, "prose-constraint", signals="signal battery : % from {b}\n")
    assert title == "Add `keeps battery >= 10 %`"
    (found,) = problems(requirement("FailureIf the battery falls below 10 %"), "prose-constraint")
    assert found.fixes == ()


def test_a_requirement_with_a_clause_is_no_longer_prose() -> None:
    text = 'QualityReq rq1 "SuccessIf all is fine" verified by review\n'
    assert findings(text, "prose-constraint") == []


def test_a_requirement_that_is_repeated_is_told_where_it_is_defined() -> None:
    node = 'satisfies QualityReq ID = "rq1" description = "FailureIf it takes longer than 5 s"'
    text = f"BehaviorTree Main\n    ->\n        Pick ({node})\n        Place ({node})\n"
    (found,) = problems(text, "prose-constraint")
    assert found.span.start < text.index("Place")
    assert found.fixes == ()  # with a clause in one of the two places there would be two requirements
    assert found.notes == ("write it as a clause: `takes at most 5 s`",)


@given(st.text(alphabet=st.sampled_from("Su cesIfFailr:.\"'\\\n\r(){}=<>3 s%#/*"), max_size=40))
def test_any_description_at_all(text: str) -> None:
    source = requirement(f"SuccessIf {text} FailureIf {text}")
    for found in problems(source, "prose-constraint"):
        assert source[found.span.start : found.span.end] in ("SuccessIf", "FailureIf")


@pytest.mark.parametrize(
    ("prose", "clause"),
    [
        ("SuccessIf time < 90 sec", "takes at most 90 s"),
        ("SuccessIf time <= 1.5 min", "takes at most 1.5 min"),
        ("SuccessIf execution time ≤ 90 s", "takes at most 90 s"),
        ("FailureIf time > 90 sec", "takes at most 90 s"),
        ("FailureIf duration < 5 s", "takes at least 5 s"),
        ("SuccessIf time > 5 s", "takes at least 5 s"),
    ],
)
def test_the_time_that_a_node_takes(prose: str, clause: str) -> None:
    text = f'QualityReq r : safety "{prose}"\n'
    assert [title for title, _, _ in fixes(text, "prose-constraint")] == [f"Add `{clause}`"]


def test_a_signal_called_time_is_a_condition() -> None:
    text = 'signal time : s\nQualityReq r : safety "SuccessIf time < 90 s"\n'
    assert "takes" not in str(fixes(text, "prose-constraint"))
