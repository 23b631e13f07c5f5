"""`[[factory]]` in the project file, at the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq

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
        "main.xml:1:42: hint[missing-include] no file matches `gone/*.xml`, which the factory `nav` loads"
    ]
    write("btq.toml", '[[factory]]\nname = "nav"\nload = ["gone/*.xml"]\n')
    assert "btq: btq.toml: the factory `nav` loads no file" in run_btq("check", cwd=tmp_path)[2]


def test_packages_of_the_workspace_come_before_installed_ones(
    tmp_path: Path, write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path}/opt/none:{tmp_path}/opt/ros")
    write("src/nav/btq.toml", '[[factory]]\nname = "nav"\nload = ["*.xml", "package://docking/trees/*.xml"]\n')
    write("src/nav/main.xml", MAIN)
    lost = "no file matches `package://docking/trees/*.xml`, which the factory `nav` loads"
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
