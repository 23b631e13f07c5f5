"""`btq test --engine` where there is no engine; `engine/test_engine_scenarios.py` has what it does with one."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from in_process import run_btq

TREE = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Deliver">
    <MoveTo location="A"/>
  </BehaviorTree>
</root>
"""
CASES = """\
include "tree.xml"

scenario "all is well"
    expect mission succeeds
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "tree.xml").write_text(TREE, encoding="utf-8")
    (tmp_path / "cases.btq").write_text(CASES, encoding="utf-8")
    (tmp_path / "empty").mkdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("BTQ_ENGINE", raising=False)
    return tmp_path


def refusal(folder: Path, prefix: str) -> str:
    code, out, err = run_btq("test", "cases.btq", "--engine", prefix, cwd=folder)
    assert (code, out) == (2, "")
    return err


def test_there_is_no_such_folder(folder: Path) -> None:
    assert refusal(folder, "nowhere") == (
        "btq test: --engine: no folder `nowhere`; give the prefix under which BehaviorTree.CPP is installed\n"
    )


def test_it_is_another_system(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    assert refusal(folder, "empty") == (
        "btq test: --engine: scenarios run in an engine on Linux only, where its time can be controlled\n"
    )


def test_there_is_no_cmake(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(folder))
    assert refusal(folder, "empty") == "btq test: --engine: no CMake on PATH; install cmake and a C++ compiler\n"


@pytest.mark.skipif(not (shutil.which("cmake") and shutil.which("c++")), reason="no CMake, or no C++ compiler")
def test_there_is_no_engine(folder: Path) -> None:
    """Also where one is installed elsewhere: CMake would find that, too."""
    (folder / "empty" / "behaviortree_cppConfig.cmake").write_text("set(behaviortree_cpp_FOUND FALSE)\n")
    assert refusal(folder, "empty") == (
        "btq test: --engine: no BehaviorTree.CPP 4 found in `empty`; install it, as with "
        "`sudo apt install ros-jazzy-behaviortree-cpp` and `source /opt/ros/jazzy/setup.bash`, "
        "or name the prefix under which it is: --engine PREFIX\n"
    )


@pytest.mark.skipif(not shutil.which("cmake"), reason="no CMake")
def test_there_is_no_compiler(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CXX", "no-such-compiler")
    assert refusal(folder, "empty") == "btq test: --engine: no C++ compiler found by CMake; install one, such as g++\n"
