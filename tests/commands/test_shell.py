"""Completion scripts, in the shells that are here."""

from __future__ import annotations

import argparse
import shutil
import subprocess
from pathlib import Path

import pytest

from btq_lang.commands.shell import SHELLS, completion_script


def parser() -> argparse.ArgumentParser:
    """A command line with one of each: choices, files, values, flags, hidden options, commands without help."""
    made = argparse.ArgumentParser("btq")
    made.add_argument(
        "--color", choices=["auto", "always", "never"], default="auto", help="when (default: %(default)s)"
    )
    commands = made.add_subparsers(dest="command")
    check = commands.add_parser("check", help="Find what's wrong: everything")
    check.add_argument("paths", nargs="*")
    check.add_argument("--output-format", "-f", choices=["full", "concise", "json"], help="how\nto print")
    check.add_argument("--fix", action="store_true", help="mend 100 %%")
    check.add_argument("--config", help="the project file")
    check.add_argument("--trace", help=argparse.SUPPRESS)
    explain = commands.add_parser("explain", help="Print a rule's page")
    explain.add_argument("rule", nargs="?")
    completion = commands.add_parser("completion")
    completion.add_argument("shell", choices=SHELLS)
    return made


def script(shell: str) -> str:
    return completion_script(shell, parser(), {"rule": ["unknown-node", "unused-tree", "$(touch never)"]})


def needs(program: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(shutil.which(program) is None, reason=f"{program} is not installed: only it can tell")


def run(*command: str) -> str:
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert (result.stderr, result.returncode) == ("", 0)
    return result.stdout


# Words of a command line and their completions; the cursor is at the end of the last word.
LINES = [
    (["btq", ""], ["check", "completion", "explain"]),
    (["btq", "ch"], ["check"]),
    (["btq", "--c"], ["--color"]),
    (["btq", "--color", ""], ["always", "auto", "never"]),
    (["btq", "--color", "always", "ex"], ["explain"]),
    (["btq", "check", "--"], ["--config", "--fix", "--help", "--output-format"]),
    (["btq", "check", "-f", "co"], ["concise"]),
    (["btq", "check", "--fix", "--output-format", ""], ["concise", "full", "json"]),
    (["btq", "check", "--config", "explain", "--f"], ["--fix"]),
    (["btq", "explain", ""], ["unknown-node", "unused-tree"]),
    (["btq", "completion", "z"], ["zsh"]),
]
IDS = [" ".join(words) for words, _ in LINES]


@needs("bash")
def test_bash_accepts_the_script(tmp_path: Path) -> None:
    (tmp_path / "btq").write_text(script("bash"))
    assert run("bash", "-n", str(tmp_path / "btq")) == ""


@needs("bash")
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        *LINES,
        # Readline gives `--output-format=co` as three words.
        (["btq", "check", "--output-format", "=", "co"], ["concise"]),
        (["btq", "check", "--output-format", "="], ["concise", "full", "json"]),
        (["btq", "check", "--output-format", "=", "json", "--f"], ["--fix"]),
        (["btq", "check", "mission"], []),  # files, which readline offers where nothing else is
        (["btq", "check", "--config", ""], []),
    ],
)
def test_bash_completes(tmp_path: Path, words: list[str], expected: list[str]) -> None:
    (tmp_path / "btq").write_text(script("bash"))
    program = (
        f'source {tmp_path}/btq; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _btq; printf \'%s\\n\' "${{COMPREPLY[@]}}"'
    )
    assert sorted(run("bash", "-u", "-c", program, "bash", *words).split()) == expected


@needs("bash")
def test_bash_is_told_to_use_it(tmp_path: Path) -> None:
    (tmp_path / "btq").write_text(script("bash"))
    assert run("bash", "-c", f"source {tmp_path}/btq; complete -p btq") == "complete -o default -F _btq btq\n"


@needs("zsh")
def test_zsh_accepts_the_script(tmp_path: Path) -> None:
    (tmp_path / "_btq").write_text(script("zsh"))
    assert run("zsh", "-n", str(tmp_path / "_btq")) == ""


@needs("fish")
def test_fish_accepts_the_script(tmp_path: Path) -> None:
    (tmp_path / "btq.fish").write_text(script("fish"))
    assert run("fish", "--no-execute", str(tmp_path / "btq.fish")) == ""


@needs("fish")
@pytest.mark.parametrize(("words", "expected"), LINES, ids=IDS)
def test_fish_completes(tmp_path: Path, words: list[str], expected: list[str]) -> None:
    (tmp_path / "btq.fish").write_text(script("fish"))
    shown = run("fish", "--no-config", "-c", f"source {tmp_path}/btq.fish; complete -C '{' '.join(words)}'")
    assert sorted(line.split("\t")[0] for line in shown.splitlines()) == expected


def test_zsh_script() -> None:
    """The parts that the parser decides: the rest is the same for every parser."""
    made = script("zsh")
    assert made.startswith("#compdef btq\n")
    assert "('btq check --output-format'|'btq check -f') choices=(full concise json) ;;" in made
    assert "('btq check --config') choices=() ;;" in made
    assert "commands=('check:Find what'\\''s wrong: everything' 'explain:Print a rule'\\''s page' 'completion')" in made
    assert "'--output-format:how to print' '-f:how to print' '--fix:mend 100 %' '--config:the project file')" in made
    assert "'--color:when (default: auto)')" in made


def test_powershell_script() -> None:
    """PowerShell is on no machine of the project: the parts that the parser decides, as they are to be."""
    made = script("powershell")
    assert "$lines = @('btq check', 'btq explain', 'btq completion')" in made
    assert "$values['btq check -f'] = @('full', 'concise', 'json')" in made
    assert "$values['btq check --config'] = @()" in made
    assert "'btq' = @('check\tFind what''s wrong: everything', 'explain\tPrint a rule''s page', 'completion')\n" in made
    assert "'btq explain' = @('unknown-node', 'unused-tree')\n" in made
    assert made.count("{") == made.count("}")


@pytest.mark.parametrize("shell", SHELLS)
def test_hidden_options_and_words_that_shells_read_are_left_out(shell: str) -> None:
    made = script(shell)
    assert "trace" not in made
    assert "touch" not in made


def test_commands_below_commands() -> None:
    made = argparse.ArgumentParser("btq")
    below = made.add_subparsers().add_parser("log").add_subparsers()
    below.add_parser("stats").add_argument("--by", choices=["node", "tree"])
    assert "\"btq log stats --by\") words='node tree' ;;" in completion_script("bash", made)


def test_an_unknown_shell_is_refused() -> None:
    with pytest.raises(ValueError, match="no completion for 'tcsh'; expected one of bash, zsh, fish, powershell"):
        completion_script("tcsh", parser())
