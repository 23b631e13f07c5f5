"""Files that belong together: an immutable workspace, who means what in it, and the edge to the disk.

One invariant: a workspace that edits have made equals one made afresh from the same texts.  Texts by path come in;
files, symbols and references go out.  Only `loader` reads and writes the disk.  Not known here: what is wrong with a
mission, and how it is written as XML.

    config.py, project_evidence.py   the project file
    file.py          one file: its text, its tree, and what of it survives an edit
    workspace.py     files, what they include, and edits
    symbols.py       what a file declares, and what is in scope
    item_index.py    what is known of an item from itself
    references.py    every word that names something
    queries.py, inputs.py   the one memory, and what queries read in the workspace
    resolved.py, node_names.py   what written nodes mean, and by which names they are found
    comments.py      to which element a comment belongs
    placeholders.py, port_types.py, custom_nodes.py   what names, ports and undeclared nodes are taken for
    findings.py, fixes.py   diagnostics placed in a file, and fixes put into its text
    loader.py        files from the disk and onto it, whole or not at all
    watcher.py       what changed on the disk
"""
