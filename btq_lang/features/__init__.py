"""What an editor asks of a workspace: `f(workspace, path, offset, …)` to frozen data, one module a feature.

One invariant: a feature is a pure function that answers for every text and every offset, and "nothing" is None or ().
Offsets are Python indices; no editor, no protocol and no line is known here.
"""
