"""Writes every file of the editors that follows from the tables of btq_lang: `python tools/generate.py`.

One invariant: the same tables give the same bytes; `--check` says which files are not what they would be.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import extension_manifest
import kate_syntax
import language_configuration
import textmate
import vim_syntax

ROOT = Path(__file__).resolve().parents[1]

# Every generated file and who makes its text.
GENERATED: Mapping[str, Callable[[], str]] = {
    "editors/vscode/syntaxes/btq.tmLanguage.json": textmate.grammar,
    "editors/vscode/package.json": extension_manifest.manifest,
    "editors/vscode/language-configuration.json": language_configuration.configuration,
    "editors/kate/btq.xml": kate_syntax.syntax,
    "editors/nvim/syntax/btq.vim": vim_syntax.syntax,
    "editors/nvim/autoload/btq/words.vim": vim_syntax.openers,
}


def stale() -> list[str]:
    """The files that are not what their tables say."""
    return [
        name
        for name, make in GENERATED.items()
        if not (ROOT / name).exists() or (ROOT / name).read_text(encoding="utf-8") != make().rstrip() + "\n"
    ]


def main() -> int:
    """Write what is stale; with `--check` only say so, by exit code 1."""
    old = stale()
    for name in old:
        if "--check" in sys.argv:
            print(f"{name} is not what tools/generate.py makes: run it", file=sys.stderr)
            continue
        (ROOT / name).parent.mkdir(parents=True, exist_ok=True)
        (ROOT / name).write_text(GENERATED[name]().rstrip() + "\n", encoding="utf-8", newline="\n")
        print(f"wrote {name}")
    return 1 if old and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
