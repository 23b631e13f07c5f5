"""What requirements mean: their clauses resolved, with units, subjects and scopes.

One invariant: the answer is a function of the workspace and of the file at whose scope it looks.  It does not know what
the engine can enforce, nor what a run of the robot was like.

    resolve.py   `requirements(workspace, path)`: all of a file and what it includes
    model.py     what a requirement says once its words are resolved
    names.py     by which names a written node is found
    trees.py     the nodes of one tree
    nodes.py     which written nodes a path, a kind or a tag means
    memory.py    what is kept from one edit to the next
    paths.py     the one node that a path names
    resolved.py  what comes out of it for a file
    reader.py    values and conditions: names, units, what compares with what; `reading`, which signals are read
    clauses.py   what each verb asks for
    classic.py, constraints.py   SuccessIf and FailureIf in classic descriptions
    attach.py    which requirement holds for which node
    durations.py, composition.py, budgets.py   how long nodes take when all that is demanded below them holds
    spans.py     the node whose time a span is
"""
