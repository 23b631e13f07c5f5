"""Parameter files of Nav2: what bt_navigator loads, and what is wrong with that.

    yaml_reader.py   YAML as values with their places; PyYAML, only here
    parameters.py    the parameters of bt_navigator in a file, and its distribution
    names.py         parameters that are refused, misspelt, of the wrong type, or read by other distributions only
    loaded.py        the trees that bt_navigator creates, also for goals, and the files that it reads for them
    libraries.py     libraries of nodes: missing, unknown or loaded twice; those that CMake builds
    findings.py      all that is wrong with a file and with what it loads

One invariant: every text gives an answer, and never an exception.  This room does not know how findings are printed,
nor what else is wrong with the trees, which `checks` reports.
"""
