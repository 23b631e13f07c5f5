"""The evidence store: the verdicts of many logs, kept in a folder as Parquet files and summarised by SQL.

One invariant: of each log there is one set of files, whole or not at all, named by the SHA-256 of the log.

    tables.py      the tables and their columns
    rows.py        the findings of a log, as rows of text, while it is judged; nodes have names without numbers
    sets.py        a log's set of files, published at once; what killed writers leave is removed
    engine.py      DuckDB, which writes the files and is asked for rows, and other engines, asked through Ibis
    damage.py      files that are missing, damaged or of another table
    queries.py     the questions, as SQL
    summary.py     the report of a whole store
"""
