"""A record written out for the compiler (tools/native_records.py) says and does what the record does.

Both forms run here as Python runs them; tests/test_compiled.py runs what the compiler makes of them.
"""

from __future__ import annotations

import ast
import copy
import pickle
import runpy
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from btq_lang.record import fields_of, replace

ROOT = Path(__file__).resolve().parents[1]
TOOL = runpy.run_path(str(ROOT / "tools" / "native_records.py"))
MODULES = [
    path
    for path in sorted((ROOT / "btq_lang").rglob("*.py"))
    if path.name != "record.py" and "(Record):" in path.read_text(encoding="utf-8")
]

SOURCE = '''"""A module."""

from __future__ import annotations

from btq_lang.record import Record, replace

class Point(Record):
    """Where.

    Attributes:
        label: behind `|`.
    """

    x: int
    y: int = 2
    label: (
        str | None
    ) = None

    @property
    def sum(self) -> int:
        return self.x + self.y


class Lone(Record):
    """One field, and equality of its own."""

    x: int

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Lone)

    def __hash__(self) -> int:
        return 7
'''


def natively(source: str) -> str:
    """What the compiler is given."""
    written: str = TOOL["natively"](source, "native_records_of_tests")
    return written


@pytest.fixture(params=["as Python makes it", "written out"])
def module(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The module above in either form."""
    base = ModuleType("native_records_of_tests.native_record")
    exec(TOOL["BASE"], base.__dict__)
    made = ModuleType("points_of_tests")
    for name, each in (("native_records_of_tests", ModuleType("")), (base.__name__, base), (made.__name__, made)):
        monkeypatch.setitem(sys.modules, name, each)
    exec(SOURCE if request.param == "as Python makes it" else natively(SOURCE), made.__dict__)
    return made


def test_a_record_has_its_fields_in_order_and_their_defaults(module: Any) -> None:
    point = module.Point(1)
    assert (point.x, point.y, point.label, point.sum) == (1, 2, None, 3)
    assert module.Point(1, label="a", y=5).label == "a"
    assert fields_of(point) == ("x", "y", "label")
    assert fields_of(module.Lone(1)) == ("x",)
    with pytest.raises(TypeError):
        module.Point()
    with pytest.raises(TypeError):
        module.Point(1, z=3)


def test_records_are_equal_by_type_and_fields(module: Any) -> None:
    assert module.Point(1, 3) == module.Point(1, 3)
    assert hash(module.Point(1, 3)) == hash(module.Point(1, 3))
    assert module.Point(1, 3) != module.Point(1, 4)
    assert module.Point(1, 3) != (1, 3, None)
    assert module.Lone(1) == module.Lone(2)
    assert hash(module.Lone(1)) == 7


def test_a_record_shows_and_copies_itself(module: Any) -> None:
    point = module.Point(1, label="a")
    assert repr(point) == "Point(x=1, y=2, label='a')"
    assert repr(module.Lone(1)) == "Lone(x=1)"
    assert replace(point, y=4) == module.Point(1, 4, "a")
    with pytest.raises(TypeError):
        replace(point, z=4)
    for same in (copy.copy(point), copy.deepcopy(point), pickle.loads(pickle.dumps(point))):
        assert (type(same), same) == (module.Point, point)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT / "btq_lang")))
def test_every_line_behind_the_fields_stays_where_it_is(path: Path) -> None:
    source = path.read_text(encoding="utf-8")
    before, after = source.splitlines(), natively(source).splitlines()
    heads = {
        number
        for part in ast.parse(source).body
        if isinstance(part, ast.ClassDef) and [ast.unparse(base) for base in part.bases] == ["Record"]
        for field in part.body
        if isinstance(field, ast.AnnAssign)
        for number in range(part.lineno, (field.end_lineno or 0) + 1)
    }
    others = [number for number in range(1, len(before) + 1) if number not in heads]
    moved = [number for number in others if not after[number - 1].startswith(before[number - 1])]
    assert heads
    assert moved == []
    assert after[len(before) :] == [TOOL["NAMES"]]


def test_a_module_without_records_stays_as_it_is() -> None:
    assert natively("x = 1") == "x = 1"
