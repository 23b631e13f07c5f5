"""The commands: a module each, with a record of its options and a function `run(options, messages)` that adds what
there is to print to the messages and returns the exit code.

One invariant: 0 means clean, 1 findings, 2 a usage or I/O error; output files are written completely or not at all.
`output.Terminal` prints messages as they come; only what runs until it is stopped, such as a preview, prints by itself.
How to check, build or judge is unknown here; other packages do that.

    arguments.py the command line, and which module runs which command
    output.py, reporting.py   where output goes, and the report of a check
    fixing.py, ignoring.py    changes that a check makes
    baseline.py               findings that are not reported
    check.py, format.py, build.py …   the commands
    shell/           completion scripts
"""
