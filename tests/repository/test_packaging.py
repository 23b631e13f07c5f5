"""What is installed is the whole package: the wheel that a source distribution makes, in an environment of its own."""

from __future__ import annotations

import re
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(*command: str | Path, cwd: Path) -> str:
    return subprocess.run(command, cwd=cwd, check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel made from what the source distribution holds, and from nothing else."""
    folder = tmp_path_factory.mktemp("packaging")
    run(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder, cwd=ROOT)
    (archive,) = folder.glob("*.tar.gz")
    with tarfile.open(archive) as source:
        source.extractall(folder, filter="data")
    run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder, cwd=folder / archive.name[:-7])
    (made,) = folder.glob("*.whl")
    return made


def test_the_wheel_holds_every_file_of_the_package(wheel: Path) -> None:
    files = {path.relative_to(ROOT).as_posix() for path in (ROOT / "btq_lang").rglob("*") if path.is_file()}
    known = {name for name in files if "__pycache__" not in name}
    assert "btq_lang/py.typed" in known
    assert {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith("btq_lang/")} == known


def test_links_of_the_readme_work_on_pypi(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith("/METADATA"))
        metadata = archive.read(name).decode()
    repository = "https://github.com/btq-lang/btq"
    assert f"Project-URL: Repository, {repository}\n" in metadata
    assert f"[The tutorial]({repository}/blob/main/docs/tutorial.md)" in metadata
    assert "](https://raw.githubusercontent.com/btq-lang/btq/main/docs/deliver.svg)" in metadata
    targets = re.findall(r"\]\(([^)]*)\)", metadata)
    assert [target for target in targets if not target.startswith(("https://", "#"))] == []


def test_the_installed_commands_work_elsewhere(wheel: Path, tmp_path: Path) -> None:
    venv.create(tmp_path / "env", with_pip=False, symlinks=True)
    python = tmp_path / "env" / "bin" / "python"
    run(sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-deps", wheel, cwd=tmp_path)
    where = run(python, "-c", "import btq_lang; print(btq_lang.__file__)", cwd=tmp_path)
    assert Path(where.strip()).is_relative_to(tmp_path)
    btq = python.with_name("btq")
    run(btq, "init", "robot", cwd=tmp_path)
    assert run(btq, "check", "robot", cwd=tmp_path) == "No problems found in 3 files\n"
    run(btq, "build", "robot", cwd=tmp_path)
    assert "<root BTCPP_format=" in (tmp_path / "robot" / "mission.xml").read_text(encoding="utf-8")
    assert run(btq, "explain", "missing-port", cwd=tmp_path).startswith("# missing-port\n")
    assert run(btq, "trace", "robot", "--format", "markdown", cwd=tmp_path).startswith(
        "## Requirements and qualities\n"
    )
