"""A new built-in node is a row of the table, and so is a new version of the engine, or what one changes; no other
module changes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

# Each runs in a process of its own, before anything has read the table.
NODES = """
from btq_lang.catalog import engine_nodes
from btq_lang.catalog.kinds import PortKind, control, decorator

TIMES = PortKind("times", "input", "int", "How often", required=True, role="count")
AFTER = PortKind("after", "input", "unsigned int", "The time", required=True, unit="ms", role="time")
engine_nodes.ENGINE_NODES += (
    control(
        *("Routine", "Ticks its children in order.", "As a Sequence."), aliases=("Steps",), flow="sequence",
        since="4.10",
    ),
    decorator("Negate", "Turns the result around.", "As an Inverter.", flow="invert"),
    decorator("Again", "Repeats its child.", "As a Repeat.", ports=(TIMES,), flow="repeat"),
    decorator("Deadline", "Limits its child.", "As a Timeout.", ports=(AFTER,), flow="timeout"),
)
"""
VERSION = """
from pathlib import Path
from types import ModuleType

import btq_lang.catalog

(folder,) = btq_lang.catalog.__path__
text = Path(folder, "versions.py").read_text(encoding="utf-8")
for row, changed in (
    ('("4.6", "4.8", "4.10")', '("4.6", "4.8", "4.10", "4.11")'),
    ('UNIQUE_SUBTREES: Final = VersionChange("4.8"', 'UNIQUE_SUBTREES: Final = VersionChange("4.11"'),
):
    assert text.count(row) == 1, row
    text = text.replace(row, changed)
versions = ModuleType("btq_lang.catalog.versions")
sys.modules[versions.__name__] = versions
exec(text, versions.__dict__)
"""
RUN = """
from btq_lang.cli import main

for line in sys.stdin.read().splitlines():
    print(f"$ {line}", flush=True)
    print("exit", main(line.split()), flush=True)
"""
EDITOR = """
from btq_lang import Workspace
from btq_lang.ide.completion import complete
from btq_lang.ide.hover import hover

text = "BehaviorTree Main\\n    Ste"
found = complete(Workspace.of({"m.btq": text}), "m.btq", len(text)).proposals
print([each.label for each in found if each.label in ("Steps", "Routine", "Negate", "Again", "Deadline")])
text = "BehaviorTree Main\\n    Deadline (after = 1 s)\\n        Move\\n"
print(hover(Workspace.of({"m.btq": text}), "m.btq", text.index("Deadline")).markdown)
"""
MISSION = """\
QualityReq brisk : safety
    on violation log
    Move takes at most 4 s

QualityReq quick : safety
    on violation log
    Again takes at most 10 s

QualityReq late : safety
    on violation fail
    Dock takes at most 1 min

BehaviorTree Main
    Steps
        Again (times = 3)
            Move
        Deadline (after = 20 s)
            Dock
        Deadline (after = 0)
            Charge
        Negate
            AlwaysSuccess
        Park
"""
CHECKED = """\
$ check m.btq --output-format concise
m.btq:7:5: warning[budget-exceeded] `Again` may take 12 s, more than `10 s` allows: 3 × `Move` 4 s
m.btq:11:5: warning[dead-bound] `1 min` is never reached: a Deadline halts `Dock` after 20 s
m.btq:14:5: warning[newer-engine-node] `Routine` requires BehaviorTree.CPP 4.10; 4.6 does not have it
m.btq:19:27: warning[count-of-nothing] a Deadline of `0` is disabled: it never halts its child
m.btq:23:9: warning[unreachable-child] `Park` can never run: `Negate` before it never succeeds
Found 5 warnings
exit 1
"""
EDITED = """\
['Steps', 'Routine', 'Negate', 'Again', 'Deadline']
**Deadline** (Decorator) · `Deadline` · children: 1 · since 4.6

Limits its child.

As a Timeout.

- `input after : unsigned int` (in ms, required): The time
"""
TREE = """\
    <Routine>
      <Again times="3">
        <Move/>
      </Again>
      <Deadline after="20000">
        <Dock/>
      </Deadline>
      <Deadline after="0">
        <Charge/>
      </Deadline>
      <Negate>
        <AlwaysSuccess/>
      </Negate>
      <Park/>
    </Routine>
"""
TWICE = """\
BehaviorTree Main
    ->
        SubTree Go Twice
        SubTree Go Twice

BehaviorTree Go
    Move
"""


def test_a_row_of_each_node(tmp_path: Path) -> None:
    (tmp_path / "m.btq").write_text(MISSION, encoding="utf-8")
    printed = run(NODES + RUN + EDITOR, "check m.btq --output-format concise\n", tmp_path)
    assert printed == CHECKED + EDITED
    (tmp_path / "m.btq").write_text(MISSION[MISSION.index("BehaviorTree") :], encoding="utf-8")
    run(NODES + RUN, "build m.btq -o out\n", tmp_path)
    assert TREE in (tmp_path / "out" / "m.xml").read_text(encoding="utf-8")


def test_a_row_of_a_version_and_of_a_change(tmp_path: Path) -> None:
    (tmp_path / "m.btq").write_text(TWICE, encoding="utf-8")
    for target, names in (("4.10", ["Twice", "Twice"]), ("4.11", ["Twice", "Twice_2"])):
        printed = run(VERSION + RUN, f"build m.btq -o {target} --target {target}\n", tmp_path)
        assert printed.endswith("exit 0\n")
        written = (tmp_path / target / "m.xml").read_text(encoding="utf-8")
        assert [part.split('"')[0] for part in written.split(' name="')[1:]] == names
    run(VERSION + RUN, "init new\n", tmp_path)
    project = (tmp_path / "new" / "btq.toml").read_text(encoding="utf-8")
    assert 'engine = ["4.6", "4.8", "4.10", "4.11"]' in project
    printed = run(VERSION + RUN, "check new\n", tmp_path)
    assert printed.endswith("exit 0\n")


def run(script: str, commands: str, folder: Path) -> str:
    """What a script prints, which reads command lines."""
    done = subprocess.run(
        [sys.executable, "-c", f"import sys\n{script}"],
        input=commands,
        cwd=folder,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
    )
    return done.stdout
