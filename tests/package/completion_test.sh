#!/usr/bin/env bash
# Tests the completions in bash. usage: completion_test.sh COMPLETION FOLDER_OF_PROGRAMS [interfaces]
# With `interfaces` only the names of interfaces are tested, where vcan0 and vcan1 exist.
set -u
export PATH=$2:$PATH
# shellcheck disable=SC1091 # Debian's
source /usr/share/bash-completion/bash_completion
# shellcheck disable=SC1090 # the one under test
source "$1"
work=$(mktemp -d /tmp/completion_test.XXXXXX)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
mkdir drive
touch a.toml a.txt a.log
failures=0

Completes() { # Completes WANTED WORD...: the last word is the one at the cursor
  local wanted=$1
  shift
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMP_LINE="$*" COMP_TYPE=9 COMPREPLY=()
  COMP_POINT=${#COMP_LINE}
  _lpvmpcd "$1" "${!#}" "${COMP_WORDS[COMP_CWORD - 1]}" 2>/dev/null # compopt has no command line here
  local got
  got=$(printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' ')
  if [ "${got% }" != "$wanted" ]; then
    printf 'FAILED: %s|\n  wanted: %s\n  got:    %s\n' "$*" "$wanted" "${got% }" >&2
    failures=$((failures + 1))
  fi
}

if [ "${3:-}" = interfaces ]; then # processes are slow where vcan0 and vcan1 exist
  Completes 'vcan0 vcan1' lpvmpcd --interface ''
  Completes 'vcan1' lpvmpc-sim --interface vcan1
  exit $((failures > 0))
fi

Completes '--check-config --config --controller' lpvmpcd --c
Completes 'a.toml drive' lpvmpcd --config ''
Completes 'lpv lpv-affine lpv-standard' lpvmpcd --controller ''
Completes '--scenario' lpvmpc-sim --interface vcan0 --s
Completes 'a.toml drive' lpvmpc-sim --scenario ''
Completes 'bench catalogue decode falsify paper report run sweep' lpvmpc ''
Completes 'report run' lpvmpc r
Completes 'catalogue qp step' lpvmpc bench ''
Completes '--horizon' lpvmpc bench step --hor
Completes '--map' lpvmpc paper --m
Completes 'lpv lpv-affine lpv-standard nmpc nmpc-affine' lpvmpc run --controller ''
Completes '--out' lpvmpc run --scenario a.toml --o
Completes 'drive' lpvmpc run --out ''
Completes 'a.log drive' lpvmpc decode ''
Completes 'drive' lpvmpc report ''
Completes '' lpvmpc bench step --repeat ''
Completes 'merge' lpvmpc sweep ''
Completes 'a.log a.toml a.txt drive' lpvmpc sweep merge ''
Completes '' lpvmpc sweep --shard ''
Completes 'merge' lpvmpc falsify ''
Completes 'a.log a.toml a.txt drive' lpvmpc falsify merge ''
Completes '' lpvmpc falsify --budget ''
Completes 'a.log a.toml a.txt drive' lpvmpc falsify --out ''
Completes '--filter' lpvmpc catalogue --f
Completes '' lpvmpc catalogue --filter ''
Completes 'drive' lpvmpc catalogue --json ''
Completes '--report' lpvmpc catalogue --rep
Completes 'drive' lpvmpc catalogue --report ''

for program in lpvmpcd lpvmpc-sim lpvmpc; do
  complete -p "$program" | grep -q -- '-F _lpvmpcd' || { echo "FAILED: no completion of $program" >&2; failures=1; }
done
exit $((failures > 0))
