#!/usr/bin/env bash
# Other programs open traces, and see what is in them: h5py, MDAnalysis, VTK and meshio (readers.py). A module that Python does not
# have is named, and then the test counts as skipped. docs/traces.md says what each reader cannot do.
set -euo pipefail
. "$2/tests/support/command_line.sh"

make_traces
ends 0 run --scene cloth2500 --threads 1 --duration 0.02 --fps 100 --trace Übung.h5 --energy-curve Übung.csv

run_python "$2" output/traces/readers.py cloth double bodies garment Übung
