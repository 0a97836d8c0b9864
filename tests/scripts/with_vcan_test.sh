#!/usr/bin/env bash
# Tests the promises of scripts/with-vcan. usage: with_vcan_test.sh PATH_OF_WITH_VCAN
set -u
with_vcan=$1
work=$(mktemp -d /tmp/with_vcan_test.XXXXXX)
trap 'rm -rf "$work"' EXIT
failures=0

Expect() { # Expect WHAT WANTED GOT
  if [ "$2" != "$3" ]; then
    printf 'FAILED: %s\n  wanted: %q\n  got:    %q\n' "$1" "$2" "$3" >&2
    failures=$((failures + 1))
  fi
}

# True if no process has the text in its command line (those of this script do not).
NoneRuns() {
  ! pgrep -f -- "$1" >/dev/null
}

# Prints the temporary folder of the wrapper that booted the kernel whose command line is in FILE; nothing for our own.
GuestFolder() { # GuestFolder FILE
  [ "$(<"$1")" = "$(</proc/cmdline)" ] || sed -n 's,.* init=\([^ ]*\)/init .*,\1,p' "$1"
}

WaitFor() { # WaitFor COMMAND...: repeats COMMAND until it succeeds, for at most 30 s
  local i
  for ((i = 0; i < 300; i++)); do
    "$@" && return
    sleep 0.1
  done
  echo "FAILED: timed out waiting for: $*" >&2
  exit 1
}

# --- One run that passes everything through: arguments, environment, folder, output, status.
# shellcheck disable=SC2016,SC1003 # meant literally
arguments=('' 'two words' $'new\nline' "'single' \"double\"" '$HOME `id`' '\' -t '*' $'\xc3\xa9 \xff' 'a=b')
cat >"$work/show.sh" <<'SHOW'
printf '%s\0' "$@" >"$WORK/arguments"
printf '%s' "$ODD_VALUE" >"$WORK/value"
pwd >"$WORK/folder"
cat >"$WORK/stdin"
cat /proc/cmdline >"$WORK/cmdline"
for interface in vcan0 vcan1; do ip link show up dev $interface; done | grep -c 'mtu 72' >"$WORK/interfaces"
candump -L -n 1 -T 20000 vcan1 >"$WORK/candump" &
sleep 0.5
cansend vcan1 123#1122334455667788
wait $!
setsid sleep 7.654321 &
cat "$WORK/binary"
tac -b "$WORK/binary" >&2
exit 7
SHOW
head -c 200000 /dev/urandom >"$work/binary"
mkdir "$work/a folder"
cd "$work/a folder" || exit 1
export WORK=$work ODD_VALUE=$'two words\nand a line "quoted" \xff'
"$with_vcan" -t 60 -- bash "$work/show.sh" "${arguments[@]}" >"$work/stdout" 2>"$work/stderr" <&-
Expect 'exit status' 7 $?
printf '%s\0' "${arguments[@]}" | cmp - "$work/arguments"
Expect 'arguments' 0 $?
printf '%s' "$ODD_VALUE" | cmp - "$work/value"
Expect 'environment' 0 $?
Expect 'working directory' "$work/a folder" "$(<"$work/folder")"
Expect 'stdin is empty' '' "$(<"$work/stdin")"
Expect 'interfaces that are up with the length of FD frames' 2 "$(<"$work/interfaces")"
grep -qE '^\([0-9]+\.[0-9]{6}\) vcan1 123#1122334455667788' "$work/candump"
Expect 'candump sees what cansend sends' 0 $?
cmp "$work/binary" "$work/stdout"
Expect 'stdout' 0 $?
tac -b "$work/binary" | cmp - "$work/stderr"
Expect 'stderr' 0 $?
NoneRuns 'sleep 7.654321'
Expect 'no process is left' 0 $?
folder=$(GuestFolder "$work/cmdline")
if [ -n "$folder" ]; then # in User-Mode Linux
  NoneRuns "$folder"
  Expect 'no guest is left' 0 $?
  Expect 'no folder is left' no "$([ -e "$folder" ] && echo yes || echo no)"
fi
cd / || exit 1

# --- Three at once: time limit, time limit of a command that will not end, death by a signal.
"$with_vcan" -t 12 -- sleep 71.5 &
limited=$!
"$with_vcan" -t 12 -- sh -c 'trap "" TERM; sleep 72.5; sleep 72.5' 2>/dev/null &
stubborn=$!
"$with_vcan" -- sh -c 'kill -SEGV $$' &
killed=$!
wait "$limited"
Expect 'time limit' 124 $?
wait "$stubborn"
Expect 'time limit of a command that ignores SIGTERM' 124 $?
wait "$killed"
Expect 'death by SIGSEGV' 139 $?

# --- Signals to the wrapper end all its processes; none may be left.
for signal in TERM KILL; do
  "$with_vcan" -- sh -c "cat /proc/cmdline >'$work/ready.$signal'; sleep 73.5" 2>/dev/null &
  wrapper=$!
  WaitFor test -s "$work/ready.$signal"
  kill -s "$signal" "$wrapper"
  wait "$wrapper" 2>/dev/null
  status=$?
  Expect "SIG$signal to the wrapper" "$signal" "$(kill -l "$status")"
  WaitFor NoneRuns 'sleep 7[0-9].5'
  folder=$(GuestFolder "$work/ready.$signal")
  [ -z "$folder" ] || WaitFor NoneRuns "$folder"
  if [ "$signal" = TERM ] && [ -n "$folder" ]; then
    Expect 'no folder is left' no "$([ -e "$folder" ] && echo yes || echo no)"
  fi
  [ -z "$folder" ] || rm -rf "$folder" # left only after SIGKILL
done

# --- Mistakes
for mistake in '--nonsense true' '-t x true' '-m x true' '-t' ''; do
  # shellcheck disable=SC2086 # several words
  message=$("$with_vcan" $mistake 2>&1)
  Expect "status of with-vcan $mistake" 125 $?
  Expect "lines of with-vcan $mistake" 1 "$(wc -l <<<"$message")"
done
"$with_vcan" --help | grep -q '^usage: with-vcan'
Expect '--help' 0 $?

exit $((failures > 0))
