"""Verdicts that were judged before their requirement meant what it means now."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows
from in_process import run_btq as run_in
from json_schema import violations

from btq_lang.evidence.identity import Candidate
from btq_lang.evidence.meanings import NO_MEANINGS, is_suspect, meanings_of
from btq_lang.evidence.store.tables import OPTIONAL
from btq_lang.workspace.workspace import Workspace

QUICK = 'QualityReq quick "In time"\n    Move takes at most 30 ms\n'
OTHER = "QualityReq other\n    Pick takes at most 1 s\n"
SLOWER = QUICK.replace("30 ms", "1 min")
SCHEMA = json.loads((Path(__file__).parents[2] / "btq_lang/evidence/verdicts.schema.json").read_text(encoding="utf-8"))
SUSPECT = "suspect: judged before the requirement was changed"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with a mission, and a store of its log."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "btq.toml").write_text("", encoding="utf-8")
    write(tmp_path, QUICK)
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 40 2S 3R 60 3S 1S")))
    run_btq("verify", "run.btlog", "--store", "kept", "--label", "v1", code=1)
    run_btq("verify", "run.btlog", "-o", "verdicts.json", code=1)
    return tmp_path


def run_btq(*arguments: str, code: int = 0) -> str:
    exit_code, out, messages = run_in(*arguments, cwd=Path.cwd())
    assert exit_code == code, messages
    return out


def write(folder: Path, quick: str) -> None:
    (folder / "main.btq").write_text(quick + OTHER + MAIN, encoding="utf-8")


def verify(*arguments: str, code: int = 1) -> str:
    return run_btq("verify", "--store", "kept", *arguments, code=code)


def suspects(text: str) -> dict[str, bool]:
    document = json.loads(text)
    assert not [*violations(document, SCHEMA)]
    return {each["id"]: each.get("suspect", False) for each in document["requirements"]}


def test_in_the_summary_of_a_store(folder: Path) -> None:
    assert suspects(verify("--format", "json")) == {"quick": False, "other": False}
    assert SUSPECT not in verify()
    write(folder, SLOWER)
    assert suspects(verify("--format", "json")) == {"quick": True, "other": False}
    assert verify().splitlines()[2:5] == [
        "  violated         quick  In time  Move takes at most 30 ms  1 of 1 activation, worst 40 ms in run 1",
        f"                   {SUSPECT}",
        "                   Move::2: took 40 ms, bound 30 ms"
        " (run 1 of run.btlog, 40 ms after its start at 2026-11-20 21:22:20.000 UTC)",
    ]
    assert f"1 of 1 activation, worst 40 ms in run 1<br>{SUSPECT} |" in verify("--format", "markdown")
    assert '<property name="suspect" value="true"/>' in verify("--format", "junit")
    cells = [(row["requirement"], row["suspect"]) for row in csv.DictReader(io.StringIO(verify("--format", "csv")))]
    assert cells == [("quick", "yes"), ("other", "")]


def test_a_log_that_is_judged_again_is_not_suspect(folder: Path) -> None:
    write(folder, SLOWER)
    run_btq("verify", "run.btlog", "--store", "kept")
    assert suspects(verify("--format", "json", code=0)) == {"quick": False, "other": False}


def test_the_same_in_other_words_and_a_source_are_no_other_meaning(folder: Path) -> None:
    write(folder, QUICK.replace("30 ms", "0.03 s") + '    source "ISO 13482"\n')
    assert suspects(verify("--format", "json")) == {"quick": False, "other": False}


def test_some_logs_of_a_store_were_judged_before(folder: Path) -> None:
    write(folder, QUICK + "    on violation warn\n")  # the clause, and so its row, is the same
    (folder / "again.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 10 2S 3R 60 3S 1S")))
    run_btq("verify", "again.btlog", "--store", "kept", "--label", "v2")
    (quick, _) = json.loads(verify("--format", "json"))["requirements"]
    assert (len(quick["fingerprints"]), len(quick["clauses"]), quick["suspect"]) == (2, 1, True)
    by_label = json.loads(verify("--by", "label", "--format", "json"))["requirements"]
    assert [(each["mission"], each.get("suspect")) for each in by_label if each["id"] == "quick"] == [
        ("main, label v1", True),
        ("main, label v2", None),
    ]


def test_in_an_overview(folder: Path) -> None:
    for evidence in ("kept", "verdicts.json"):
        write(folder, QUICK)
        assert [each["evidence"][0]["suspect"] for each in trace(evidence)] == [False, False]
        write(folder, SLOWER)
        assert [each["evidence"][0]["suspect"] for each in trace(evidence)] == [True, False]
    text = run_btq("trace", "main.btq", "--evidence", "kept")
    assert [line[57:].strip() for line in text.splitlines()[2:5]] == [
        "violated",
        "1 of 1 activation, worst 40 ms in run 1; suspect: judged",
        "before the requirement was changed",
    ]
    assert "violated (suspect)" in text  # by build
    document = json.loads(run_btq("trace", "main.btq", "--evidence", "kept", "--format", "json"))
    assert [verdict["suspect"] for verdict in document["builds"][0]["verdicts"]] == [True, False]
    lines = csv.DictReader(io.StringIO(run_btq("trace", "main.btq", "--evidence", "kept", "--format", "csv")))
    assert [(line["kind"], line["requirement"]) for line in lines if line["suspect"]] == [
        ("evidence", "quick"),
        ("build", "quick"),
    ]
    page = run_btq("trace", "main.btq", "--evidence", "kept", "--format", "html")
    assert (SUSPECT in page, "<small>suspect</small>" in page) == (True, True)
    assert [each["id"] for each in trace("kept", "--state", "suspect")] == ["quick"]


def trace(evidence: str, *arguments: str) -> Any:
    return json.loads(run_btq("trace", "main.btq", "--evidence", evidence, "--format", "json", *arguments))[
        "requirements"
    ]


def test_on_the_page_of_a_store(folder: Path) -> None:
    assert SUSPECT not in run_btq("report", "kept")
    write(folder, SLOWER)
    assert run_btq("report", "kept").count(f"<small>{SUSPECT}</small>") == 1


def test_of_a_set_without_fingerprints_nothing_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import duckdb

    (file,) = (folder / "kept").glob("*/clauses.parquet")
    of_before = f"SELECT * EXCLUDE ({', '.join(OPTIONAL['clauses'])}) FROM '{file}'"
    duckdb.sql(f"COPY ({of_before}) TO '{file}.new' (FORMAT parquet)")
    Path(f"{file}.new").replace(file)
    write(folder, SLOWER)
    assert suspects(verify("--format", "json")) == {"quick": False, "other": False}
    document = json.loads((folder / "verdicts.json").read_text(encoding="utf-8"))
    for requirement in document["requirements"]:
        del requirement["fingerprints"]
    (folder / "verdicts.json").write_text(json.dumps(document), encoding="utf-8")
    assert [each["evidence"][0]["suspect"] for each in trace("verdicts.json")] == [False, False]


def test_elsewhere_nothing_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(folder, SLOWER)
    (folder / "elsewhere").mkdir()
    monkeypatch.chdir(folder / "elsewhere")
    (folder / "elsewhere/btq.toml").write_text("", encoding="utf-8")
    assert suspects(run_btq("verify", "--store", "../kept", "--format", "json", code=1)) == dict.fromkeys(
        ("quick", "other"), False
    )


def test_as_built_nothing_is_said(folder: Path) -> None:
    """What a build restores of a requirement may be written in other words."""
    run_btq("build", "main.btq")
    (folder / "main.btq").unlink()
    run_btq("verify", "run.btlog", "--mission", "main.xml", "--store", "built", code=1)
    write(folder, QUICK)
    assert not any(suspects(run_btq("verify", "--store", "built", "--format", "json", code=1)).values())


def test_of_two_missions_with_one_name_either_meaning_counts() -> None:
    missions = [
        Candidate(Workspace.of({"main.btq": quick + MAIN}), "main.btq", "main", None) for quick in (QUICK, SLOWER)
    ]
    meanings = meanings_of((mission.name, mission.fingerprints) for mission in missions)
    one, other = (mission.fingerprints["quick"] for mission in missions)
    assert meanings == {("main", "quick"): {one, other}}
    assert (is_suspect([one], meanings["main", "quick"]), is_suspect(["1:0"], meanings["main", "quick"])) == (
        False,
        True,
    )
    assert not is_suspect([one], NO_MEANINGS.get(("main", "quick")))
