"""An installed BehaviorTree.CPP: finding it, building the program that runs trees in it, and running that.

One invariant: a program is built once for an engine, and again when the engine or the program is another one.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from btq_lang.catalog.versions import at_least
from btq_lang.util.caches import cache_folder
from btq_lang.util.record import Record


class NoInstalledEngine(Exception):
    """No tree can be run in an engine; the message says why, and what to do."""


class EngineFailure(Exception):
    """The engine ended its process; the message says how."""


class EngineTooSlow(Exception):
    """The engine gave no answer in time; the message says in which."""


class InstalledEngine(Record):
    """An engine.

    Attributes:
        program: runs a tree in it.
        version: of the engine, such as `4.10.0`.
    """

    program: str
    version: str

    @property
    def line(self) -> str:
        """Its version as missions name it, such as `4.10`."""
        return ".".join(self.version.split(".")[:2])

    def run(self, job: Mapping[str, object]) -> dict[str, Any]:
        """What came of a job; `replay.py` and `main.cpp` say what is in both.

        Raises:
            EngineFailure: the engine ended its process.
            EngineTooSlow: it did not answer in time; maybe it never returns.
        """
        text = json.dumps({**job, "seconds": _SECONDS})
        ran = subprocess.run([self.program], input=text, capture_output=True, text=True, errors="replace")
        _, mark, answer = ran.stdout.rpartition(_MARK)
        if not mark:
            if ran.returncode == -_ALARM:
                raise EngineTooSlow(f"it takes longer than {_SECONDS} s, if it ever ends")
            raise EngineFailure(f"it ends its process: {ran.stderr.strip() or f'signal {-ran.returncode}'}")
        answered: dict[str, Any] = json.loads(answer)
        return answered


def installed_engine(prefix: str) -> InstalledEngine:
    """The engine in a prefix; empty: that of BTQ_ENGINE, or else the one that CMake finds.

    Raises:
        NoInstalledEngine: there is none, or nothing to build a program with.
    """
    if sys.platform != "linux":
        raise NoInstalledEngine("scenarios run in an engine on Linux only, where its time can be controlled")
    prefix = prefix or os.environ.get("BTQ_ENGINE", "").split(os.pathsep)[0]
    if prefix and not os.path.isdir(prefix):
        raise NoInstalledEngine(f"no folder `{prefix}`; give the prefix under which BehaviorTree.CPP is installed")
    # What CMake finds by itself depends on where a sourced ROS points it.
    found_by = prefix or ":".join(os.environ.get(name, "") for name in ("CMAKE_PREFIX_PATH", "AMENT_PREFIX_PATH"))
    sources = b"".join((_SOURCES / name).read_bytes() for name in _NAMES)
    folder = (
        Path(cache_folder(), "engine") / hashlib.sha256(sources + os.path.abspath(found_by).encode()).hexdigest()[:16]
    )
    program = folder / "program"
    if not _is_of(folder):
        _build(prefix, folder)
    started = _ran(str(program), "--version")
    if started.returncode:
        raise NoInstalledEngine(f"the program for the engine cannot be started: {started.stderr.strip()}")
    version = started.stdout.strip()
    if not at_least(version, "4.6"):
        raise NoInstalledEngine(f"the engine is {version}; btq runs scenarios in 4.6 and later ones")
    return InstalledEngine(str(program), version)


def _build(prefix: str, folder: Path) -> None:
    """Build the program, and put it into a folder with what says of which library it is."""
    if not shutil.which("cmake"):
        raise NoInstalledEngine("no CMake on PATH; install cmake and a C++ compiler")
    with tempfile.TemporaryDirectory() as build:
        options = ["-DCMAKE_BUILD_TYPE=Release", *([f"-DCMAKE_PREFIX_PATH={prefix}"] if prefix else [])]
        configured = _ran("cmake", "-S", str(_SOURCES), "-B", build, *options)
        if configured.returncode:
            raise NoInstalledEngine(_why_not(configured.stderr, prefix))
        built = _ran("cmake", "--build", build)
        if built.returncode:
            errors = [line for line in (built.stdout + built.stderr).splitlines() if "error" in line]
            raise NoInstalledEngine(f"the program for the engine cannot be built: {' '.join(errors[:1])}")
        library = Path(build, "library.txt").read_text(encoding="utf-8")
        ready = Path(build, "ready")
        ready.mkdir()
        shutil.copy(Path(build, "program"), ready)
        (ready / "library.txt").write_text(f"{library}\n{_stamp(library)}", encoding="utf-8")
        shutil.rmtree(folder, ignore_errors=True)
        folder.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(ready, folder)


def _why_not(complaint: str, prefix: str) -> str:
    if "behaviortree_cpp" in complaint:
        where = f"in `{prefix}`" if prefix else "by CMake"
        return (
            f"no BehaviorTree.CPP 4 found {where}; install it, as with "
            "`sudo apt install ros-jazzy-behaviortree-cpp` and `source /opt/ros/jazzy/setup.bash`, "
            "or name the prefix under which it is: --engine PREFIX"
        )
    if "CMAKE_CXX_COMPILER" in complaint:
        return "no C++ compiler found by CMake; install one, such as g++"
    return f"CMake cannot configure the program for the engine: {complaint.strip()}"


def _is_of(folder: Path) -> bool:
    """Whether the program in a folder is of the library that is installed."""
    try:
        library, stamp = (folder / "library.txt").read_text(encoding="utf-8").splitlines()
        return stamp == _stamp(library)
    except (OSError, ValueError):
        return False


def _stamp(library: str) -> str:
    status = os.stat(library)
    return f"{status.st_mtime_ns} {status.st_size}"


def _ran(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, errors="replace")


_SOURCES: Final = Path(__file__).parent / "engine_program"
_NAMES: Final = ("CMakeLists.txt", "main.cpp", "clock.cpp", "clock.hpp")
_MARK: Final = "\x1e"  # before the answer, which follows what the engine prints
_ALARM: Final = 14  # the signal
_SECONDS: Final = 60
