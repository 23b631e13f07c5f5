"""A model of BehaviorTree.CPP: what the engine does with a tree, tick by tick, version by version.

One invariant: every status change is the engine's, in its order; what is not modelled raises `NotModelled` and is never
guessed.

    errors.py       what ends a run early
    versions.py     what differs between versions of the engine
    blackboard.py   entries, their types and numbers, and how subtrees remap them
    scripts.py      what a script does with entries
    ports.py        what a node reads at its ports, and writes
    nodes.py        a node: its status and its memory
    ticking.py      one tick of a node, its conditions, and how it is halted
    controls.py     what each control node does with its children
    decorators.py   what each decorator does with its child
    timers.py       nodes that wait, and the time
    leaves.py       the engine's own leaves, and those of a program
    version3.py     what version 3 of the engine has and later ones have not
    world.py        what nodes of Nav2 read beside entries and the time
    nav2.py         what Nav2's control nodes and decorators do
    nav2_conditions.py  what its conditions answer
    nav2_answered.py    what these do where their answers are given
    nav2_inputs.py  the goals and paths that both read
    nav2_models.py  the ports of its nodes, by distribution
    skills.py       what the leaves of a program do, as given
    kinds.py        which function is which node's
    loading.py      XML to nodes
    drivers.py      how a program ticks its tree
    programs.py     the program that runs a tree
"""
