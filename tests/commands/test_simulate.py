"""`btq simulate`, as a user runs it."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest
from in_process import run_btq
from json_schema import violations
from simulated_project import ANSWER, MISSION, SCHEMA, SETTINGS

from btq_lang.commands.progress import Progress

TABLE = """mission.btq as built for 4.10, 1 000 runs from seed 1 of 4 skills: 3 declared, 1 ASSUMED

  will miss         reliable  mission succeeds in at least 90 % of runs  80.3 % (77.7 to 82.7) (run 4: --show reliable)\
   mostly Pick fails (72 % of 100 misses)
  never run         charging  takes at most 2 h                          Charge ran in 0 of 1 000 runs
  will hold         in_time   takes at most 30 s                         1 000 of 1 000 activations, worst 20 s (run 44)
  will hold         way_home  leaves battery >= 3 %                      949 of 949 activations, worst 50 % (run 44)

runs: 803 succeed, 197 fail · those that succeed take 22.6 s, and 95 % of them at most 29.9 s
ASSUMED to succeed at once: Charge
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "mission.btq").write_text(MISSION, encoding="utf-8")
    (tmp_path / "btq.toml").write_text(SETTINGS, encoding="utf-8")
    return tmp_path


def prediction(project: Path, *options: str) -> dict[str, object]:
    code, out, err = run_btq("simulate", "--format", "json", *options, cwd=project)
    assert (code, err) == (0, "")
    document: dict[str, object] = json.loads(out)
    assert list(violations(document, SCHEMA)) == []
    return document


def words(document: object) -> dict[str, str]:
    assert isinstance(document, dict)
    return {each["id"]: each["word"] for each in document["requirements"]}


def test_the_table(project: Path) -> None:
    assert run_btq("simulate", "--runs", "1000", cwd=project) == (0, TABLE, "")


def test_a_condition_that_nobody_answers(project: Path) -> None:
    (project / "btq.toml").write_text(SETTINGS.replace(ANSWER, ""), encoding="utf-8")
    code, out, err = run_btq("simulate", cwd=project)
    assert (code, out) == (2, "")
    assert err == (
        "btq simulate: nobody says what this condition answers: BatteryLow; --template prints the lines for btq.toml\n"
    )
    code, out, err = run_btq("simulate", "--template", cwd=project)
    assert (code, err) == (0, "")
    assert 'BatteryLow = { is = "" }' in out
    assert "Charge = " in out
    assert "Drive" not in out


def test_any_number_of_processes_gives_the_same_bytes(project: Path) -> None:
    outputs = {run_btq("simulate", "--runs", "450", "--jobs", jobs, "--format", "json", cwd=project) for jobs in "13"}
    assert len(outputs) == 1


def test_more_runs_begin_with_the_same_ones(project: Path) -> None:
    few, many = (run_btq("simulate", "--runs", runs, "--show", "reliable", cwd=project) for runs in ("150", "950"))
    assert few == many
    assert few[1].startswith("run 4 misses reliable: it fails\n")
    other = run_btq("simulate", "--runs", "150", "--seed", "2", "--show", "reliable", cwd=project)
    assert other != few


def test_check_stops_when_all_is_decided(project: Path) -> None:
    mission = MISSION.replace(" satisfies in_time, way_home", "").replace(" satisfies charging", "")
    only = re.sub(r"(?ms)^QualityReq (in_time|way_home|charging).*?(?=^QualityReq|^Action)", "", mission)
    (project / "mission.btq").write_text(only, encoding="utf-8")
    code, out, _ = run_btq("simulate", "--check", cwd=project)
    assert code == 1
    assert out.startswith("mission.btq as built for 4.10, 200 of 10 000 runs from seed 1")
    (project / "mission.btq").write_text(only.replace("90 %", "60 %"), encoding="utf-8")
    code, out, _ = run_btq("simulate", "--check", cwd=project)
    assert code == 0
    assert "will hold" in out
    code, out, _ = run_btq("simulate", cwd=project)
    assert "10 000 runs" in out


def test_close_to_what_is_demanded(project: Path) -> None:
    (project / "mission.btq").write_text(MISSION.replace("90 %", "80 %"), encoding="utf-8")
    assert words(prediction(project, "--runs", "1000")) == {
        "reliable": "too close to say",
        "in_time": "will hold",
        "way_home": "will hold",
        "charging": "never run",
    }


def test_a_value_that_is_unknown(project: Path) -> None:
    mission = MISSION.replace("Action Pick\n", "Action Pick\n    output weight : double\n").replace(
        "            Pick\n", '            Pick (weight = {weight})\n        ScriptCondition (code = "weight < 5")\n'
    )
    (project / "mission.btq").write_text(mission, encoding="utf-8")
    document = prediction(project, "--runs", "100")
    assert words(document)["reliable"] == "unknown"
    _, out, _ = run_btq("simulate", "--runs", "100", cwd=project)
    assert "in 81 of 100 runs: ScriptCondition::9 reads {weight}, and nothing says what Pick::8 writes" in out


def test_runs_without_an_end_count_as_misses(project: Path) -> None:
    text = MISSION.replace("            Pick\n", "            Pick\n        Wait\n").replace(
        "Action Pick\n", "Action Pick\nAction Wait\n"
    )
    (project / "mission.btq").write_text(text, encoding="utf-8")
    settings = SETTINGS.replace(ANSWER, f'Wait = {{ takes = "360 d" }}\n{ANSWER}')
    (project / "btq.toml").write_text(settings, encoding="utf-8")
    document = prediction(project, "--runs", "200")
    ends = {each["end"]: each["runs"] for each in document["ends"]}  # type: ignore[attr-defined]  # the form is in the schema
    assert ends == {"does not end": 160, "fails": 40}
    clause = document["requirements"][0]["clauses"][0]  # type: ignore[index]  # as above
    assert (clause["held"], clause["counted"], clause["cause"]["text"]) == (0, 200, "it does not end")


