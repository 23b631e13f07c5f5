"""unknown-quality, old-quality-name, ambiguous-quality: what their pages do not show."""

from __future__ import annotations

import pytest
from check_asserts import assert_clean, assert_fix, assert_problems

from btq_lang.workspace.config import Project


def node(quality: str, head: str = "") -> str:
    return f"{head}BehaviorTree Main\n    X satisfices {quality}\n"


@pytest.mark.parametrize(
    "quality",
    [
        "safety",
        "time-behaviour",
        "Time_Behavior",
        '"time behaviour"',
        "performance-efficiency.time-behaviour",
        "performance <time-behavior>",  # as the paper prints it
        "energy-autonomy",
        "flexibility",  # in 2011 something else, too, but a name of 2023
    ],
)
def test_good_names(quality: str) -> None:
    assert_clean(node(quality))


def test_three_names_are_offered_at_most() -> None:
    own = [f"reliability{letter}" for letter in "abcd"]
    assert_problems(
        "".join(f"quality {name}\n" for name in own) + node("reliabilityx"),
        "6:18 warning unknown-quality «reliabilityx» unknown quality `reliabilityx`; "
        "did you mean `reliabilitya`, `reliabilityb` or `reliabilityc`?",
    )


def test_a_name_is_looked_at_wherever_it_stands() -> None:
    assert_problems(
        """
        quality gentle : safty
        QualityReq rq1 : safty "Be careful"
        BehaviorTree Main
            satisfices safty
            X (satisfices Quality = safty (QualityReq ID = "rq2" description = "Slowly"))
                satisfies rq1, QualityReq rq3 : safty "Softly"
        """,
        "1:18 warning unknown-quality «safty» unknown quality `safty`; did you mean `safety`?",
        "2:18 warning unknown-quality «safty» unknown quality `safty`; did you mean `safety`?",
        "4:16 warning unknown-quality «safty» unknown quality `safty`; did you mean `safety`?",
        "5:29 warning unknown-quality «safty» unknown quality `safty`; did you mean `safety`?",
        "6:41 warning unknown-quality «safty» unknown quality `safty`; did you mean `safety`?",
    )
    assert_fix(node("safty"), "Replace `safty` with `safety`", node("safety"))


# ---- qualities of one's own ------------------------------------------------------------------------------------------


def test_own_qualities() -> None:
    own = "quality night-quiet : safety\n"
    for quality in ("night-quiet", "Night_Quiet", "safety.night-quiet"):
        assert_clean(node(quality, own))
    assert_clean('//- main.btq\ninclude "own.btq"\n' + node("night-quiet") + f"//- own.btq\n{own}")
    assert_clean(node("usability", "quality usability\n"))  # one's own word means what one says
    assert_fix(node("night-quit", own), "Replace `night-quit` with `night-quiet`", node("night-quiet", own))
    spaced = 'quality "quiet nights?" : safety\n'
    assert_fix(
        node('"quiet night?"', spaced),
        'Replace `quiet night?` with `"quiet nights?"`',
        node('"quiet nights?"', spaced),
    )


# ---- editions --------------------------------------------------------------------------------------------------------


def test_the_edition_of_a_file_and_of_a_project() -> None:
    old = Project(qualities="iso25010-2011")
    assert_clean(node("portability"), old)
    assert_clean(node("portability", "qualities iso25010-2011\n"))
    assert_clean(node("flexibility", "qualities iso25010-2023\n"), old)
    assert_problems(
        node("portability"),
        "2:18 hint old-quality-name «portability» `portability` is called `flexibility` in iso25010-2023",
    )
    assert_problems(
        node("safety.fail-safe"),
        "2:18 hint old-quality-name «safety.fail-safe» iso25010-2011 does not define `safety.fail-safe`",
        project=old,
    )


def test_an_edition_that_there_is_not() -> None:
    text = node("safety", "qualities iso25010-2025\n")
    assert_problems(text, "1:11 warning unknown-quality «iso25010-2025» unknown quality model `iso25010-2025`")
    assert_fix(text, "Replace it with `iso25010-2023`", text.replace("2025", "2023"))


def test_a_name_without_an_equal_is_not_changed_safely() -> None:
    assert_problems(
        node("context-coverage"),
        "2:18 hint old-quality-name «context-coverage» iso25010-2023 does not define `context-coverage`",
    )


def test_another_word_is_changed_safely() -> None:
    assert_problems(
        node("latency"),
        "2:18 hint old-quality-name «latency» `latency` is an alias of `performance-efficiency.time-behaviour`",
    )
    title = "Replace it with `performance-efficiency.time-behaviour`"
    assert_fix(node("latency"), title, node("performance-efficiency.time-behaviour"), safe=True)
    # As the paper prints it: the bracket goes, too.
    assert_fix(
        node("performance <latency>, safety"), title, node("performance-efficiency.time-behaviour, safety"), safe=True
    )


# ---- ambiguous-quality -----------------------------------------------------------------------------------------------


def test_an_old_characteristic_has_a_usual_meaning() -> None:
    assert_problems(
        node("Usability"),
        "2:18 info ambiguous-quality «Usability» "
        "ambiguous quality name `Usability`; btq reads it as `interaction-capability`",
    )
    assert_clean(node("usability", "qualities iso25010-2011\n"))


@pytest.mark.parametrize("word", ["efficiency", "robustness", "suitability", "accessibility"])
def test_words_that_may_mean_this_or_that(word: str) -> None:
    assert_problems(node(word), f"2:18 warning ambiguous-quality «{word}» ambiguous quality name `{word}`")
    assert_clean(node(word, f"quality {word}\n"))


def test_each_meaning_is_offered() -> None:
    assert_fix(
        node("robustness"),
        "Replace it with `reliability.fault-tolerance`: Fault tolerance",
        node("reliability.fault-tolerance"),
    )
