"""`btq simulate --what-if` and `--improve`, as a user runs them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from in_process import run_btq
from json_schema import violations
from simulated_project import MISSION, SCHEMA, SETTINGS

XML = """<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <Sequence>
      <Drive name="There"/>
      <RetryUntilSuccessful num_attempts="2"><Pick/></RetryUntilSuccessful>
      <Timeout name="Soon" msec='7000'><Action ID="Pick" name="Last"/></Timeout>
    </Sequence>
  </BehaviorTree>
</root>
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "mission.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "btq.toml").write_text(SETTINGS, encoding="utf-8")
    return tmp_path


def predicted(project: Path, *options: str, runs: int = 300) -> dict[str, Any]:
    code, out, err = run_btq("simulate", "--format", "json", "--runs", str(runs), *options, cwd=project)
    assert (code, err) == (0, "")
    document: dict[str, Any] = json.loads(out)
    assert list(violations(document, SCHEMA)) == []
    return document


def test_the_table(project: Path) -> None:
    change = "Retry Pick num_attempts = 5"
    code, out, err = run_btq("simulate", "--runs", "1000", "--what-if", change, cwd=project)
    assert (code, err) == (0, "")
    assert out == run_btq("simulate", "--runs", "1000", cwd=project)[1] + (
        "\nwhat if Retry Pick num_attempts = 5\n"
        "  never run              charging  takes at most 2 h\n"
        "  will miss → will hold  reliable  mission succeeds in at least 90 % of runs  80.3 % → 94 %"
        "  +13.7 points (+11.5 to +15.9)\n"
        "  will hold              in_time   takes at most 30 s                         100 % → 100 %"
        "  0 points (−0.368 to +0.368)\n"
        "  will hold              way_home  leaves battery >= 3 %                      100 % → 100 %"
        "  0 points (−0.388 to +0.388)\n"
        "  runs that succeed: 803 → 940 of 1 000 · they take 22.6 s → 23.5 s"
        " · 95 % of them at most 29.9 s → 37 s\n"
    )


@pytest.mark.parametrize(
    ("change", "old", "new"),
    [
        ("Retry num_attempts = 5", "num_attempts = 2", "num_attempts = 5"),
        ("RetryUntilSuccessful Pick num_attempts = 5", "num_attempts = 2", "num_attempts = 5"),
        ('Pick _failureIf = "1 < 0"', "            Pick\n", '            Pick (_failureIf = "1 < 0")\n'),
        ("Retry _skipIf = true", "(num_attempts = 2)", "(num_attempts = 2 _skipIf = true)"),
    ],
)
def test_an_attribute_is_as_if_the_file_were_edited(project: Path, change: str, old: str, new: str) -> None:
    (alternative,) = predicted(project, "--what-if", change)["alternatives"]
    assert (project / "mission.btq").read_text(encoding="utf-8") == MISSION
    assert MISSION.count(old) == 1
    (project / "mission.btq").write_text(MISSION.replace(old, new), encoding="utf-8")
    assert alternative["prediction"] == predicted(project)


@pytest.mark.parametrize(
    ("change", "old", "new"),
    [
        ("Retry Pick num_attempts = 5", 'num_attempts="2"', 'num_attempts="5"'),
        ("Timeout Soon msec = 1000", "msec='7000'", 'msec="1000"'),
        ("Last _skipIf = true", '<Action ID="Pick"', '<Action _skipIf="true" ID="Pick"'),
    ],
)
def test_an_attribute_of_xml(project: Path, change: str, old: str, new: str) -> None:
    (project / "mission.btq").unlink()
    (project / "tree.xml").write_text(XML, encoding="utf-8")
    (project / "btq.toml").write_text(SETTINGS.partition("BatteryLow")[0], encoding="utf-8")
    document = predicted(project, "tree.xml", "--what-if", change)
    (alternative,) = document["alternatives"]
    assert alternative["prediction"]["ends"] != document["ends"]
    assert XML.count(old) == 1
    (project / "tree.xml").write_text(XML.replace(old, new), encoding="utf-8")
    assert alternative["prediction"] == predicted(project, "tree.xml")


def test_an_attribute_in_an_included_file(project: Path) -> None:
    head, _, tree = MISSION.partition("BehaviorTree Deliver\n")
    (project / "mission.btq").write_text(
        f'include "pick.btq"\n{head.replace("Action Pick", "")}BehaviorTree Deliver\n'
        + tree.replace("        Retry (num_attempts = 2)\n            Pick\n", "        SubTree Picking\n"),
        encoding="utf-8",
    )
    part = "Action Pick\n\nBehaviorTree Picking\n    Retry (num_attempts = 2)\n        Pick\n"
    (project / "pick.btq").write_text(part, encoding="utf-8")
    document = predicted(project, "mission.btq", "--what-if", "Retry Pick num_attempts = 5")
    (project / "pick.btq").write_text(part.replace("2", "5"), encoding="utf-8")
    assert document["alternatives"][0]["prediction"] == predicted(project, "mission.btq")


