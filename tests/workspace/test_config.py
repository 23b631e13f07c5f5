"""The project file: its settings, and what is reported about errors in it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from btq_lang.catalog.qualities import DEFAULT_EDITION, EDITIONS
from btq_lang.catalog.versions import VERSIONS
from btq_lang.diagnostics.model import Diagnostic
from btq_lang.diagnostics.rules import RULES, Severity
from btq_lang.util.text import LineIndex, Span
from btq_lang.workspace.config import (
    Project,
    configured,
    has_btq_table,
    include_candidates,
    parse_project,
    unknown_rule,
)
from btq_lang.workspace.overrides import Override, severities_at

WHOLE = """\
engine = "4.8"
qualities = "iso25010-2011"
include-paths = ["missions", "../shared", "/opt/btq"]
exclude = ["generated/", "*.old.btq"]
select = ["unknown-node", "unused-tree"]
ignore = ["unused-tree"]
baseline = "ci/known.json"

[rules]
missing-port = "warning"
unknown-node = "off"

[[overrides]]
include = ["vendor/"]
ignore = ["unknown-node"]

[[overrides]]
include = ["vendor/ours/", "*.new.btq"]

[overrides.rules]
unknown-node = "error"
unused-tree = "off"
"""
PROJECT = Project(
    root="/home/lab",
    include_paths=("/home/lab/missions", "/home/shared", "/opt/btq"),
    engines=("4.8",),
    qualities="iso25010-2011",
    severities=(("missing-port", Severity.WARNING), ("unknown-node", None)),
    select=("unknown-node", "unused-tree"),
    ignore=("unused-tree",),
    baseline="/home/lab/ci/known.json",
    exclude=("generated/", "*.old.btq"),
    overrides=(
        Override(("vendor/",), (("unknown-node", None),)),
        Override(("vendor/ours/", "*.new.btq"), (("unknown-node", Severity.ERROR), ("unused-tree", None))),
    ),
)


def problems(text: str, kind: str = "btq.toml") -> list[str]:
    """What is wrong, each with line and column from 1."""
    found = parse_project(text, kind)[1]  # type: ignore[arg-type]  # one of the two kinds
    return [
        f"{problem.position.line + 1}:{problem.position.column + 1}: {problem.message}"
        if problem.position
        else problem.message
        for problem in found
    ]


def test_every_key() -> None:
    assert parse_project(WHOLE, root="/home/lab") == (PROJECT, ())
    in_pyproject = "[tool.btq]\n" + WHOLE.replace("[rules]", "[tool.btq.rules]")
    in_pyproject = in_pyproject.replace("[overrides", "[tool.btq.overrides")
    assert parse_project(in_pyproject, "pyproject.toml", "/home/lab") == (PROJECT, ())


@pytest.mark.parametrize(("text", "kind"), [("", "btq.toml"), ("", "pyproject.toml"), ("[tool.x]", "pyproject.toml")])
def test_nothing_said_is_the_default(text: str, kind: str) -> None:
    assert parse_project(text, kind) == (Project(), ())  # type: ignore[arg-type]  # one of the two kinds
    assert (Project().engines, Project().target, Project().qualities) == (VERSIONS, "4.10", "iso25010-2023")
    assert EDITIONS[Project().qualities] == DEFAULT_EDITION


@pytest.mark.parametrize(
    ("engine", "engines"),
    [('"4.10"', ("4.10",)), ('["4.10", "4.6", "4.9", "4.6"]', ("4.6", "4.9", "4.10")), ("'4.6'", ("4.6",))],
)
def test_engines_are_sorted_as_versions(engine: str, engines: tuple[str, ...]) -> None:
    project, found = parse_project(f"engine = {engine}")
    assert (project.engines, project.target, found) == (engines, engines[-1], ())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("engin = 1", ["1:1: unknown key `engin`; did you mean `engine`?"]),
        ("\n  include_paths = []", ["2:3: unknown key `include_paths`; did you mean `include-paths`?"]),
        ("[zebra]\nx = 1", ["1:2: unknown key `zebra`"]),
        ("zebra.x = 1", ["1:1: unknown key `zebra`"]),
        ('"a b" = 1', ["1:1: unknown key `a b`"]),
        (
            "engine = 4.10",
            ['1:1: `engine` must be a string such as "4.10", or a list of them: TOML reads 4.10 as 4.1'],
        ),
        ("engine = 4", ['1:1: `engine` must be a string such as "4.10", or a list of them']),
        (
            'engine = "4.11"',
            ["1:10: unknown engine version `4.11`; did you mean `4.10`? btq supports 3.8 and 4.6 to 4.10"],
        ),
        (
            'engine = ["4.6",\n  "4.5"]',
            ["2:3: unknown engine version `4.5`; did you mean `4.6`? btq supports 3.8 and 4.6 to 4.10"],
        ),
        ('engine = "3.7"', ["1:10: unknown engine version `3.7`; btq supports 3.8 and 4.6 to 4.10"]),
        ("engine = []", ["1:1: `engine` must name at least one version; btq supports 3.8 and 4.6 to 4.10"]),
        ('engine = "4.09"', ["1:10: unknown engine version `4.09`; btq supports 3.8 and 4.6 to 4.10"]),
        ("qualities = 2023", ['1:1: `qualities` must be "iso25010-2023" or "iso25010-2011"']),
        ('exclude = "x"', ["1:1: `exclude` must be a list of strings"]),
        ('exclude = ["x", 1]', ["1:1: `exclude` must be a list of strings"]),
        (
            'select = [\n  "unknown-node",\n  "unknwn-node", # "unknwn-node"\n]',
            ["3:3: unknown rule `unknwn-node`; did you mean `unknown-node`?"],
        ),
        ("ignore = ['zebra']", ["1:11: unknown rule `zebra`"]),
        ("rules = 1", ["1:1: `rules` must be a table of rules and severities"]),
        ('[rules]\nzebra = "error"', ["2:1: unknown rule `zebra`"]),
        (
            '[rules]\nunused-tree = "warn"',
            ['2:1: `rules.unused-tree` must be one of "error", "warning", "info", "hint", "off"'],
        ),
        (
            "[rules]\nunused-tree = []",
            ['2:1: `rules.unused-tree` must be one of "error", "warning", "info", "hint", "off"'],
        ),
        ("baseline = ''", ["1:1: `baseline` must be the name of a file"]),
        ("baseline = true", ["1:1: `baseline` must be the name of a file"]),
        ("overrides = 1", ["1:1: `overrides` must be a list of tables"]),
        ("[overrides]\ninclude = []", ["1:2: `overrides` must be a list of tables"]),
        (
            '[[overrides]]\ninclude = ["a"]\n[[overrides]]\nignore = ["zebra"]',
            [
                "3:3: `overrides.include` must have at least one pattern, none of them empty",
                "4:11: unknown rule `zebra`",
            ],
        ),
        (
            '[[overrides]]\ninclude = ["a", ""]',
            ["2:1: `overrides.include` must have at least one pattern, none of them empty"],
        ),
        ("[[overrides]]\ninclude = 'a'", ["2:1: `overrides.include` must be a list of strings"]),
        (
            '[[overrides]]\ninclude = ["a"]\n[[overrides]]\ninclude = ["b"]\n[overrides.rules]\nunused-tree = "x"',
            ['6:1: `overrides.rules.unused-tree` must be one of "error", "warning", "info", "hint", "off"'],
        ),
        (
            'overrides = [{include = ["a"], ignor = []}]',
            ["1:32: unknown key `overrides.ignor`; did you mean `ignore`?"],
        ),
        ('exclude = ["""\nengin = 1\n"""]\nengin = 2', ["4:1: unknown key `engin`; did you mean `engine`?"]),
        ("x = 1\ny = 2", ["1:1: unknown key `x`", "2:1: unknown key `y`"]),
        ("engine = \n", ["1:10: Invalid value"]),
        ("engine = ", ["1:10: Invalid value"]),
        ("a = 1\na = 2", ["2:6: Cannot overwrite a value"]),
        ("x = [" * 5000, ["1:6: Invalid value"]),
        ("x = " + "[" * 100000, ["nested too deeply"]),
    ],
)
def test_problems_and_their_places(text: str, expected: list[str]) -> None:
    assert problems(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            '[tool.btq]\nengine = "4.1"',
            ["2:10: unknown engine version `4.1`; did you mean `4.10`? btq supports 3.8 and 4.6 to 4.10"],
        ),
        ("[engine]\n[tool.btq]\nengine = 1", ['3:1: `engine` must be a string such as "4.10", or a list of them']),
        ('[tool.btq.rules]\nzebra = "off"', ["2:1: unknown rule `zebra`"]),
        ('[tool]\nbtq = { select = ["zebra"] }', ["2:19: unknown rule `zebra`"]),
        ('tool.btq.rules = { zebra = "off" }', ["1:20: unknown rule `zebra`"]),
        ("[tool]\nbtq = 1", ["2:1: `tool.btq` must be a table"]),
        ("tool = 1", ["1:1: `tool.btq` must be a table"]),
    ],
)
def test_problems_in_a_pyproject(text: str, expected: list[str]) -> None:
    assert problems(text, "pyproject.toml") == expected


def test_what_is_right_holds_beside_what_is_wrong() -> None:
    text = 'engine = ["4.6", "5.0"]\nselect = ["zebra", "unused-tree"]\n[rules]\nzebra = "off"\nunused-tree = "hint"\n'
    project, found = parse_project(text)
    assert project == Project(engines=("4.6",), select=("unused-tree",), severities=(("unused-tree", Severity.HINT),))
    assert len(found) == 3


def test_severities_and_choice_of_rules() -> None:
    found = [Diagnostic(rule, Span(0, 0), "m") for rule in ("unused-tree", "unknown-node", "missing-port")]

    def kept(project: Project) -> list[tuple[str, Severity]]:
        return [(one.rule, one.effective_severity) for one in configured(project, path, found)]

    path = "main.btq"
    assert list(configured(Project(), path, found)) == found
    assert kept(Project(severities=(("unused-tree", Severity.ERROR), ("unknown-node", None)))) == [
        ("unused-tree", Severity.ERROR),
        ("missing-port", Severity.ERROR),
    ]
    assert kept(Project(select=("unused-tree", "missing-port"), ignore=("missing-port",))) == [
        ("unused-tree", Severity.WARNING)
    ]


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("main.btq", {"missing-port": Severity.WARNING, "unknown-node": None}),
        ("vendor/a/b.btq", {"missing-port": Severity.WARNING, "unknown-node": None}),
        ("vendor/ours/a.btq", {"missing-port": Severity.WARNING, "unknown-node": Severity.ERROR, "unused-tree": None}),
        ("a.new.btq", {"missing-port": Severity.WARNING, "unknown-node": Severity.ERROR, "unused-tree": None}),
    ],
)
def test_the_last_override_counts(path: str, expected: dict[str, Severity | None]) -> None:
    file = f"/home/lab/{path}"
    assert severities_at(PROJECT.root, PROJECT.severities, PROJECT.overrides, file) == expected


def test_unknown_rules_of_the_command_line() -> None:
    assert unknown_rule("unused-tree") is None
    assert unknown_rule("unusd-tree") == "unknown rule `unusd-tree`; did you mean `unused-tree`?"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[tool.btq]", True),
        ("x = 1\n [ tool . 'btq' ]\n", True),
        ("[tool.btq.rules]", True),
        ("[tool.btqx]", False),
        ("# [tool.btq]", False),
        ("", False),
    ],
)
def test_a_pyproject_with_and_without_a_btq_table(text: str, expected: bool) -> None:
    assert has_btq_table(text) is expected


def test_include_candidates() -> None:
    project = Project(include_paths=("/p/shared", "/p/a"))
    assert include_candidates(project, "/p/a/x.btq", "../y.btq") == ("/p/y.btq",)
    assert include_candidates(project, "/p/a/x.btq", "y.btq") == ("/p/a/y.btq", "/p/shared/y.btq")
    assert include_candidates(project, "/p/a/x.btq", "/q/./y.btq") == ("/q/y.btq",)
    assert include_candidates(Project(), "x.btq", "./sub/y.btq") == ("sub/y.btq",)


KEYS = st.sampled_from(
    [
        "engine",
        "qualities",
        "include-paths",
        "exclude",
        "select",
        "ignore",
        "rules",
        "baseline",
        "overrides",
        "tool.btq",
        "x",
    ]
)
VALUES = st.recursive(
    st.sampled_from(["1", "4.10", '"4.10"', '"off"', "true", "1979-05-27", *(f'"{rule}"' for rule in list(RULES)[:3])]),
    lambda inner: (
        st.lists(inner, max_size=3).map(lambda items: f"[{', '.join(items)}]")
        | st.dictionaries(st.sampled_from(["a", "unused-tree", "btq"]), inner, max_size=2).map(
            lambda table: "{" + ", ".join(f"{key} = {value}" for key, value in table.items()) + "}"
        )
    ),
)
FILES = st.lists(
    st.tuples(KEYS, VALUES).map(" = ".join) | KEYS.map("[{}]".format) | st.text(max_size=20), max_size=6
).map("\n".join)


@given(FILES, st.sampled_from(["btq.toml", "pyproject.toml"]))
def test_every_text_gives_a_project(text: str, kind: str) -> None:
    project, found = parse_project(text, kind)  # type: ignore[arg-type]  # one of the two kinds
    assert project.engines
    assert all(rule in RULES for rule in (*project.select, *project.ignore, *dict(project.severities)))
    lines = LineIndex(text)
    for problem in found:
        if problem.position:
            assert 0 <= problem.position.line < lines.line_count
            assert 0 <= problem.position.column <= len(lines.line(problem.position.line)) + 1


def test_a_path_is_shown_as_seen_from_where_people_work() -> None:
    project = Project("/home/lab/robot", folders=("/home/lab", "/srv/common/"))
    shown = {
        "/home/lab/robot/a.btq": "robot/a.btq",
        "/srv/common/b.btq": "b.btq",
        "/home/labs/c.btq": "/home/labs/c.btq",
        "/home/lab": ".",
    }
    assert {path: project.shown(path) for path in shown} == shown
    assert Project("/home/lab/robot").shown("/home/lab/robot/a.btq") == "a.btq"
    assert (Project().shown("a/b.btq"), Project().shown(".")) == ("a/b.btq", ".")
