"""`[[factory]]` in the project file, at the command line."""

from __future__ import annotations

import csv
import io
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from evidence_logs import as_logged, btlog
from evidence_logs import rows as transitions
from in_process import run_btq

from btq_lang.checks import check as check_file
from btq_lang.projects.opening import open_workspace
from btq_lang.workspace.workspace import Workspace

Write = Callable[..., None]

MAIN = '<root BTCPP_format="4"><BehaviorTree ID="Main"><SubTree ID="Dock"/></BehaviorTree></root>\n'
DOCK = '<root BTCPP_format="4"><BehaviorTree ID="Dock"><AlwaysSuccess/></BehaviorTree></root>\n'
UNKNOWN = "unknown tree `Dock`; no file of its factory defines it"
ELSEWHERE = "unknown tree `Dock`; neither this file nor its includes define it"


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write(name: str, text: str) -> None:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)

    return write


def check(folder: Path, *arguments: str) -> list[str]:
    """The lines of the report without the last one, and the messages."""
    code, out, err = run_btq("check", "--output-format", "concise", *arguments, cwd=folder)
    *lines, last = out.splitlines()
    assert (code == 0) is not any(": error" in line or ": warning" in line for line in lines), last
    return [*lines, *err.splitlines()]


def test_files_of_a_factory_see_each_other(tmp_path: Path, write: Write) -> None:
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["trees/*.xml", "lib/**/*.btq"]\nmain = "Main"\n')
    write("trees/main.xml", MAIN)
    write("lib/deep/dock.btq", "BehaviorTree Dock\n    AlwaysSuccess\n")
    write("other.btq", "BehaviorTree Other\n    SubTree Dock\n")  # a factory of its own
    assert check(tmp_path) == [f"other.btq:2:13: error[unknown-tree] {ELSEWHERE}"]
    assert check(tmp_path, "trees") == []
    assert check(tmp_path, "lib/deep/dock.btq") == []
    write("trees/a.xml", DOCK)
    assert check(tmp_path, "trees") == ["trees/a.xml:1:42: error[duplicate-tree] duplicate tree `Dock`"]


def test_a_file_of_two_factories_is_checked_in_each(tmp_path: Path, write: Write) -> None:
    factories = ('[[factory]]\nname = "a"\nload = ["*.xml"]\n', '[[factory]]\nname = "b"\nload = ["main.xml"]\n')
    write("btq.toml", "\n".join(factories))
    write("main.xml", MAIN)
    write("dock.xml", DOCK)
    assert check(tmp_path) == [f"main.xml:1:61: error[unknown-tree] {UNKNOWN}"]
    assert "= note: only in the factory `b`" in run_btq("check", cwd=tmp_path)[1]
    write("btq.toml", factories[0] + factories[1].replace("main.xml", "*.xml"))
    assert check(tmp_path) == []


def test_a_fix_in_a_file_of_two_factories_is_made_once(tmp_path: Path, write: Write) -> None:
    write("btq.toml", '[[factory]]\nname = "a"\nload = ["*.btq"]\n[[factory]]\nname = "b"\nload = ["m.btq"]\n')
    write("m.btq", "BehaviorTree Main\n    SequenceStar\n        Dock\n        Dock\n")
    assert run_btq("check", "--fix", cwd=tmp_path)[1] == "No problems found in 1 file\nFixed 1 problem\n"
    assert (tmp_path / "m.btq").read_text() == "BehaviorTree Main\n    SequenceWithMemory\n        Dock\n        Dock\n"


def test_built_xml_stands_for_its_mission(tmp_path: Path, write: Write) -> None:
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["*.xml"]\nmain = "Main"\n')
    write("main.btq", "BehaviorTree Main\n    SubTree Dock\n")
    write("dock.xml", DOCK)
    write("package.xml", "<package/>\n")
    assert check(tmp_path, "main.btq") == [f"main.btq:2:13: error[unknown-tree] {ELSEWHERE}"]  # nothing is built
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["main.btq", "*.xml"]\nmain = "Main"\n')
    assert run_btq("build", "main.btq", cwd=tmp_path)[:2] == (0, "wrote main.xml\n")
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["*.xml"]\nmain = "Main"\n')
    assert check(tmp_path) == []


