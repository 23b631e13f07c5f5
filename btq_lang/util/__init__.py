"""General helpers: text, records, paths.

One invariant: nothing here concerns behavior trees or imports another room.

    text.py         spans, edits and the index of lines: the basis of all positions in a file
    source_map.py   maps a generated text to its source, and back
    readable.py     characters that an output's encoding lacks
    spelling.py     names similar to a misspelt one
    record.py       immutable classes, without the start-up time of dataclasses, and the fields of a class
    reach.py        reachability in graphs, and their cycles
    grouping.py     values grouped by a key
    formulas.py     cells of CSV that a spreadsheet would take for formulas
    globs.py        patterns of paths
    processes.py    processes that share the work of a command
    toml_places.py  positions of keys in a TOML text
    caches.py       where what can be made again is kept
    garbage.py      pauses of the garbage collector
    version.py      the version of btq
"""
