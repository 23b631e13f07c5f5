"""Runs that are drawn: how likely a mission does what it must, and how long it takes.

One invariant: what a skill does is declared, measured or shown as assumed, and a condition is never assumed.

    skill.py       what a skill does in a drawn activation
    declared.py    what btq.toml declares of skills and conditions
    measured.py    what logs show of skills, with halted activations
    measuring.py   reads that from logs and stores
    template.py    the table of btq.toml for skills that nothing is known of
    streams.py     the random numbers of one activation, the same in every process
"""