def test_what_is_not_there_is_unknown(tmp_path: Path, write: Write) -> None:
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["*.xml", "gone/*.xml"]\n')
    write("main.xml", MAIN)
    assert check(tmp_path) == [
        "main.xml:1:42: hint[missing-include] no file matches `gone/*.xml`, a pattern of the factory `nav`"
    ]
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["gone/*.xml"]\n')
    assert "btq: btq.toml: the factory `nav` loads no file" in run_btq("check", cwd=tmp_path)[2]


def test_packages_of_the_workspace_come_before_installed_ones(
    tmp_path: Path, write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path}/opt/none:{tmp_path}/opt/ros")
    write("src/nav/btq.toml", '[[factory]]\nname = "nav"\nload = ["*.xml", "package://docking/trees/*.xml"]\n')
    write("src/nav/main.xml", MAIN)
    lost = "no file matches `package://docking/trees/*.xml`, a pattern of the factory `nav`"
    assert check(tmp_path, "src") == [f"src/nav/main.xml:1:42: hint[missing-include] {lost}"]
    write("opt/ros/share/docking/trees/dock.xml", DOCK)
    assert check(tmp_path, "src") == []
    write("src/other/docking/package.xml", "<package><name> docking </name></package>\n")
    write("src/other/docking/trees/undock.xml", DOCK.replace("Dock", "Undock"))
    assert check(tmp_path, "src/nav") == [f"src/nav/main.xml:1:61: error[unknown-tree] {UNKNOWN}"]


def test_other_commands_use_the_factory_too(tmp_path: Path, write: Write) -> None:
    write(
        "btq.toml",
        '[[factory]]\nname = "a"\nload = ["*.btq"]\nmain = "Main"\n[[factory]]\nname = "b"\nload = ["m.btq"]\n',
    )
    write("m.btq", "BehaviorTree Main\n    ->\n        SubTree Dock\n        Pick satisfies rq1\n")
    write("d.btq", 'QualityReq rq1 "In time"\n    takes at most 3 s\nBehaviorTree Dock\n    AlwaysSuccess\n')
    assert run_btq("build", "--check", cwd=tmp_path)[2] != ""
    code, _, err = run_btq("build", cwd=tmp_path)
    assert (code, (tmp_path / "m.xml").exists(), (tmp_path / "d.xml").exists()) == (0, True, True), err
    assert 'main_tree_to_execute="Main"' in (tmp_path / "m.xml").read_text()
    assert "main_tree_to_execute" not in (tmp_path / "d.xml").read_text()
    assert "rq1" in run_btq("trace", cwd=tmp_path)[1]
    assert "Dock" in run_btq("graph", "m.btq", cwd=tmp_path)[1]


# ---- projects of Groot2 ----

GROOT = """<root BTCPP_format="4" project_name="Project">
<include path="trees/main.xml"/><include path="trees/dock.xml"/>
<TreeNodesModel><Action ID="Go"><input_port name="goal"/></Action></TreeNodesModel></root>
"""


def test_a_project_of_groot_is_a_factory(tmp_path: Path, write: Write) -> None:
    write("robot.btproj", GROOT)
    write(
        "trees/main.xml",
        MAIN.replace('<SubTree ID="Dock"/>', '<Sequence><Go gaol="1"/><SubTree ID="Dock"/></Sequence>'),
    )
    write("trees/dock.xml", DOCK)
    write("trees/old.xml", DOCK)
    found = ["trees/main.xml:1:62: error[unknown-port] `Go` has no port `gaol`; did you mean `goal`?"]
    assert check(tmp_path) == found
    assert run_btq("check", "trees/dock.xml", "trees/old.xml", cwd=tmp_path)[1] == "No problems found in 2 files\n"
    write(".git/HEAD", "")  # so a file by itself is known to be in the project above
    assert check(tmp_path, "trees/main.xml") == found
    write("trees/dock.xml", DOCK.replace('"Dock"', '"Undock"'))
    unknown = f"trees/main.xml:1:85: error[unknown-tree] {UNKNOWN}"
    assert check(tmp_path, "trees/main.xml") == [*found, unknown]
    (tmp_path / "trees" / "dock.xml").unlink()
    assert check(tmp_path) == [
        "robot.btproj:2:48: error[missing-include] cannot find the file `trees/dock.xml`",
        *found,
    ]


