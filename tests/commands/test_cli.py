"""The commands as a person runs them: the output, the exit code, and the files that are left."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from in_process import run_btq
from running_process import running

from btq_lang import __version__
from btq_lang.catalog.language import SIGNS
from btq_lang.catalog.verdicts import VERDICTS
from btq_lang.diagnostics.rules import RULES
from btq_lang.evidence.verdicts import WORST_FIRST
from btq_lang.util import processes
from btq_lang.workspace.config import parse_project

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def process(tmp_path: Path) -> Run:
    """Run `btq` as a process in an empty folder."""

    def run(*arguments: str, stdin: str | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "btq_lang", *arguments],
            cwd=tmp_path,
            input=stdin,
            capture_output=True,
            encoding="utf-8",
            env={**os.environ, "NO_COLOR": "1", "PYTHONUTF8": "1"},
            timeout=60,
        )

    return run


@pytest.fixture
def btq(tmp_path: Path) -> Run:
    """The same in this process, without its start."""

    def run(*arguments: str, stdin: str | bytes = "") -> subprocess.CompletedProcess[str]:
        return subprocess.CompletedProcess(arguments, *run_btq(*arguments, cwd=tmp_path, stdin=stdin))

    return run


WRONG = "BehaviorTree Main\n    ->\n        Sequnce\n            Dock\n        Timeout (msec = -5)\n            Dock\n"


def test_version(process: Run) -> None:
    assert process("--version").stdout == f"btq {__version__}\n"
    assert process("-V").returncode == 0


def test_help_says_what_there_is(process: Run) -> None:
    done = process("--help")
    assert done.returncode == 0
    for command in ("check", "format", "build", "import", "explain", "init", "completion"):
        assert f"  {command} " in done.stdout
    assert "exit codes: 0 clean, 1 findings, 2 usage or I/O" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("check", "--watch", "-"), "check: --watch cannot watch standard input"),
        (("check", ""), "check: empty path; `.` is this folder"),
        (("check", "--color", "never", ""), "check: empty path; `.` is this folder"),
        (("check", "--jobs", "-1"), "check: --jobs -1: expected a number of processes, or 0 to let btq choose"),
        (("check", "--select", "unknown-nod"), "check: unknown rule `unknown-nod`; did you mean `unknown-node`?"),
        (("format", ""), "format: empty path; `.` is this folder"),
    ],
)
def test_usage_errors(btq: Run, arguments: tuple[str, ...], message: str) -> None:
    done = btq(*arguments)
    assert (done.stdout, done.stderr, done.returncode) == ("", f"btq {message}\n", 2)


def test_no_command_and_unknown_words_are_usage_errors(btq: Run) -> None:
    assert btq().returncode == 2
    done = btq("chekc")
    assert (done.returncode, done.stderr.endswith("; did you mean check?\n")) == (2, True)
    done = btq("check", "--output-format", "jsno")
    assert (done.returncode, done.stderr.endswith("; did you mean json?\n")) == (2, True)
    assert btq("check", "--output-format", "yaml").returncode == 2
    done = btq("format", "--chekc")
    assert (done.returncode, done.stderr.splitlines()[-1]) == (2, "btq format: error: unrecognized arguments: --chekc")
    assert done.stderr.startswith("usage: btq format ")
    done = btq("check", "--select", "unknown-nod")
    assert (done.returncode, done.stdout) == (2, "")
    assert "unknown-node" in done.stderr


@pytest.mark.parametrize(
    ("mixed", "ordered"),
    [
        ("check a.btq --output-format json b.btq", "check --output-format json a.btq b.btq"),
        ("format a.btq --check b.btq", "format --check a.btq b.btq"),
        ("build a.btq --no-enforce b.btq", "build --no-enforce a.btq b.btq"),
        ("trace a.btq --format csv b.btq", "trace --format csv a.btq b.btq"),
        ("diff a.btq --format json b.btq", "diff --format json a.btq b.btq"),
        ("explain takes --color never at most", "explain --color never takes at most"),
        ("graph --format dot a.btq --qualities", "graph --format dot --qualities a.btq"),
        ("schema xsd --target 4.6 a.btq", "schema --target 4.6 xsd a.btq"),
    ],
)
def test_options_and_paths_may_come_in_any_order(btq: Run, tmp_path: Path, mixed: str, ordered: str) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.btq").write_text(
            WRONG.replace("Main", name) if name == "b" else "BehaviorTree a\n    Dock\n"
        )
    done, expected = btq(*mixed.split()), btq(*ordered.split())
    assert (done.stdout, done.stderr, done.returncode) == (expected.stdout, expected.stderr, expected.returncode)
    assert "unrecognized" not in done.stderr


@pytest.mark.parametrize("command", ["build", "import"])
@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("-", "expected a folder; input from `-` goes to standard output"),
        ("out.xml", "expected a folder; each file keeps its name there"),
        ("out.btq", "expected a folder; each file keeps its name there"),
    ],
)
def test_a_folder_is_asked_for(btq: Run, command: str, output: str, message: str) -> None:
    done = btq(command, "mission.btq", "-o", output)
    told = done.stderr.endswith(f"error: argument -o/--output: {message}\n")
    assert (done.returncode, done.stdout, told) == (2, "", True)


def test_check_a_clean_folder(process: Run) -> None:
    done = process("check", str(EXAMPLES / "laboratory"))
    assert (done.returncode, done.stdout, done.stderr) == (0, "No problems found in 2 files\n", "")


def test_check_shows_the_place(process: Run, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    done = process("check")
    assert done.returncode == 1
    assert done.stdout.startswith(
        "warning[unknown-node]: unknown node `Sequnce`; did you mean `Sequence`?\n --> main.btq:3:9\n"
    )
    assert "  = help: Replace `Sequnce` with `Sequence`\n" in done.stdout
    assert done.stdout.endswith("Found 1 error, 1 warning\n")


def test_check_names_folders_as_seen_from_the_current_one(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('include-paths = ["shared", "/opt/missions"]\n')
    (tmp_path / "lab").mkdir()
    (tmp_path / "shared").mkdir()
    (tmp_path / "lab" / "main.btq").write_text('include "gone.btq"\nBehaviorTree Main\n    Wait\n')
    (note,) = (
        line for line in btq("check", "--select", "missing-include").stdout.splitlines() if "include-paths" in line
    )
    assert re.findall("`[^`]*`", note)[:3] == ["`lab`", "`shared`", "`/opt/missions`"]


def test_check_concise_and_json_agree(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    lines = btq("check", "--output-format", "concise").stdout.splitlines()
    assert lines[0] == "main.btq:3:9: warning[unknown-node] unknown node `Sequnce`; did you mean `Sequence`?"
    assert lines[1].startswith("main.btq:5:25: error[invalid-literal] expected ")
    found = json.loads(btq("check", "--output-format", "json").stdout)
    assert [each["rule"] for each in found["diagnostics"]] == ["unknown-node", "invalid-literal"]


@pytest.mark.parametrize("form", ["sarif", "github", "junit"])
def test_check_for_machines(btq: Run, tmp_path: Path, form: str) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    done = btq("check", "--output-format", form)
    assert done.returncode == 1
    assert "unknown-node" in done.stdout
    assert "Sequnce" in done.stdout


def test_select_ignore_and_severity(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    concise = ("check", "--output-format", "concise")
    assert btq(*concise, "--select", "invalid-literal").stdout.count("[") == 1
    assert btq(*concise, "--ignore", "invalid-literal,unknown-node").returncode == 0
    done = btq(*concise, "--severity", "error")
    assert [line.split(": ")[1][:5] for line in done.stdout.splitlines()[:-1]] == ["error"]


def test_hints_alone_are_clean(btq: Run) -> None:
    done = btq("check", str(EXAMPLES / "classic"))
    assert done.returncode == 0
    assert "hint[" in done.stdout


def test_standard_input(process: Run) -> None:
    done = process("check", "--output-format", "concise", "-", stdin="BehaviorTree Main\n    Sequnce\n        Dock\n")
    assert done.returncode == 1
    assert done.stdout.startswith("<stdin>:2:5: warning[unknown-node]")


def test_standard_input_with_a_name_finds_its_includes(process: Run, tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "skills.btq").write_text("Action Dock\n")
    text = 'include "skills.btq"\nBehaviorTree Main\n    Dock (x = 1)\n'
    done = process("check", "--output-format", "concise", "--stdin-filename", "lib/main.btq", "-", stdin=text)
    assert done.stdout.splitlines()[0] == "lib/main.btq:3:11: warning[unknown-port] `Dock` has no port `x`"


def test_fix_mends_what_is_certain_and_reports_the_rest(btq: Run, tmp_path: Path) -> None:
    file = tmp_path / "main.btq"
    file.write_text(
        "BehaviorTree Main\n    ->\n        SequenceStar\n            Dock\n        Sequnce\n            Dock\n"
    )
    done = btq("check", "--fix")
    assert file.read_text() == (
        "BehaviorTree Main\n    ->\n        SequenceWithMemory\n            Dock\n        Sequnce\n            Dock\n"
    )
    assert done.returncode == 1
    assert done.stdout.endswith("Found 1 warning\n") or "Fixed 1 problem\n" in done.stdout
    assert "SequenceStar" not in done.stdout


def test_fix_of_standard_input_prints_the_new_text(process: Run) -> None:
    done = process("check", "--fix", "-", stdin="BehaviorTree Main\n    SequenceStar\n        Dock\n")
    assert done.stdout == "BehaviorTree Main\n    SequenceWithMemory\n        Dock\n"


def test_a_missing_file_is_trouble_and_the_others_are_checked(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    done = btq("check", "main.btq", "nowhere.btq")
    assert done.returncode == 2
    assert done.stderr == "btq: nowhere.btq: cannot be read: No such file or directory\n"
    assert "unknown-node" in done.stdout


def test_nothing_checked_is_not_called_clean(btq: Run) -> None:
    done = btq("check", "nowhere.btq")
    assert (done.returncode, done.stdout) == (2, "No files were checked\n")


def test_a_folder_without_missions_is_named(btq: Run, tmp_path: Path) -> None:
    for folder in ("empty", "x.btq"):
        (tmp_path / folder).mkdir()
    done = btq("check", "empty", "x.btq/")
    assert (done.returncode, done.stdout, done.stderr) == (
        2,
        "No files were checked: no .btq file and no BehaviorTree.CPP XML below empty/, x.btq/\n",
        "",
    )
    done = btq("check", "empty", "--output-format", "github")
    assert (done.returncode, done.stdout, done.stderr) == (
        2,
        "",
        "btq check: no .btq file and no BehaviorTree.CPP XML below empty/\n",
    )
    for command in ("build", "trace", "graph"):
        done = btq(command, "x.btq")
        assert (done.returncode, done.stdout, done.stderr) == (2, "", f"btq {command}: no .btq file below x.btq/\n")
    (tmp_path / "a.btq").write_text("BehaviorTree Main\n    AlwaysSuccess\n")
    assert btq("check", "empty", "a.btq").returncode == 0


XML = """\
<root BTCPP_format="4">
  <BehaviorTree ID="Main">
    <SubTree ID="Pick"/>
  </BehaviorTree>
