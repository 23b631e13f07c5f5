"""`import btq_lang`: the names that it offers, what a shell shows of them, and what each does in one call."""

from __future__ import annotations

import doctest
import inspect
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from evidence_logs import MAIN, MAIN_XML, btlog, rows, samples

import btq_lang as btq
from btq_lang.cli import main
from btq_lang.workspace.file import SIDE_SUFFIX

ROOT = Path(__file__).resolve().parents[2]
PUBLIC = [
    "Built",
    "Change",
    "Diagnostic",
    "Imported",
    "LineIndex",
    "Node",
    "Parsed",
    "Requirement",
    "Span",
    "TraceTable",
    "Tree",
    "Verification",
    "Workspace",
    "__version__",
    "build",
    "check",
    "diff_missions",
    "draw_tree",
    "format_text",
    "import_xml",
    "open_workspace",
    "parse",
    "trace_table",
    "verify_logs",
]
FUNCTIONS = [name for name in PUBLIC if name[0].islower()]
CONSOLE = """\
import json, rlcompleter, sys
import btq_lang
listed, loaded = dir(btq_lang), [name for name in sys.modules if name.startswith("btq_lang.")]
print(json.dumps([listed, loaded, rlcompleter.Completer({"btq_lang": btq_lang}).attr_matches("btq_lang.")]))
"""
DOCK = "BehaviorTree Main\n    Action Dock\n"
DEMAND = 'QualityReq rq1 "In time"\n    takes at most 30 s\n    on violation fail\n'
DEMANDED = DEMAND + "BehaviorTree Main\n    Action Dock satisfies rq1\n"


def test_a_shell_lists_and_completes_the_public_names() -> None:
    """In a fresh process: here the other tests have imported many of them."""
    run = subprocess.run([sys.executable, "-c", CONSOLE], capture_output=True, text=True, check=True)
    listed, loaded, completed = json.loads(run.stdout)
    assert (listed, loaded) == (PUBLIC, [])
    shown = [name.partition("(")[0].removeprefix("btq_lang.") for name in completed]
    assert shown == [name for name in PUBLIC if name != "__version__"]


def test_every_name_is_there_and_no_other() -> None:
    assert btq.__all__ == PUBLIC
    assert [name for name in PUBLIC if not hasattr(btq, name)] == []
    with pytest.raises(AttributeError, match="module 'btq_lang' has no attribute 'biuld'"):
        _ = btq.biuld


def test_no_name_is_also_a_module() -> None:
    """It would be the module as soon as somebody had imported that."""
    modules = {path.stem for path in (ROOT / "btq_lang").iterdir() if path.is_dir() or path.suffix == ".py"}
    assert modules & set(PUBLIC) == set()


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_says_how_it_is_used(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    function = getattr(btq, name)
    text = inspect.getdoc(function) or ""
    for parameter in inspect.signature(function).parameters:
        assert re.search(rf"\b{parameter}\b", text) or parameter in ("workspace", "old", "new"), parameter
    assert "\nArgs:\n" in text
    assert "\nRaises:\n" in text or "any string" in text
    (example,) = doctest.DocTestFinder(recurse=False).find(function, name)
    assert example.examples
    assert doctest.DocTestRunner().run(example).failed == 0


# ---- build ----


@pytest.fixture
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The examples, and the laboratory that logs are of."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    shutil.copy(ROOT / "tests" / "evidence" / "lab.btq", tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    "mission",
    [
        "examples/hospital/missions/deliver.btq",
        "examples/hospital/missions/disinfect.btq",
        "examples/inspection/mission.btq",
        "examples/laboratory/mission.btq",
        "examples/navigation/navigation.btq",
        "examples/pick-and-place/cell.btq",
        "examples/classic/inspector.qualitybtcpp",
        "lab.btq",
    ],
)
@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ({}, []),
        ({"bundle": True}, ["--bundle"]),
        ({"enforce": False}, ["--no-enforce"]),
        ({"target": "4.6"}, ["--target", "4.6"]),
    ],
    ids=str,
)
def test_a_build_is_what_the_command_writes(
    mission: str, options: dict[str, object], arguments: list[str], clone: Path
) -> None:
    path = (clone / mission).as_posix()
    built = btq.build(btq.open_workspace(mission), path, **options)  # type: ignore[arg-type]  # of several types
    assert (built.problems, {*clone.rglob("*.xml")}) == ((), set())
    assert main(["build", mission, *arguments]) == 0
    suffixes = (".xml", SIDE_SUFFIX)
    written = {each.as_posix(): each.read_bytes() for each in clone.rglob("*") if each.name.endswith(suffixes)}
    assert {name: text.encode() for name, text in built.files.items()} == written
    assert len(built.files) >= (3 if "hospital" in mission and "bundle" not in options else 1)


