#!/usr/bin/env bash
# A sweep in two shards under GNU parallel (docs/sweep.md) equals the whole one. usage: sweep_parallel_test.sh LPVMPC
set -euo pipefail
lpvmpc=$1
work=$(mktemp -d /tmp/sweep_parallel_test.XXXXXX)
trap 'rm -rf "$work"' EXIT
cd "$work"
export HOME=$work # parallel keeps its state there
sweep=("$lpvmpc" sweep --count 3 --seed 7 --speed 9 12 --controller lpv lpv-standard --jobs 1)

parallel --jobs 2 --results 'parts/{}' "${sweep[@]}" --shard '{}/2' ::: 1 2 >/dev/null
"$lpvmpc" sweep merge parts/1 parts/2 --out merged >merged.txt
"${sweep[@]}" --out whole >whole.txt
cmp merged/sweep.json whole/sweep.json

# The merged figures are those of the whole sweep, apart from the times.
"$lpvmpc" sweep merge parts/2 parts/1 --json >merged.json
python3 - <<'PYTHON'
import json

merged, whole = json.load(open("merged.json")), json.load(open("whole/sweep.json"))
timing = merged.pop("timing")
assert merged == whole
assert timing["lpv"]["steps"] == json.load(open("whole/timing.json"))["lpv"]["steps"] > 100
assert [scenario["index"] for scenario in whole["scenarios"]] == [0, 1, 2]
PYTHON

# One of the two shards alone is rejected.
if "$lpvmpc" sweep merge parts/1 --out half 2>error; then
  echo "one of two shards was taken for the whole" >&2
  exit 1
fi
grep -q 'parts/1: no file is shard 2/2 of its sweep' error
[ ! -e half ]