</root>
"""


def test_xml_is_checked_and_shown_as_it_stands(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(XML)
    done = btq("check", "--fix", "tree.xml")
    assert done.stdout == (
        "error[unknown-tree]: unknown tree `Pick`; no file of the project defines it\n"
        " --> tree.xml:3:18\n"
        "  |\n"
        '2 |   <BehaviorTree ID="Main">\n'
        '3 |     <SubTree ID="Pick"/>\n'
        "  |                  ^^^^\n"
        "4 |   </BehaviorTree>\n"
        "\n"
        "Found 1 error\n"
    )
    assert (done.returncode, (tmp_path / "tree.xml").read_text()) == (1, XML)


def test_xml_is_not_formatted(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "tree.xml").write_text(XML)
    done = btq("format", "tree.xml")
    assert done.returncode == 2
    assert done.stderr.startswith(
        "btq: tree.xml: this is XML, which `btq format` does not change; `btq import` converts it to .btq\n"
    )


OLD = """\
<!-- one tube -->
<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <SequenceStar>
      <SubTree ID="Pick" tube="current"/>
    </SequenceStar>
  </BehaviorTree>
</root>
"""


def test_import_writes_beside_the_xml_and_says_what_changed(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "old.xml").write_text(OLD)
    done = btq("import", "old.xml")
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == (
        'old.xml:2:2: BTCPP_format="4" is added\n'
        "old.xml:4:6: SequenceStar is now SequenceWithMemory\n"
        'old.xml:5:26: tube="current" of a SubTree names an entry: now "{current}"\n'
        "1 file imported with 3 changes\n"
        "Next: btq check old.btq\n"
    )
    text = "# one tube\n\nRoot Main\n\nBehaviorTree Main\n    M->\n        SubTree Pick (tube = {current})\n"
    assert (tmp_path / "old.btq").read_text() == text


def test_import_keeps_version_3_if_asked(process: Run) -> None:
    done = process("import", "--keep-v3", "-", stdin=OLD)
    assert done.stdout == (
        '# one tube\n\nRoot Main ()\n\nBehaviorTree Main\n    SequenceStar\n        SubTree Pick (tube = "current")\n'
    )
    assert (done.returncode, done.stderr) == (0, "1 file imported\n")


def test_import_writes_over_nothing(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "x.xml").write_text(XML)
    (tmp_path / "x.xml").write_text(XML)
    (tmp_path / "x.btq").write_text("mine")
    done = btq("import", "x.xml")
    assert (done.returncode, (tmp_path / "x.btq").read_text()) == (2, "mine")
    assert done.stderr == "btq: x.btq: already exists; --force overwrites it\n0 files imported\n"
    done = btq("import", "x.xml", "a/x.xml", "-o", "made")
    assert done.returncode == 2
    assert "btq: a/x.xml: not imported: x.xml would also become made/x.btq\n" in done.stderr
    assert not (tmp_path / "made").exists()
    assert btq("import", "x.xml", "-o", "made").returncode == 0
    assert (tmp_path / "made" / "x.btq").read_text() == (
        "Root (BTCPP_format = 4)\n\nBehaviorTree Main\n    SubTree Pick\n"
    )
    assert btq("import", "--force", "x.xml").returncode == 0
    assert (tmp_path / "x.btq").read_text() == (tmp_path / "made" / "x.btq").read_text()


def test_files_imported_together_include_each_other(btq: Run, tmp_path: Path) -> None:
    for name in ("main", "imported", "other"):
        includes = '<include path="sub/imported.xml"/><include path="sub/other.xml"/><include path="sub/absent.xml"/>'
        (tmp_path / "sub").mkdir(exist_ok=True)
        (tmp_path / ("" if name == "main" else "sub") / f"{name}.xml").write_text(
            f"<root BTCPP_format='4'>{includes if name == 'main' else ''}</root>"
        )
    done = btq("import", "main.xml", "sub/imported.xml", "-o", "made")
    assert (tmp_path / "made" / "main.btq").read_text() == (
        'Root (BTCPP_format = 4)\n\ninclude "imported.btq"\ninclude "../sub/other.xml"\ninclude "sub/absent.xml"\n'
    )
    assert "main.xml:1:39: includes `imported.btq`\n" in done.stderr
    assert btq("import", "main.xml", "sub/imported.xml").returncode == 0
    assert (tmp_path / "main.btq").read_text() == (
        'Root (BTCPP_format = 4)\n\ninclude "sub/imported.btq"\ninclude "sub/other.xml"\ninclude "sub/absent.xml"\n'
    )


def test_import_of_broken_xml_writes_nothing_and_shows_it(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "x.xml").write_text(XML.replace("</BehaviorTree>", "</Sequence>"))
    done = btq("import", "x.xml")
    assert (done.returncode, (tmp_path / "x.btq").exists()) == (1, False)
    assert done.stderr.startswith("error[xml-syntax]: expected </BehaviorTree>, found </Sequence>\n --> x.xml:4:3\n")
    assert done.stderr.endswith("0 files imported, 1 file not imported\n")
    assert btq("import", "nowhere.xml").returncode == 2
    assert btq("import").returncode == 2


def test_a_mission_includes_xml(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text('include "pick.xml"\n\nBehaviorTree Main\n    SubTree Pick\n')
    (tmp_path / "pick.xml").write_text(XML.replace("Main", "Pick").replace('<SubTree ID="Pick"/>', "<AlwaysSuccess/>"))
    assert btq("check").stdout == "No problems found in 2 files\n"


def test_an_error_in_an_included_file_is_told_once(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "lib.btq").write_text("BehaviorTree Lib\n    Pick (\n")
    (tmp_path / "main.btq").write_text('include "lib.btq"\nBehaviorTree Main\n    SubTree Lib\n')
    message = "missing `)` for this `(`"
    at_include = f"main.btq:1:9: error[include-with-errors] `lib.btq` has 1 error: {message}\n"
    itself = f"lib.btq:2:10: error[unclosed-bracket] {message}\n"
    for paths, told in ((["main.btq"], at_include), (["."], itself), (["main.btq", "lib.btq"], itself)):
        done = btq("check", "--output-format", "concise", *paths)
        assert (done.returncode, done.stdout) == (1, f"{told}Found 1 error\n")


def test_an_error_in_included_xml_is_told_once(btq: Run, tmp_path: Path) -> None:
    tree = '<root BTCPP_format="4">\n<BehaviorTree ID="Old"><Sequence/></BehaviorTree>\n</root>\n'
    (tmp_path / "old.xml").write_text(tree)
    (tmp_path / "m.btq").write_text('include "old.xml"\nRoot Main\nBehaviorTree Main\n    SubTree Old\n')
    message = "`Sequence` requires 1 or more children, found none"
    at_include = f"m.btq:1:9: error[include-with-errors] `old.xml` has 1 error: {message}\n"
    itself = f"old.xml:2:25: error[child-count] {message}\n"
    for paths, told in ((["m.btq"], at_include), (["."], itself), (["m.btq", "old.xml"], itself)):
        done = btq("check", "--output-format", "concise", *paths)
        assert (done.returncode, done.stdout) == (1, f"{told}Found 1 error\n")
    shown = btq("check", "m.btq").stdout
    assert "\nnote: here\n --> old.xml:2:25\n" in shown


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="this system has no /dev/full")
def test_an_output_that_cannot_be_written_is_trouble(tmp_path: Path) -> None:
    command = f"{sys.executable} -m btq_lang explain > /dev/full"
    done = subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0
    assert "Traceback" not in done.stderr


def test_a_file_that_is_no_utf8_is_checked_but_never_written(btq: Run, tmp_path: Path) -> None:
    file = tmp_path / "main.btq"
    file.write_bytes(b"BehaviorTree Main\n    SequenceStar\n        Dock # caf\xe9\n")
    done = btq("check", "--fix")
    assert done.returncode == 2
    assert done.stderr == "btq: main.btq:3:19: this is not UTF-8: byte 0xe9\n"
    for form, said in (("github", "::error file=main.btq,line=3,col=19,"), ("junit", "<error "), ("json", "io-error")):
        assert said in btq("check", "--output-format", form).stdout
    assert file.read_bytes() == b"BehaviorTree Main\n    SequenceStar\n        Dock # caf\xe9\n"


def test_bytes_that_are_no_text_are_told_once(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "latin.btq").write_bytes(b"BehaviorTree M\xfc\n    SequenceStar\n        A\n")
    (tmp_path / "program.btq").write_bytes(b"\x7fELF\xff\xfe\x01(\n")
    done = btq("check", "--output-format", "concise")
    assert done.returncode == 2
    assert done.stderr == (
        "btq: latin.btq:1:15: this is not UTF-8: byte 0xfc\nbtq: program.btq:1:5: this is not UTF-8: byte 0xff\n"
    )
    assert [line.split(" ", 1)[1].split("]")[0] for line in done.stdout.splitlines()[:-1]] == [
        "warning[not-an-engine-node"
    ]


def test_a_binary_file_is_one_error(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "program.btq").write_bytes(b"\x7fELF\0SequenceStar\0a ( b\n\0 \0->")
    done = btq("check", "--fix", "program.btq")
    expected = ("No files were checked\n", "btq: program.btq: this is not a text file\n", 2)
    assert (done.stdout, done.stderr, done.returncode) == expected


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"BehaviorTree M\n    SequenceStar\0\n", "this is not a text file"),
        (b"BehaviorTree M\n    SequenceStar # caf\xe9\n", "2:23: this is not UTF-8: byte 0xe9"),
        ("BehaviorTree M\n".encode("utf-16"), "1:1: this is UTF-16; save it as UTF-8"),
    ],
)
@pytest.mark.parametrize(
    "command", [("check",), ("check", "--fix"), ("format",), ("build",), ("trace",), ("graph",), ("import",)], ids=str
)
def test_standard_input_is_read_as_a_file_is(command: tuple[str, ...], data: bytes, problem: str, btq: Run) -> None:
    done = btq(*command, "-", stdin=data)
    told = f"btq: <stdin>:{problem}" if problem[0].isdigit() else f"btq: <stdin>: {problem}"
    assert done.returncode == 2
    assert told in done.stderr.splitlines()
    if command[0] in ("format", "import") or "--fix" in command:
        assert "SequenceStar" not in done.stdout  # to write it back would lose something


def test_what_fix_could_not_write_is_still_found(btq: Run, tmp_path: Path) -> None:
    file = tmp_path / "main.btq"
    file.write_text("BehaviorTree Main\n    SequenceStar\n        Dock\n")
    before = btq("check", "--output-format", "concise", "main.btq").stdout
    code = (
        "from btq_lang.commands import fixing\n"
        "from btq_lang.cli import main\n"
        "def refuse(path, text):\n"
        "    raise PermissionError(13, 'Permission denied', path)\n"
        "fixing.write_whole = refuse\n"
        "raise SystemExit(main(['check', '--fix', '--output-format', 'concise', 'main.btq']))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "NO_COLOR": "1"}
    )
    assert (done.returncode, done.stderr) == (2, "btq: main.btq: cannot be written: Permission denied\n")
    assert "SequenceStar" in before
    assert done.stdout == f"{before.rstrip()}; incomplete because of main.btq: cannot be written: Permission denied\n"


def test_the_project_file_counts(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('[rules]\nunknown-node = "off"\ninvalid-literal = "hint"\n')
    (tmp_path / "main.btq").write_text(WRONG)
    done = btq("check", "--output-format", "concise")
    assert done.returncode == 0
    assert [line.split()[1] for line in done.stdout.splitlines()[:-1]] == ["hint[invalid-literal]"]


def test_a_broken_project_file_is_trouble(btq: Run, tmp_path: Path) -> None:
    (tmp_path / "btq.toml").write_text('engin = "4.10"\n')
    done = btq("check")
    assert done.returncode == 2
    assert done.stderr.startswith("btq: btq.toml:1:1: ")


@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_many_files_on_several_processors_give_the_same_report(
    start: str, btq: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(processes, "START", start)
    for number in range(30):
        (tmp_path / f"m{number}.btq").write_text(WRONG.replace("Main", f"Main{number}"))
    one, two = btq("check", "--jobs", "1"), btq("check", "--jobs", "2")
    assert one.stdout == two.stdout
    assert one.stdout.count("unknown-node") == 30
    assert (one.returncode, two.returncode, two.stderr) == (1, 1, "")


def test_watch_checks_again_after_a_change(tmp_path: Path) -> None:
    file = tmp_path / "main.btq"
    file.write_text(WRONG)
    command = [sys.executable, "-u", "-m", "btq_lang", "check", "--watch", "--output-format", "concise"]
    with running(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        assert process.stdout is not None
        seen: list[str] = []

        def until(ending: str) -> None:
            for line in process.stdout or ():
                seen.append(line)
                if ending in line:
                    return
            raise AssertionError(f"no {ending!r} in {seen}")

        until("Watching for changes")
        assert any("unknown-node" in line for line in seen)
        stamp = time.time() + 2  # a file system may count whole seconds only
        file.write_text("BehaviorTree Main\n    Dock\n")
        os.utime(file, (stamp, stamp))
        until("main.btq changed")
        until("No problems found in 1 file")
        process.terminate()  # not SIGINT: a test run in the background has its children ignore that
        assert process.wait(20) == -signal.SIGTERM


def test_format_writes_checks_and_shows(btq: Run, tmp_path: Path) -> None:
    file = tmp_path / "main.btq"
    file.write_text("BehaviorTree Main\n  Retry(num_attempts=3)   # again\n    Dock\n")
    tidy = "BehaviorTree Main\n    Retry (num_attempts = 3)  # again\n        Dock\n"
    done = btq("format", "--check")
    assert (done.returncode, done.stdout) == (1, "would format main.btq\n")
    done = btq("format", "--diff")
    assert done.returncode == 1
    assert "+    Retry (num_attempts = 3)  # again" in done.stdout.splitlines()
    assert file.read_text() != tidy
    assert btq("format").returncode == 0
    assert file.read_text() == tidy
    done = btq("format", "--check")
    assert (done.returncode, done.stdout) == (0, "")


def test_format_leaves_a_file_with_syntax_errors_alone(btq: Run, tmp_path: Path) -> None:
    file = tmp_path / "main.btq"
    file.write_text("BehaviorTree Main\n  Retry (num_attempts 3)\n    Dock\n")
    done = btq("format")
    assert done.returncode == 1
    assert done.stderr.startswith("main.btq:2:")
    assert file.read_text() == "BehaviorTree Main\n  Retry (num_attempts 3)\n    Dock\n"


def test_format_of_standard_input(process: Run) -> None:
    done = process("format", "-", stdin="BehaviorTree Main\n  Dock\n")
    assert (done.returncode, done.stdout) == (0, "BehaviorTree Main\n    Dock\n")


@pytest.mark.parametrize(
    ("name", "first_line"),
    [
        ("unknown-node", "# unknown-node"),
        ("->", "# Sequence (Control)"),
        ("Retry", "# RetryUntilSuccessful (Decorator)"),
        ("time-behaviour", "# performance-efficiency.time-behaviour"),
        ("ManualSelector", "# ManualSelector"),
        ("Selector", "# Selector (of other engines)"),
        ("satisfies", "# satisfies (clause of a node)"),
        ("on violation", "# on violation (clause)"),
        ("violation", "# on violation (clause)"),
        ("io-error", "# io-error"),
        ("m/s", "# m/s (unit)"),
        ("%", "# % (unit)"),
        ("0.5 h", "# 0.5 h (quantity)"),
        ("text", "# text (in the place of a unit)"),
        ("_skipIf", "# _skipIf (attribute of a node)"),
        ("_autoremap", "# _autoremap (attribute of a node)"),
        ("_uid", "# _uid (attribute of a node, which the engine does not read)"),
        ("BTCPP_format", "# BTCPP_format (attribute of the file)"),
        ("SuccessIf", "# SuccessIf (classic form)"),
        ("num_attempts", "# num_attempts (port)"),
        ("std::string", "# std::string (type of a port)"),
        ("{goal}", "# { } (sign)"),
        ("{=}", "# {=} (sign)"),
        ("{@goal}", "# {@ } (sign)"),
        ("#", "# # (sign)"),
        ("btq: ignore[unused-tree]", "# btq: ignore (sign)"),
    ],
)
def test_explain(btq: Run, name: str, first_line: str) -> None:
    done = btq("explain", name)
    assert (done.returncode, done.stdout.splitlines()[0]) == (0, first_line)


def test_explain_of_several_names(btq: Run) -> None:
    done = btq("explain", "unknown-port", "Retry", "->")
    headings = [line for line in done.stdout.splitlines() if line.startswith("# ")]
    assert headings == ["# unknown-port", "# RetryUntilSuccessful (Decorator)", "# Sequence (Control)"]
    assert done.returncode == 0
    assert btq("explain", "time", "behaviour").stdout == btq("explain", "time-behaviour").stdout.replace(
        "`time-behaviour`", "`time behaviour`"
    )
    assert btq("explain", "takes at most").stdout == btq("explain", "takes").stdout != ""
    done = btq("explain", "Retry", "nonsense")
    assert done.stdout == btq("explain", "Retry").stdout
    assert done.stderr == ("btq explain: unknown name `nonsense`; `btq explain` says what there is\n")
    assert done.returncode == 2


def test_explain_of_something_unknown(btq: Run) -> None:
    done = btq("explain", "unknown-nod")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "btq explain: unknown name `unknown-nod`; did you mean unknown-node?\n"
    meant_by = (("kwh", "kWh"), ("_skipif", "_skipIf"), ("msecs_", "msec"), ("sek", "s"), ("skip", "skips?"))
    for name, meant in meant_by:
        assert f"did you mean {meant}" in btq("explain", name).stderr


def test_near_names_are_of_the_kind_that_is_asked_for(btq: Run) -> None:
    def meant(name: str) -> str:
        return btq("explain", name).stderr.partition("; ")[2].strip()

    assert btq("explain", "Selector").returncode == 0  # a name of other engines has a page of its own
    assert meant("Sequnce") == "did you mean Sequence?"
    assert meant("unused-nod") == "`btq explain` says what there is"
    assert meant("unused-tre") == "did you mean unused-tree?"
    assert meant("foo") == "`btq explain` says what there is"


def test_explain_lists_the_rules_on_one_screen(btq: Run) -> None:
    lines = btq("explain").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert len(lines) <= 58
    assert {word for line in lines for word in line.split()} > {*RULES}
    assert lines[lines.index("# XML") + 1] == "xml-syntax  xml-root  xml-not-well-formed  xml-ignored  refused-element"
    assert lines[-1] == "Lists: btq explain rules nodes qualities words signs attributes verdicts units"
    for kind in lines[-1].removeprefix("Lists: btq explain ").split():
        assert btq("explain", kind).stdout.startswith("# ")


def test_explain_of_units(btq: Run) -> None:
    assert btq("explain", "30 min").stdout == "# 30 min (quantity)\n\nMeasures time. It is 1800 s.\n"
    assert btq("explain", "msec", "deg").stdout.endswith(
        "# deg (unit)\n\nMeasures angle. 1 deg is 0.01745329252 rad.\n\ncompares with: rad, urad, mrad, rev\n"
    )


@pytest.mark.parametrize("sign", [sign for sign, _, _ in SIGNS])
def test_explain_knows_every_sign(btq: Run, sign: str) -> None:
    assert f"# {sign} (sign)" in btq("explain", sign).stdout


def test_init_makes_a_project_that_checks_clean_and_is_formatted(btq: Run, tmp_path: Path) -> None:
    assert btq("init", "robot").returncode == 0
    files = sorted(path.name for path in (tmp_path / "robot").iterdir())
    assert files == ["btq.toml", "mission.btq", "scenarios.btq", "skills.btq"]
    assert btq("check", "robot").stdout == "No problems found in 3 files\n"
    tested = btq("test", "robot")
    assert (tested.returncode, tested.stdout.splitlines()[-1]) == (0, "2 scenarios: 2 passed")
    assert btq("format", "--check", "robot").returncode == 0
    again = btq("init", "robot")
    assert (again.returncode, "nothing was written" in again.stderr) == (2, True)


def test_init_offers_a_table_for_logs(btq: Run, tmp_path: Path) -> None:
    """What is commented out in btq.toml is read when it is not."""
    btq("init", ".")
    text = (tmp_path / "btq.toml").read_text(encoding="utf-8")
    before, _, offered = text.partition("# [evidence]\n")
    lines = ["[evidence]", *(line.removeprefix("# ").removeprefix("#") for line in offered.splitlines())]
    project, problems = parse_project("\n".join((before, *lines)), root=str(tmp_path))
    assert [*problems] == []
    assert project.evidence is not None
    assert project.evidence.logs == ("logs/**/*.btlog",)
    assert [each.signal for each in project.evidence.signals] == ["battery"]


@pytest.mark.parametrize("name", WORST_FIRST)
def test_explain_knows_every_verdict(btq: Run, name: str) -> None:
    verdict = VERDICTS[name]
    for words in ([name], name.split()):
        done = btq("explain", *words)
        assert (done.returncode, done.stdout.partition("\n")[0]) == (0, f"# {name}")
    assert verdict.brief in done.stdout
    assert verdict.then in done.stdout
    assert f"{name:<20} {verdict.brief}\n" in btq("explain", "verdict").stdout
    assert [*VERDICTS] == [*WORST_FIRST]


def test_what_is_next_can_be_pasted(btq: Run, tmp_path: Path) -> None:
    assert btq("init", "my robot").stdout.endswith("Next: btq check 'my robot'\n")
    (tmp_path / "old one.xml").write_text(OLD)
    assert btq("import", "old one.xml").stderr.endswith("Next: btq check 'old one.btq'\n")


def test_a_closed_pipe_is_no_traceback(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG * 200)
    command = f"{sys.executable} -m btq_lang check main.btq | head -1"
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=tmp_path, capture_output=True, text=True)
    assert (done.stderr, done.returncode) == ("", 0)


def test_a_closed_standard_output_is_no_traceback(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG)
    command = f"{sys.executable} -m btq_lang check main.btq >&-"
    done = subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True)
    assert (done.stderr, done.returncode) == ("", 1)


def test_format_keeps_the_line_ends_of_standard_input(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "btq_lang", "format", "-"]
    done = subprocess.run(command, cwd=tmp_path, input=b"BehaviorTree Main\r\n  Dock\r\n", capture_output=True)
    assert done.stdout == b"BehaviorTree Main\r\n    Dock\r\n"


def test_a_tree_that_runs_itself_as_a_declared_one_is_a_finding(process: Run) -> None:
    text = "BehaviorTree A\n    Go\n        value = {x}\n            A\nTreeNodesModel\n    SubTree A\n"
    done = process("check", "--output-format", "concise", "-", stdin=text)
    assert done.stdout.splitlines() == [
        "<stdin>:3:9: error[syntax-error] attributes go in brackets: `(key = value)`",
        "<stdin>:4:13: error[recursive-tree] the tree `A` contains itself",
        "Found 2 errors",
    ]
    assert (done.stderr, done.returncode) == ("", 1)


BROKEN = """\
import sys
from btq_lang import checks
def check(workspace, path, **more):
    raise {error}