def test_the_project_file_counts_before_a_project_of_groot(tmp_path: Path, write: Write) -> None:
    write("robot.btproj", GROOT)
    write("trees/main.xml", MAIN)
    write("trees/dock.xml", DOCK)
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["trees/main.xml"]\n')
    assert check(tmp_path) == [f"trees/main.xml:1:61: error[unknown-tree] {UNKNOWN}"]
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["*.btproj"]\nmain = "Dock"\n')
    unused = "unused tree `Main`: nothing refers to it, and the main tree is `Dock`"
    assert check(tmp_path) == [f"trees/main.xml:1:42: warning[unused-tree] {unused}"]


FACTORY = '[[factory]]\nname = "nav"\nload = ["*.btq", "lib/**/*.xml"]\nmain = ["Main", "Park"]\n'
DEMANDED = """\
QualityReq quick : time-behaviour
    takes at most 3 s
    on violation fail

BehaviorTree Main
    SubTree Dock satisfies quick
"""
PARK = '<root BTCPP_format="4"><BehaviorTree ID="Park"><SubTree ID="Dock"/></BehaviorTree></root>\n'


@pytest.fixture
def nav(tmp_path: Path, write: Write) -> Path:
    write("btq.toml", FACTORY)
    write("main.btq", DEMANDED)
    write("dock.btq", "BehaviorTree Dock\n    Grip satisfies quick\n\nAction Grip\n")
    write("lib/deep/park.xml", PARK)
    return tmp_path


def test_a_bundle_holds_all_that_its_factory_registers(nav: Path) -> None:
    assert run_btq("build", "--bundle", "-o", "out", cwd=nav)[1] == "wrote out/main.xml\nwrote out/main.qreq.json\n"
    xml = (nav / "out" / "main.xml").read_text()
    assert [line.split('"')[1] for line in xml.splitlines() if "<BehaviorTree" in line] == ["Dock", "Park", "Main"]
    assert '<root BTCPP_format="4" main_tree_to_execute="Main">' in xml
    assert xml.count('_btq="quick"') == 2  # of `Grip` too, in the other file
    assert run_btq("build", "dock.btq", "--bundle", "-o", "other", cwd=nav)[0] == 0
    assert 'main_tree_to_execute="Main"' in (nav / "other" / "dock.xml").read_text()  # its own tree is no main tree
    (nav / "lib" / "deep" / "park.xml").write_text(PARK.replace('"Dock"', '"Duck"'))
    code, out, _ = run_btq("build", "--bundle", "-o", "out", cwd=nav)
    assert (code, out.splitlines()[0]) == (1, "error[unknown-tree]: unknown tree `Duck`; did you mean `Dock`?")


def test_a_bundle_begins_with_the_main_tree_of_its_own_file(tmp_path: Path, write: Write) -> None:
    write("btq.toml", FACTORY)
    write("main.btq", "BehaviorTree Main\n    SubTree Park\n")
    write("park.btq", "BehaviorTree Park\n    AlwaysSuccess\n")
    assert run_btq("build", "--bundle", "-o", "out", cwd=tmp_path)[1] == "wrote out/main.xml\nwrote out/park.xml\n"
    roots = [(tmp_path / "out" / name).read_text().splitlines()[2] for name in ("main.xml", "park.xml")]
    assert roots == [f'<root BTCPP_format="4" main_tree_to_execute="{name}">' for name in ("Main", "Park")]


def rows(folder: Path, *arguments: str) -> list[dict[str, str]]:
    table = run_btq("trace", "main.btq", "--format", "csv", *arguments, cwd=folder)[1]
    return list(csv.DictReader(io.StringIO(table)))


def test_the_other_commands_look_at_factories(nav: Path) -> None:
    held = [[row["how"] for row in rows(nav, *arguments) if row["how"]] for arguments in ((), ("--bundle",))]
    assert held == [["monitored", "enforced"], ["enforced", "enforced"]]
    assert "Dock" in run_btq("graph", "lib/deep/park.xml", "--format", "mermaid", cwd=nav)[1]