def test_a_shown_run_as_a_log_and_as_a_scenario(project: Path) -> None:
    code, _, err = run_btq("simulate", "--runs", "200", "--show", "reliable", "-o", "run.btlog", cwd=project)
    assert (code, err) == (0, "run 4 is in run.btlog: btq verify run.btlog --signals run.csv\n")
    _, verdicts, _ = run_btq("verify", "run.btlog", "--signals", "run.csv", "--format", "json", cwd=project)
    judged = {each["id"]: each["verdict"] for each in json.loads(verdicts)["requirements"]}
    assert judged == {
        "reliable": "violated",
        "in_time": "satisfied",
        "way_home": "satisfied",
        "charging": "never exercised",
    }
    assert run_btq("simulate", "--runs", "200", "--show", "reliable", "-o", "case.btq", cwd=project)[0] == 0
    code, out, _ = run_btq("test", "case.btq", cwd=project)
    assert (code, out) == (
        0,
        "passed  Run 4 of reliable (case.btq:3): fails after 25.7 s\n1 scenario: 1 passed\n",
    )


def test_other_formats(project: Path) -> None:
    _, markdown, _ = run_btq("simulate", "--runs", "300", "--format", "markdown", cwd=project)
    assert markdown.startswith("### Deliver: 1 will miss, 1 never run, 2 will hold\n")
    _, rows, _ = run_btq("simulate", "--runs", "300", "--format", "csv", cwd=project)
    assert rows.splitlines()[1].startswith(
        "reliable,The parcel mostly arrives,mission.btq,mission succeeds in at least 90 % of runs,Sequence::1,will miss"
    )
    assert run_btq("simulate", "--runs", "300", "-o", "page.html", cwd=project) == (0, "", "")
    page = (project / "page.html").read_text(encoding="utf-8")
    assert '<meter min="0" max="100" value="82">82 %</meter>' in page
    assert json.loads(run_btq("schema", "simulate", cwd=project)[1]) == SCHEMA


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--runs", "0"), "--runs 0: expected at least one"),
        (("--jobs", "-1"), "--jobs -1: expected a number of processes, or 0 to let btq choose"),
        (("--show", "other"), "--show other: no requirement has this ID"),
        (
            ("--show", "reliable", "-o", "run.txt"),
            "-o run.txt: --show writes a log, FILE.btlog, or a scenario, FILE.btq",
        ),
        (("--tree", "Other"), "mission.btq: the tree `Other` cannot be built; run btq check"),
    ],
)
def test_usage(project: Path, options: tuple[str, ...], message: str) -> None:
    assert run_btq("simulate", *options, cwd=project) == (2, "", f"btq simulate: {message}\n")


def test_ctrl_c_ends_with_the_table_so_far(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(self: Progress, runs: int, more: str = "") -> None:
        if runs == 300:
            raise KeyboardInterrupt

    monkeypatch.setattr(Progress, "reached", stop)
    code, out, err = run_btq("simulate", "--jobs", "1", cwd=project)
    assert (code, err) == (0, "btq simulate: stopped after 300 of 10000 runs\n")
    assert out.startswith("mission.btq as built for 4.10, 300 of 10 000 runs from seed 1 of 4 skills")


def test_plain_xml(project: Path) -> None:
    xml = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequence><Drive/><Pick/></Sequence></BehaviorTree></root>'
    (project / "mission.btq").unlink()
    (project / "tree.xml").write_text(xml, encoding="utf-8")
    skills = SETTINGS.partition(ANSWER)[0]
    (project / "btq.toml").write_text(skills, encoding="utf-8")
    code, out, err = run_btq("simulate", "tree.xml", "--runs", "1000", cwd=project)
    assert (code, err) == (0, "")
    assert "no requirement to judge" in out
    assert "runs: 569 succeed, 431 fail" in out  # 0.95 · 0.6 = 0.57


def test_skills_measured_in_a_log_and_in_a_store(tmp_path: Path) -> None:
    folder = shutil.copytree(Path(__file__).parents[2] / "examples/laboratory", tmp_path / "laboratory")
    of_log = run_btq("simulate", "--runs", "200", "--from", "runs.btlog", cwd=folder)
    assert of_log[0] == 0
    assert of_log[1].startswith(
        "mission.btq as built for 4.10, 200 runs from seed 1 of 9 skills: 5 measured (50 runs), 4 declared\n"
    )
    pytest.importorskip("duckdb", reason="the store is not installed: pip install -e '.[fleet]'")
    run_btq("verify", "runs.btlog", "--store", "store", "--label", "v1.4", cwd=folder)
    of_store = run_btq("simulate", "--runs", "200", "--from", "store", "--label", "v1.4", cwd=folder)
    assert of_store[1].replace("v1.4, ", "") == of_log[1]
    code, _, err = run_btq("simulate", "--from", "store", "--label", "v9", cwd=folder)
    assert (code, err) == (2, "btq simulate: --from store: no run of mission.btq\n")
    code, _, err = run_btq("simulate", "--from", "runs.btlog", "--label", "v1.4", cwd=folder)
    assert (code, err) == (2, "btq simulate: --label is for --from with a store\n")
