"""How likely trees succeed, as an editor shows it, with skills that are declared."""

from __future__ import annotations

from itertools import count

import pytest
from feature_asserts import Fixture

from btq_lang.ide.hints import code_lenses
from btq_lang.ide.hover import hover
from btq_lang.ide.outlook import outlook, trees_with_outlook
from btq_lang.workspace.config import Project, parse_project
from btq_lang.workspace.queries import Cancelled

MISSION = """
//- main.btq
Action Pick
Action Place
Condition Seen
QualityReq quick : performance-efficiency "In time"
    takes at most 5 s
    on violation fail
QualityReq safe : safety "Not for long"
    uses at most 2 kB of traffic
    on violation fail
signal traffic : kB from {bytes} counter initially 0 kB
BehaviorTree Main
    Sequence
        Re$0try (num_attempts = 3)
            Pick
        Place
BehaviorTree Waits
    Timeout (msec = 4000)
        Pick
BehaviorTree Reacts
    ReactiveSequence
        Pick
BehaviorTree Asks
    Sequence
        Seen
        Pick
BehaviorTree Other
    Place
BehaviorTree Stops
    Pick satisfies quick
BehaviorTree Guarded
    Pick satisfies safe
"""


def declared(text: str) -> Project:
    project, problems = parse_project(text)
    assert problems == ()
    return project


SKILLS = declared('[simulate.skills]\nPick = { takes = ["2 s", "6 s"], succeeds = "80 %" }\n')


def test_what_is_exact_of_each_tree() -> None:
    workspace = Fixture(MISSION, project=SKILLS).workspace
    texts = {tree: outlook(workspace, "main.btq", tree) for tree in trees_with_outlook(workspace, "main.btq")}
    assert texts == {
        "Main": "succeeds 99.2 %, p95 9.9 s (declared, 1 ASSUMED)",
        "Waits": "succeeds 39.8 %, p95 3.9 s (declared)",
        "Reacts": "",
        "Asks": "",
        "Other": "",
        "Stops": "succeeds 59.8 %, p95 4.8 s (declared)",
        "Guarded": "succeeds 80 %, p95 5.8 s (declared, without guards)",
    }


def test_nothing_is_said_without_declared_skills() -> None:
    workspace = Fixture(MISSION).workspace
    assert trees_with_outlook(workspace, "main.btq") == ()
    assert outlook(workspace, "main.btq", "Main") == ""


def test_a_lens_is_at_its_tree() -> None:
    workspace = Fixture(MISSION, project=SKILLS).workspace
    lenses = code_lenses(workspace, "main.btq", outlooks={"Waits": "succeeds"})
    text = workspace.files["main.btq"].text
    assert [text[slice(*each.span)] for each in lenses if each.title == "succeeds"] == ["Waits"]


def shown(text: str, project: Project | None = SKILLS) -> str:
    """The last paragraph of the hover at the cursor."""
    answer = hover(*Fixture(text, project=project).at)
    assert answer is not None
    return answer.markdown.rpartition("\n\n")[2]


def test_other_numbers_of_attempts() -> None:
    assert shown(MISSION).splitlines() == [
        "| attempts | succeeds | p95 | the tree succeeds |",
        "|---|---|---|---|",
        "| 1 | 80 % | 5.8 s | 80 % |",
        "| 2 | 96 % | 8.9 s | 96 % |",
        "| 3 | 99.2 % | 9.9 s | 99.2 % |",
        "| 4 | 99.8 % | 10 s | 99.8 % |",
        "| 5 | 99.97 % | 10 s | 99.97 % |",
    ]


def test_other_limits() -> None:
    text = MISSION.replace("Re$0try", "Retry").replace("Timeout", "Time$0out")
    assert [line.split(" | ")[:2] for line in shown(text).splitlines()[2:]] == [
        ["| 2 s", "0 %"],
        ["| 3 s", "19.8 %"],
        ["| 4 s", "39.8 %"],
        ["| 6 s", "79.8 %"],
        ["| 8 s", "80 %"],
    ]


def test_why_there_is_no_number() -> None:
    text = MISSION.replace("Re$0try", "Retry").replace("    ReactiveSequence\n", "    Re$0try (num_attempts = -1)\n")
    assert "No exact prediction" not in shown(text)  # there is no other number to compare
    text = text.replace(
        "Re$0try (num_attempts = -1)\n        Pick", "Re$0try (num_attempts = 2)\n        RunOnce\n            Pick"
    )
    assert shown(text) == "No exact prediction: RunOnce: it remembers that it has run."


def test_a_driver_with_another_period_has_no_number() -> None:
    other = declared('[simulate]\ndriver = { tick_once = "100 ms" }\nskills = { Pick = { takes = "2 s" } }\n')
    assert outlook(Fixture(MISSION, project=other).workspace, "main.btq", "Waits") == ""
    same = declared('[simulate]\ndriver = { tick_while_running = "10 ms" }\nskills = { Pick = { takes = "2 s" } }\n')
    assert (
        outlook(Fixture(MISSION, project=same).workspace, "main.btq", "Waits") == "succeeds 100 %, p95 2 s (declared)"
    )


def test_a_message_ends_it() -> None:
    workspace = Fixture(MISSION, project=SKILLS).workspace
    for most in range(100_000):
        looks = count()
        try:
            text = outlook(workspace, "main.btq", "Main", lambda looks=looks, most=most: next(looks) >= most)  # type: ignore[misc]
        except Cancelled:
            continue
        assert most > 10
        assert text == outlook(workspace, "main.btq", "Main")
        return
    pytest.fail("it never ends")
