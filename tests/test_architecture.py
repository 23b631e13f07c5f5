"""The layers of ARCHITECTURE.md, held: a module imports only from its own row or the rows above it."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from missions import SEED, mission

import btq_lang

PACKAGE = Path(btq_lang.__file__).parent

# Row by row, from the ground up; a package stands for all its modules.
ROWS: tuple[frozenset[str], ...] = (
    frozenset(
        {"record", "garbage", "text", "places", "near", "globs"}
        | {"rules", "diagnostics", "units", "quantities", "version"}
    ),
    frozenset(
        {
            "tokens",
            "scan",
            "measured",
            "slips",
            "lexer",
            "words",
            "node_clauses",
            "syntax",
            "cursor",
        }
        | {
            "conditions",
            "claims",
            "clauses",
            "attributes",
            "nodes",
            "blocks",
        }
        | {"item_words", "parser", "comments", "script"}
    ),
    frozenset({"catalog"}),
    frozenset(
        {
            "toml_places",
            "project",
            "project_evidence",
            "name_kinds",
            "symbols",
            "constraints",
            "mentions",
            "facts",
            "file",
            "workspace",
            "loader",
            "findings",
        }
        | {"placeholders", "entry_types", "custom_nodes", "requirements", "graph", "findings"}
    ),
    frozenset({"checks", "formatter", "render", "fixes", "btcpp", "diff", "features", "trace", "evidence"}),
    frozenset({"building"}),
    frozenset({"watch", "shell", "failures", "commands", "preview"}),
    frozenset({"session", "convert", "editor", "protocol", "handlers"}),
    frozenset({"cli", "__main__", "server"}),
)
ROW_OF = {module: row for row, modules in enumerate(ROWS) for module in modules}
# The rules' pages, the catalog's data and the page of the preview too.
READS_THE_DISK = frozenset({"loader", "rules", "commands", "catalog", "preview"})
READS_LOGS = PACKAGE / "evidence" / "readers"
READS_SIBLINGS = {
    "checks": frozenset({"btcpp"}),  # whether a build enforces what it is asked to
    "features": frozenset({"checks", "fixes", "formatter", "btcpp"}),  # an editor shows what they find and would do
    # how wide a text is on a terminal, and its colours; a page shows verdicts; what is enforced is what a build does
    "trace": frozenset({"render", "evidence", "btcpp", "checks"}),
    "diff": frozenset({"btcpp"}),  # which models a build has made
    "evidence": frozenset({"btcpp", "render", "checks"}),  # which trees a build makes; errors
}
PROTOCOL = frozenset({"pygls", "lsprotocol"})
SPEAKS_THE_PROTOCOL = frozenset({"server", "editor", "protocol", "handlers", "convert"})


def modules() -> Iterator[tuple[str, Path]]:
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        yield parts[0], path


def imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{name.name}" for name in node.names if node.module == "btq_lang")


@pytest.mark.parametrize(("module", "path"), list(modules()), ids=lambda value: str(value).rpartition("btq_lang/")[2])
def test_a_module_imports_only_downwards(module: str, path: Path) -> None:
    if module == "__init__":
        return
    row = ROW_OF[module]
    for imported in imports(path):
        parts = imported.split(".")
        if parts[0] in PROTOCOL:
            assert module in SPEAKS_THE_PROTOCOL, f"{path.name} imports {imported}"
        if parts[0] == "lxml":
            assert module == "btcpp", f"{path.name} imports {imported}"
        if parts[0] == "btq_lang" and len(parts) > 1 and parts[1] in ROW_OF and parts[1] != module:
            assert ROW_OF[parts[1]] <= row, f"{path.name} imports {imported}"
            may_read = parts[1] in READS_SIBLINGS.get(module, ())
            assert row != 4 or ROW_OF[parts[1]] != 4 or may_read, f"{path.name} imports its sibling {imported}"


@pytest.mark.parametrize(("module", "path"), list(modules()), ids=lambda value: str(value).rpartition("btq_lang/")[2])
def test_only_the_edges_open_files(module: str, path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    opened = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "open"]
    assert not opened or module in READS_THE_DISK or path.parent == READS_LOGS


def test_a_file_without_clauses_needs_no_requirements() -> None:
    text = 'QualityReq rq1 "In time"\nBehaviorTree Main\n    Action Drive satisfies rq1\n'
    program = (
        "import sys; from btq_lang.checks import check; from btq_lang.workspace import Workspace\n"
        f"assert check(Workspace.of({{'a.btq': {text!r}}}), 'a.btq') == ()\n"
        "print([name for name in sys.modules if name.startswith('btq_lang.requirements')])"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=PACKAGE.parent
    )
    assert run.stdout == "[]\n"


def test_every_module_has_a_row() -> None:
    assert {module for module, _ in modules()} - {"__init__"} <= set(ROW_OF)


def test_no_module_is_named_as_one_of_the_standard_library() -> None:
    assert not {path.stem for _, path in modules()} & (sys.stdlib_module_names - {"__init__", "__main__"})


@pytest.mark.parametrize(
    ("statement", "absent"),
    [
        ("import btq_lang", {"pygls", "lsprotocol", "lxml", "btq_lang.parser"}),
        (
            "import btq_lang.cli; btq_lang.cli.main(['check', 'examples/laboratory'])",
            {"pygls", "lsprotocol", "lxml", "dataclasses", "inspect", "pathlib", "json", "asyncio", "multiprocessing"}
            | {"argparse", "ast", "btq_lang.fixes", "btq_lang.render.full"},
        ),
        (
            "import btq_lang.commands.arguments",
            {"btq_lang.parser", "btq_lang.workspace", "btq_lang.catalog", "btq_lang.requirements", "dataclasses"},
        ),
        ("import btq_lang.cli; btq_lang.cli.main(['--version'])", {"argparse", "btq_lang.parser"}),
        (
            "import site; site.main(); import btq_lang.server",  # what an editor waits for
            {"btq_lang.parser", "btq_lang.workspace", "btq_lang.checks", "btq_lang.catalog", "lxml"},
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