def test_a_mission_with_errors_is_not_built() -> None:
    workspace = btq.Workspace.of({"main.btq": "BehaviorTree Main\n    Timeout (msec = -1)\n        Action Dock\n"})
    built = btq.build(workspace, "main.btq")
    assert built.files == {}
    (found,) = btq.check(workspace, "main.btq")
    assert [(each.path, each.span, each.message) for each in built.problems] == [
        ("main.btq", found.span, found.message)
    ]


def test_a_file_without_a_tree_is_not_built() -> None:
    workspace = btq.Workspace.of({"empty.btq": "", "skills.btq": "Action Dock\n"})
    built = btq.build(workspace, "empty.btq")
    assert [(each.path, each.message) for each in built.problems] == [("empty.btq", "has no tree to run")]
    assert [*btq.build(workspace, "skills.btq").files] == ["skills.xml"]


def test_what_cannot_be_built_is_said() -> None:
    workspace = btq.Workspace.of({"main.btq": DOCK})
    with pytest.raises(ValueError, match=r"unknown engine version `5\.0`; btq supports 4\.6 to 4\.10"):
        btq.build(workspace, "main.btq", target="5.0")
    with pytest.raises(KeyError, match=r"gone\.btq"):
        btq.build(workspace, "gone.btq")


def test_xml_is_built_already(tmp_path: Path) -> None:
    file = tmp_path / "main.xml"
    file.write_text('<root BTCPP_format="4"><BehaviorTree ID="Main"><Dock/></BehaviorTree></root>', encoding="utf-8")
    with pytest.raises(ValueError, match=r"main\.xml is XML already; expected a \.btq file"):
        btq.build(btq.open_workspace(str(file)), file.as_posix())


# ---- the other calls ----


def test_a_folder_without_files(tmp_path: Path) -> None:
    assert btq.open_workspace(str(tmp_path)).files == {}


def test_a_folder_of_cpp(tmp_path: Path) -> None:
    pytest.importorskip("tree_sitter_cpp", reason="the C++ grammar is not installed: pip install -e '.[cpp]'")
    (tmp_path / "btq.toml").write_text('nodes = ["*.cpp"]\n')
    (tmp_path / "n.cpp").write_text('void add(F& f) { f.registerSimpleAction("Dock", dock); }\n')
    workspace = btq.open_workspace(str(tmp_path))
    assert [file.text.splitlines()[-1] for file in workspace.files.values()] == ["    Action Dock"]


def test_an_import_and_what_it_changed() -> None:
    tree = '<BehaviorTree ID="Main"><SequenceStar><Dock/></SequenceStar></BehaviorTree>'
    done = btq.import_xml(f'<root main_tree_to_execute="Main">{tree}</root>')
    assert done.text == "Root Main\n\nBehaviorTree Main\n    M->\n        Dock\n"
    assert [change.message for change in done.changes] == [
        'BTCPP_format="4" is added',
        "SequenceStar is now SequenceWithMemory",
    ]
    assert btq.import_xml("<root>").diagnostics[0].rule == "xml-syntax"


