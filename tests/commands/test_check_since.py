"""`btq check --since`: what changed against a revision, and what depends on it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from in_process import run_btq

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="there is no git to ask for changes")

WRONG = "BehaviorTree {name}\n    Sequnce\n        Dock\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A repository with a commit: missions with an error each; `main` includes `mid`, and that `low`."""
    for name, includes in {"main": "mid", "mid": "low", "low": "", "other": ""}.items():
        include = f'include "{includes}.btq"\n' if includes else ""
        (tmp_path / f"{name}.btq").write_text(include + WRONG.format(name=name))
    git(tmp_path, "init", "-q", "-b", "main")
    commit(tmp_path)
    return tmp_path


def git(folder: Path, *arguments: str) -> None:
    names = ("-c", "user.name=a", "-c", "user.email=a@example.org")
    subprocess.run(["git", *names, *arguments], cwd=folder, check=True, capture_output=True)


def commit(folder: Path) -> None:
    git(folder, "add", "-A")
    git(folder, "commit", "-q", "-m", "all")


def found(folder: Path, *arguments: str, since: str = "HEAD") -> list[str]:
    """The files with findings."""
    options = ("--output-format", "concise", "--select", "unknown-node", "--since", since, *arguments)
    code, printed, errors = run_btq("check", *options, cwd=folder)
    assert errors == ""
    names = [line.partition(":")[0] for line in printed.splitlines()[:-1]]
    assert code == bool(names)
    return names


def test_nothing_has_changed(folder: Path) -> None:
    message = "No files were checked: nothing has changed since HEAD\n"
    assert run_btq("check", "--since", "HEAD", cwd=folder) == (0, message, "")


def test_a_changed_file_and_those_that_include_it(folder: Path) -> None:
    with (folder / "mid.btq").open("a") as file:
        file.write("# changed\n")
    assert found(folder) == ["main.btq", "mid.btq"]
    git(folder, "add", "-A")
    assert found(folder) == ["main.btq", "mid.btq"]
    commit(folder)
    assert found(folder) == []
    assert found(folder, since="HEAD~1") == ["main.btq", "mid.btq"]
    assert found(folder, "main.btq", "other.btq", since="HEAD~1") == ["main.btq"]


def test_new_removed_and_renamed_files(folder: Path) -> None:
    (folder / "new.btq").write_text(WRONG.format(name="new"))
    assert found(folder) == ["new.btq"]
    (folder / "low.btq").rename(folder / "deep.btq")
    assert found(folder) == ["deep.btq", "main.btq", "mid.btq", "new.btq"]


def test_a_new_file_in_front_of_an_included_one(folder: Path) -> None:
    """`lib/a.btq` includes the `low.btq` of an include path until there is one beside it."""
    (folder / "btq.toml").write_text('include-paths = ["."]\n')
    (folder / "lib").mkdir()
    (folder / "lib" / "a.btq").write_text('include "low.btq"\n' + WRONG.format(name="a"))
    commit(folder)
    (folder / "lib" / "low.btq").write_text("Action Dock\n")
    assert found(folder, "lib/a.btq") == ["lib/a.btq"]


def test_imported_requirements_concern_all(folder: Path) -> None:
    (folder / "btq.toml").write_text('[requirements]\nimport = ["reqs.csv"]\n')
    (folder / "reqs.csv").write_text("id\nR1\n")
    commit(folder)
    assert found(folder) == []
    (folder / "reqs.csv").write_text("id\nR2\n")
    assert found(folder) == ["low.btq", "main.btq", "mid.btq", "other.btq"]


def test_the_project_file_concerns_all(folder: Path) -> None:
    (folder / "btq.toml").write_text("ignore = []\n")
    assert found(folder) == ["low.btq", "main.btq", "mid.btq", "other.btq"]


def test_files_of_a_factory_depend_on_each_other(folder: Path) -> None:
    (folder / "btq.toml").write_text('[[factory]]\nname = "robot"\nload = ["other.btq", "low.btq"]\n')
    commit(folder)
    with (folder / "other.btq").open("a") as file:
        file.write("# changed\n")
    assert found(folder) == ["low.btq", "other.btq"]


def test_xml_depends_on_the_trees_of_its_pool(folder: Path) -> None:
    def xml(tree: str, runs: str) -> str:
        return (
            f'<root BTCPP_format="4"><BehaviorTree ID="{tree}"><Sequnce>'
            f'<SubTree ID="{runs}"/></Sequnce></BehaviorTree></root>\n'
        )

    for name, runs in {"top": "below", "below": "deep", "deep": "deep2", "deep2": "deep2", "alone": "alone"}.items():
        (folder / f"{name}.xml").write_text(xml(name, runs))
    commit(folder)
    (folder / "deep.xml").write_text(xml("deep", "deep2") + "<!-- changed -->\n")
    assert found(folder) == ["below.xml", "deep.xml", "top.xml"]
    (folder / "deep.xml").unlink()
    assert found(folder) == ["below.xml", "top.xml"]


@pytest.mark.parametrize(
    ("revision", "message"),
    [
        ("nowhere", "git does not know the revision `nowhere`"),
        ("HEAD..HEAD", "expected one revision, which the files are compared with, not `HEAD..HEAD`"),
        ("--output=x", "git does not know the revision `--output=x`"),
    ],
)
def test_a_revision_that_is_none(folder: Path, revision: str, message: str) -> None:
    expected = (2, "", f"btq check: --since: {message}\n")
    assert run_btq("check", f"--since={revision}", cwd=folder) == expected


def test_a_folder_without_a_repository(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG.format(name="main"))
    code, printed, errors = run_btq("check", "--since", "HEAD", cwd=tmp_path)
    assert (code, printed) == (2, "")
    assert errors.startswith("btq check: --since: git: not a git repository")


def test_what_since_cannot_do(folder: Path) -> None:
    message = "btq check: --since cannot be used for standard input\n"
    assert run_btq("check", "--since", "HEAD", "-", cwd=folder) == (2, "", message)
    message = "btq check: --update-baseline needs all findings; leave out --since\n"
    options = ("--since", "HEAD", "--baseline", "a.json", "--update-baseline")
    assert run_btq("check", *options, cwd=folder) == (2, "", message)


def test_xml_depends_on_what_its_pool_has_lost(tmp_path: Path) -> None:
    def xml(content: str) -> str:
        return f'<root BTCPP_format="4">{content}</root>'

    odd = xml('<BehaviorTree ID="Main"><Sequence><Go goal="1"/><Dock/></Sequence></BehaviorTree>')
    (tmp_path / "main.xml").write_text(odd.replace("<Dock/>", "<Sequnce/>"))
    (tmp_path / "other.xml").write_text(odd.replace("Go", "Stay").replace("<Dock/>", "<Sequnce/>"))
    models = tmp_path / "lib" / "models.xml"
    models.parent.mkdir()
    models.write_text(xml('<TreeNodesModel><Action ID="Go"><input_port name="goal"/></Action></TreeNodesModel>'))
    git(tmp_path, "init", "-q", "-b", "main")
    commit(tmp_path)
    assert found(tmp_path) == []
    models.write_text(xml("<TreeNodesModel/>"))
    assert found(tmp_path) == ["main.xml"]
    models.unlink()
    assert found(tmp_path) == ["main.xml"]
