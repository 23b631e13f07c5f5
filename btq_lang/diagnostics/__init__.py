"""Diagnostics and their fixes as data, and the rules, each with a page.

One invariant: these are values; nothing here finds or prints anything.  Files, trees, and which findings a user wants
to see are not known here.

    model.py   Diagnostic, Related, Fix
    rules/     one row and one page a rule: its name, its severity, what it means, and how to fix it
"""
