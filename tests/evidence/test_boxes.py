"""What logs show of a requirement at its node in a drawn tree: the last run's value, the verdict, and the history."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, START, btlog, rows

from btq_lang.cli import main
from btq_lang.evidence.boxes import measured_by
from btq_lang.evidence.tally import MOST_RUNS
from btq_lang.evidence.verdicts import RequirementVerdict
from btq_lang.evidence.verifying import verify_logs
from btq_lang.graph.missions import figures
from btq_lang.requirements.resolve import requirements
from btq_lang.workspace.workspace import Workspace

MISSION = """\
QualityReq quick : performance-efficiency "Moves <fast>"
    Move takes at most 30 ms
QualityReq sure : reliability
    Pick succeeds
    in at least 60 % of activations
"""
RUNS = "0 1R 2R 20 2S 3R 60 3F 1F 1I 100 1R 2R 140 2S 3R 150 3S 1S 1I 200 1R 2R 225 2S 3R 250 3S 1S"
NODES = ("Move", "Pick")
QUICK = ["quick", "Moves <fast>", "takes at most 30 ms", "last run: 25 ms, satisfied", "violated: 1 of 3 broke it"]
SURE = ["sure", "succeeds", "in at least 60 % of activations", "last run: satisfied", "satisfied: 1 of 3 broke it"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A mission, and a log of three runs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.btq").write_text(MISSION + MAIN, encoding="utf-8")
    (tmp_path / "run.btlog").write_bytes(btlog(MAIN_XML, rows(RUNS)))
    return tmp_path


def drawn(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    capsys.readouterr()
    assert main(["graph", "main.btq", *arguments]) == 0
    return capsys.readouterr().out


def notes(svg: str) -> list[str]:
    """The groups of the notes of requirements."""
    return re.findall(r'<g class="note requirement.*?</g>(?=\n(?:<g class="(?:note|box)|</g>\n</svg>))', svg, re.DOTALL)


def texts(note: str) -> list[str]:
    found = re.findall(r"<text [^>]*>(.*?)</text>", note)
    return [text.replace("&lt;", "<").replace("&gt;", ">") for text in found]


def test_the_box_of_a_requirement(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    quick, sure = notes(drawn(capsys, "--evidence", "run.btlog"))
    assert (texts(quick), texts(sure)) == (QUICK, SURE)
    assert '<g class="note requirement violated" data-note="quick">' in quick
    assert (
        "<title>last run: 25 ms, satisfied; violated: 1 of 3 broke it; 3 runs, 1 violated, from 20 ms to 40 ms" in quick
    )
    (value,), (limit,) = re.findall(r'class="value" d="(.*?)"', quick), re.findall(r'class="limit" d="(.*?)"', quick)
    points = [(float(x), float(y)) for x, y in re.findall(r"([\d.]+) ([\d.]+)", value)]
    (x, top), step = points[1], points[1][0] - points[0][0]
    # 20, 40 and 25 ms over 30 pixels, the bound of 30 ms halfway.
    assert points == [(x - step, top + 30), (x, top), (x + step, top + 22.5)]
    assert re.fullmatch(rf"M{x - step:g} {top + 15}h{2 * step:g}", limit)
    assert re.findall(r'class="broken" d="(.*?)"', quick) == [f"M{x - 3:g} {top - 3:g}l6 6m0 -6l-6 6"]
    assert re.findall(r'class="last" d="(.*?)"', quick) == [f"M{x + step} {top + 22.5}h0"]
    # Nothing is measured: whether it held.
    (value,) = re.findall(r'class="value" d="(.*?)"', sure)
    heights = [float(y) for y in re.findall(r" ([\d.]+)", value)]
    assert (heights[0] - heights[1], heights[1]) == (30, heights[2])
    assert 'class="limit"' not in sure


def test_logs_a_store_and_a_file_of_verdicts_give_the_same_picture(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("duckdb")
    main(["verify", "run.btlog", "--mission", "main.btq", "--store", "kept", "-o", "verdicts.json"])
    by_log = drawn(capsys, "--evidence", "run.btlog")
    assert drawn(capsys, "--evidence", "kept") == by_log
    assert drawn(capsys, "--evidence", "verdicts.json") == by_log


@pytest.mark.parametrize("form", ["dot", "mermaid"])
def test_other_formats_have_its_words(form: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = {"dot": r"\n".join(QUICK[2:]), "mermaid": "<br/>".join(QUICK[2:])}
    assert lines[form] in drawn(capsys, "--evidence", "run.btlog", "--format", form)


@pytest.mark.parametrize("evidence", ["gone.btlog", "gone.json"])
def test_evidence_that_is_missing_is_an_error(evidence: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["graph", "main.btq", "--evidence", evidence, "-o", "tree.svg"]) == 2
    assert capsys.readouterr().err == f"btq graph: {evidence}: cannot be read: No such file or directory\n"
    assert not (folder / "tree.svg").exists()


def test_pages_have_the_boxes_in_their_trees(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trace", "main.btq", "--evidence", "run.btlog", "--format", "html"]) == 0
    traced = capsys.readouterr().out
    assert main(["verify", "run.btlog", "--mission", "main.btq", "--format", "html"]) == 1
    verified = capsys.readouterr().out
    for page in (traced, verified):
        assert page.count('<g class="sparkline">') == 2
        assert "violated: 1 of 3 broke it" in page


def test_a_store_with_another_node_of_the_requirement(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What an earlier version demanded of another node is shown at none."""
    pytest.importorskip("duckdb")
    timely = "QualityReq timely : performance-efficiency\n    takes at most 30 ms\n"
    at_move, at_pick = (timely + MAIN.replace(f"Action {name}", f"Action {name} satisfies timely", 1) for name in NODES)
    (folder / "main.btq").write_text(at_move)
    main(["verify", "run.btlog", "--mission", "main.btq", "--store", "kept"])
    assert "broke it" in drawn(capsys, "--evidence", "kept")
    (folder / "main.btq").write_text(at_pick)
    assert "broke it" not in drawn(capsys, "--evidence", "kept")


