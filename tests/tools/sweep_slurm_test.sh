#!/usr/bin/env bash
# A sweep as a job array of Slurm (docs/sweep.md) equals the whole one. The cluster is this machine alone: the test starts
# its own munged, slurmctld and slurmd, on free ports and with all files in a temporary folder, and ends them.
# usage: sweep_slurm_test.sh LPVMPC
set -euo pipefail
lpvmpc=$(realpath "$1")
work=$(mktemp -d /tmp/sweep_slurm_test.XXXXXX)
chmod 755 "$work" # munged refuses a socket in a folder that others cannot enter
daemons=()
jobs_begun=no

finish() {
  local status=$?
  set +e
  if [ $status -ne 0 ]; then
    tail -n 40 "$work"/log/* "$work"/slurm-*.out >&2
  fi
  [ $jobs_begun = no ] || timeout 10 scancel --user "$(id -un)"
  local pid
  for pid in "${daemons[@]}"; do kill "$pid"; done
  for pid in "${daemons[@]}"; do # slurmd waits for its steps to end
    timeout 20 tail --pid="$pid" -f /dev/null || kill -KILL "$pid"
  done
  wait
  rm -rf "$work"
  exit $status
}
trap finish EXIT
trap 'exit 1' INT TERM

cd "$work"
mkdir log munge spool state
export PATH=$PATH:/usr/sbin
free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])'
}
# Repeats a command until it succeeds, for at most 30 s.
await() {
  local i
  for ((i = 0; i < 150; i++)); do
    if "$@" >log/await 2>&1; then return; fi
    sleep 0.2
  done
  echo "not within 30 s: $*" >&2
  return 1
}

host=$(hostname -s)
cat >slurm.conf <<CONF
ClusterName=sweep
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1
KillWait=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=5 State=UP
CONF
echo "CgroupPlugin=cgroup/v1" >cgroup.conf
export SLURM_CONF=$work/slurm.conf

mungekey --create --keyfile munge/key
munged --foreground --force --socket munge/socket --key-file munge/key --seed-file munge/seed --pid-file munge/pid \
  2>log/munged &
daemons+=($!)
await munge --no-input --socket munge/socket
slurmctld -D -c >log/slurmctld 2>&1 &
daemons+=($!)
await scontrol ping
slurmd -D -N "$host" >log/slurmd 2>&1 &
daemons+=($!)
idle() { [ "$(sinfo --noheader --format %T)" = idle ]; }
await idle

sweep="$lpvmpc sweep --count 3 --seed 7 --speed 9 12 --controller lpv lpv-standard --jobs 1"
jobs_begun=yes
# shellcheck disable=SC2016 # the job's shell knows the task
sbatch --wait --quiet --array=1-2 --cpus-per-task=1 --wrap="srun $sweep "'--shard $SLURM_ARRAY_TASK_ID/2 --out part-$SLURM_ARRAY_TASK_ID.json'
"$lpvmpc" sweep merge part-*.json --out merged >merged.txt
$sweep --out whole >whole.txt
cmp merged/sweep.json whole/sweep.json
[ "$(grep -c '"seed"' merged/sweep.json)" = 4 ] # of the sweep and of its three scenarios

# A task that fails fails its job: nothing is merged without its part.
# shellcheck disable=SC2016
if sbatch --wait --quiet --array=1-2 --wrap="srun $sweep "'--shard $((SLURM_ARRAY_TASK_ID + 1))/2 --out late-$SLURM_ARRAY_TASK_ID.json'; then
  echo "shard 3/2 was driven" >&2
  exit 1
fi
if "$lpvmpc" sweep merge late-*.json --out half 2>error; then
  echo "one of two shards was taken for the whole" >&2
  exit 1
fi
grep -q 'late-1.json: no file is shard 1/2 of its sweep' error
