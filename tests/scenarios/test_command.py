"""`btq test` as a person runs it: which scenarios, in which form, and the exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from in_process import run_btq

TREE = """\
<root BTCPP_format="4" main_tree_to_execute="Deliver">
  <BehaviorTree ID="Deliver">
    <Sequence>
      <MoveTo location="A"/>
      <Dock place="{place}"/>
      <Fallback>
        <ScriptCondition code="place == 3"/>
        <MoveTo location="B"/>
      </Fallback>
    </Sequence>
  </BehaviorTree>
</root>
"""
CASES = """\
include "tree.xml"

scenario "one way"
    given Dock succeeds and writes place = 3
    expect MoveTo runs "A"

scenario "the other way" verifies swift
    given Dock succeeds and writes place = 4
    expect MoveTo runs "A"

scenario "nobody says where"
    expect mission succeeds

QualityReq swift : time-behaviour "Soon there"
    mission takes at most 1 min
"""
WHY = (
    "ScriptCondition::5 reads {place}, and nothing says what Dock::3 writes into {place}; "
    "write `given Dock succeeds and writes place = …`"
)
ALL = """\
passed  one way (cases.btq:3): succeeds after 0 ms
failed  the other way (cases.btq:7): succeeds after 0 ms
        line 9: expect MoveTo runs "A"
          after 0 ms MoveTo::6 (tree.xml:8): it runs with "B"; expected no further activation
                               0                                   0 ms
          Sequence            |S                                       | succeeded
            MoveTo            |S                                       | succeeded
            Dock              |S                                       | succeeded
            Fallback          |S                                       | succeeded
              ScriptCondition |F                                       | failed
              MoveTo          |S                                       | succeeded
        ASSUMED to succeed at once: MoveTo::2, MoveTo::6
unknown nobody says where (cases.btq:11)
        WHY
                      0                                   0 ms
          Sequence   |>                                       | running
            MoveTo   |S                                       | succeeded
            Dock     |S                                       | succeeded
            Fallback |>                                       | running
        ASSUMED to succeed at once: Dock::3, MoveTo::2
