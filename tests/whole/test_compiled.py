"""What is compiled (hatch_build.py) says the same as the pure form: tree, offsets, diagnostics and semantic tokens.

It is compiled into a temporary folder, without optimisation, and runs in a process of its own, since one process
imports a package only once.  Skipped, saying so, where the tools to compile it are missing.
"""

from __future__ import annotations

import importlib.util
import json
import os
import random
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from missions import mission
from rule_pages import blocks
from seeds import SEED, share_of
from torn_texts import CLASSIC, EXAMPLES, SHORT, torn

ROOT = Path(__file__).resolve().parents[2]

TELL = """
import json, sys
from btq_lang import checks, parser
from btq_lang.syntax import tree as syntax
from btq_lang.syntax.script import parser as script
from btq_lang.ide.colours import colours
from btq_lang.workspace.workspace import Workspace

def told(part):
    if type(part) in (list, tuple):
        return [told(element) for element in part]
    if hasattr(part, "__match_args__"):
        return [type(part).__name__, *(told(getattr(part, field)) for field in type(part).__match_args__)]
    return repr(part)

print(json.dumps([parser.__file__, syntax.__file__, script.__file__]))
for line in sys.stdin:
    text = json.loads(line)
    parsed = parser.parse(text)
    workspace = Workspace.of({"main.btq": text})
    found = checks.check(workspace, "main.btq")
    data = colours(workspace, "main.btq", "utf-16").data
    print(json.dumps(told([parsed.entries, parsed.diagnostics, parsed.tokens, found, data])))
"""


LEFT_BEHIND = """
import gc, sys
from btq_lang.ide.completion import complete
from btq_lang.ide.hover import hover
from btq_lang.lsp.session import Session

text, path, session = sys.stdin.read(), "/nowhere/main.btq", Session()
session.open[path] = text
session.reload()

def key(place):
    session.edit(path, text[:place] + "x" + text[place:])
    session.findings(path)
    session.let_go()
    workspace = session.workspace_of(path)
    complete(workspace, path, place)
    hover(workspace, path, place)

key(0)  # the first one imports
gc.collect()
gc.disable()
for place in range(0, len(text), len(text) // 20):
    key(place)
print(gc.collect())
"""


def answers(package: Path, texts: list[str], **environment: str) -> tuple[list[Path], list[str]]:
    """The results of the parser, the checks and the colours of a package for each text, and a module of each."""
    said = subprocess.run(
        [sys.executable, "-c", TELL],
        input="".join(json.dumps(text) + "\n" for text in texts),
        cwd=package,  # which stands first in the path of `-c`
        env=os.environ | {"PYTHONPATH": str(package)} | environment,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    return [Path(file) for file in json.loads(said[0])], said[1:]


def deep(levels: int) -> str:
    """A tree of nodes in nodes: letting go of it is nested deeper than Python lets go of objects in one go."""
    inner = "".join(f"{'  ' * level}->\n" for level in range(1, levels))
    return f"BehaviorTree A\n{inner}{'  ' * levels}Action X (a = b) satisfies r\n"


def hatch_build() -> Any:
    """The module that compiles, which stands outside of the package."""
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package compiled as for a wheel."""
    for module in ("hatchling", "mypyc", "setuptools"):
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"the parser cannot be compiled here: {module} is not installed")
    if shutil.which(os.environ.get("CC", "cc")) is None:
        pytest.skip("the parser cannot be compiled here: there is no C compiler")
    folder = tmp_path_factory.mktemp("compiled")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MYPYC_OPT_LEVEL", "0")
        patch.setenv("CFLAGS", "-Wno-all")  # to look for what it warns of takes gcc twice as long as to compile
        hatch_build().compile_package(ROOT, folder)
    return folder


def test_what_is_compiled_reads_and_checks_as_the_pure_form(compiled: Path) -> None:
    draw = random.Random(SEED)
    texts = [path.read_bytes().decode("utf-8") for path in EXAMPLES]
    texts += [text for _, language, text in blocks() if language == "btq"]
    texts += [mission(1_000, 2, "classic"), mission(1_000, 2, "short")]
    texts += [deep(60), f"context c : {' * '.join('a' * 80)}"]
    torn_texts = [torn(draw.choice((CLASSIC, SHORT, *texts[: len(EXAMPLES)])), draw) for _ in range(150)]
    texts += share_of(torn_texts, 4)
    pure_files, pure = answers(ROOT, texts)
    compiled_files, by_compiled = answers(compiled, texts, PYTHONMALLOC="debug")  # writing beside an object is fatal
    names = ("parser.py", "syntax/tree.py", "syntax/script/parser.py")
    assert pure_files == [ROOT / "btq_lang" / name for name in names]
    assert [file.parent for file in compiled_files] == [(compiled / "btq_lang" / name).parent for name in names]
    assert {file.suffix for file in compiled_files}.isdisjoint({".py"})
    assert len(pure) == len(by_compiled) == len(texts)
    for text, expected, found in zip(texts, pure, by_compiled, strict=True):
        assert found == expected, text


def test_keys_and_questions_leave_nothing_to_the_garbage_collector(compiled: Path) -> None:
    """mypyc makes a ring of every function inside of another one: what the outer one holds stays with it."""
    for package in (ROOT, compiled):
        command = [sys.executable, "-c", LEFT_BEHIND]
        env = os.environ | {"PYTHONPATH": str(package)}
        done = subprocess.run(
            command, input=mission(100, 2, "classic"), cwd=package, env=env, capture_output=True, text=True, check=True
        )
        assert done.stdout == "0\n", package


def test_nothing_compiled_lies_in_the_checkout(compiled: Path) -> None:
    assert not [*ROOT.glob("*.so"), *(ROOT / "btq_lang").rglob("*.so"), *(ROOT / "btq_lang").rglob("*.pyd")]


def test_what_is_compiled_has_no_property_that_is_worked_out_once() -> None:
    """mypyc makes of a `cached_property` in a compiled class one that is worked out every time."""
    modules = hatch_build().compiled_sources(ROOT / "btq_lang")
    assert [path.name for path in modules if "cached_property" in path.read_text(encoding="utf-8")] == []
