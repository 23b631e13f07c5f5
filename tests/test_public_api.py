"""`import btq_lang` in a shell: what a person sees of it before anything is used."""

from __future__ import annotations

import json
import subprocess
import sys

PUBLIC = [
    "Diagnostic",
    "LineIndex",
    "Node",
    "Parsed",
    "Requirement",
    "Span",
    "Tree",
    "Workspace",
    "__version__",
    "check",
    "format_text",
    "open_workspace",
    "parse",
]
CONSOLE = """\
import json, rlcompleter, sys
import btq_lang
listed, loaded = dir(btq_lang), [name for name in sys.modules if name.startswith("btq_lang.")]
print(json.dumps([listed, loaded, rlcompleter.Completer({"btq_lang": btq_lang}).attr_matches("btq_lang.")]))
"""


def test_a_shell_lists_and_completes_the_public_names() -> None:
    """In a fresh process: here the other tests have imported many of them."""
    run = subprocess.run([sys.executable, "-c", CONSOLE], capture_output=True, text=True, check=True)
    listed, loaded, completed = json.loads(run.stdout)
    assert (listed, loaded) == (PUBLIC, [])
    shown = [name.partition("(")[0].removeprefix("btq_lang.") for name in completed]
    assert shown == [name for name in PUBLIC if name != "__version__"]
