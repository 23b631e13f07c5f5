"""The nodes that C++ sources register, as plain records, read with tree-sitter.

One invariant: what the sources do not say in so many words is reported as unseen and never guessed.  Text comes in and
records go out: neither the disk, nor how nodes are written in a mission, is known here.

    model.py       the records
    grammar.py     tree-sitter, and small questions to its nodes; type_names.py: C++ types as texts
    source.py      one file: its classes, functions, constants and registrations
    sources.py     all files: which class a name means, and what it derives from
    ports.py       what `providedPorts()` returns; values.py: strings, defaults and types in it
    library_ports.py  what classes of the engine and of behaviortree_ros2 provide
    uses.py        which ports the code of a class reads and writes, and what it does without them
    ticks.py       which classes end within the tick that starts them
    nodes.py       the nodes
    findings.py    what is wrong between ports and code, and what is unseen, as diagnostics
"""
