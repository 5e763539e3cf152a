#!/usr/bin/env bash
# Pictures have the silhouettes that VTK sees, and the rasteriser that draws them finds the depths that VTK finds (vtk_pictures.py).
# Python's modules may be missing: see readers_test.sh.
# $1: mssim, $2: the source folder, $3: what runs programs of another machine, or nothing
set -euo pipefail
. "$2/tests/support/command_line.sh"

ends 0 run --scene cloth2500 --threads 1 --duration 0.5 --fps 2 --trace cloth.h5
ends 0 run --scene box-small --threads 1 --duration 0.4 --fps 3 --trace bodies.h5
ends 0 run --scene jeans1k --threads 1 --fps 1 --trace garment.h5
pictures=()
for trace in cloth bodies garment; do
  ends 0 export "$trace.h5" --format obj
  # From above, where ground and shadow are drawn as well, and from below.
  for view in 35,18 -110,-15; do
    ends 0 render "$trace.h5" --view "$view" --size 320x240 --out "$trace-$view.png"
    ${3:+"$3"} "${mssim%/*}/../bin/depth_map" "$trace.h5" "$view" 320 240 "$trace-$view.depths" || fail "there are no depths of $trace"
    pictures+=("$trace-$view")
  done
done

run_python "$2" render/vtk_pictures.py "${pictures[@]}"