3 scenarios: 1 passed, 1 failed, 1 unknown
""".replace("WHY", WHY)

JUNIT = """\
<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="btq test" tests="2" failures="1" errors="0" skipped="0">
  <testsuite name="cases.btq" tests="2" failures="1" errors="0" skipped="0" time="0">
    <testcase classname="cases.btq" name="one way" file="cases.btq" line="3" time="0">
    </testcase>
    <testcase classname="cases.btq" name="the other way" file="cases.btq" line="7" time="0">
      <properties><property name="verifies" value="swift"/></properties>
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A tree with its scenarios."""
    monkeypatch.setenv("NO_COLOR", "1")
    (tmp_path / "tree.xml").write_text(TREE, encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    return tmp_path


def test_all_scenarios_below_a_folder(folder: Path) -> None:
    assert run_btq("test", cwd=folder) == (1, ALL, "")


def test_those_with_a_text_in_their_title(folder: Path) -> None:
    assert run_btq("test", "-k", "ONE", cwd=folder) == (
        0,
        "passed  one way (cases.btq:3): succeeds after 0 ms\n1 scenario: 1 passed\n",
        "",
    )
    assert run_btq("test", "-k", "three", cwd=folder) == (
        2,
        "",
        "btq test: no scenario whose title contains `three`\n",
    )
    assert run_btq("test", "tree.xml", cwd=folder) == (2, "", "btq test: no scenario\n")


def test_in_two_processes_all_is_the_same(folder: Path) -> None:
    assert run_btq("test", "--jobs", "2", cwd=folder) == run_btq("test", "--jobs", "1", cwd=folder)


def test_junit_has_the_requirements(folder: Path) -> None:
    code, out, err = run_btq("test", "-k", "way", "--format", "junit", cwd=folder)
    assert (code, err) == (1, "")
    assert out.startswith(JUNIT)
    reason = "expect MoveTo runs &quot;A&quot;: after 0 ms MoveTo::6 (tree.xml:8): it runs with &quot;B&quot;"
    reason += "; expected no further activation"
    rest = out.removeprefix(JUNIT).splitlines()
    assert rest[:2] == [f'      <failure type="failed" message="{reason}">', reason]
    assert rest[-4:] == [
        "    MoveTo          |S                                       | succeeded</failure>",
        "    </testcase>",
        "  </testsuite>",
        "</testsuites>",
    ]


def test_a_file_for_programs(folder: Path) -> None:
    assert run_btq("test", "-o", "out.json", cwd=folder) == (1, "", "")
    document = json.loads((folder / "out.json").read_text(encoding="utf-8"))
    outcomes = [(each["title"], each["outcome"], each["why"]) for each in document["scenarios"]]
    assert outcomes == [
        ("one way", "passed", ""),
        ("the other way", "failed", ""),
        ("nobody says where", "unknown", WHY),
    ]


def test_the_engine_refuses_the_tree(folder: Path) -> None:
    (folder / "tree.xml").write_text(TREE.replace("<Dock ", "<Fallback "), encoding="utf-8")
    code, out, err = run_btq("test", "-k", "one", cwd=folder)
    assert (code, err) == (1, "")
    assert out.splitlines()[1] == "        tree.xml:5: `Fallback` requires 1 or more children, found none"


def test_the_engine_throws_an_exception(folder: Path) -> None:
    (folder / "tree.xml").write_text(TREE.replace("place == 3", "plaice == 3"), encoding="utf-8")
    code, out, err = run_btq("test", "-k", "one", cwd=folder)
    assert (code, err) == (1, "")
    assert out.splitlines()[1:3] == [
        "        the engine throws an exception after 0 s: Exception in node 'ScriptCondition::5' [ScriptCondition]: "
        "Error in script [plaice == 3]",
        "        Variable not found: plaice",
    ]


def test_an_older_engine_runs(folder: Path) -> None:
    assert run_btq("test", "-k", "one", "--target", "4.6", cwd=folder)[0] == 0


def test_guards_run_unless_they_are_left_out(folder: Path) -> None:
    (folder / "main.btq").write_text(
        "QualityReq soon : time-behaviour\n    Move takes at most 5 s\n    on violation fail\n"
        "BehaviorTree Main\n    Action Move\n"
        'scenario "too long"\n    given Move takes 9 s\n    expect mission succeeds\n',
        encoding="utf-8",
    )
    guarded, bare = (run_btq("test", "main.btq", *more, cwd=folder) for more in ((), ("--no-enforce",)))
    assert (guarded[0], bare[0]) == (1, 0)
    assert guarded[1].splitlines() == [
        "failed  too long (main.btq:6): fails after 5 s",
        "        line 8: expect mission succeeds",
        "          after 5 s Move::2 (main.btq:5): the guard of soon fails; expected mission succeeds",
        "                0                                    5 s",
        "          Move |---------------------------------------H| halted",
        "1 scenario: 1 failed",
    ]
    assert bare[1].splitlines()[0] == "passed  too long (main.btq:6): succeeds after 9 s"


def test_a_file_that_cannot_be_read(folder: Path) -> None:
    assert run_btq("test", "missing.btq", cwd=folder) == (
        2,
        "",
        "btq: missing.btq: cannot be read: No such file or directory\nbtq test: no scenario\n",
    )


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", 'line 1: it is unknown which tree runs; name it: `scenario "…" of Tree`'),
        ('include "gone.xml"\n', "line 1: cannot find the file `gone.xml`"),
        ('include "tree.xml"\nBehaviorTree One\n    Dock\n', None),
    ],
)
def test_which_tree_runs(text: str, why: str | None, folder: Path) -> None:
    (folder / "one.btq").write_text(f'{text}scenario "x"\n    expect mission succeeds\n', encoding="utf-8")
    code, out, _ = run_btq("test", "one.btq", cwd=folder)
    assert (code, out.splitlines()[1] if why else None) == (2 if why else 0, f"        {why}" if why else None)


def test_the_engine_would_never_return(folder: Path) -> None:
    retry = '<RetryUntilSuccessful num_attempts="-1"><Dock place="{place}"/></RetryUntilSuccessful>'
    (folder / "tree.xml").write_text(TREE.replace('<Dock place="{place}"/>', retry), encoding="utf-8")
    (folder / "cases.btq").write_text(
        'include "tree.xml"\n\nscenario "it"\n    given Dock fails\n    expect mission succeeds\n', encoding="utf-8"
    )
    code, out, err = run_btq("test", cwd=folder)
    assert (code, err) == (1, "")
    assert out.splitlines()[:2] == [
        "unknown it (cases.btq:3)",
        "        RetryUntilSuccessful::3 goes on without an end in one tick",
    ]


def test_a_mission_that_never_returns_names_its_own_node(folder: Path) -> None:
    """Not the root, which a build may have put around the tree."""
    (folder / "own.btq").write_text(
        "signal speed : m/s from {@s} initially 0 m/s\n"
        "QualityReq r : safety\n    mission keeps speed <= 1 m/s\n    on violation halt\n"
        "Action Drive\nAction Dock\nRoot Main\nBehaviorTree Main\n    -> satisfies r\n        Dock\n"
        "        Repeat Patience (num_cycles = -1)\n            ->\n                Dock\n                Drive\n"
        'scenario "it"\n    given every Dock succeeds\n    given Drive succeeds\n    expect mission succeeds\n',
        encoding="utf-8",
    )
    _, out, err = run_btq("test", "own.btq", cwd=folder)
    assert (out.splitlines()[1], err) == ("        Patience goes on without an end in one tick", "")


@pytest.mark.parametrize(
    ("main", "library"),
    [
        ("Root A\nBehaviorTree A\n    ->\n        Go\n        SubTree B\n", "BehaviorTree B\n    Ho\n"),
        ("BehaviorTree A\n    ->\n        Go\n        SubTree B\n", "BehaviorTree B\n    Ho\n"),
        ("Root A\nBehaviorTree A\n    ->\n        Go\n        SubTree B\n", "Root B\nBehaviorTree B\n    Ho\n"),
        ("Root A\nBehaviorTree A\n    Go\n", "BehaviorTree B\n    Ho\n"),
    ],
)
def test_the_main_tree_of_several_included_files_runs(main: str, library: str, folder: Path) -> None:
    (folder / "library.btq").write_text(library, encoding="utf-8")
    (folder / "main.btq").write_text(f'include "library.btq"\n{main}', encoding="utf-8")
    (folder / "tests.btq").write_text(
        'include "main.btq"\n'
        'scenario "right"\n    given Go takes 3 s\n    expect mission succeeds\n'
        'scenario "wrong"\n    given Gone takes 3 s\n    expect mission succeeds\n',
        encoding="utf-8",
    )
    assert run_btq("test", "tests.btq", cwd=folder) == (
        2,
        "passed  right (tests.btq:2): succeeds after 3 s\n"
        "error   wrong (tests.btq:5)\n        line 6: unknown node `Gone`\n"
        "2 scenarios: 1 passed, 1 with an error\n",
        "",
    )


def test_a_mistake_in_one_scenario_is_none_of_another_without_a_tree(folder: Path) -> None:
    (folder / "tests.btq").write_text(
        "BehaviorTree A\n    Go\nBehaviorTree B\n    Go\n"
        'scenario "right"\n    expect mission succeeds\n'
        'scenario "wrong"\n    given Gone takes 3 s\n    expect mission succeeds\n',
        encoding="utf-8",
    )
    _, out, _ = run_btq("test", "tests.btq", cwd=folder)
    unknown = 'it is unknown which tree runs; name it: `scenario "…" of Tree`'
    assert out.splitlines()[1::2] == [f"        line 5: {unknown}", f"        line 7: {unknown}"]
