#!/usr/bin/env bash
# Persons of real proportions, slim and full, women and men, are dressed within all bounds on every backend with what mssim measure
# writes for them. $1: mssim, $2: the source folder, $3: an emulator, in which that would take an hour
set -euo pipefail
[ -z "${3-}" ] || exit 77
MSSIM_BIN=$(dirname "$1")
export MSSIM_BIN
"$2/scripts/dress-persons" woman-161 woman-312 woman-tall-slim woman-tall-heavy man-10339
