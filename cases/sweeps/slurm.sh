#!/bin/bash
# A sweep as a Slurm job array, one run a task. Plan it where the cluster sees the folder, submit it, gather the results:
#
#   creepage sweep cases/sweeps/kt-large.toml --out runs/kt-large --plan runs.sh
#   cases/sweeps/slurm.sh runs.sh --cpus-per-task=4
#   creepage sweep cases/sweeps/kt-large.toml --out runs/kt-large --collect
#
# Called so, the script asks `creepage mesh --json` for the memory and the time of every run, and submits itself with
# twice the largest memory and four times the longest time, and 10 minutes for preload and check. Options after the plan
# go to sbatch and win: --mem, --time, --partition. Runs of implicit steps have no estimate of time: give --time. A task
# runs on as many threads as Slurm gives it processors. One that fails can be submitted again by its number
# (sbatch --array=7 ... slurm.sh runs.sh): it replaces its own run and no other.
# CREEPAGE names the program where it is not on the path.
#
#SBATCH --job-name=creepage
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --output=slurm-%A_%a.log

set -euo pipefail
plan="${1:?usage: slurm.sh PLAN [options of sbatch]}"
shift
creepage="${CREEPAGE:-creepage}"

# The number of a key in a JSON document with one key a line; nothing where it is null.
number() { sed -n "s/^ *\"$1\": *\([0-9.eE+-]*\),\{0,1\}$/\1/p" | head -n 1; }

# Memory (MB) and time (s, or "none") that the runs of the plan take at most.
estimate() {
    local line document memory time
    while read -r line; do
        line="${line%% && *}"
        eval "set -- ${line#* run }" # the words as the shell reads them: the case first
        document="$("$creepage" mesh "$1" --json)" || exit 2
        memory="$(number memory_mb <<<"$document")"
        time="$(number run_time_s <<<"$document")"
        echo "$memory ${time:-none}"
    done <"$plan" | awk '$1 > memory { memory = $1 } $2 == "none" { none = 1 } $2 > time { time = $2 }
        END { print memory + 0, none ? "none" : time + 0 }'
}

if [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then
    found="$(estimate)"
    read -r memory time <<<"$found"
    limits="$(awk -v memory="$memory" -v time="$time" 'BEGIN {
        printf "--mem=%dM", 2 * memory + 500
        if (time != "none") printf " --time=%d", int(4 * time / 60) + 10 }')"
    echo "largest run: $memory MB, $time s; submitted with $limits" >&2
    # shellcheck disable=SC2086 # two options
    exec sbatch --array="1-$(($(wc -l <"$plan")))" $limits "$@" "$0" "$plan"
fi

line="$(sed -n "${SLURM_ARRAY_TASK_ID}p" "$plan")"
if [ -z "$line" ]; then
    echo "$plan has no line $SLURM_ARRAY_TASK_ID" >&2
    exit 2
fi
if [ -n "${SLURM_CPUS_PER_TASK:-}" ]; then
    line="$(sed "s/ --threads [0-9]*/ --threads $SLURM_CPUS_PER_TASK/" <<<"$line")"
fi
echo "$line"
exec bash -c "$line"
