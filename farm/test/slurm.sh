# SPDX-License-Identifier: Apache-2.0
# A Slurm of one node on the loopback address, in a folder of its own, for tests. Sourced by farm/test/run, with `place`
# set to the folder. Needs root: slurmd starts jobs as their user.

start_slurm() {
  local host
  host=$(hostname -s)
  mkdir -p "$place/slurm/state" "$place/slurm/spool" "$place/munge" || return 1
  export SLURM_CONF=$place/slurm/slurm.conf
  # Jobs that are requeued wait until their credential has expired: 5 s is the least that Slurm allows.
  cat >"$SLURM_CONF" <<EOF
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmctldPort=17817
SlurmdPort=17818
AuthType=auth/munge
AuthInfo=socket=$place/munge/socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$place/slurm/state
SlurmdSpoolDir=$place/slurm/spool
SlurmctldPidFile=$place/slurm/slurmctld.pid
SlurmdPidFile=$place/slurm/slurmd.pid
SlurmctldLogFile=$place/slurm/slurmctld.log
SlurmdLogFile=$place/slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
JobRequeue=1
ReturnToService=2
MinJobAge=300
KillWait=30
MaxArraySize=1001
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
EOF
  touch "$place/slurm/cgroup.conf"
  head -c 1024 /dev/urandom >"$place/munge/key" && chmod 600 "$place/munge/key" || return 1
  munged --key-file="$place/munge/key" --socket="$place/munge/socket" --pid-file="$place/munge/pid" \
    --log-file="$place/munge/log" --seed-file="$place/munge/seed" --force >/dev/null 2>&1 || return 1
  munged=$(cat "$place/munge/pid") || return 1
  # The daemons stay children of the shell, which ends exactly these.
  slurmctld -D >/dev/null 2>&1 &
  slurmctld=$!
  slurmd -D >/dev/null 2>&1 &
  slurmd=$!
  local try
  for try in $(seq 60); do
    [[ $(sinfo -h -o %T 2>/dev/null) != idle* ]] || return 0
    sleep 0.5
  done
  tail -n 20 "$place/slurm/slurmctld.log" "$place/slurm/slurmd.log" >&2
  return 1
}

stop_slurm() {
  [ -z "${slurmctld:-}" ] || { scancel -Q -u "$(id -un)" 2>/dev/null; sleep 1; }
  local daemon
  for daemon in ${slurmd:-} ${slurmctld:-}; do
    kill "$daemon" 2>/dev/null
    wait "$daemon" 2>/dev/null
  done
  [ -z "${munged:-}" ] || kill "$munged" 2>/dev/null
  slurmd='' slurmctld='' munged=''
}
