"""The scripting language of BehaviorTree.CPP, as it stands in `code`, `if`, `_skipIf`, `_onSuccess` and the like.

One invariant: every string parses, in linear time and without an exception, and all offsets count from the start of
the script.  What the newest engine refuses, or loads only to fail at it, is a `script-error`; what the engines before
it refuse or read in another way is a `script-version`.  Not known here: where a script stands, which keys exist, and
what they hold.

    tree.py      what a script is: frozen records, the variables in them, and back to text
    tokens.py    text to tokens; common slips are read as what they mean
    parser.py    tokens to tree, by the grammar of the newest engine
    mistakes.py  what is said about a script that the newest engine refuses
    versions.py  what older engines refuse, or read in another way
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
