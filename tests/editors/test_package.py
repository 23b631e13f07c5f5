"""The extension's package: what is in it, and that its server needs nothing but the standard library."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from installed import ROOT, STORE, there
from lsp_editor import Editor

from btq_lang.btcpp import recognition

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
    "syntaxes/btq.tmLanguage.json",
    "walkthrough/check.md",
    "walkthrough/mistake.md",
    "walkthrough/project.md",
    "walkthrough/python.md",
}
# Those of C++ are the program that runs scenarios in an installed engine.
ENDINGS = {"", ".btq", ".cpp", ".css", ".hpp", ".html", ".j2", ".js", ".json", ".md", ".py", ".pyi", ".txt", ".typed"}


@pytest.fixture(scope="session")
def unpacked(vsix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("vsix")
    with zipfile.ZipFile(vsix) as archive:
        archive.extractall(folder)
    return folder / "extension"


def run(unpacked: Path, *arguments: str, **options: object) -> subprocess.CompletedProcess[bytes]:
    """The bundled btq, by a Python that finds no package but those in the bundle."""
    command = bundled(unpacked, *arguments)
    return subprocess.run(command, capture_output=True, **options)  # type: ignore[call-overload,no-any-return]  # options


def bundled(unpacked: Path, *arguments: str) -> tuple[str, ...]:
    return (sys.executable, "-I", "-S", str(unpacked / "python/run_btq.py"), *arguments)


def test_the_package_is_small(vsix: Path) -> None:
    assert vsix.stat().st_size < 3_000_000


def test_there_is_what_belongs_there_and_no_more(unpacked: Path) -> None:
    files = {path.relative_to(unpacked).as_posix() for path in unpacked.rglob("*") if path.is_file()}
    python = {name for name in files if name.startswith(("python/libs/", "python/btq_lang/"))}
    assert files - python == FILES_OF_THE_EXTENSION
    assert {Path(name).suffix for name in python} <= ENDINGS
    assert {name.split("/")[2] for name in python if "dist-info" not in name} >= {
        "pygls",
        "lsprotocol",
        "cattrs",
        "jinja2",
    }


def test_every_setting_and_every_command_is_tested() -> None:
    """In the workbench: a setting is written, a command is chosen by its title or by a button that runs it."""
    contributes = json.loads((ROOT / "editors/vscode/package.json").read_text(encoding="utf-8"))["contributes"]
    tests = "".join(path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_vscode*.py"))
    settings = contributes["configuration"]["properties"]
    assert [name for name in settings if f'"{name}"' not in tests] == []
    assert [each["title"] for each in contributes["commands"] if each["title"] not in tests] == []


def test_the_node_of_the_readme_packs_it_without_a_warning() -> None:
    """npm warns (EBADENGINE) of each package of the lock file whose `engines` exclude the Node that runs."""
    assert "needs Node.js 20 or newer to pack the extension" in (ROOT / "README.md").read_text(encoding="utf-8")
    lock = json.loads((ROOT / "editors/vscode/package-lock.json").read_text(encoding="utf-8"))
    needs = {name: package.get("engines", {}).get("node", "*") for name, package in lock["packages"].items()}
    assert len(needs) > 100
    assert {name: need for name, need in needs.items() if not any(map(admits_20_19, need.split("||")))} == {}


def admits_20_19(versions: str) -> bool:
    """Whether one alternative of a range of npm's admits Node 20.19, the last line of 20: of the forms that occur."""
    least = re.fullmatch(r"\s*>=\s*(\d+)(?:\.(\d+))?(?:\.\d+)?\s*", versions)
    return versions.strip() in ("*", "20") or (least is not None and (int(least[1]), int(least[2] or 0)) <= (20, 19))


def test_every_library_is_pure_python(unpacked: Path) -> None:
    """Of MarkupSafe, whose wheels are compiled, only the Python part is there: all files end as in `ENDINGS`."""
    wheels = {path.parent.name.partition("-")[0]: path for path in unpacked.glob("python/libs/*.dist-info/WHEEL")}
    assert len(wheels) == 9
    del wheels["markupsafe"]
    assert {path.name for path in unpacked.glob("python/libs/markupsafe/*")} == {
        "__init__.py",
        "_native.py",
        "py.typed",
    }
    assert {
        line for wheel in wheels.values() for line in wheel.read_text().splitlines() if line.startswith("Tag:")
    } <= {
        "Tag: py3-none-any",
        "Tag: py2-none-any",
    }


