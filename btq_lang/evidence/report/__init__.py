"""The overview of a store as a page: what got worse, requirements by version and robot, trends, failures, coverage.

One invariant: all that is called a change is a finding of `compare/`; the rest are counts and verdicts.

    overview.py   what the page shows, as data
    trends.py     what happened in each step of the time, and what clauses measured
    page.py       the page; page.html.j2 its template, page.css its style sheet
    charts.py     its drawings
"""
