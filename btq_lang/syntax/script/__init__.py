"""The scripting language of BehaviorTree.CPP, used in `code`, `if`, `_skipIf`, `_onSuccess` and similar attributes.

One invariant: every string parses, in linear time and without an exception, and all offsets count from the start of the
script.  What the newest engine refuses, or loads but fails to run, is a `script-error`; what older engines refuse or
read differently is a `script-version`.  Where a script is used, which keys exist and what they hold is unknown here.

    tree.py      a script as frozen records, and its variables
    tokens.py    text to tokens; common mistakes are read as what they mean
    parser.py    tokens to tree, by the grammar of the newest engine
    mistakes.py  diagnostics for scripts that the newest engine refuses
    versions.py  what older engines refuse, or read differently
    check.py     all problems of a script for given versions
"""
