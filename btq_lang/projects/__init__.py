"""Projects: what is on the disk and belongs together.

One invariant: which files there are, and which of them one program loads, is decided here alone; other packages read
their contents.  Of command lines, only options are known here.

    files.py         the files of a command line or a program, in their projects, cached until they change
    factory_files.py, nav2_factory.py   the files of each factory, those that parameter files of Nav2 name among them
    xml_below.py     which XML below a folder is the engine's
    created_trees.py which trees of XML the programs around it create; `tree_servers.py`, servers in parameter files
    cpp_files.py     C++ sources as files with the models of their nodes; `node_writers.py` writes such models
    scenario_files.py   the files with scenarios of requested missions
    external_files.py   files with the requirements of other tools
    simulated_names.py   whether the names in `[simulate]` of a project file are those of its missions
    opening.py       a folder as a workspace
    building.py      a mission as XML, in memory, and what prevents a build
    build_files.py, import_files.py   missions on the disk as XML, and XML as missions; `messages.py`: their output
    nav2_check.py    findings in parameter files, and in trees because of them
    git.py, since.py   files of another revision, and those that a later change concerns
    options.py       the options that are needed without a parser of command lines
    failures.py      messages for exceptions that nothing expected
"""
