"""The extension's package.json: the rules that its setting `btq.rules` knows, with what each finds.

One invariant: everything else in the file is written by hand, and stays as it is.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from btq_lang.diagnostics.rules import RULES, Severity

FILE = Path(__file__).resolve().parents[1] / "editors" / "vscode" / "package.json"
_RULES = re.compile(r'(?s)("btq\.rules": \{.*?"default": \{\},\n)(.*?)(          "scope")')
_LEVELS = json.dumps([*(severity.value for severity in Severity), "off"])


def manifest() -> str:
    """The file with the rules of today."""
    rows = [
        f'            {json.dumps(rule.name)}: {{ "enum": {_LEVELS}, "default": "{rule.severity.value}",'
        f' "description": {json.dumps(f"{rule.summary[0].upper()}{rule.summary[1:]}.", ensure_ascii=False)} }}'
        for rule in RULES.values()
    ]
    body = (
        '          "additionalProperties": false,\n          "properties": {\n' + ",\n".join(rows) + "\n          },\n"
    )
    text, count = _RULES.subn(lambda match: match[1] + body + match[3], FILE.read_text(encoding="utf-8"))
    assert count == 1, "the setting is not where it was"
    return text
