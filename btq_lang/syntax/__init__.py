"""The vocabulary of a file: the classes of its tree, its tokens and words, and its characters.

One invariant: every span counts from the start of its item (a tree, a requirement), so that an item keeps its value
wherever an edit elsewhere moves it.  Text comes in and these values go out; how they are found is the work of the lexer
and the parser.  Not known here: whether a name exists, or what it means.

    tree.py          the tree: entries and items, with all classes below
    words.py, clauses.py, node_clauses.py, nodes.py   words with their place, what is made of them, and nodes
    tokens.py        the kinds of tokens
    scan.py          runs of characters: names, numbers, blanks
    indentation.py   the blocks that are open around a line
    strange.py       characters that begin no token
    quantities.py    numbers with units
    suggestions.py   what was meant by a misspelt token
    script/          the scripting language of the engine, in strings
"""
