"""The bugs that bench/mutants.py puts into modules, to see whether tests find them."""

from __future__ import annotations

import mutators
import pytest


@pytest.mark.parametrize(
    ("source", "bugs"),
    [
        ("a < b", ["1 comparison a < b -> a <= b"]),
        ("a not in b", ["1 comparison a not in b -> a in b"]),
        ("a == b < c", ["1 comparison a == b < c -> a != b < c"]),
        ("a and b or c", ["1 and/or a and b or c -> (a and b) and c", "1 and/or a and b -> a or b"]),
        ("x = 7", ["1 constant 7 -> 8"]),
        ("x = True", []),
        ("x = a['k']", ["1 key 'k' -> 'kx'"]),
        ("x = {'k': 'v'}", ["1 key 'k' -> 'kx'"]),
        ("x = ('one word', 'word')", ["1 key 'word' -> 'wordx'"]),
        ("x = 'v'", []),
        (
            "x = y if z else [1 for a in b if a]",
            ["1 condition z -> not z", "1 constant 1 -> 2", "1 condition a -> not a"],
        ),
        (
            "def f(a):\n    if a is None:\n        raise\n    a.b = c = a\n    return a",
            [
                "2 return if a is None: raise -> return",
                "2 comparison a is None -> a is not None",
                "3 drop raise -> pass",
                "4 drop a.b = c = a -> pass",
            ],
        ),
        (
            "def f():\n    for a in b:\n        while a:\n            a += 1\n            break",
            [
                "2 return for a in b: while a: a += 1 break -> return",
                "3 condition a -> not a",
                "4 drop a += 1 -> pass",
                "4 constant 1 -> 2",
                "5 drop break -> pass",
            ],
        ),
        ("class A:\n    '''A.'''\n    __slots__ = ('a', 'b')\n    def __repr__(self): return self[0]", []),
        ("TYPE_CHECKING = False\nif TYPE_CHECKING:\n    X = dict[0, 'a']\n", []),
        ("def f(a: b[1], c: d['e'] = 2) -> g[3]:\n    h: i[4] = f'{5} {a == b}'", ["1 constant 2 -> 3"]),
    ],
)
def test_the_bugs_of_a_module(source: str, bugs: list[str]) -> None:
    assert [f"{bug.line} {bug.kind} {bug.before} -> {bug.after}" for bug in mutators.mutants(source)] == bugs
    assert [bug.number for bug in mutators.mutants(source)] == list(range(len(bugs)))


@pytest.mark.parametrize(
    ("source", "number", "after"),
    [
        ("x = 1  # one\ny = a < b", 1, "x = 1\ny = a <= b"),
        ("if a or b:\n    x = {'k': 1}", 0, "if not (a or b):\n    x = {'k': 1}"),
        ("if a or b:\n    x = {'k': 1}", 1, "if a and b:\n    x = {'k': 1}"),
        ("if a or b:\n    x = {'k': 1}", 2, "if a or b:\n    x = {'kx': 1}"),
        ("def f():\n    yield 1\n    with a:\n        pass", 2, "def f():\n    yield 1\n    return"),
        ("def f():\n    yield 1\n    with a:\n        pass", 0, "def f():\n    pass\n    with a:\n        pass"),
    ],
)
def test_a_module_with_a_bug(source: str, number: int, after: str) -> None:
    assert mutators.with_bug(source, number) == after
