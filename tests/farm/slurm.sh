# The scripts of share/slurm on a real Slurm: munged, slurmctld and two slurmd on the loopback address, in the scratch
# folder. 12 frames; a node is killed in the middle of a task; the pictures equal those of the tools without Slurm.
. "$(dirname "$0")/../tools/check.sh"

# The arguments of submit.sh for sbatch, checked with a stand-in: a % in the folder is kept in the names of logs.
mkdir stand-in
printf '%s\n' '#!/bin/sh' 'echo "$@" >>asked' 'echo 7' >stand-in/sbatch
chmod 755 stand-in/sbatch
PATH=$PWD/stand-in:$PATH exits 0 bash "$source_dir/share/slurm/submit.sh" 1-2 views '100%a out'
grep -qF -- '--output=100%%a out/warp.%a.log' asked && grep -qF -- '--output=100%%a out/gather.%a.log' asked ||
    fail "the logs of a folder with %: $(cat asked)"
PATH=$PWD/stand-in:$PATH fails_saying 2 'no backslash' bash "$source_dir/share/slurm/submit.sh" 1-2 views 'a\b'

PATH=$PATH:/usr/sbin:/sbin
for program in munged slurmctld slurmd sbatch; do
    command -v $program >/dev/null || skip "needs Slurm (slurmctld, slurmd, slurm-client, munge): no $program"
done
chmod 755 "$scratch" # munged wants its socket to be reachable by all users
declare -A daemons   # name -> process

processes=           # of the stopped task

stop_all() {
    # shellcheck disable=SC2086
    kill -KILL "${daemons[@]}" $processes 2>/dev/null || true
    wait 2>/dev/null || true
    rm -rf "$scratch"
}
trap stop_all EXIT

# start NAME COMMAND...: runs it in the background, with messages in NAME.log.
start() {
    "${@:2}" >"$1.log" 2>&1 </dev/null &
    daemons[$1]=$!
}
# until_true SECONDS COMMAND...: the command must succeed within this time, at least ten times what it usually takes.
until_true() {
    local end=$((SECONDS + $1))
    while ! "${@:2}" >/dev/null 2>&1; do
        [ $SECONDS -lt $end ] || return 1
        sleep 0.2
    done
}

# Newer versions are told not to use cgroups. Slurm 22.05 starts no node without them, whatever its plugins.
cgroups=CgroupPlugin=disabled
if [ "$(slurmctld -V | sed -E 's/[^0-9]*([0-9]+).*/\1/')" -lt 23 ]; then
    [ -e /sys/fs/cgroup/cgroup.controllers ] || [ -d /sys/fs/cgroup/freezer ] ||
        skip "no cgroups are mounted in /sys/fs/cgroup"
    cgroups=CgroupAutomount=no
fi

# --- Slurm ---
user=$(id -un) port=$((20000 + $$ % 20000))
mkdir state spool
head -c 1024 /dev/urandom >key && chmod 600 key
export SLURM_CONF=$scratch/slurm.conf
cat >slurm.conf <<END
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$scratch/munge.socket,cred_expire=8
CredType=cred/munge
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool/%n
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd-%n.pid
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2,bf_interval=2,batch_sched_delay=1,sched_min_interval=100000
SlurmdParameters=config_overrides
SlurmdTimeout=300
JobRequeue=1
ReturnToService=2
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=2
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=2
PartitionName=all Nodes=n1,n2 Default=YES State=UP
END
echo $cgroups >cgroup.conf
start munged munged --foreground --force --key-file="$scratch/key" --socket="$scratch/munge.socket" --num-threads=2 \
    --pid-file="$scratch/munged.pid" --log-file="$scratch/munged-log" --seed-file="$scratch/munged.seed"
