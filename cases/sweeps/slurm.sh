#!/bin/bash
# A sweep as a Slurm job array, one run a task. Plan it where the cluster sees the folder, count the
# lines, hand them over, gather the results:
#
#   creepage sweep cases/sweeps/kt-large.toml --out runs/kt-large --plan runs.sh --threads 4
#   sbatch --array=1-$(wc -l < runs.sh) --cpus-per-task=4 cases/sweeps/slurm.sh runs.sh
#   creepage sweep cases/sweeps/kt-large.toml --out runs/kt-large --collect
#
# A task that fails can be submitted again by its number: it replaces its own run and no other.
# CREEPAGE names the program where it is not on the path of the nodes.
#
#SBATCH --job-name=creepage
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --mem=2G
#SBATCH --time=04:00:00
#SBATCH --output=slurm-%A_%a.log

set -euo pipefail
plan="${1:?usage: sbatch --array=1-N slurm.sh PLAN}"
line="$(sed -n "${SLURM_ARRAY_TASK_ID:?is set by Slurm: submit with --array}p" "$plan")"
if [ -z "$line" ]; then
    echo "$plan has no line $SLURM_ARRAY_TASK_ID" >&2
    exit 2
fi
echo "$line"
exec bash -c "$line"
