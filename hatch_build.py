"""Compile the parser, most checks, what requirements mean and what colours a text when a wheel is built with
`BTQ_COMPILE=1`; without it the wheel is pure Python.

One invariant: nothing compiled ever lies in the checkout.  The package is copied, compiled in a folder that is removed
when the wheel is made, and only the compiled modules are taken from there; the sources stay beside them in the wheel,
for tracebacks, and Python prefers the compiled ones.

Which modules: those where a check of many files spends its time, or a server while an editor waits for the first
colours of a large one.  Their records are written out as plain classes (tools/native_records.py), of which mypyc makes
structures of C; a class with a `cached_property` must not be there, for mypyc makes one of it that is worked out every
time.

What mypyc 2.4 makes wrong, and how to tell: of a class that is said to be `acyclic`, though most are, Python lets go in
a way that writes before the object, where 50 objects are let go of inside each other.  It took a `sum` of floats,
multiplied, for a whole number: `fsum` is none.  In `x.y is a record and x.y.z …` it lets go of an `x.y` that it never
took, if `x` is not compiled: the C compiler says that it "may be used uninitialized", and the build of a wheel fails;
that of the test does not, for nothing is optimised there.  A name of its own for `x.y` helps.
"""

from __future__ import annotations

import os
import runpy
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PACKAGE = "btq_lang"
COMPILED = (
    "near",
    "quantities",
    "diagnostics",
    "characters",
    "words",
    "node_clauses",
    "syntax",
    "scan",
    "item_words",
    "blocks",
    "lexer",
    "mentions",
    "token_list",
    "cursor",
    "conditions",
    "claims",
    "clauses",
    "attributes",
    "nodes",
    "parser",
    "symbols",
    "constraints",
    "placeholders",
    "script/tokens",
    "catalog/kinds",
    "catalog/literals",
    "catalog/names",
    "catalog/nodes",
    "requirements/__init__",
    "requirements/attach",
    "requirements/budgets",
    "requirements/clauses",
    "requirements/composition",
    "requirements/durations",
    "requirements/memory",
    "requirements/model",
    "requirements/names",
    "requirements/paths",
    "requirements/reader",
    "requirements/spans",
    "requirements/trees",
    "checks/__init__",
    "checks/answers",
    "checks/bounds",
    "checks/budgets",
    "checks/children",
    "checks/clauses",
    "checks/conditions",
    "checks/constants",
    "checks/counts",
    "checks/demanded",
    "checks/demands",
    "checks/empty",
    "checks/entries",
    "checks/includes",
    "checks/kinds",
    "checks/limits",
    "checks/literals",
    "checks/lookups",
    "checks/measures",
    "checks/misspelt",
    "checks/mixed_types",
    "checks/names",
    "checks/odds",
    "checks/outputs",
    "checks/placeholders",
    "checks/pointers",
    "checks/ports",
    "checks/preconditions",
    "checks/prose",
    "checks/qualities",
    "checks/reactive",
    "checks/renewals",
    "checks/repeated",
    "checks/requirements",
    "checks/results",
    "checks/scripts",
    "checks/seen",
    "checks/signals",
    "checks/statuses",
    "checks/strings",
    "checks/swallowing",
    "checks/trees",
    "checks/unenforced",
    "checks/unreachable",
    "checks/unused",
    "checks/view",
    "checks/writers",
    "features/looks",
    "features/stretches",
)
# mypyc makes C of typed Python and calls setuptools to have it compiled.
REQUIRED = ("mypy[mypyc]>=2.0,<3", "setuptools>=64")

# At level 3 the parser is 3 % faster and the code an eighth larger; nobody debugs the C, and a wheel is 4 MB without.
DEFAULTS = {"MYPYC_OPT_LEVEL": "2", "MYPYC_DEBUG_LEVEL": "0"}
COLD = "cold_paths.h"


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


def compile_package(root: Path, folder: Path) -> list[Path]:
    """Compile the package of a checkout in another folder.

    Returns:
        The compiled modules, in `folder` where they belong beside the package's sources.

    Raises:
        RuntimeError: mypyc or the C compiler failed; the message is what they said.
    """
    shutil.copytree(root / PACKAGE, folder / PACKAGE, ignore=shutil.ignore_patterns("__pycache__"))
    modules = [f"{PACKAGE}/{module}.py" for module in COMPILED]
    modules.append(_write_records_out(root, folder, modules))
    shutil.copy(root / "tools" / COLD, folder)  # where the C compiler runs
    # What is in the environment stands for what Python was built with, which it is to add to.
    flags = " ".join((sysconfig.get_config_var("CFLAGS") or "", *_flags(), os.environ.get("CFLAGS", ""))).strip()
    environment = DEFAULTS | os.environ | {"MYPYPATH": str(folder), "CFLAGS": flags}
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    options = ("--config-file", str(root / "pyproject.toml"), "--python-version", version)
    command = (sys.executable, "-m", "mypyc", *options, *modules)
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"mypyc failed:\n{done.stdout}{done.stderr}")
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    return sorted((*folder.glob(f"*{suffix}"), *(folder / PACKAGE).rglob(f"*{suffix}")))


def _write_records_out(root: Path, folder: Path, modules: list[str]) -> str:
    """Write out the records of the modules to compile; the module of their base, which is compiled, too."""
    tool = runpy.run_path(str(root / "tools" / "native_records.py"))
    for module in modules:
        path = folder / module
        path.write_text(tool["natively"](path.read_text(encoding="utf-8"), PACKAGE), encoding="utf-8")
    base = f"{PACKAGE}/{tool['BASE_MODULE']}.py"
    (folder / base).write_text(tool["BASE"], encoding="utf-8")
    return base


def _flags() -> tuple[str, ...]:
    """What the C compiler is told besides what Python and mypyc say.

    A language server has all of a compiled library in its memory, for nearly each page has a line that runs: 7.4 MB.
    With what is cold put apart, and no names but those that Python looks for, it is 5.4, and the parser is a twentieth
    faster: nobody else can replace a function that is hidden, so the small ones are put in place of their calls.
    """
    return () if sys.platform == "win32" else ("-fvisibility=hidden", "-include", COLD)
