#!/usr/bin/env bash
# A Slurm of this machine alone, as root, in a folder of its own: nothing of an installed Slurm is changed.
#   slurm-node.sh start FOLDER   starts munged, slurmctld and slurmd; prints the line that makes sbatch find it
#   slurm-node.sh stop FOLDER
# Needs the packages slurm-wlm and munge. Exits with 77 where it cannot run, with the reason.
set -euo pipefail
usage() { echo "usage: $0 start|stop FOLDER" >&2; exit 2; }
[ $# = 2 ] || usage
mkdir -p "$2"
folder=$(cd "$2" && pwd)
log=$folder/log

cannot() { echo "no Slurm here: $1" >&2; exit 77; }
port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

configure() {
  local host cores
  host=$(hostname -s)
  cores=$(nproc)
  cat >"$folder/slurm.conf" <<END
ClusterName=tuft
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(port)
SlurmdPort=$(port)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$log/slurmctld.log
SlurmdLogFile=$log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
ReturnToService=2
MinJobAge=600
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cores State=UNKNOWN
PartitionName=here Nodes=$host Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
END
}

start() {
  [ "$(id -u)" = 0 ] || cannot "it must be started as root"
  for program in munged slurmctld slurmd sbatch squeue sinfo; do
    command -v "$program" >/dev/null || cannot "$program is not installed (package slurm-wlm, munge)"
  done
  mkdir -p "$log" "$folder/state" "$folder/spool"
  chmod 755 "$folder"
  head -c 1024 /dev/urandom >"$folder/munge.key"
  chmod 400 "$folder/munge.key"
  munged --force --key-file "$folder/munge.key" --socket "$folder/munge.socket" --pid-file "$folder/munged.pid" \
    --log-file "$log/munged.log" --seed-file "$folder/munged.seed" >"$log/start" 2>&1 ||
    cannot "munged does not start: $(tail -n 1 "$log/start")"
  configure
  export SLURM_CONF=$folder/slurm.conf
  slurmctld -c >>"$log/start" 2>&1 || cannot "slurmctld does not start: $(tail -n 1 "$log/start")"
  slurmd -c >>"$log/start" 2>&1 || cannot "slurmd does not start: $(tail -n 1 "$log/start")"
  for _ in $(seq 100); do
    if sinfo -h -o %T 2>/dev/null | grep -qE '^(idle|mixed|allocated)'; then
      echo "export SLURM_CONF=$SLURM_CONF"
      return
    fi
    sleep 0.2
  done
  stop
  cannot "its node does not become idle: $(tail -n 1 "$log/slurmd.log" 2>/dev/null)"
}

stop() {
  for program in slurmd slurmctld munged; do
    [ -s "$folder/$program.pid" ] && kill "$(cat "$folder/$program.pid")" 2>/dev/null || true
  done
}

case $1 in
  start) start ;;
  stop) stop ;;
  *) usage ;;
esac
