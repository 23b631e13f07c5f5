"""The nodes that C++ sources register, as plain records, read with tree-sitter.

One invariant: what the sources do not say in so many words is reported as unseen and never guessed.  Text comes in and
records go out: neither the disk, nor how nodes are written in a mission, is known here.

    model.py       the records
    grammar.py     tree-sitter, and small questions to its nodes
    macros.py      macros that register nodes, expanded
    source.py      one file: its classes, functions, constants and registrations; C++ types as texts
    sources.py     all files: which class a name means, what it derives from, and what classes of libraries provide
    ports.py       what `providedPorts()` returns; values.py: strings, defaults and types in it
    uses.py        which ports the code of a class reads and writes, and what it does without them
    nodes.py       the nodes, and which of them end within the tick that starts them
    entries.py     which entries the code sets on a blackboard
    findings.py    what is wrong between ports and code, and what is unseen, as diagnostics
"""
