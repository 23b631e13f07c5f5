"""Completion for bash, without the bash-completion package; compatible with bash 3.2, which macOS has."""

from __future__ import annotations

from collections.abc import Iterator

from btq_lang.commands.shell import Command, valued_options


def script(commands: tuple[Command, ...]) -> str:
    """The script, to be sourced, or put into ~/.local/share/bash-completion/completions under the program's name."""
    program = commands[0].line
    lines = "\n".join(f'            {_line(command.line)}) line="$line $word" last= ;;' for command in commands[1:])
    return _SCRIPT.format(
        program=program,
        function="_" + program.replace("-", "_"),
        lines=lines,
        values="\n".join(_values(commands)),
        words="\n".join(map(_words, commands)),
    )


def _values(commands: tuple[Command, ...]) -> Iterator[str]:
    for lines, choices in valued_options(commands):
        yield f"        {'|'.join(map(_line, lines))}) words={_quoted(choices)} ;;"


def _words(command: Command) -> str:
    names = [name for option in command.options for name in option.names]
    words = [*(name for name, _ in command.commands), *command.choices]
    return f'        "{command.line}") options={_quoted(names)} words={_quoted(words)} ;;'


def _line(line: str) -> str:
    return f'"{line}"'


def _quoted(words: list[str] | tuple[str, ...]) -> str:
    return "'" + " ".join(words) + "'"


# Readline splits words at `=`, so `--color=al` arrives as three.  Without other proposals, files are offered (-o
# default).
_SCRIPT = """\
# Completion of {program} for bash.

{function}_value() {{
    case "$1" in
{values}
        *) return 1 ;;
    esac
}}

{function}() {{
    local cur=${{COMP_WORDS[COMP_CWORD]}} line={program} last= options= words= word
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        if [[ $word == "=" ]]; then continue; fi
        if {function}_value "$line $last"; then last=; continue; fi
        last=$word
        case "$line $word" in
{lines}
        esac
    done
    if [[ $cur == "=" ]]; then cur=; fi
    if ! {function}_value "$line $last"; then
        case "$line" in
{words}
        esac
        if [[ $cur == -* ]]; then words=$options; fi
    fi
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
}}

complete -o default -F {function} {program}
"""
