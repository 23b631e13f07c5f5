"""The version of btq, in a module of its own so that writers of documents import nothing else."""

__version__ = "0.1.0.dev0"
