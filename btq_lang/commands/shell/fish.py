"""Completion for fish, 3.0 and later."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.commands.shell import Command, Option


def script(commands: tuple[Command, ...]) -> str:
    """The script, to be put into ~/.config/fish/completions under the program's name with `.fish`, or sourced."""
    program = commands[0].line
    lines = " ".join(_quoted(command.line) for command in commands[1:])
    rules = "\n".join(rule for command in commands for rule in _rules(program, command))
    return _SCRIPT.format(program=program, lines=lines, rules=rules)


def _rules(program: str, command: Command) -> Iterator[str]:
    start = f"complete -c {program} -n {_quoted(f'__{program}_at {_quoted(command.line)}')}"
    for name, help_ in command.commands:
        yield f"{start} -a {name}{_description(help_)}"
    if command.choices:
        yield f"{start} -a {_quoted(' '.join(command.choices))}"
    if command.takes_files:
        yield f"{start} -F"
    for option in command.options:
        yield f"{start}{_names(option)}{_value(option)}{_description(option.help)}"


def _names(option: Option) -> str:
    return "".join(f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}" for name in option.names)


def _value(option: Option) -> str:
    if option.choices:
        return f" -x -a {_quoted(' '.join(option.choices))}"
    return " -r -F" if option.takes_value else ""


def _description(help_: str) -> str:
    return f" -d {_quoted(help_)}" if help_ else ""


def _quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


_SCRIPT = """\
# Completion of {program} for fish.

function __{program}_at --description 'Whether the command line has got to this command'
    set -l line {program}
    for word in (commandline -opc)[2..-1]
        if contains -- "$line $word" {lines}
            set line "$line $word"
        end
    end
    test "$line" = "$argv[1]"
end

complete -c {program} -f
{rules}
"""
