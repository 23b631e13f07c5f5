"""The extension's package: what is in it, and that its server needs nothing but the standard library."""

from __future__ import annotations

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

FILES_OF_THE_EXTENSION = {
    "LICENSE.txt",
    "dist/extension.js",
    "images/file-dark.svg",
    "images/file-light.svg",
    "images/icon.png",
    "images/icon.svg",
    "language-configuration.json",
    "package.json",
    "python/requirements.txt",
    "python/run_btq.py",
    "readme.md",
    "snippets/btq.json",
    "syntaxes/btq.tmLanguage.json",
    "walkthrough/check.md",
    "walkthrough/mistake.md",
    "walkthrough/project.md",
    "walkthrough/python.md",
}


@pytest.fixture(scope="session")
def unpacked(vsix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("vsix")
    with zipfile.ZipFile(vsix) as archive:
        archive.extractall(folder)
    return folder / "extension"


def run(unpacked: Path, *arguments: str, **options: object) -> subprocess.CompletedProcess[bytes]:
    """The bundled btq, by a Python that finds no package but those in the bundle."""
    command = [sys.executable, "-I", "-S", str(unpacked / "python/run_btq.py"), *arguments]
    return subprocess.run(command, capture_output=True, **options)  # type: ignore[call-overload,no-any-return]  # options


def test_the_package_is_small(vsix: Path) -> None:
    assert vsix.stat().st_size < 3_000_000


def test_there_is_what_belongs_there_and_no_more(unpacked: Path) -> None:
    files = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if path.is_file()}
    python = {name for name in files if name.startswith(("python/libs/", "python/btq_lang/"))}
    assert files - python == FILES_OF_THE_EXTENSION
    assert {Path(name).suffix for name in python} <= {".py", ".pyi", ".md", ".typed", ".txt", ".json", ".html", ""}
    assert {name.split("/")[2] for name in python if "dist-info" not in name} >= {"pygls", "lsprotocol", "cattrs"}


def test_every_library_is_pure_python(unpacked: Path) -> None:
    wheels = sorted(unpacked.glob("python/libs/*.dist-info/WHEEL"))
    assert len(wheels) == 7
    assert {line for wheel in wheels for line in wheel.read_text().splitlines() if line.startswith("Tag:")} <= {
        "Tag: py3-none-any",
        "Tag: py2-none-any",
    }


def test_the_bundled_server_starts_and_answers(unpacked: Path, tmp_path: Path) -> None:
    messages = [
        {"id": 1, "method": "initialize", "params": {"processId": None, "rootUri": None, "capabilities": {}}},
        {"method": "initialized", "params": {}},
        {"id": 2, "method": "shutdown"},
        {"method": "exit"},
    ]
    bodies = [json.dumps({"jsonrpc": "2.0", **message}).encode() for message in messages]
    spoken = b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(body), body) for body in bodies)
    answer = run(unpacked, "lsp", "--stdio", input=spoken, cwd=tmp_path, timeout=60)
    assert (answer.returncode, answer.stderr) == (0, b"")
    assert b'"serverInfo":{"name":"btq"' in answer.stdout.replace(b'": ', b'":')


def test_the_bundled_commands_run(unpacked: Path, tmp_path: Path) -> None:
    assert run(unpacked, "init", "robot", cwd=tmp_path).returncode == 0
    checked = run(unpacked, "check", "robot", cwd=tmp_path)
    assert (checked.returncode, checked.stderr) == (0, b"")
