"""What a coloured word can be: the token types of LSP 3.16, and `label` of 3.18 for instance names.

It is apart from `appearance`, whose tables the server does not need before the first colours are requested.
"""

from __future__ import annotations

TYPES = (
    *("keyword", "comment", "string", "number", "operator", "class", "type", "function", "interface", "variable"),
    *("enumMember", "parameter", "property", "label", "decorator"),
)
MODIFIERS = ("definition", "defaultLibrary", "modification", "readonly")
