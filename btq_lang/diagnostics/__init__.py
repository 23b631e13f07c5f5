"""Diagnostics and their fixes as data, and the rules, each with a page.

One invariant: these are values.  Who finds something makes one, who prints it reads one; nothing here finds or prints.
Not known here: files, trees, and which findings a user wants to see.

    model.py   Diagnostic, Related, Fix
    rules/     one row and one page a rule: its name, its severity, what it means, and how to mend it
"""
