"""What requirements mean: their clauses resolved, with units, subjects and scopes.

One invariant: the result is a function of the workspace and of the viewpoint, the file from which names are looked up.
What the engine can enforce, and logs of runs, are not known here.

Most functions are queries of the store (workspace/queries.py), with a viewpoint and a name or an item, which is
identified by its facts.  What they read is in workspace/inputs.py.

    nodes.py     which nodes (workspace/resolved.py) a path, a kind or a tag means
    model.py, applied.py   a requirement with its words resolved, and what it applies to
    paths.py, terms.py, reader.py, entries.py   reading paths, values and conditions; those of scenarios too
    contexts.py   how deeply contexts are nested
    clauses.py, visits.py   what each verb demands, and which nodes are visited
    metadata.py   the clauses that demand nothing
    verifying.py  the scenarios that verify requirements
    one_run.py    what a scenario, which is one run, cannot decide
    fingerprint.py, approval.py, approving.py   whether a requirement is approved as it is, and writing that
    shares.py, pooled.py   claims of a share of time, and those that are judged of all runs together
    classic.py, constraints.py   the same in SuccessIf and FailureIf of descriptions
    simulation.py   the settings for simulated runs in a mission
    definitions.py   the requirement of a name
    attach.py    which requirement holds for which node
    durations.py, composition.py, budgets.py   how long nodes take when all that is demanded below them holds:
                 `control_budgets` and `nav2_budgets` by rules, `budget_parts` the parts of these
    spans.py     the node whose time a span is
    external/    reading the requirements that other tools have written
    resolve.py   `requirements(workspace, path)`: all of a file and what it includes
"""
