"""The rooms of ARCHITECTURE.md, held: what may import what, and that no circle of imports exists."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from missions import SEED, mission

import btq_lang

PACKAGE = Path(btq_lang.__file__).parent

# From the ground up: a room, which is a package or a module beside it, imports from rooms above it only.
ROWS = (
    ("util",),
    ("catalog",),
    ("diagnostics",),
    ("syntax",),
    ("cpp",),
    ("lexer",),
    ("grammar",),
    ("parser",),
    ("workspace",),
    ("formatter", "requirements"),
    ("btcpp", "graph"),
    ("simulator",),
    ("checks", "nav2"),
    ("diff", "render"),
    ("evidence",),
    ("exploration",),
    ("projects",),
    ("scenarios",),
    ("prediction",),
    ("ide", "trace"),
    ("preview",),
    ("commands", "lsp"),
    ("server",),
    ("cli",),
    ("__main__",),
)
ROW_OF = {room: row for row, rooms in enumerate(ROWS) for room in rooms}
READS_THE_DISK = {"workspace/loader.py", "diagnostics/rules/__init__.py", "preview/__init__.py"}
MOST_LINES = 600
READS_LOGS = ("evidence/readers/", "evidence/store/")
# Which rooms know a package of others.
ONLY_IN = {
    "lxml": {"btcpp"},
    "jinja2": {"render"},
    "markupsafe": {"render"},
    "pygls": {"lsp", "server"},
    "lsprotocol": {"lsp", "server"},
    "tree_sitter": {"cpp"},
    "tree_sitter_cpp": {"cpp"},
    "reqif": {"requirements"},
    "yaml": {"nav2"},
    "zmq": {"evidence"},
    "msgpack": {"evidence"},
}


def module_name(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def imports(tree: ast.AST) -> Iterator[str]:
    """What a module imports, in functions and for type checkers, too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            yield from (f"{node.module}.{name.name}" for name in node.names)


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imported_by(module: str) -> list[str]:
    return list(imports(parsed(MODULES[module])))


def imported_module(name: str) -> str:
    """The module of btq that an import names, or that holds what it names."""
    while name not in MODULES:
        name = name.rpartition(".")[0]
    return name


def room(module: str) -> str:
    return module.split(".")[1]


def test_a_module_imports_from_rooms_above_its_own() -> None:
    for module in MODULES.keys() - {"btq_lang"}:
        for name in imported_by(module):
            first = name.partition(".")[0]
            if first in ONLY_IN:
                assert room(module) in ONLY_IN[first], f"{module} imports {name}"
            if first == "btq_lang":
                target = imported_module(name)
                assert target != "btq_lang", f"{module} imports {name}"
                is_above = ROW_OF[room(target)] < ROW_OF[room(module)]
                assert is_above or room(target) == room(module), f"{module} imports {name}"


def test_no_circle_exists() -> None:
    order = TopologicalSorter(
        {
            module: {imported_module(name) for name in imported_by(module) if name.startswith("btq_lang.")} - {module}
            for module in MODULES
        }
    )
    order.prepare()  # raises CycleError, which names the modules


def test_the_top_of_the_package_is_small() -> None:
    names = {path.name for path in PACKAGE.iterdir() if path.is_file()}
    assert names == {"__init__.py", "__main__.py", "cli.py", "lexer.py", "parser.py", "py.typed", "server.py"}


def test_a_module_has_at_most_600_lines() -> None:
    """A longer one is parted where a stranger expects it."""
    lines = {
        path.relative_to(PACKAGE).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in MODULES.values()
    }
    assert {module: count for module, count in lines.items() if count > MOST_LINES} == {}


def test_a_package_names_its_modules() -> None:
    """In its docstring, which says what they are for; ARCHITECTURE.md does so for the rooms."""
    for module in MODULES.keys() - {"btq_lang"}:
        package, _, name = module.rpartition(".")
        if package != "btq_lang":
            docstring = ast.get_docstring(parsed(MODULES[package])) or ""
            assert name in re.findall(r"\w+", docstring.lower()), f"{package} does not name {name}"


def test_only_the_edges_open_files() -> None:
    for path in MODULES.values():
        calls = [node for node in ast.walk(parsed(path)) if isinstance(node, ast.Call)]
        name = path.relative_to(PACKAGE).as_posix()
        if any(getattr(call.func, "id", "") == "open" for call in calls):
            assert name in READS_THE_DISK or name.startswith(READS_LOGS)


