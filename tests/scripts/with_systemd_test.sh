#!/usr/bin/env bash
# Tests the promises of scripts/with-systemd. usage: with_systemd_test.sh PATH_OF_WITH_SYSTEMD
set -u
with_systemd=$1
work=$(mktemp -d /tmp/with_systemd_test.XXXXXX)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

Expect() { # Expect WHAT WANTED GOT
  if [ "$2" != "$3" ]; then
    printf 'FAILED: %s\n  wanted: %q\n  got:    %q\n' "$1" "$2" "$3" >&2
    failures=$((failures + 1))
  fi
}

# shellcheck disable=SC2016 # expanded on the machine
inside='
  cat /proc/1/comm
  systemctl is-system-running
  pwd
  printf "%s|" "$@"
  echo "a word aside" >&2
  echo written >file
  touch /gone
  logger "noted in the journal"
  exit 7'
"$with_systemd" -t 60 -j "$work/journal" -- bash -c "$inside" - 'two words' '' $'new\nline' >"$work/stdout" 2>"$work/stderr"
Expect 'exit status' 7 $?
Expect 'stdout' $'systemd\nrunning\n'"$work"$'\ntwo words||new\nline|' "$(<"$work/stdout")"
grep -q '^a word aside$' "$work/stderr"
Expect 'stderr' 0 $?
Expect 'working directory is shared' written "$(<"$work/file")"
Expect 'the rest is not' no "$([ -e /gone ] && echo yes || echo no)"
grep -q 'noted in the journal' "$work/journal"
Expect 'journal' 0 $?

"$with_systemd" -t 2 -- sleep 71.5 2>/dev/null
Expect 'time limit' 124 $?

for mistake in '--nonsense true' '-t x true' '-j' ''; do
  # shellcheck disable=SC2086 # several words
  message=$("$with_systemd" $mistake 2>&1)
  Expect "status of with-systemd $mistake" 125 $?
  Expect "lines of with-systemd $mistake" 1 "$(wc -l <<<"$message")"
done
exit $((failures > 0))
