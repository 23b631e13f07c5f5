"""Compile the parser when a wheel is built with `BTQ_COMPILE=1`; without it the wheel is pure Python.

One invariant: nothing compiled ever lies in the checkout.  The package is copied, compiled in a folder that is removed
when the wheel is made, and only the compiled modules are taken from there; the sources stay beside them in the wheel,
for tracebacks, and Python prefers the compiled ones.

A class with a `cached_property` must not be in these modules: mypyc makes of it one that is worked out every time.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PACKAGE = "btq_lang"
COMPILED = ("lexer.py", "parser.py", "grammar", "syntax")
# mypyc makes C of typed Python and calls setuptools to have it compiled.
REQUIRED = ("mypy[mypyc]>=2.0,<3", "setuptools>=64")

# At level 3 the parser is 3 % faster and the code an eighth larger; nobody debugs the C, and a wheel is 4 MB without.
DEFAULTS = {"MYPYC_OPT_LEVEL": "2", "MYPYC_DEBUG_LEVEL": "0"}


def is_wanted() -> bool:
    return os.environ.get("BTQ_COMPILE", "") not in ("", "0")


class CompileHook(BuildHookInterface[Any]):
    """Hatchling's hook (https://hatch.pypa.io/latest/plugins/build-hook/custom/) for the target `wheel`."""

    def dependencies(self) -> list[str]:
        return list(REQUIRED) if is_wanted() else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile and add the modules; `editable` installs run the checkout and stay pure."""
        if not is_wanted() or version == "editable":
            return
        self.folder = Path(tempfile.mkdtemp(prefix="btq-compile-"))
        compiled = compile_package(Path(self.root), self.folder)
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        build_data["force_include"] |= {str(file): str(file.relative_to(self.folder)) for file in compiled}

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        if hasattr(self, "folder"):
            shutil.rmtree(self.folder, ignore_errors=True)


def compiled_sources(package: Path) -> list[Path]:
    """The modules of a package that are compiled."""
    named = [package / name for name in COMPILED]
    return sorted(path for each in named for path in ([each] if each.is_file() else each.rglob("*.py")))


def compile_package(root: Path, folder: Path) -> list[Path]:
    """Compile the package of a checkout in another folder.

    Returns:
        The compiled modules, in `folder` where they belong beside the package's sources.

    Raises:
        RuntimeError: mypyc or the C compiler failed; the message is what they said.
    """
    shutil.copytree(root / PACKAGE, folder / PACKAGE, ignore=shutil.ignore_patterns("__pycache__"))
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    options = ["--config-file", str(root / "pyproject.toml"), "--python-version", version]
    # What is not compiled is not judged here: the libraries that it imports need not be there.
    options += ["--no-site-packages", "--follow-imports", "silent"]
    modules = [str(path.relative_to(folder)) for path in compiled_sources(folder / PACKAGE)]
    command = (sys.executable, "-m", "mypyc", *options, *modules)
    environment = DEFAULTS | os.environ | {"MYPYPATH": str(folder), "CFLAGS": _flags()}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"mypyc failed:\n{done.stdout}{done.stderr}")
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    return sorted((*folder.glob(f"*{suffix}"), *(folder / PACKAGE).rglob(f"*{suffix}")))


def _flags() -> str:
    """The flags of the C compiler: those in the environment replace those that Python was built with, so it gets both.

    A function that is hidden cannot be replaced by somebody else's, so calls go straight to it: a twentieth faster.
    """
    hidden = "" if sys.platform == "win32" else "-fvisibility=hidden"
    return " ".join((sysconfig.get_config_var("CFLAGS") or "", hidden, os.environ.get("CFLAGS", ""))).strip()