until_true 100 test -S munge.socket || fail "munged does not start: $(tail -n 1 munged.log)"
start slurmctld slurmctld -D -c
for node in n1 n2; do start $node slurmd -D -N $node; done
idle() { [ "$(sinfo -h -N -o %T | sort -u)" = idle ]; }
until_true 200 idle || fail "Slurm does not start: $(tail -n 2 slurmctld.log n1.log n2.log)"
echo "Slurm runs after $SECONDS s"

# --- 12 frames, and their pictures without Slurm ---
lens=(--focus-distance 1:5,12:2.2)
mkdir views
for frame in {01..12}; do
    "$bin/dof-trace" fence --size 48x27 --views 2 --spp 1 --seed "$((10#$frame))" -o still
    for file in center view_0 view_1; do mv still/$file.exr views/$file.00$frame.exr; done
done
exits 0 "$bin/ldi-warp" views/center.####.exr views/view_0.####.exr views/view_1.####.exr -o expected/ldi.####.exr --frames 1-12
exits 0 "$bin/dof-gather" expected/ldi.####.exr -o expected/picture.####.exr "${lens[@]}" --frames 1-12

# Puts the tools in the tasks' PATH. The first time, frame 5 stops in the middle of ldi-warp, and reports its node.
mkdir path
ln -s "$bin/dof-gather" path
cat >path/ldi-warp <<END
#!/bin/bash
[[ \$SLURM_ARRAY_TASK_ID -ne 5 || -e $scratch/stopped ]] && exec "$bin/ldi-warp" "\$@"
"$bin/ldi-warp" "\$@" &
kill -STOP \$!
echo "\$SLURMD_NODENAME \$PPID \$\$ \$!" >$scratch/stopping
mv $scratch/stopping $scratch/stopped
wait
END
chmod +x path/ldi-warp
read -r warp gather <<<"$(PATH=$scratch/path:$PATH "$source_dir/share/slurm/submit.sh" 1-12 "$scratch/views" "$scratch/out" "${lens[@]}")"

# --- The node of frame 5 dies, with everything that runs on it ---
until_true 300 test -e stopped || fail "frame 5 does not begin: $(squeue; cat out/*.log)"
read -r node processes <stopped
[ ! -e out/ldi.0005.exr ] || fail "frame 5 is there before it is made"
# shellcheck disable=SC2086
kill -KILL "${daemons[$node]}" $processes
wait "${daemons[$node]}" 2>/dev/null || true
unset "daemons[$node]"
processes=
echo "killed $node after $SECONDS s"
# As an operator would do. This tests what a job of share/slurm does when its node is gone; that Slurm itself notices,
# after half a minute, is not tested.
set_down() { scontrol update NodeName="$node" State=DOWN Reason=killed; }
set_down
down() { sinfo -h -n "$node" -o %T | grep -q '^down'; }
until_true 100 down || fail "Slurm does not see that $node is gone: $(sinfo)"
echo "Slurm knows after $SECONDS s"

# Repeated, because Slurm 24 waits for ever for a task that was given to the node while it died.
done_all() { set_down && [ -z "$(squeue -h)" ]; }
until_true 600 done_all || fail "it does not end: $(squeue; tail -n 20 slurmctld.log)"
echo "all is done after $SECONDS s"
state() { scontrol show job "$1_$2" | grep -oE '(JobState|Restarts)=[A-Z0-9]+' | tr '\n' ' '; }
[ "$(state "$warp" 5)" = "JobState=COMPLETED Restarts=1 " ] || fail "frame 5 was not started again: $(state "$warp" 5)"
for frame in {1..12}; do
    for job in "$warp" "$gather"; do
        [[ "$(state "$job" "$frame")" == JobState=COMPLETED* ]] || fail "frame $frame of job $job: $(state "$job" "$frame")"
    done
done
[ "$(cd out && ls -- *.exr)" = "$(cd expected && ls)" ] || fail "not the same files: $(ls -a out)"
for file in expected/*; do cmp "$file" "out/${file##*/}" || fail "${file##*/} is another one"; done