def test_revisions_are_compared_in_the_same_factory(nav: Path) -> None:
    git = ("git", "-c", "user.name=a", "-c", "user.email=a@b")
    for words in (("init", "-q"), ("add", "-A"), ("commit", "-qm", "first")):
        subprocess.run([*git, *words], cwd=nav, check=True)
    (nav / "lib" / "deep" / "park.xml").write_text(PARK.replace('"Dock"', '"Main"'))
    (nav / "dock.btq").write_text("BehaviorTree Dock\n    Grab satisfies quick\n\nAction Grab\n")
    code, out, err = run_btq("diff", "--git", "HEAD", cwd=nav)
    assert (code, err) == (1, "")
    assert [line for line in out.splitlines() if line.startswith("~")] == [
        "~ node model Grip renamed to Grab  dock.btq:4",
        "~ node Park/SubTree Main changed  lib/deep/park.xml:1",
    ]


def test_a_workspace_in_python_is_that_of_the_factory(nav: Path, write: Write) -> None:
    def found(workspace: Workspace, path: str) -> list[str]:
        return [each.message for each in check_file(workspace, f"{nav.as_posix()}/{path}")]

    workspace = open_workspace(str(nav / "main.btq"))
    assert workspace.factory is not None
    assert workspace.factory.name == "nav"
    assert (found(workspace, "main.btq"), found(workspace, "lib/deep/park.xml")) == ([], [])
    write("more/other.btq", "BehaviorTree Other\n    SubTree Dock\n")
    other = open_workspace(str(nav / "more"))
    assert (other.factory, [*other.files]) == (None, [f"{nav.as_posix()}/more/other.btq"])
    assert found(other, "more/other.btq") == [ELSEWHERE]
    assert open_workspace(str(nav)).factory is None  # some are in no factory
    assert found(open_workspace(str(nav), factory="nav"), "main.btq") == []
    with pytest.raises(ValueError, match=r"^no factory `nix` registers any of these files$"):
        open_workspace(str(nav), factory="nix")


def test_a_workspace_in_python_has_the_pool_of_its_xml(tmp_path: Path, write: Write) -> None:
    write("package.xml", "<package/>\n")
    write("trees/main.xml", MAIN)
    path = f"{tmp_path.as_posix()}/trees/main.xml"
    nowhere = "unknown tree `Dock`; no file of the project defines it"
    assert [each.message for each in check_file(open_workspace(path), path)] == [nowhere]
    write("lib/dock.xml", DOCK)
    assert check_file(open_workspace(path), path) == ()
    assert check_file(open_workspace(str(tmp_path)), path) == ()


def test_verdicts_join_the_nodes_of_all_files(nav: Path, write: Write) -> None:
    trees = {"Main": '<SubTree ID="Dock"/>', "Dock": '<Action ID="Grip"/>'}
    text = "".join(f'<BehaviorTree ID="{name}">{root}</BehaviorTree>' for name, root in trees.items())
    xml = as_logged(f'<root BTCPP_format="4" main_tree_to_execute="Main">{text}</root>')
    log = btlog(xml, transitions("0 1R 2R 5000 2S 1S 2I 1I"))
    (nav / "run.btlog").write_bytes(log)
    code, out, err = run_btq("verify", "run.btlog", "--mission", "main.btq", "--format", "csv", cwd=nav)
    assert (code, err) == (1, "")
    assert [row["verdict"] for row in csv.DictReader(io.StringIO(out))] == ["violated"] * 2


def test_findings_of_several_factories_are_in_the_order_of_files(tmp_path: Path, write: Write) -> None:
    write("btq.toml", '[[factory]]\nname = "a"\nload = ["c.btq"]\n[[factory]]\nname = "b"\nload = ["a.btq"]\n')
    for name in "abc":
        write(f"{name}.btq", f"BehaviorTree {name.upper()}\n    Sequnce\n        Dock\n        Retry\n            Go\n")
    places = [line.split(": ")[0] for line in check(tmp_path)]
    assert places == ["a.btq:2:5", "a.btq:4:9", "b.btq:2:5", "b.btq:4:9", "c.btq:2:5", "c.btq:4:9"]


def test_a_file_of_scenarios_is_not_loaded(tmp_path: Path, write: Write) -> None:
    write("btq.toml", '[[factory]]\nname = "robot"\nload = ["**/*.btq"]\n')
    write("main.btq", "Root Main\nBehaviorTree Main\n    Dock satisfies fast\nQualityReq fast\n    takes at most 3 s\n")
    write("tests/cases.btq", 'include "../main.btq"\nscenario "S"\n    expect fst\n')
    assert check(tmp_path) == [
        "tests/cases.btq:3:12: error[unknown-requirement] unknown requirement `fst`; did you mean `fast`?"
    ]