def runs(count: int, first: int = 0) -> bytes:
    """Runs of a second, in each of which Move takes a millisecond more."""
    text = "".join(f" {n * 1000} 1R 2R {n * 1000 + 1 + n} 2S 3R {n * 1000 + 500} 3S 1S 1I" for n in range(first, count))
    return btlog(MAIN_XML, rows(text), START)


@pytest.mark.parametrize("logs", [("a.btlog", "b.btlog"), ("b.btlog", "a.btlog")])
def test_the_last_runs_are_kept_whatever_the_order_of_logs(logs: Sequence[str], folder: Path) -> None:
    (folder / "a.btlog").write_bytes(runs(70))
    (folder / "b.btlog").write_bytes(runs(90, first=70))
    workspace = Workspace.of({"main.btq": MISSION + MAIN})
    verdict = verify_logs(workspace, "main.btq", logs).report.missions[0].requirements[0].clauses[0]
    assert MOST_RUNS == 60
    assert [value.si for value in verdict.by_run] == [n / 1000 for n in range(31, 91)]
    numbers = range(1, 91) if logs[0] == "a.btlog" else (*range(21, 91), *range(1, 21))
    assert [value.run for value in verdict.by_run] == [*numbers][30:]
    assert [value.verdict for value in verdict.by_run] == ["violated"] * 60


def shown(text: str, verdicts: Sequence[RequirementVerdict]) -> list[tuple[tuple[str, ...], list[bool]]]:
    """Of each clause in a picture of the text: its lines, and which runs are crossed."""
    workspace = Workspace.of({"main.btq": text})
    figure = figures(workspace, "main.btq", True, measured_by(requirements(workspace, "main.btq"), verdicts))[0]
    of_notes = (measured for box in figure.boxes for note in box.notes for measured in note.measured)
    return [(measured.lines, [is_broken for _, is_broken in measured.values]) for measured in of_notes]


def test_clauses_at_one_node_are_told_apart_and_both_bounds_are_drawn(folder: Path) -> None:
    between = "takes between 21 ms and 30 ms"
    at_move = MAIN.replace("Action Move\n        ", "Action Move satisfies both\n        ", 1)
    text = f"QualityReq both : reliability\n    {between}\n    succeeds\n{at_move}"
    workspace = Workspace.of({"main.btq": text})
    verdicts = verify_logs(workspace, "main.btq", "run.btlog").report.missions[0].requirements
    assert shown(text, verdicts) == [
        (
            ("takes between 21 ms and 30 ms", "last run: 25 ms, satisfied", "violated: 2 of 3 broke it"),
            [True, True, False],
        ),
        (("succeeds", "last run: satisfied", "satisfied: 0 of 3 broke it"), [False, False, False]),
    ]
    found = requirements(workspace, "main.btq")
    ((first, second),) = (measured_by(found, verdicts)(applied) for applied in found.applied)
    assert (first.bounds, second.bounds) == ((0.021, 0.03), ())


def test_a_scope_keeps_its_verdict_and_a_span_is_drawn_at_its_nodes(folder: Path) -> None:
    signal = "signal speed : m/s from {speed}\n"
    slow = "QualityReq slow : safety\n    Move keeps speed <= 1 m/s\n    while speed > 2 m/s\n"
    both = "QualityReq both : reliability\n    from Move starts to Pick succeeds takes at most 1 s\n"
    text = signal + slow + both + MAIN
    verdicts = verify_logs(Workspace.of({"main.btq": text}), "main.btq", "run.btlog").report.missions[0].requirements
    lines = ("last run: 50 ms, satisfied", "violated: 1 of 3 broke it")
    assert shown(text, verdicts) == [(("unknown: 3 unknown",), [False] * 3), *[(lines, [True, False, False])] * 2]
