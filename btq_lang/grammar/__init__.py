"""The productions of docs/grammar.md between lexer and parser: a module a group of productions.

One invariant: a production reads from a cursor, always advances, and gives a tree and diagnostics for every text; one
mistake gives one diagnostic.  Logical lines come in, trees of `syntax` go out.  Other items, other files and the
meaning of names are unknown here.

    cursor.py        the position of the parser: the next token, what is expected, recovery
    items.py         the items of a file
    nodes.py         trees' blocks: nodes, their children
    ports.py         the ports of trees and models
    attributes.py    attributes in brackets, and what is attached to nodes
    requirements.py  requirements, their parameters and units
    clauses.py       the clauses of a requirement
    metadata.py      those of them that demand nothing
    hazards.py       hazards
    claims.py        what a clause demands
    claim_words.py   the words of claims, and whether some are next
    conditions.py    the conditions in clauses
    claim_mistakes.py, node_mistakes.py   what people write in place of claims and nodes, and reports of it
    prose.py, clause_slips.py   clauses in the words of other notations
    scenarios.py                scenarios; scenario_words.py, their words; scenario_slips.py, other words for them
    item_words.py    the words that begin items
"""
