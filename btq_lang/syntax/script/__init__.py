"""The scripting language of BehaviorTree.CPP, used in `code`, `if`, `_skipIf`, `_onSuccess` and similar attributes.

One invariant: every string parses, in linear time and without an exception, and all offsets count from the start of the
script.  What the newest engine refuses, or loads but fails to run, is a `script-error`; what older engines refuse or
read differently is a `script-version`.  Where a script is used, which keys exist and what they hold is unknown here.

    tree.py      a script as frozen records, its variables, and back to text
    tokens.py    text to tokens; common mistakes are read as what they mean
    parser.py    tokens to tree, by the grammar of the newest engine
    mistakes.py  diagnostics for scripts that the newest engine refuses
    versions.py  what older engines refuse, or read differently
    check.py     all problems of a script for given versions
"""

from btq_lang.syntax.script.check import check_script
from btq_lang.syntax.script.parser import MAX_DEPTH, parse_script
from btq_lang.syntax.script.tree import (
    Assign,
    Binary,
    Bool,
    Comparison,
    Expression,
    Group,
    Name,
    Number,
    Script,
    Ternary,
    Text,
    Unary,
    Variable,
    children,
    unparse,
    variables,
)

__all__ = [
    "MAX_DEPTH",
    "Assign",
    "Binary",
    "Bool",
    "Comparison",
    "Expression",
    "Group",
    "Name",
    "Number",
    "Script",
    "Ternary",
    "Text",
    "Unary",
    "Variable",
    "check_script",
    "children",
    "parse_script",
    "unparse",
    "variables",
]
