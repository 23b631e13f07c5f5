"""The commands: a module each, with a function `run(options)` that returns the exit code.

One invariant: 0 is clean, 1 says that there are findings, 2 that the call or a file is at fault; output files appear
whole or not at all.  A command line comes in, and text on the standard streams and files go out.  Not known here: how
anything is checked, built or judged; commands ask the rooms that know.

    arguments.py     the command line, and which module runs which command
    files.py, output.py, options.py   what commands share: which files, where to, which findings
    check.py, format.py, build.py …   the commands
    shell/           completion scripts
"""