def test_skills(project: Path) -> None:
    changes = ("Drive takes x 0.5", "Drive takes 5 s to 10 s", "Pick succeeds 90 %", "Charge takes 1 h")
    options = [option for change in changes for option in ("--what-if", change)]
    document = predicted(project, *options, runs=2000)
    assert [each["what"] for each in document["alternatives"]] == [*changes]
    half, other, surer, charged = (each["prediction"] for each in document["alternatives"])
    assert half["ends"] == document["ends"]  # the same runs, in less time
    assert half["median"] < document["median"] - 5
    assert abs(half["median"] - other["median"]) < 0.002  # rounded once more
    (difference,) = [each for each in document["alternatives"][2]["differences"] if each["requirement"] == "reliable"]
    assert surer["requirements"][0]["clauses"][0]["share"] == difference["share"]
    assert difference["interval"][0] < 0.95 * (0.99 - 0.84) < difference["interval"][1]
    assert [each["source"] for each in charged["sources"]].count("ASSUMED") == 0
    in_toml = SETTINGS.replace('["10 s", "20 s"]', '["5 s", "10 s"]')
    (project / "btq.toml").write_text(in_toml, encoding="utf-8")
    assert predicted(project, runs=2000) == other


def test_improvements(project: Path) -> None:
    _, out, _ = run_btq("simulate", "--runs", "1000", "--improve", cwd=project)
    assert (
        "\nwhat helps reliable: mission succeeds in at least 90 % of runs\n"
        "  will miss → too close to say  Pick: half its failures   80.3 % → 91.3 %  +11 points (+8.22 to +13.8)\n"
        "  will miss                     Drive: half its failures  80.3 % → 82.7 %  +2.4 points (+1.27 to +3.53)\n"
        "  the same with: Drive: half its time, Drive: always its average time, Pick: half its time,"
        " Pick: always its average time\n"
        "\nwhat helps in_time: takes at most 30 s\n  none of 6 improvements changes this\n"
    ) in out
    document = predicted(project, "--improve")
    assert document["improves"]
    assert [each["what"] for each in document["alternatives"]][:2] == [
        "Pick: half its failures",
        "Drive: half its failures",
    ]


def test_a_demand_for_time(project: Path) -> None:
    (project / "mission.btq").write_text(MISSION.replace("at most 30 s", "at most 18 s"), encoding="utf-8")
    document = predicted(project, "--improve")
    by_change = {
        each["what"]: next(row["share"] for row in each["differences"] if row["requirement"] == "in_time")
        for each in document["alternatives"]
    }
    assert by_change["Drive: half its time"] == by_change["Drive: always its average time"] == 1
    assert by_change["Pick: half its time"] < 0.9


def test_other_formats(project: Path) -> None:
    options = ("--runs", "300", "--what-if", "Pick succeeds 90 %")
    _, markdown, _ = run_btq("simulate", *options, "--format", "markdown", cwd=project)
    assert (
        "\n#### what if Pick succeeds 90 %\n\n| Prediction | Requirement | Clause | Share | Difference |\n" in markdown
    )
    assert (
        "| will miss → will hold | reliable | mission succeeds in at least 90 % of runs | 82 % → 95.7 % |" in markdown
    )
    _, rows, _ = run_btq("simulate", *options, "--format", "csv", cwd=project)
    assert [row.rpartition(",")[2] for row in rows.splitlines()] == ["what_if"] + 4 * [""] + 4 * ["Pick succeeds 90 %"]
    assert run_btq("simulate", *options, "-o", "page.html", cwd=project) == (0, "", "")
    page = (project / "page.html").read_text(encoding="utf-8")
    assert "<h2>what if Pick succeeds 90 %</h2>" in page
    assert "<td>will miss → will hold</td>" in page


def test_any_number_of_processes_gives_the_same_bytes(project: Path) -> None:
    options = ("--runs", "450", "--what-if", "Retry num_attempts = 5", "--format", "json")
    assert len({run_btq("simulate", *options, "--jobs", jobs, cwd=project) for jobs in "13"}) == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("Retry Pick num_atempts = 5", "`Retry` has no port `num_atempts`"),
        ("Retry Pick num_attempts = five", "expected an integer for `num_attempts`, found `five`"),
        ("Repeat Pick num_cycles = 5", "no `Repeat` is named `Pick` or around it"),
        ("Pik succeeds 97 %", "no node is named `Pik`; did you mean `Pick`?"),
        ("Pick succeeds 120 %", "expected a percentage from 0 to 100 such as `97 %`, not `120 %`"),
        ("Pick succeeds often", "expected a percentage from 0 to 100 such as `97 %`, not `often`"),
        (
            "Drive takes soon",
            "expected a duration such as `12 s` or `12 s to 20 s`, or a factor such as `x 0.8`, not `soon`",
        ),
        (
            "faster please",
            "expected an attribute of a node such as `Retry Dock num_attempts = 5`, or what an action takes or how"
            " often it succeeds, such as `MoveBase takes x 0.8` or `Dock succeeds 97 %`",
        ),
        ("BatteryLow succeeds 5 %", "`BatteryLow` is a condition; expected an action, or an attribute of a node"),
        ("Retry takes 5 s", "`Retry` is not an action of the program"),
        ("Charge takes x 2", "`Charge` is assumed to take no time; expected a duration such as `takes 12 s`"),
    ],
)
def test_mistakes(project: Path, change: str, message: str) -> None:
    code, out, err = run_btq("simulate", "--what-if", change, cwd=project)
    assert (code, out, err) == (2, "", f"btq simulate: --what-if '{change}': {message}\n")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--improve", "--what-if", "Pick succeeds 9 %"), "--improve and --what-if are two questions; ask one of them"),
        (("--improve", "--check"), "--check is for the mission as it is; leave out --improve and --what-if"),
        (("--improve", "--show", "x"), "--show draws a run of the mission as it is; leave out --improve and --what-if"),
    ],
)
def test_usage(project: Path, options: tuple[str, ...], message: str) -> None:
    assert run_btq("simulate", *options, cwd=project) == (2, "", f"btq simulate: {message}\n")
