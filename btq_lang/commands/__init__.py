"""The commands: a module each, with a function `run(options)` that returns the exit code.

One invariant: 0 means clean, 1 findings, 2 a usage or I/O error; output files are written completely or not at all.  A
command line comes in, and text on the standard streams and files go out.  How to check, build or judge is unknown here;
other packages do that.

    arguments.py the command line, and which module runs which command
    files.py, factory_files.py, xml_below.py   input files, by project and factory, and which XML counts
    output.py, options.py, reporting.py   output, options of a check, its report
    fixing.py, ignoring.py   what a check changes
    baseline.py, since.py   which findings are known, and which files have changed
    failures.py      messages for exceptions that nothing expected, of commands and of the server
    check.py, format.py, build.py …   the commands
    shell/           completion scripts
"""
