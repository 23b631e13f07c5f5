"""The recipes of docs/editors.md, as they stand there, in the editors they are for."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest
from installed import ROOT, missing, there

RECIPES = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8")
WRONG = "BehaviorTree   Main\n    ->\n        Sequnce\n            Dock\n"
TIDY = WRONG.replace("   Main", " Main")


def recipe(language: str) -> str:
    """The block of a language; there is one."""
    block: str
    (block,) = re.findall(rf"^```{language}\n(.*?)^```$", RECIPES, re.DOTALL | re.MULTILINE)
    return block.replace("/path/to/btq", str(ROOT))


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """`btq-lsp` is on the PATH and is this checkout's."""
    program = tmp_path / "bin" / "btq-lsp"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m btq_lang.server "$@"\n')
    program.chmod(0o755)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "HOME": str(tmp_path), "PYTHONPATH": str(ROOT)}


def test_emacs(tmp_path: Path, environment: dict[str, str]) -> None:
    there(shutil.which("emacs"), "Emacs", "more_from_apt")
    (tmp_path / "main.btq").write_text(WRONG)
    (tmp_path / "recipe.el").write_text(recipe("elisp"))
    (tmp_path / "test.el").write_text(
        """
        (load (expand-file-name "recipe.el"))
        (require 'eglot)
        (find-file "main.btq")
        (call-interactively #'eglot)
        (with-timeout (60 (error "no diagnostics"))
          (while (null (flymake-diagnostics)) (accept-process-output nil 0.05)))
        (eglot-format-buffer)
        (princ (format "%s\\n" (mapcar #'flymake-diagnostic-text (flymake-diagnostics))))
        (princ (buffer-substring-no-properties (point-min) (point-max)))
        """
    )
    if "eglot" not in run(
        ["emacs", "-q", "--batch", "--eval", '(princ (locate-library "eglot"))'], tmp_path, environment
    ):
        missing("Eglot", "more_from_apt")
    said = run(["emacs", "-q", "--batch", "-l", "test.el"], tmp_path, environment)
    assert "unknown node `Sequnce`" in said
    assert said.endswith(TIDY)


def test_the_colours_of_emacs(tmp_path: Path, environment: dict[str, str]) -> None:
    there(shutil.which("emacs"), "Emacs", "more_from_apt")
    (tmp_path / "main.btq").write_text(
        'QualityReq rq1 : security "It\'s safe"  # said\nBehaviorTree Main\n    Action Dock (n = 1) satisfies rq1\n'
    )
    expected = {
        "QualityReq": "font-lock-keyword-face",
        "rq1": "font-lock-function-name-face",
        "It's": "font-lock-string-face",
        "said": "font-lock-comment-face",
        "BehaviorTree": "font-lock-keyword-face",
        "Main": "font-lock-function-name-face",
        "Action": "font-lock-keyword-face",
        "Dock": "font-lock-function-name-face",
        "n =": "font-lock-variable-name-face",
        "satisfies": "font-lock-keyword-face",
    }
    assert emacs_faces(expected, tmp_path, environment) == expected


def test_an_apostrophe_in_a_comment_of_any_form_opens_no_string_in_emacs(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    there(shutil.which("emacs"), "Emacs", "more_from_apt")
    (tmp_path / "main.btq").write_text(
        "# it's one\n// it's two\n/* it's\n   three # no end */\nBehaviorTree Main\n"
        "    Dock (a = 'four // five')  // it's six\n    Charge (b = 1/2)\n"
    )
    expected = {
        "one": "font-lock-comment-face",
        "two": "font-lock-comment-face",
        "three": "font-lock-comment-face",
        "no end": "font-lock-comment-face",
        "BehaviorTree": "font-lock-keyword-face",
        "four": "font-lock-string-face",
        "five": "font-lock-string-face",
        "six": "font-lock-comment-face",
        "b =": "font-lock-variable-name-face",
        "2)": "nil",
    }
    assert emacs_faces(expected, tmp_path, environment) == expected


def emacs_faces(words: Iterable[str], tmp_path: Path, environment: dict[str, str]) -> dict[str, str]:
    """The face that each of some words has in `main.btq` with the recipe."""
    listed = " ".join(map(json.dumps, words))
    # Without what needs Eglot, which has no part in it.
    (tmp_path / "recipe.el").write_text(recipe("elisp").partition("(with-eval-after-load")[0])
    (tmp_path / "test.el").write_text(
        f"""
        (load (expand-file-name "recipe.el"))
        (find-file "main.btq")
        (font-lock-ensure)
        (dolist (word '({listed}))
          (goto-char (point-min))
          (search-forward word)
          (princ (format "%s: %s\n" word (get-text-property (match-beginning 0) 'face))))
        """
    )
    said = run(["emacs", "-q", "--batch", "-l", "test.el"], tmp_path, environment).splitlines()
    return dict(line.rsplit(": ", 1) for line in said)


def test_vim_with_ale(tmp_path: Path, environment: dict[str, str]) -> None:
    there(shutil.which("vim"), "Vim", "more_from_apt")
    ale = there("/usr/share/vim-ale", "ALE", "more_from_apt")
    (tmp_path / "main.btq").write_text(WRONG)
    (tmp_path / "recipe.vim").write_text(recipe("vim"))
    (tmp_path / "test.vim").write_text(
        f"""
        set nocompatible
        set runtimepath+={ale}
        runtime plugin/ale.vim
        source recipe.vim
        edit main.btq
        ALELint
        let turn = 0
        while turn < 600 && empty(ale#engine#GetLoclist(bufnr('')))
          sleep 100m
          let turn += 1
        endwhile
        let found = map(copy(ale#engine#GetLoclist(bufnr(''))), '[v:val.lnum, v:val.col, v:val.code]')
        call writefile([json_encode([&filetype, &commentstring, found])], 'found.json')
        qall!
        """
    )
    run(["vim", "-es", "-n", "-N", "-u", "NONE", "-S", "test.vim"], tmp_path, environment)
    assert json.loads((tmp_path / "found.json").read_text()) == ["btq", "# %s", [[3, 9, "unknown-node"]]]


def run(command: list[str], folder: Path, environment: dict[str, str]) -> str:
    """What it prints; batch editors of some versions end with another code than 0 when all went well."""
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120).stdout
