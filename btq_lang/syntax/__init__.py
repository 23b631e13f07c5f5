"""The vocabulary of a file: the classes of its tree, its tokens and words, and its characters.

One invariant: every span counts from the start of its item (a tree, a requirement), so that an item keeps its value
wherever an edit elsewhere moves it.  The lexer and the parser make these values.  Whether a name exists and what it
means is unknown here.

    tree.py          the tree: entries and items, with all classes below
    words.py, clauses.py, node_clauses.py, nodes.py   words with their positions, clauses made of them, and nodes
    scenarios.py     scenarios: what is given, what happens, what is expected
    tokens.py        the kinds of tokens
    scan.py          runs of characters: names, numbers, blanks
    indentation.py   the open blocks around a line
    strange.py       invalid characters
    quantities.py    numbers with units; composed_times.py, times of several numbers
    suggestions.py   what a wrong token was probably meant to be
    script/          the engine's scripting language, in strings
"""
