"""Static knowledge: the engine's nodes and names, its attributes and literals, and the quality models.

nodes       look-up of node kinds; `kinds` holds the records, `engine_nodes` the rows; words that look like kinds
attributes  attributes that are not ports: pre- and post-conditions, and those of tools
names       which names the engine refuses; `foreign_names`, what other engines call its nodes and ports
versions    the engine's versions, and what changed between them; `engine_changes`, changes in what nodes do
cpp_classes base classes in C++: their categories and ports
literals    what the engine reads from a literal
qualities   look-up of quality names; `quality_model` and `quality_words` hold the rows
units       which words are units, and how values convert; used by the lexer
language    the words of the language, as completion and `btq explain` show them; `name_kinds`, what names can name
verbs       the verbs of clauses, and what their numbers measure; `verdicts`, the results of verification
standard_answers  what `btq explore` says without a question
nav2/       Nav2's nodes and libraries, and what bt_navigator sets

One invariant: tables and look-ups only.  Nothing here knows a file, a tree or a diagnostic.
"""
