# SPDX-License-Identifier: Apache-2.0
# What was typed up to the cursor, in $typed; bash cuts words at = and :, which belong to them.
_parhelion_type()
{
    local word glue=
    typed=()
    for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
        if [[ ${#typed[@]} -gt 0 && ( $glue || $word == [=:]* ) ]]; then
            typed[${#typed[@]} - 1]+=$word
        else
            typed+=("$word")
        fi
        [[ $word == *[=:] ]] && glue=yes || glue=
    done
}

_parhelion_files()
{
    mapfile -t COMPREPLY < <(compgen -f -- "$1")
    compopt -o filenames 2>/dev/null
}

_parhelion_words()
{
    mapfile -t COMPREPLY < <(compgen -W "$2" -- "$1")
}

_parhelion()
{
    local typed command value option='' commands='' guides='' takes='' flags='' files='' named=''
    local arguments=''
    local -A values=()
    COMPREPLY=()
    _parhelion_type
    value=${typed[${#typed[@]} - 1]}
    unset "typed[${#typed[@]} - 1]"
    command=${typed[0]}
    _parhelion_row ''
    local all=$commands
    if [[ $command ]]; then
        commands='' flags=''
        _parhelion_row "$command"
        if [[ $commands && ${typed[1]} ]]; then
            commands='' flags=''
            _parhelion_row "$command ${typed[1]}"
        fi
    fi
    if [[ $value == --*=* ]]; then
        option=${value%%=*} value=${value#*=}
    elif [[ ${#typed[@]} -gt 0 && $takes == *" ${typed[${#typed[@]} - 1]} "* ]]; then
        option=${typed[${#typed[@]} - 1]}
    fi
    if [[ $option ]]; then
        if [[ ${values[$option]} ]]; then
            _parhelion_words "$value" "${values[$option]}"
        elif [[ $files == *" $option "* ]]; then
            _parhelion_files "$value"
        elif [[ $named == *" $option "* && $value == *=* ]]; then
            _parhelion_files "${value#*=}"
        fi
    elif [[ $value == -* ]]; then
        _parhelion_words "$value" "$takes $flags"
    elif [[ $commands ]]; then
        _parhelion_words "$value" "$commands"
    elif [[ $arguments == names ]]; then
        _parhelion_words "$value" "$all $guides"
    elif [[ $arguments == files ]]; then
        _parhelion_files "$value"
    fi
    # bash puts the answer behind the last = or : that was typed
    local cut=${value%"${value##*[=:]}"}
    [[ $cut ]] && COMPREPLY=("${COMPREPLY[@]#"$cut"}")
    return 0
}
complete -F _parhelion parhelion
