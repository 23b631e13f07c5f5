"""btq in a browser's Python: Pyodide, here in Node.js, which has no packages and no processes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from installed import ROOT, STORE, there

PROGRAM = """\
import sys
from pathlib import Path

import btq_lang as btq
from btq_lang.cli import main

Path("main.btq").write_text('''\\
include "pick.xml"

BehaviorTree   Main
    Rety (num_attempts = 3)
        SubTree Pick
''')
Path("pick.xml").write_text('''\\
<root BTCPP_format="4">
  <BehaviorTree ID="Pick">
    <Sequence><Grip force="&"/></Sequence>
  </BehaviorTree>
</root>
''')
sys.stderr = sys.stdout
workspace = btq.open_workspace(".")
(path,) = (path for path in workspace.files if path.endswith("main.btq"))
print(len(btq.parse(workspace.files[path].text).entries))
print(btq.check(workspace, path)[0].message)
print(btq.format_text(workspace.files[path].text).text)
print(*[Path(built).name for built in btq.build(workspace, path).files])
print(btq.import_xml(Path("pick.xml").read_text()).text)
for command in (
    "check --output-format concise .",
    "check --jobs 2 --output-format concise main.btq pick.xml",
    "format main.btq",
    "build main.btq",
    "import pick.xml",
):
    print(f"{command}: {main(command.split())}")
print(*[path.read_text() for path in sorted(Path(".").glob("*.*"))])
"""


@pytest.fixture(scope="module")
def pyodide() -> Path:
    return there(STORE / "pyodide/node_modules/pyodide", "Pyodide", "pyodide")


def test_it_does_the_same_as_everywhere(node: Path, pyodide: Path, tmp_path: Path) -> None:
    """Parse, check, format, build and import, by calls and by commands."""
    here = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, cwd=tmp_path, timeout=100)
    command: list[str | Path] = [node, ROOT / "tests/editors/pyodide.mjs", pyodide, ROOT, PROGRAM]
    in_pyodide = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert (in_pyodide.returncode, in_pyodide.stderr) == (0, "")
    assert in_pyodide.stdout == here.stdout
    assert [
        line for line in in_pyodide.stdout.splitlines() if line.startswith(("check ", "format ", "build ", "import "))
    ] == [
        "check --output-format concise .: 1",
        "check --jobs 2 --output-format concise main.btq pick.xml: 1",
        "format main.btq: 0",
        "build main.btq: 0",
        "import pick.xml: 0",
    ]
    assert "pick.xml:3:28: warning[xml-not-well-formed] the engine reads this" in in_pyodide.stdout