def test_there_is_one_way_to_look_something_up() -> None:
    """Inputs and queries are functions that `ask` is called with; nobody calls an input."""
    declared = {"workspace/inputs.py", "checks/lookups.py", "checks/cpp_lookups.py"}
    topics = {"of_viewpoint", "of_name", "of_model", "of_item", "of_project"}
    names = {
        node.name
        for path in declared
        for node in parsed(PACKAGE / path).body
        if isinstance(node, ast.FunctionDef) and {ast.unparse(each) for each in node.decorator_list} & topics
    }
    assert {"definition", "is_complete", "is_xml"} <= names
    called = {
        ast.unparse(node.func)
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(parsed(path))
        if isinstance(node, ast.Call)
    }
    assert called & {f"{module}.{name}" for module in ("inputs", "lookups", "cpp_lookups") for name in names} == set()
    takes_query = {
        f"{node.name}.{method.name}"
        for path in ("workspace/queries.py", "checks/view.py")
        for node in parsed(PACKAGE / path).body
        if isinstance(node, ast.ClassDef)
        for method in node.body
        if isinstance(method, ast.FunctionDef) and "query" in {each.arg for each in method.args.posonlyargs}
    }
    assert takes_query == {"Store.ask", "Store.pin", "Store.unpin", "View.ask"}


def test_a_file_without_clauses_needs_no_requirements() -> None:
    text = 'QualityReq rq1 "In time"\nBehaviorTree Main\n    Action Drive satisfies rq1\n'
    program = (
        "import sys; from btq_lang.checks import check; from btq_lang.workspace.workspace import Workspace\n"
        f"assert check(Workspace.of({{'a.btq': {text!r}}}), 'a.btq') == ()\n"
        "print([name for name in sys.modules if name.startswith('btq_lang.requirements')])"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=PACKAGE.parent
    )
    assert run.stdout == "['btq_lang.requirements', 'btq_lang.requirements.constraints']\n"


def test_no_module_is_named_as_one_of_the_standard_library() -> None:
    assert not {path.stem for path in MODULES.values()} & (sys.stdlib_module_names - {"__init__", "__main__"})


@pytest.mark.parametrize(
    ("statement", "absent"),
    [
        ("import btq_lang", {"pygls", "lsprotocol", "lxml", "btq_lang.parser"}),
        (
            "import btq_lang.cli; btq_lang.cli.main(['check', 'examples/laboratory'])",
            {
                "pygls",
                "lsprotocol",
                "lxml",
                "jinja2",
                "dataclasses",
                "inspect",
                "pathlib",
                "json",
                "asyncio",
                "multiprocessing",
            }
            | {"argparse", "ast", "btq_lang.workspace.fixes", "btq_lang.render.full"},
        ),
        (
            "import btq_lang.commands.arguments",
            {
                "btq_lang.parser",
                "btq_lang.workspace.workspace",
                "btq_lang.catalog",
                "btq_lang.requirements",
                "dataclasses",
            },
        ),
        ("import btq_lang.cli; btq_lang.cli.main(['--version'])", {"argparse", "btq_lang.parser"}),
        (
            "import site; site.main(); import btq_lang.server",  # what an editor waits for
            {
                "btq_lang.parser",
                "btq_lang.workspace.workspace",
                "btq_lang.checks",
                "btq_lang.catalog",
                "lxml",
                "jinja2",
            },
        ),
        ("import site; site.main(); import btq_lang.lsp.commands, btq_lang.lsp.editor", {"jinja2", "markupsafe"}),
        ("import btq_lang.cli; btq_lang.cli.main(['trace', 'examples/laboratory'])", {"jinja2", "markupsafe"}),
        (
            "import btq_lang.cli; btq_lang.cli.main(['verify', 'examples/laboratory/runs.btlog', '--mission', "
            "'examples/laboratory/mission.btq', '--format', 'json'])",
            {"jinja2", "markupsafe"},
        ),
    ],
)
def test_what_a_start_does_not_import(statement: str, absent: set[str]) -> None:
    program = f"{statement}\nimport sys\nprint(sorted(set(sys.modules) & {absent!r}))"
    run = subprocess.run(
        [sys.executable, "-S", "-c", f"import sys; sys.path.insert(0, '.')\n{program}"],
        capture_output=True,
        text=True,
        check=True,
        cwd=PACKAGE.parent,
    )
    assert run.stdout.splitlines()[-1] == "[]"


def test_a_small_file_is_checked_without_heavy_modules(tmp_path: Path) -> None:
    file = tmp_path / "mission.btq"
    file.write_text(mission(100, SEED, "short"), encoding="utf-8")
    program = (
        "import sys; sys.path.insert(0, '.'); import btq_lang.cli\n"
        f"btq_lang.cli.main(['check', {str(file)!r}])\n"
        "print(sorted({'dataclasses', 'inspect', 'argparse', 'json', 'pathlib'} & set(sys.modules)))"
    )
    command = [sys.executable, "-S", "-c", program]
    run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=PACKAGE.parent)
    assert run.stdout.splitlines()[-1] == "[]"


def test_no_public_class_name_means_two_things() -> None:
    names = Counter(
        node.name
        for path in MODULES.values()
        for node in parsed(path).body
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    )
    assert [name for name, count in names.items() if count > 1] == []
