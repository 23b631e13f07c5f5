"""`btq schema` as a person runs it."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq
from lxml import etree

from btq_lang.workspace.project_schema import project_schema

Run = Callable[..., subprocess.CompletedProcess[str]]

MISSION = 'include "skills.btq"\n\nBehaviorTree Main\n    ->\n        Drive (to = home)\n'
PALETTE = '<root BTCPP_format="4"><TreeNodesModel><Action ID="Lift"/></TreeNodesModel></root>\n'
TREES = '<root BTCPP_format="4"><BehaviorTree ID="Other"><Lift/></BehaviorTree></root>\n'


@pytest.fixture
def btq(tmp_path: Path) -> Run:
    def run(*arguments: str, stdin: str = "") -> subprocess.CompletedProcess[str]:
        return subprocess.CompletedProcess(arguments, *run_btq(*arguments, cwd=tmp_path, stdin=stdin))

    return run


@pytest.fixture
def project(tmp_path: Path) -> Path:
    texts = {"skills.btq": "Action Drive\n    input to\n", "main.btq": MISSION, "a.xml": PALETTE, "b.xml": TREES}
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def names(xsd: str) -> set[str]:
    """The custom nodes in a schema, and the trees that it proposes."""
    root = etree.fromstring(xsd.encode())
    found = root.xpath(
        "xs:group/xs:choice/xs:element/@name | xs:simpleType[@name='tree']//@value",
        namespaces={"xs": "http://www.w3.org/2001/XMLSchema"},
    )
    return {name for name in found if name in ("Drive", "Lift", "Dock", "Sequnce", "TryCatch", "Main", "Other")}


def test_the_nodes_of_a_project_in_both_languages(btq: Run, project: Path) -> None:
    done = btq("schema", "xsd")
    assert (done.returncode, done.stderr) == (0, "")
    assert names(done.stdout) == {"Drive", "Lift", "TryCatch", "Main", "Other"}
    assert btq("schema", "xsd", ".", "a.xml").stdout == done.stdout


def test_of_one_file_with_what_it_includes(btq: Run, project: Path) -> None:
    assert names(btq("schema", "xsd", "main.btq").stdout) == {"Drive", "TryCatch", "Main"}
    assert names(btq("schema", "xsd", "-", stdin=MISSION).stdout) == {"Drive", "TryCatch", "Main"}


def test_for_a_version_of_the_engine(btq: Run, project: Path) -> None:
    assert names(btq("schema", "xsd", "--target", "4.6").stdout) == {"Drive", "Lift", "Main", "Other"}
    (project / "btq.toml").write_text('engine = ["4.6", "4.8"]\n', encoding="utf-8")
    done = btq("schema", "xsd")
    assert names(done.stdout) == {"Drive", "Lift", "Main", "Other"}
    assert done.stdout.splitlines()[1] == (
        "<!-- The nodes of BehaviorTree.CPP 4.8 and of this project, by btq schema xsd. -->"
    )


@pytest.mark.parametrize(
    ("project_file", "root", "version"),
    [
        ("", 'BTCPP_format="4"', "4.10"),
        ("", "", "4.10"),  # nothing says what it is for
        ("", 'BTCPP_format="3"', "4.6"),  # the nearest that has a schema
        ('engine = "3.8"\n', 'BTCPP_format="4"', "4.6"),
        ('engine = "4.8"\n', 'BTCPP_format="3"', "4.8"),
        ('nodes = ["nav2-humble"]\n', "", "4.6"),
        ('nodes = ["nav2-jazzy"]\n', "", "4.10"),
    ],
)
def test_it_is_for_the_version_that_the_files_are_for(
    btq: Run, tmp_path: Path, project_file: str, root: str, version: str
) -> None:
    (tmp_path / "btq.toml").write_text(project_file, encoding="utf-8")
    (tmp_path / "a.xml").write_text(TREES.replace('BTCPP_format="4"', root), encoding="utf-8")
    told = btq("schema", "xsd", "a.xml").stdout.splitlines()[1]
    assert told == f"<!-- The nodes of BehaviorTree.CPP {version} and of this project, by btq schema xsd. -->"


def test_nodes_that_the_checks_call_unknown_are_left_out(btq: Run, project: Path) -> None:
    (project / "b.xml").write_text(TREES.replace("<Lift/>", "<Sequnce><Dock/></Sequnce>"), encoding="utf-8")
    assert names(btq("schema", "xsd").stdout) == {"Drive", "Lift", "Dock", "TryCatch", "Main", "Other"}
    (project / "btq.toml").write_text('ignore = ["unknown-node"]\n', encoding="utf-8")
    assert "Sequnce" in names(btq("schema", "xsd").stdout)


def test_it_is_written_to_a_file_whole_or_not_at_all(btq: Run, project: Path) -> None:
    done = btq("schema", "xsd", "-o", "out/btq.xsd")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (project / "out/btq.xsd").read_text(encoding="utf-8") == btq("schema", "xsd").stdout
    for target in ("main.btq", "b.xml"):
        done = btq("schema", "xsd", "-o", target)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == f"btq schema: -o {target} may overwrite a mission; choose another file name\n"
    assert (project / "b.xml").read_text(encoding="utf-8") == TREES
    (project / "file").write_text("", encoding="utf-8")
    assert btq("schema", "xsd", "-o", "file/btq.xsd").returncode == 2
    assert btq("schema", "xsd", "missing.btq", "-o", "new.xsd").returncode == 2
    assert not (project / "new.xsd").exists()


def test_files_that_cannot_be_read_whole(btq: Run, project: Path) -> None:
    (project / "main.btq").write_text("Action Dock\n\nBehaviorTree Main\n    -> (\n", encoding="utf-8")
    done = btq("schema", "xsd")
    assert (done.returncode, done.stderr) == (
        1,
        "btq schema: main.btq has errors, so nodes may be missing; run btq check\n",
    )
    assert names(done.stdout) >= {"Drive", "Lift", "Dock"}


def test_a_folder_without_missions(btq: Run, tmp_path: Path) -> None:
    done = btq("schema", "xsd")
    assert (done.returncode, names(done.stdout)) == (0, {"TryCatch"})
    empty = "no .btq file and no BehaviorTree.CPP XML below ./"
    assert done.stderr == f"btq schema: {empty}; the schema has only the nodes of the engine\n"


def test_the_schema_of_the_project_file(btq: Run, tmp_path: Path) -> None:
    done = btq("schema", "project")
    assert (done.returncode, json.loads(done.stdout), done.stderr) == (0, project_schema(), "")
    assert btq("schema", "project", "-o", "btq.schema.json").returncode == 0
    assert (tmp_path / "btq.schema.json").read_text(encoding="utf-8") == done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("project", "."), "btq schema: `project` takes no path: its schema is the same for every project\n"),
        (("xsd", ""), "btq schema: empty path; `.` is this folder\n"),
    ],
)
def test_usage(btq: Run, arguments: tuple[str, ...], message: str) -> None:
    done = btq("schema", *arguments)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", message)
