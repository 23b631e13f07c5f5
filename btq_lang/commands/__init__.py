"""The commands: a module each, with a record of its options and a function `run(options, messages)` that adds what
there is to print to the messages and returns the exit code.

One invariant: 0 means clean, 1 findings, 2 a usage or I/O error; output files are written completely or not at all.
`output.Terminal` prints messages as they come; only what runs until it is stopped, such as a preview, prints by itself.
How to check, build or judge is unknown here; other packages do that.

    arguments.py       the command line, and which module runs which command; suggesting_parser reads it
    output.py, progress.py, watch_mode.py   files and standard output, a line of progress, and `--watch`
    check.py           with project_files, parallel, fixing, ignoring, baseline, reporting, show_settings and target
    format.py, build.py, import_xml.py, diff.py, graph.py, nodes.py, schema.py, preview.py, approve.py   a command each
    explain.py         with explain_nav2, a page about a node of Nav2
    init.py            with init_from_xml, whose parts are init_lines and packages
    explore.py         what can happen; explored_scenarios.py writes its runs as scenarios
    testing.py         `btq test`: scenarios; with testing_options
    simulating.py      `btq simulate`: runs that are drawn; with simulate_options
    verify.py          with verify_options, candidates, stored, live, live_screen, recorded, verdict_report and
                       verdict_events
    compare.py, report.py, tracing.py   what a store has, and the overview; given_evidence: verdicts beside requirements
    completion.py      with the scripts in shell/
"""
