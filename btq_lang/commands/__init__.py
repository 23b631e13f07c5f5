"""The commands: a module each, with a function `run(options)` that returns the exit code."""