checks.check = check
from btq_lang.cli import program
program()
"""


@pytest.mark.parametrize(
    ("error", "code", "told", "commands"),
    [
        ("KeyError('x')", 2, "btq: internal error: KeyError: 'x' while reading main.btq", 3),
        ("RuntimeError('two\\nlines')", 2, "btq: internal error: RuntimeError: two lines while reading main.btq", 1),
        ("RecursionError", 2, "btq: internal error: RecursionError while reading main.btq", 1),
        ("KeyboardInterrupt", 130, "", 3),
        ("SystemExit(3)", 3, "", 3),
    ],
)
def test_what_nothing_expected_is_one_line_and_no_finding(
    tmp_path: Path, error: str, code: int, told: str, commands: int
) -> None:
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    more = "; report it in btq's issue tracker; BTQ_TRACEBACK=1 shows the traceback\n" if told else ""
    for arguments in (["check", "main.btq"], ["check", "--jobs", "2", "."], ["build", "main.btq"])[:commands]:
        done = run_broken(tmp_path, error, arguments)
        assert (done.stdout, done.stderr, done.returncode) == ("", told + more, code)


def test_the_traceback_is_shown_when_asked_for(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    done = run_broken(tmp_path, "KeyError('x')", ["check", "main.btq"], BTQ_TRACEBACK="1")
    lines = done.stderr.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert lines[-2:] == [
        "KeyError: 'x'",
        "btq: internal error: KeyError: 'x' while reading main.btq; report it in btq's issue tracker; "
        "BTQ_TRACEBACK=1 shows the traceback",
    ]
    assert done.returncode == 2


def test_where_no_file_was_at_hand_the_command_is_said(tmp_path: Path) -> None:
    broken = BROKEN.replace("from btq_lang import checks", "from btq_lang.commands import explain")
    broken = broken.replace("checks.check = check", "explain._pages = lambda _: check('', '')")
    done = run_broken(tmp_path, "KeyError('x')", ["explain", "Retry"], broken)
    assert done.stderr == (
        "btq: internal error: KeyError: 'x' in `btq explain Retry`; report it in btq's issue tracker; "
        "BTQ_TRACEBACK=1 shows the traceback\n"
    )
    assert done.returncode == 2


def test_a_bug_is_reported_without_any_package(tmp_path: Path) -> None:
    (tmp_path / "main.btq").write_text(WRONG, encoding="utf-8")
    program = f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{BROKEN.format(error='ValueError')}"
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", program, "check", "main.btq"], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.stderr == (
        "btq: internal error: ValueError while reading main.btq; report it in btq's issue tracker; "
        "BTQ_TRACEBACK=1 shows the traceback\n"
    )


def run_broken(
    folder: Path, error: str, arguments: list[str], program: str = BROKEN, **environment: str
) -> subprocess.CompletedProcess[str]:
    """`btq` with a check that raises."""
    return subprocess.run(
        [sys.executable, "-c", program.format(error=error), *arguments],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        env={**os.environ, "NO_COLOR": "1", "PYTHONUTF8": "1", **environment},
        timeout=60,
    )
