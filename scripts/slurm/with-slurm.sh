#!/usr/bin/env bash
# Runs a command beside a Slurm of its own: one node, this machine, everything in a temporary folder. Needs root,
# munge and slurm-wlm; exits with 77 where they are missing.
#   scripts/slurm/with-slurm.sh COMMAND...
set -euo pipefail

skip() {
  echo "with-slurm.sh: $1; skipped" >&2
  exit 77
}
[[ $# -gt 0 ]] || { sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
[[ $(id -u) == 0 ]] || skip "Slurm's node can only be started by root"
PATH=$PATH:/usr/sbin
for program in munged mungekey slurmctld slurmd sbatch squeue scancel; do
  command -v $program >/dev/null || skip "there is no $program (apt-get install slurm-wlm munge)"
done

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
folder=$(mktemp --directory --tmpdir trackbed-slurm-XXXXXX)
export TRACKBED_SLURM=$folder SLURM_CONF=$folder/slurm.conf
chmod 755 "$folder"
take_down() {
  "$here/node.sh" kill
  for daemon in slurmctld munged; do
    [[ -s $folder/$daemon.pid ]] || continue
    process=$(cat "$folder/$daemon.pid")
    kill "$process" || true
    # It writes its state before it ends; where nobody collects its exit code it stays behind as a zombie.
    for ((tries = 0; tries < 50; ++tries)); do
      [[ $(ps -o stat= -p "$process") == [!Z]* ]] || break
      sleep 0.1
    done
  done
  rm -rf "$folder"
}
trap take_down EXIT

cat >"$SLURM_CONF" <<END
ClusterName=trackbed
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
AuthType=auth/munge
CryptoType=crypto/munge
# a task of a node that was lost may start again when its old credential has expired
AuthInfo=socket=$folder/munge.socket,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=6
KillWait=2
# every processor is one to Slurm, also where two share a core
SlurmdParameters=config_overrides
NodeName=$(hostname -s) NodeAddr=127.0.0.1 Port=16818 CoresPerSocket=$(nproc) ThreadsPerCore=1 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
mkdir "$folder/state" "$folder/spool"

mungekey --create --keyfile "$folder/munge.key"
munged --force --key-file "$folder/munge.key" --socket "$folder/munge.socket" --pid-file "$folder/munged.pid" \
  --log-file "$folder/munged.log" --seed-file "$folder/munged.seed"
slurmctld
"$here/node.sh" start
for ((tries = 0; tries < 100; ++tries)); do
  [[ $(sinfo --noheader --format=%T 2>/dev/null) == idle ]] && break
  sleep 0.2
done
if ((tries == 100)); then
  tail -n 20 "$folder"/*.log >&2
  echo "with-slurm.sh: Slurm does not come up" >&2
  exit 1
fi
"$@"
