"""What every program needs and no language knows: text, records, paths.

One invariant: nothing here knows a behavior tree, and nothing imports another room.  Strings and numbers come in, and
strings and numbers go out.

    text.py         spans, edits and the index of lines: the base of every place in a file
    source_map.py   from a generated text to the one it was made of, and back
    spelling.py     names near to a misspelt one
    record.py       immutable classes, without the start-up time of dataclasses
    globs.py        patterns of paths
    toml_places.py  where in a TOML text a key stands
    garbage.py      pauses of the garbage collector
    version.py      the version of btq
"""
