"""What `btq check FOLDER` looks at: missions in this language and the engine's XML, and no other files."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq

from btq_lang.btcpp.recognition import is_mission, may_be_mission
from btq_lang.projects.files import Files

TREE = '<root BTCPP_format="4"><BehaviorTree ID="Main"><Sequnce/></BehaviorTree></root>\n'
MISSION = "BehaviorTree Main\n    Dock satisfies rq1\nQualityReq rq1\n    takes at most 3 s\n"

Write = Callable[..., None]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write(*files: str, text: str = TREE) -> None:
        for name in files:
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text)

    return write


def checked(folder: Path, *arguments: str) -> list[str]:
    """The files with the misspelt node of TREE."""
    code, out, err = run_btq("check", "--output-format", "concise", *arguments, cwd=folder)
    assert (code, err) == (1, "")
    *lines, _ = out.splitlines()
    assert all(line.endswith("unknown node `Sequnce`; did you mean `Sequence`?") for line in lines)
    return [line.partition(":")[0] for line in lines]


def test_the_xml_of_the_engine_is_checked_with_its_folder(tmp_path: Path, write: Write) -> None:
    write("b.xml", "trees/a.xml", "c.btq/not.xml")
    write("a.btq", text="BehaviorTree Main\n    Sequnce\n        Dock\n")
    assert checked(tmp_path) == ["a.btq", "b.xml", "c.btq/not.xml", "trees/a.xml"]
    assert checked(tmp_path, "trees") == ["trees/a.xml"]


def test_other_xml_is_passed_over(tmp_path: Path, write: Write) -> None:
    write("a.xml")
    write("package.xml", text='<?xml version="1.0"?>\n<package format="3"><name>root</name></package>\n')
    write("robot.xml", text='<robot name="r"><link name="BehaviorTree"/></robot>\n')
    write("strings.xml", text="<root><data>BTCPP_format=4 main_tree_to_execute=Main</data></root>\n")
    write("parts.xml", text='<root><include file="part.xml"/></root>\n')
    write("empty.xml", text="")
    write("text.xml", text="no XML\n")
    (tmp_path / "bytes.xml").write_bytes(b"\0\1\2<root")
    assert checked(tmp_path) == ["a.xml"]
    assert run_btq("check", "robot.xml", cwd=tmp_path)[0] == 1  # a file that is named is checked as it is


@pytest.mark.parametrize(
    "text",
    [
        '<?xml version="1.0"?>\n<!-- a > comment --><!DOCTYPE root>\n<root BTCPP_format="4"/>',
        '\ufeff<root main_tree_to_execute = "Main">',
        "<root><TreeNodesModel/></root>",
        '<root>\n<include ros_pkg="p" path="a.xml"/></root>',
        "text before it <root><BehaviorTree>",
        f"<!-- {'x' * 10_000} --><root><BehaviorTree/></root>",
    ],
)
def test_missions_are_recognized(text: str) -> None:
    assert is_mission(text)
    assert all(may_be_mission(text[:size]) for size in range(len(text[:4_096])))


@pytest.mark.parametrize(
    "text",
    ["", "<", "<rooted BTCPP_format='4'/>", "<!-- <root BTCPP_format='4'/>", "<a/><root BTCPP_format='4'/>", "<root/>"],
)
def test_others_are_not(text: str) -> None:
    assert not is_mission(text)


def test_what_is_made_is_not_looked_at(tmp_path: Path, write: Write) -> None:
    write("src/a.xml", "build/a.xml", "install/p/a.xml", "log/a.xml", "vendor/a.xml", "node_modules/a.xml", ".x/a.xml")
    write("vendor/COLCON_IGNORE", text="")
    assert checked(tmp_path) == ["src/a.xml"]
    assert checked(tmp_path, "vendor") == ["vendor/a.xml"]
    write("other/install/a.xml", "other/log/a.xml")  # not a workspace of colcon
    assert checked(tmp_path, "other") == ["other/install/a.xml", "other/log/a.xml"]


def test_what_git_ignores_is_not_looked_at(tmp_path: Path, write: Write) -> None:
    write("a.xml", "out/b.xml", "out/tracked.xml", "sub/out/c.xml", "sub/d.xml", "made/e.xml")
    write(".gitignore", text="out/\nmade/\n")
    for folder in (tmp_path, tmp_path / "sub"):  # one within the other
        subprocess.run(["git", "init", "-q"], cwd=folder, check=True)
    subprocess.run(["git", "add", "-f", "out/tracked.xml"], cwd=tmp_path, check=True)
    assert checked(tmp_path) == ["a.xml", "out/tracked.xml", "sub/d.xml", "sub/out/c.xml"]
    assert checked(tmp_path, "made") == ["made/e.xml"]  # named on purpose


def test_a_file_with_two_paths_is_one_file(tmp_path: Path, write: Write) -> None:
    write("trees/z.xml")
    (tmp_path / "a.xml").symlink_to("trees/z.xml")
    (tmp_path / "linked").symlink_to("trees")
    assert checked(tmp_path) == ["trees/z.xml"]


def test_built_xml_is_not_looked_at_beside_its_mission(tmp_path: Path, write: Write) -> None:
    write("missions/main.btq", text=MISSION)
    assert run_btq("build", "missions", "-o", "out", cwd=tmp_path)[0] == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["main.qreq.json", "main.xml"]
    assert run_btq("check", cwd=tmp_path)[1] == "No problems found in 1 file\n"
    assert run_btq("check", "out", cwd=tmp_path)[0] == 2
    (tmp_path / "missions" / "main.btq").unlink()
    assert run_btq("check", cwd=tmp_path)[1] == "No problems found in 1 file\n"  # the XML


# ---- the pool: where XML finds what it lacks ----

MAIN = '<root BTCPP_format="4"><BehaviorTree ID="Main"><SubTree ID="Dock"/></BehaviorTree></root>\n'
DOCK = '<root BTCPP_format="4"><BehaviorTree ID="Dock"><AlwaysSuccess/></BehaviorTree></root>\n'
CLEAN = "No problems found in 1 file\n"


@pytest.mark.parametrize(
    ("place", "mark", "is_found"),
    [
        ("trees/dock.xml", None, True),
        ("trees/deep/dock.xml", None, True),
        ("dock.xml", None, False),
        ("dock.xml", "btq.toml", True),
        ("dock.xml", ".git/HEAD", True),
        ("dock.xml", "package.xml", True),
        ("dock.xml", "trees/btq.toml", False),
        ("other/build/dock.xml", "btq.toml", False),
    ],
)
def test_what_a_named_file_lacks_is_looked_for(
    tmp_path: Path, write: Write, place: str, mark: str | None, is_found: bool
) -> None:
    write("trees/main.xml", text=MAIN)
    write(place, text=DOCK)
    if mark is not None:
        write(mark, text="")
    assert (run_btq("check", "trees/main.xml", cwd=tmp_path)[1] == CLEAN) is is_found


def test_a_repository_counts_before_a_package(tmp_path: Path, write: Write) -> None:
    write("a/trees/main.xml", text=MAIN)
    write("b/dock.xml", text=DOCK)
    write("a/package.xml", ".git/HEAD", text="")
    assert run_btq("check", "a", cwd=tmp_path)[1] == CLEAN


def test_a_folder_that_is_named_is_a_pool(tmp_path: Path, write: Write) -> None:
    write("a/main.xml", text=MAIN)
    write("b/dock.xml", text=DOCK)
    assert run_btq("check", cwd=tmp_path)[1] == "No problems found in 2 files\n"
    assert run_btq("check", "a", cwd=tmp_path)[0] == 1


def test_an_empty_text_in_an_editor_counts_instead_of_the_file(tmp_path: Path) -> None:
    root = '<root BTCPP_format="4"><BehaviorTree ID="{}">{}</BehaviorTree></root>'
    (tmp_path / ".git").mkdir()
    (tmp_path / "a.xml").write_text(root.format("A", '<SubTree ID="B"/>'))
    (tmp_path / "b.xml").write_text(root.format("B", "<AlwaysSuccess/>"))
    files = Files()
    files.overlay[str(tmp_path / "b.xml")] = ""
    ((group,), problems) = files.groups([str(tmp_path / "a.xml")], for_checks=True)
    assert (problems, group.workspace.files[str(tmp_path / "b.xml")].source) == ((), "")


def test_xml_of_any_name_is_xml_to_every_command(tmp_path: Path) -> None:
    (tmp_path / "dock.tree").write_text('<root BTCPP_format="4"><BehaviorTree ID="Dock"><Go/></BehaviorTree></root>\n')
    (tmp_path / "main.btq").write_text('include "dock.tree"\n\nBehaviorTree Main\n    SubTree Dock\n')
    assert run_btq("check", "main.btq", "dock.tree", cwd=tmp_path)[:2] == (0, "No problems found in 2 files\n")
    assert run_btq("build", cwd=tmp_path)[1] == "wrote main.xml\n"
    assert '<include path="dock.tree"/>' in (tmp_path / "main.xml").read_text()
    assert run_btq("build", "dock.tree", cwd=tmp_path) == (2, "", "btq: dock.tree: is XML already\n")
    assert run_btq("build", "--bundle", "-o", "out", cwd=tmp_path)[0] == 0
    (tmp_path / "dock.tree").write_text("<root><Go>")
    broken = "error[include-with-errors] `dock.tree` has"
    assert broken in run_btq("check", "main.btq", "--output-format", "concise", cwd=tmp_path)[1]
