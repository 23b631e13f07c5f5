"""What requirements mean: their clauses resolved, with units, subjects and scopes.

One invariant: the answer is a function of the workspace and of the viewpoint, the file from which names are looked up.
It does not know what the engine can enforce, nor what a run of the robot was like.

What is asked here is asked of the query store (workspace/queries.py): each question a function of it, of a viewpoint,
and of a name or of an item, which is known by its facts.  What is read is in workspace/inputs.py.

    nodes.py     which nodes (workspace/resolved.py) a path, a kind or a tag means
    model.py     what a requirement says once its words are resolved
    paths.py, terms.py, reader.py   reading paths, values and conditions; reading.py, which signals are read
    clauses.py   what each verb asks for; classic.py, constraints.py, in SuccessIf and FailureIf of descriptions
    definitions.py   the requirement of a name
    attach.py    which requirement holds for which node
    durations.py, composition.py, budgets.py   how long nodes take when all that is demanded below them holds
    spans.py     the node whose time a span is
    resolve.py, resolved.py   `requirements(workspace, path)`: all of a file and what it includes
"""
