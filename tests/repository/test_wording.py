"""Messages, documents, docstrings and comments are in plain English, without phrases that readers stumble over.

The tests read the string literals, docstrings and comments of the modules, the pages of the rules, the page of the
preview, the schemas, the texts of the editors' extensions, and the documents.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

import btq_lang as btq
from btq_lang.workspace.workspace import Workspace

ROOT = Path(__file__).resolve().parents[2]
AVOIDED = re.compile(
    r"\b(?:(?<!there )is no (?!longer\b)|(?<!there )is none\b|speaks? of\b|behind\b|stands?\b|told\b|makes no\b|"
    r"who asks\b|slip(?:s|ped)?\b|left (?:over|alone|as)\b|taken out\b|anew\b|knows? no\b|all there is\b|"
    r"has it that\b|rests? on\b|brings?\b)"
)
IN_REMARKS = re.compile(rf"{AVOIDED.pattern}|\b(?:[Nn]obody|[Ss]omebody|[Ww]hoever)\b")
ARGUMENT = re.compile(r"(?m)^ +[\w*]+(?:, [\w*]+)*: ")  # names in a docstring, as `behind:`
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
TEXTS = (
    "README.md",
    "CHANGELOG.md",
    "docs/*.md",
    "btq_lang/diagnostics/rules/*.md",
    "btq_lang/**/*.html",
    "btq_lang/**/*.json",
    "editors/*/README.md",
    "editors/vscode/package.json",
    "editors/vscode/src/*.ts",
    "editors/vscode/walkthrough/*.md",
    "editors/nvim/**/*.lua",
    "editors/nvim/doc/*.txt",
    "examples/*/README.md",
)


def literals(source: str) -> Iterator[tuple[int, str]]:
    """The string literals of a module and their lines, also parts of f-strings; no docstrings and no identifiers."""
    tree = ast.parse(source)
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, DOCUMENTED) and node.body and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Constant) or id(node) in docstrings:
            continue
        if isinstance(node.value, str) and not node.value.isidentifier():
            yield node.lineno, node.value


def remarks(source: str) -> Iterator[tuple[int, str]]:
    """The docstrings and blocks of comments of a module and their lines, each on one line."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, DOCUMENTED) and (docstring := ast.get_docstring(node)):
            yield node.body[0].lineno, " ".join(ARGUMENT.sub(" ", docstring).split())
    block: list[tokenize.TokenInfo] = []
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            block.append(token)
        elif block and token.type != tokenize.NL:
            yield block[0].start[0], " ".join(each.string.lstrip("#: ") for each in block)
            block = []


def texts(pattern: str) -> Iterator[tuple[str, int, str]]:
    """Every text of the files that match, with its path and line."""
    for path in sorted(ROOT.glob(pattern)):
        text = path.read_text(encoding="utf-8")
        lines = literals(text) if path.suffix == ".py" else enumerate(text.splitlines(), 1)
        yield from ((path.relative_to(ROOT).as_posix(), line, words) for line, words in lines)


@pytest.mark.parametrize("pattern", ["btq_lang/**/*.py", *TEXTS])
def test_no_phrase_that_readers_stumble_over(pattern: str) -> None:
    found = list(texts(pattern))
    assert found != []
    assert avoided(found, AVOIDED) == []


def test_no_such_phrase_in_docstrings_and_comments() -> None:
    found = [
        (path.relative_to(ROOT).as_posix(), line, words)
        for path in sorted((ROOT / "btq_lang").rglob("*.py"))
        for line, words in remarks(path.read_text(encoding="utf-8"))
    ]
    assert found != []
    assert avoided(found, IN_REMARKS) == []


def avoided(found: list[tuple[str, int, str]], phrases: re.Pattern[str]) -> list[str]:
    """The avoided phrases in texts, each with its place and what is around it."""
    return [
        f"{path}:{line}: {words[max(0, at.start() - 60) : at.end() + 40]}"
        for path, line, words in found
        for at in phrases.finditer(words)
    ]


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        ("Timeout (msec = 30 sek)\n        A\n", ["unknown unit `sek`; did you mean `s`?"]),
        ("Retry (num_attempts = a)\n        A\n", ["expected an integer for `num_attempts`, found `a`"]),
        ("Rety (num_attempts = 3)\n        A\n", ["unknown node `Rety`; did you mean `Retry`?"]),
        ("CoroAction\n", ["`CoroAction` is not built into BehaviorTree.CPP 4.6–4.10"]),
        (
            'A satisfies r\nQualityReq r "t"\n    leaves battery >= 3 N\nsignal battery : % from {b}\n',
            ["cannot compare `battery` (a percentage) with `3 N` (a force)"],
        ),
        ('Script (code = "a := ")\n', ["missing right-hand side of `:=`"]),
    ],
)
def test_messages_say_what_is_wrong_and_what_to_do(text: str, messages: list[str]) -> None:
    workspace = Workspace.of({"main.btq": f"BehaviorTree Main\n    {text}"})
    assert [found.message for found in btq.check(workspace, "main.btq")] == messages
