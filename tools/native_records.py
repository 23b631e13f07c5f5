"""Write records out as plain classes, in the copy of the package that is compiled (hatch_build.py).

One invariant: the class says and does what the record does, and every line stays where it is, for tracebacks show the
sources as they are.  A record is made by Python while its module is loaded, so mypyc knows nothing of its fields; of
these classes it makes structures of C.  What is left to type checkers here: that nobody sets a field.
"""

from __future__ import annotations

import ast

NAMES = "from typing import ClassVar, Final"
BASE_MODULE = "native_record"
BASE = '''"""What all records do alike that are compiled: as `_Record` in record.py."""

from __future__ import annotations


class NativeRecord:
    def _tuple(self) -> tuple[object, ...]:
        raise NotImplementedError

    @property
    def _values(self) -> tuple[object, ...]:
        return self._tuple()

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and isinstance(other, NativeRecord) and self._tuple() == other._tuple()

    def __hash__(self) -> int:
        return hash((type(self), self._tuple()))

    def __repr__(self) -> str:
        fields: tuple[str, ...] = getattr(self, "__match_args__")
        values = zip(fields, self._tuple(), strict=True)
        return f"{type(self).__name__}({', '.join([f'{name}={value!r}' for name, value in values])})"

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), self._tuple()
'''


def natively(source: str, package: str) -> str:
    """The source of a module of a package, with each record in it written out."""
    tree = ast.parse(source)
    records = [part for part in tree.body if isinstance(part, ast.ClassDef) and _names_of_bases(part) == ["Record"]]
    if not records:
        return source
    lines = source.splitlines()
    for record in records:
        _write_out(record, lines)
    brings = next(part for part in tree.body if isinstance(part, ast.ImportFrom) and _brings_record(part))
    lines[(brings.end_lineno or 0) - 1] += f"; from {package}.{BASE_MODULE} import NativeRecord"
    lines.append(NAMES)
    return "\n".join([*lines, ""])


def _write_out(record: ast.ClassDef, lines: list[str]) -> None:
    """Put into the lines of a record's docstring and fields what Python would make of them."""
    fields = [part for part in record.body if isinstance(part, ast.AnnAssign)]
    names = [ast.unparse(field.target) for field in fields]
    parameters = ["self", *map(ast.unparse, fields)]
    stored = "; ".join(f"self.{name}: Final = {name}" for name in names)
    made = (
        f"__match_args__: ClassVar = ({', '.join(map(repr, names))},)",
        f"def __init__({', '.join(parameters)}) -> None: {stored}",
        f"def _tuple(self) -> tuple[object, ...]: return ({', '.join(f'self.{name}' for name in names)},)",
    )
    lines[record.lineno - 1] = f"class {record.name}(NativeRecord):"
    first, last = record.body[0].lineno - 1, (fields[-1].end_lineno or 0)
    room = last - first
    assert room >= len(made), f"{record.name} has no docstring"
    assert fields[-1] is record.body[len(fields)], f"{record.name} has something else before a field"
    lines[first:last] = [*(f"    {line}" for line in made), *[""] * (room - len(made))]


def _names_of_bases(part: ast.ClassDef) -> list[str]:
    return [ast.unparse(base) for base in part.bases]


def _brings_record(part: ast.ImportFrom) -> bool:
    return any(alias.name == "Record" for alias in part.names)
