#!/bin/bash
# The tiles of a plan as a SLURM array: sbatch --array=1-N --mem=MB examples/cluster/slurm.sh PLAN
# (N and MB as `ridgeline plan` prints them), then: ridgeline join PLAN --out DIR.
# Submitted again it makes what is missing; whole parts are kept.
#SBATCH --job-name=ridgeline
#SBATCH --cpus-per-task=1
#SBATCH --requeue
set -euo pipefail
srun "${RIDGELINE:-ridgeline}" tile "$1" "$SLURM_ARRAY_TASK_ID" --threads "$SLURM_CPUS_PER_TASK"
