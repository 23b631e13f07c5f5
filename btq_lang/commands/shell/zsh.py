"""Completion for zsh."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from btq_lang.commands.shell import Command, valued_options


def script(commands: tuple[Command, ...]) -> str:
    """The script, to be put into a folder of `$fpath` as `_` and the program's name, or sourced after `compinit`."""
    program = commands[0].line
    lines = "\n".join(f'            ({_quoted(command.line)}) line="$line $word" last= ;;' for command in commands[1:])
    return _SCRIPT.format(
        program=program, lines=lines, values="\n".join(_values(commands)), words="\n".join(map(_words, commands))
    )


def _values(commands: tuple[Command, ...]) -> Iterator[str]:
    for lines, choices in valued_options(commands):
        yield f"        ({'|'.join(map(_quoted, lines))}) choices=({' '.join(choices)}) ;;"


def _words(command: Command) -> str:
    options = _described((name, option.help) for option in command.options for name in option.names)
    return f"""\
        ("{command.line}")
            options=({options})
            commands=({_described(command.commands)})
            choices=({" ".join(command.choices)})
            files={int(command.takes_files)} ;;"""


def _described(names: Iterable[tuple[str, str]]) -> str:
    return " ".join(_quoted(name.replace(":", "\\:") + (f":{help_}" if help_ else "")) for name, help_ in names)


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"


_SCRIPT = """\
#compdef {program}
# Completion of {program} for zsh.

_{program}_value() {{
    case "$1" in
{values}
        (*) return 1 ;;
    esac
}}

_{program}() {{
    local line={program} last= word files=0
    local -a choices commands options
    for word in "${{(@)words[2,CURRENT-1]}}"; do
        if _{program}_value "$line $last"; then last=; continue; fi
        last=$word
        case "$line $word" in
{lines}
        esac
    done
    if [[ $PREFIX == --*=* ]]; then
        last=${{PREFIX%%=*}}
        compset -P '*='
    fi
    if _{program}_value "$line $last"; then
        if (( $#choices )); then compadd -a choices; else _files; fi
        return
    fi
    case "$line" in
{words}
    esac
    if [[ $PREFIX == -* ]]; then
        _describe -o option options
        return
    fi
    if (( $#commands )); then _describe command commands; fi
    if (( $#choices )); then compadd -a choices; fi
    if (( files )); then _files; fi
}}

if [[ $funcstack[1] == _{program} ]]; then _{program} "$@"; else compdef _{program} {program}; fi
"""
