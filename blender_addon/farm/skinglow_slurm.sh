#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Frames x light rigs of a scene as an array of Slurm tasks, CHUNK frames each:
#
#   sbatch --array=0-24 skinglow_slurm.sh SCENE.blend FOLDER FIRST LAST CHUNK [RIG...]
#
# Frame FIRST + CHUNK * index is the first of a task: --array=0-(number of chunks - 1). Adapt the lines below to the
# cluster. Variables:
#   BLENDER           the program, default blender; its add-ons need Skinglow, except with LIGHT=frozen
#   LIGHT             live, the default; frozen for a file whose light was frozen: any Blender renders it, without rigs
#   PICTURE_SECONDS   a picture that takes longer fails, default 3600, 0: none does
#   RETRIES           of a task, default 2
#SBATCH --job-name=skinglow
#SBATCH --requeue --open-mode=append
#SBATCH --output=skinglow_%A_%a.txt
#SBATCH --ntasks=1 --cpus-per-task=1 --mem=1000
#SBATCH --time=04:00:00

blend=$1 folder=$2 last=$4 chunk=$5
first=$(($3 + chunk * SLURM_ARRAY_TASK_ID))
end=$((first + chunk - 1 < last ? first + chunk - 1 : last))
if [ "${LIGHT:-live}" = frozen ]; then
    options=(-o "$folder/scene/####" -s "$first" -e "$end" -a)
else
    options=(--python-exit-code 2 --python-expr "import skinglow_blender as sb; sb.batch_main()" --
        --frames="$first-$end" --out "$folder" --timeout "${PICTURE_SECONDS:-3600}")
    [ $# -le 5 ] || options+=(--rigs "${@:6}")
fi

"${BLENDER:-blender}" -b -y "$blend" "${options[@]}"
code=$?
# 1: another try may help; above 130: Blender was killed or crashed. 2, 3: no use in trying.
if { [ $code -eq 1 ] || [ $code -gt 130 ]; } && [ "${SLURM_RESTART_COUNT:-0}" -lt "${RETRIES:-2}" ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
    sleep 60 # Slurm ends this script meanwhile
fi
exit $code