def test_the_bundled_server_starts_and_answers(unpacked: Path, tmp_path: Path) -> None:
    messages: list[dict[str, object]] = [
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
    page = run(unpacked, "trace", "robot", "--format", "html", cwd=tmp_path)
    assert (page.returncode, page.stderr) == (0, b"")
    assert page.stdout.startswith(b"<!DOCTYPE html>")


def test_the_bundled_server_draws_the_overview(unpacked: Path, tmp_path: Path) -> None:
    editor = Editor(tmp_path, command=bundled(unpacked, "lsp", "--stdio"))
    editor.open(
        "main.btq", 'QualityReq "Less <x>" : safety\n    takes at most 1 s\nBehaviorTree Main\n    Action Drive\n'
    )
    document = editor.document("main.btq")["textDocument"]
    page = editor.request("workspace/executeCommand", command="btq.server.overview", arguments=[document])
    assert "Less &lt;x&gt;</a>" in page
    assert editor.close() == ""


XML = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Pick">
    <SequenceStar><Grip force="&"/></SequenceStar>
  </BehaviorTree>
</root>
"""
MISSION = """\
include "pick.xml"

BehaviorTree Main
    Rety (num_attempts = 3)
        SubTree Pick
"""
IMPORTED = """\
Root (BTCPP_format = 4)

BehaviorTree Pick
    M->
        Grip (force = "&")
"""


def test_the_bundled_commands_read_xml(unpacked: Path, tmp_path: Path) -> None:
    """Without lxml, which is not in the bundle; what is wrong with one file hides nothing of the others."""
    (tmp_path / "pick.xml").write_text(XML, encoding="utf-8")
    (tmp_path / "torn.xml").write_text(XML.replace("</root>", ""), encoding="utf-8")
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    checked = run(unpacked, "check", "--output-format", "concise", cwd=tmp_path)
    assert (checked.returncode, checked.stderr.decode()) == (1, "")
    assert checked.stdout.decode().splitlines() == [
        "main.btq:4:5: warning[unknown-node] unknown node `Rety`; did you mean `Retry`?",
        "pick.xml:3:6: warning[not-an-engine-node] `SequenceStar` is not built into BehaviorTree.CPP 4.6–4.10",
        "pick.xml:3:32: warning[xml-not-well-formed] "
        "the engine reads this, but no other XML tool does: `&` does not begin a reference",
        "torn.xml:1:1: error[xml-syntax] <root> is never closed",
        "Found 1 error, 3 warnings (1 fixable with --fix)",
    ]
    assert run(unpacked, "check", "--fix", "pick.xml", cwd=tmp_path).returncode == 1
    assert (tmp_path / "pick.xml").read_text("utf-8") == XML.replace("SequenceStar", "SequenceWithMemory")
    assert run(unpacked, "import", "pick.xml", cwd=tmp_path).returncode == 0
    assert (tmp_path / "pick.btq").read_text("utf-8") == IMPORTED
    assert run(unpacked, "build", "-o", "made", "pick.btq", cwd=tmp_path).returncode == 0
    assert '<Grip force="&amp;"/>' in (tmp_path / "made/pick.xml").read_text("utf-8")


def test_the_bundled_server_reads_xml(unpacked: Path, tmp_path: Path) -> None:
    """It checks an XML mission, offers a fix and converts it; a mission beside it has its own diagnostics."""
    (tmp_path / "pick.xml").write_text(XML, encoding="utf-8")
    (tmp_path / "main.btq").write_text(MISSION, encoding="utf-8")
    editor = Editor(tmp_path, command=bundled(unpacked, "lsp", "--stdio"))
    editor.open("pick.xml", XML)
    assert editor.diagnostics("pick.xml") == [("not-an-engine-node", 2, 5, 17), ("xml-not-well-formed", 2, 31, 32)]
    editor.open("main.btq", MISSION)
    assert editor.diagnostics("main.btq") == [("unknown-node", 3, 4, 8)]
    at = {"line": 2, "character": 8}
    asked = {**editor.document("pick.xml"), "range": {"start": at, "end": at}, "context": {"diagnostics": []}}
    action = editor.request("textDocument/codeAction", **asked)[0]
    edits = action["edit"]["changes"][editor.uri("pick.xml")]
    assert action["title"] == "Replace it with `SequenceWithMemory`"
    assert [(each["range"]["start"]["character"], each["newText"]) for each in edits] == [
        (5, "SequenceWithMemory"),
        (37, "SequenceWithMemory"),
    ]
    document = editor.document("pick.xml")["textDocument"]
    converted = editor.request("workspace/executeCommand", command="btq.server.import", arguments=[document])
    assert converted["files"] == [editor.uri("pick.btq")]
    assert (tmp_path / "pick.btq").read_text("utf-8") == IMPORTED.replace("M->", "SequenceStar")
    assert editor.close() == ""


@pytest.mark.scheduled
@pytest.mark.parametrize("page", ["docs/editors.md", "README.md"])
def test_the_commands_of_the_pages_pack_and_install(page: str, node: Path, unpacked: Path, tmp_path: Path) -> None:
    """In a copy of this checkout, with npm, vsce and the command line of VS Code.

    Only what would be downloaded is taken from where install.sh has put it: `npm ci` links the modules that it has
    installed with the same command, and `pip install` copies the libraries of the package that it made.
    """
    modules = there(ROOT / "editors/vscode/node_modules", "the extension's modules", "package")
    server = there(STORE / "vscode/node_modules/code-server/out/node/entry.js", "VS Code", "vscode")
    for name in ("editors/vscode", "btq_lang"):
        shutil.copytree(ROOT / name, tmp_path / "btq" / name, ignore=IGNORED)
    shutil.copy(ROOT / "LICENSE", tmp_path / "btq")
    programs = {
        "code": f'exec "{node}" "{server}" --user-data-dir ~/user --extensions-dir ~/installed "$@"',
        "python": f"""
            case "$*" in
                *" install "*) cp -r "{unpacked}/python/libs" python ;;
                *) exec "{sys.executable}" "$@" ;;
            esac""",
    }
    for name, does in programs.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{does}\n")
        (tmp_path / name).chmod(0o755)
    (command,) = re.findall(r"^.*\bnpm ci .*--install-extension .*$", (ROOT / page).read_text("utf-8"), re.MULTILINE)
    installs = f"""
        npm() {{
            case " $* " in
                *" ci "*) ln -s "{modules}" "{tmp_path}/btq/editors/vscode/node_modules" ;;
                *) command npm "$@" ;;
            esac
        }}
    """
    path = f"{tmp_path}{os.pathsep}{node.parent}{os.pathsep}{os.environ['PATH']}"
    subprocess.run(
        ["bash", "-euc", installs + command],
        cwd=tmp_path / "btq",
        env={**os.environ, "HOME": str(tmp_path), "PATH": path, "PYTHON": str(tmp_path / "python")},
        check=True,
        capture_output=True,
        timeout=300,
    )
    (manifest,) = (tmp_path / "installed").glob("btq.btq-*/package.json")
    assert json.loads(manifest.read_text("utf-8"))["name"] == "btq"
    contents = {path.name for path in manifest.parent.rglob("*") if path.is_file()}
    assert {"extension.js", "run_btq.py", "server.py"} <= contents


IGNORED = shutil.ignore_patterns("node_modules", "libs", "dist", "__pycache__", "*.vsix")


def test_xml_is_told_apart_as_the_server_does() -> None:
    """The extension looks at XML before it starts a server, by the same patterns."""
    source = (ROOT / "editors/vscode/src/documents.ts").read_text(encoding="utf-8")
    patterns = [pattern.replace("\\/", "/") for pattern in re.findall(r"/\^(.*)/s;", source)]
    assert patterns == [recognition._PROLOG.pattern, recognition._ROOT.pattern]
