#!/bin/bash
# One run shared by several processes, as a Slurm job. Submit it where the cluster sees the folder:
#
#   sbatch --ntasks=8 --cpus-per-task=4 cases/sweeps/slurm-run.sh cases/zhao-li/a-coulomb.toml --set mesh.zone.size=0.25e-3
#
# Options after the case go to `creepage run`; --threads is what Slurm gives a process. A job that ended too soon can be
# submitted again, with another number of processes too: the run goes on from its last checkpoint. How many processes are
# worth it: `creepage mesh CASE --ranks N`, docs/large-runs.md. CREEPAGE names the program, built with the feature mpi,
# where it is not on the path.
#
#SBATCH --job-name=creepage
#SBATCH --output=slurm-%j.log

set -euo pipefail
case="${1:?usage: slurm-run.sh CASE [options of creepage run]}"
shift
# as many processes as the job has tasks; Open MPI may bind a process to one core, where it could not use more threads
exec mpirun --bind-to none "${CREEPAGE:-creepage}" run "$case" --threads "${SLURM_CPUS_PER_TASK:-1}" --resume --force "$@"
