# SPDX-License-Identifier: BSL-1.0
# bash completion for quadrant-gap, quadrant-reproduce, quadrant-cnc and quadrant-latency. What there is to complete is asked of the program, so it is never out of date.
# zsh: autoload -U bashcompinit && bashcompinit, then source this file.
_quadrant_gap() {
    local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} subcommand= w
    for w in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        case $w in -*) ;; *) subcommand=$w; break ;; esac
    done
    COMPREPLY=()
    if [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$("$program" $subcommand --help 2>/dev/null | sed -n 's/^  \(-[^ ]*\).*/\1/p' | tr ',' ' ')" -- "$word"))
    elif [[ -z $subcommand ]]; then
        COMPREPLY=($(compgen -W "$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')" -- "$word"))
    elif [[ $previous == --command-unit ]]; then
        COMPREPLY=($(compgen -W "V A N Nm" -- "$word"))
    else
        COMPREPLY=($(compgen -f -- "$word"))
    fi
}
complete -o filenames -o default -F _quadrant_gap quadrant-gap quadrant-gap-mpi quadrant-reproduce quadrant-cnc quadrant-latency
