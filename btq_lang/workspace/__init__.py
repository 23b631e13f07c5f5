"""Files that belong together: an immutable workspace, name resolution, and access to the disk.

One invariant: a workspace reached by edits equals one made from the same texts.  Only `loader` reads and writes the
disk.  Not known here: what is wrong with a mission, and how it is written as XML.

    external_requirements.py   the requirements of other tools
    config.py, project_evidence.py, project_simulation.py, project_driver.py, factories.py, overrides.py,
    project_schema.py   the project file, and its schema
    engine_version.py   for which versions of the engine a file is
    file.py          one file: its text, its tree, and what survives an edit
    workspace.py     files, what they include, and edits
    symbols.py       what a file declares, and what is in scope
    item_index.py    what follows from an item alone
    references.py    every word that names something
    queries.py, inputs.py   the query cache, and what queries read in the workspace
    resolved.py, node_names.py   what written nodes mean, and by which names they are found
    comments.py      to which element a comment belongs
    port_types.py, custom_nodes.py   what ports and undeclared nodes are taken for
    findings.py, fixes.py   diagnostics placed in a file, and fixes put into its text
    loader.py        reads files, and writes them whole or not at all
    watcher.py       what changed on the disk
"""
