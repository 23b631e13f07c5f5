"""Samples come from the project of the mission that a log is of, whatever projects are beside it."""

from __future__ import annotations

from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows, samples

from btq_lang.cli import main
from btq_lang.commands.candidates import candidates
from btq_lang.evidence.signal_sources import Declared, signal_sources

DEMAND = "signal battery : % from {battery} level\nQualityReq left : safety\n    Move leaves battery >= 30 %\n"
SOURCE = (
    '[evidence]\nlogs = ["run.btlog"]\n[evidence.signals]\nbattery = { file = "battery.csv", column = "battery" }\n'
)
OTHER = ("Move", "Drive")  # in the other project's mission, so that the trees differ


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two projects with a signal of one name, and a log of each."""
    monkeypatch.chdir(tmp_path)
    for name, battery in (("first", 20), ("second", 40)):
        words = OTHER if name == "second" else ("Move", "Move")
        (tmp_path / name).mkdir()
        (tmp_path / name / "btq.toml").write_text(SOURCE, encoding="utf-8")
        (tmp_path / name / f"{name}.btq").write_text((DEMAND + MAIN).replace(*words), encoding="utf-8")
        (tmp_path / name / "run.btlog").write_bytes(btlog(MAIN_XML.replace(*words), rows("0 1R 2R 20 2S 3R 60 3S 1S")))
        (tmp_path / name / "battery.csv").write_text(samples("battery", {0: battery}), encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("where", [".", "first", "second"])
def test_each_log_is_judged_by_the_samples_of_its_own_project(
    where: str, folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder / where)
    for name, code, verdict in (("first", 1, "violated"), ("second", 0, "satisfied")):
        log, mission = (str(folder / name / each) for each in ("run.btlog", f"{name}.btq"))
        assert main(["verify", log, "--format", "csv", *(["--mission", mission] if where != "." else [])]) == code
        assert f",{verdict}," in capsys.readouterr().out


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (None, "first/battery.csv: cannot be read: No such file or directory"),
        ("time,level\n1,2\n", "battery.csv: no column `battery`; it has level"),
    ],
)
def test_what_is_wrong_in_one_project_concerns_only_its_own_runs(
    damage: str | None, message: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if damage is None:
        (folder / "first" / "battery.csv").unlink()
    else:
        (folder / "first" / "battery.csv").write_text(damage, encoding="utf-8")
    assert main(["verify", "second"]) == 0
    assert capsys.readouterr().err == ""
    assert main(["verify", "first"]) == 2
    printed = capsys.readouterr()
    assert printed.err.startswith("btq verify: first/run.btlog: ")
    assert message in printed.err
    assert "no samples of `battery`" in printed.out


def test_two_topics_for_one_signal_are_not_mixed(folder: Path) -> None:
    for name in ("first", "second"):
        topic = f'battery = {{ topic = "/{name}", field = "level" }}'
        (folder / name / "btq.toml").write_text(f"[evidence.signals]\n{topic}\n", encoding="utf-8")
    problems: list[str] = []
    missions = candidates((), (), problems)
    declared = signal_sources(missions, problems)
    assert problems == []
    first = str(folder / "first" / "first.btq")
    why = "projects read `battery` from different topics; name the mission with --mission"
    assert (declared.problem(first, ["battery"]), declared.problem(first, ["speed"])) == (why, "")
    assert signal_sources(missions[:1], problems).problem(first, ["battery"]) == ""
    assert Declared().problem(first, ["battery"]) == ""
