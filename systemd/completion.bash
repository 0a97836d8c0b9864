# Bash completion of lpvmpcd, lpvmpc-sim and lpvmpc. Options and commands are those of --help.
_lpvmpcd() {
  local cur prev words cword
  _init_completion || return

  case $prev in
    --interface)
      _lpvmpcd_offer "$(for type in can vcan vxcan; do ip -br link show type $type; done 2>/dev/null | sed 's/[ @].*//')"
      return
      ;;
    --controller)
      local kinds="lpv-affine lpv lpv-standard"
      [[ ${words[0]##*/} != lpvmpc ]] || kinds+=" nmpc nmpc-affine" # not available in the daemon
      _lpvmpcd_offer "$kinds"
      return
      ;;
    --config | --scenario) _filedir toml && return ;;
    --log | -o | --output) _filedir && return ;;
    --out) [[ ${words[1]} == falsify ]] && _filedir && return ;;& # elsewhere a folder
    --out | --record-qp | --scenarios) _filedir -d && return ;;
    --json) [[ ${words[1]} == catalogue ]] && _filedir json && return ;; # elsewhere without a value
    --report) _filedir html && return ;;
    --horizon | --objects | --repeat | --jobs | --timeout | --count | --budget | --worst | --filter | --seed | --sweep-seed | --traffic-key | --speed | --mu | --shard) return ;; # numbers, texts
  esac

  # The command so far: each word that names a subcommand of the one before it.
  local i path=() commands
  commands=$(_lpvmpcd_commands)
  for ((i = 1; i < cword; i++)); do
    [[ " $commands " == *" ${words[i]} "* ]] || continue
    path+=("${words[i]}")
    commands=$(_lpvmpcd_commands)
  done
  if [[ $cur == -* ]]; then
    _lpvmpcd_offer "$(_parse_help "${words[0]}" "${path[*]} --help")"
  elif [[ ${path[*]} == "sweep merge" || ${path[*]} == "falsify merge" ]]; then
    _filedir
  elif [[ -n $commands ]]; then
    _lpvmpcd_offer "$commands"
  elif [[ ${path[*]} == decode ]]; then
    _filedir log
  elif [[ ${path[*]} == report || ${path[*]} == "bench qp" ]]; then
    _filedir -d
  fi
}

# Offers the words of "$1" that begin like the one at the cursor.
_lpvmpcd_offer() {
  # shellcheck disable=SC2207 # words without blanks
  COMPREPLY=($(compgen -W "$1" -- "$cur"))
}

# Prints the subcommands of `path` on one line.
_lpvmpcd_commands() {
  "${words[0]}" "${path[@]}" --help 2>/dev/null |
    sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p' | tr '\n' ' ' | sed 's/ $//'
}

complete -F _lpvmpcd lpvmpcd lpvmpc-sim lpvmpc