def test_a_trace_writes_what_the_command_writes(
    clone: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    workspace = btq.open_workspace("examples/hospital")
    for form in ("table", "csv", "json", "markdown", "html"):
        target = tmp_path / "trace"
        assert main(["trace", "examples/hospital", "--format", form, "-o", str(target)]) == 0
        assert btq.trace_table(workspace).write(form) == target.read_bytes().decode()


def test_a_trace_of_missions_with_errors_counts_them() -> None:
    broken = "BehaviorTree Main\n    Timeout (msec = -1)\n        Action Dock\n"
    workspace = btq.Workspace.of({"main.btq": DEMANDED, "broken.btq": broken})
    table = btq.trace_table(workspace, "main.btq")
    assert ([(row.name, row.way) for row in table.overview.requirements], table.errors) == ([("rq1", "enforced")], 0)
    assert btq.trace_table(workspace).errors == 1


def test_a_picture_is_what_the_command_draws(clone: Path) -> None:
    mission = "examples/laboratory/mission.btq"
    workspace, path = btq.open_workspace(mission), (clone / mission).as_posix()
    for form in ("svg", "dot", "mermaid"):
        arguments = ["--format", form, "--qualities", "--direction", "right", "-o", "drawn"]
        assert main(["graph", mission, *arguments]) == 0
        drawn = btq.draw_tree(workspace, path, form, qualities=True, direction="right")
        assert drawn == (clone / "drawn").read_bytes().decode()
    with pytest.raises(ValueError, match=r"^a\.btq has no trees to draw$"):
        btq.draw_tree(btq.Workspace.of({"a.btq": ""}), "a.btq")


def test_a_diff_of_two_missions() -> None:
    old = btq.Workspace.of({"main.btq": DEMANDED})
    new = old.with_file("main.btq", DEMANDED.replace("30 s", "20 s").replace("Dock", "Charge"))
    found = btq.diff_missions(old, "main.btq", new, "main.btq")
    assert [(each.what, each.thing, each.name) for each in found] == [
        ("changed", "requirement", "rq1"),
        ("changed", "node", "Main/Charge"),
    ]
    assert btq.diff_missions(old, "main.btq", old, "main.btq") == ()


def test_a_mission_and_what_was_built_of_it_differ_in_nothing(tmp_path: Path) -> None:
    workspace = btq.Workspace.of({"main.btq": "BehaviorTree Main\n    Dock\n"})
    (tmp_path / "main.xml").write_text(btq.build(workspace, "main.btq").files["main.xml"], encoding="utf-8")
    built = btq.open_workspace(str(tmp_path / "main.xml"))
    (path,) = built.files
    assert btq.diff_missions(workspace, "main.btq", built, path) == ()
    assert btq.diff_missions(built, path, workspace, "main.btq") == ()


# ---- logs ----

DEMANDS = "signal battery : % from {battery}\nQualityReq rq : safety\n    Move needs battery > 1 %\n"


@pytest.fixture
def logs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.btq").write_text(DEMANDS + MAIN, encoding="utf-8")
    (tmp_path / "battery.csv").write_text(samples("battery", {0: 0.5}), encoding="utf-8")
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "run.btlog").write_bytes(btlog(MAIN_XML, rows("0 1R 2R 5 2S 3S 1S 2I 3I 1I")))
    return tmp_path


def test_verdicts_are_what_the_command_writes(logs: Path) -> None:
    workspace = btq.open_workspace("main.btq")
    found = btq.verify_logs(workspace, f"{logs.as_posix()}/main.btq", ["logs"], signals="battery.csv")
    assert (found.problems, found.report.remarks) == ((), ())
    assert [(each.id, each.verdict) for each in found.report.missions[0].requirements] == [("rq", "violated")]
    for form in ("table", "json", "csv", "junit", "markdown"):
        arguments = ["--mission", "main.btq", "--signals", "battery.csv", "--format", form, "-o", "found"]
        assert main(["verify", "logs", *arguments]) == 1
        assert found.write(form) == (logs / "found").read_bytes().decode()


def test_what_keeps_logs_from_being_judged(logs: Path) -> None:
    workspace = btq.Workspace.of({"main.btq": DEMANDS + MAIN})
    (logs / "logs" / "cut.btlog").write_bytes(b"BTCPP4-FileLogger2")
    found = btq.verify_logs(workspace, "main.btq", "logs")
    assert found.problems == ("logs/cut.btlog: the file ends before its tree",)
    assert [each.runs for each in found.report.missions] == [1]
    (logs / "none").mkdir()
    assert btq.verify_logs(workspace, "main.btq", "none").problems == ("no .btlog, .db3, .btdb or .mcap below none",)
    (logs / "wrong.csv").write_text("t\n1\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"^wrong\.csv: expected a line of column names"):
        btq.verify_logs(workspace, "main.btq", "logs", signals="wrong.csv")
    with pytest.raises(FileNotFoundError):
        btq.verify_logs(workspace, "main.btq", "logs", signals="gone.csv")
