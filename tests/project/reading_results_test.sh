#!/bin/bash
# The blocks of docs/reading-results.md run in a committed folder and print what its files hold. Languages that are not installed are
# named. What each release wrote is read. Arguments: mssim, the source folder.
set -euo pipefail
mssim=$1 source=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cp "$source"/results/table1/zen4/{timings.csv,samples.csv,provenance.json} "$place"
cd "$place"

# NAME-N for the blocks of each language, in their order.
awk '/^```[a-z]/ { name = substr($0, 4); file = name "-" ++count[name]; next } /^```$/ { file = ""; next } file { print > file }' \
  "$source/docs/reading-results.md"
[[ -s python-3 && -s r-1 && -s gnuplot-1 ]]

# expect FILE TEXT...: the file has each text.
expect() {
  local text
  for text in "${@:2}"; do
    grep -qF -- "$text" "$1" || { echo "reading_results_test: $1 does not have \"$text\":" && cat "$1" && exit 1; }
  done >&2
}
# value COLUMN SCENE BACKEND: of its row with semi-euler.
value() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import csv, sys
column, scene, backend = sys.argv[1:]
rows = [row for row in csv.DictReader(open("timings.csv")) if (row["scene"], row["backend"], row["integrator"]) == (scene, backend, "semi-euler")]
print(f"{float(rows[0][column]):.5g}")
PYTHON
}

missing=()
if /usr/bin/python3 -c 'import pandas' 2>/dev/null; then
  for block in python-1 python-2; do /usr/bin/python3 "$block" >"$block.out"; done
  expect python-1.out cloth350k "$(value speedup_vs_serial cloth350k openmp | cut -c1-5)"
  expect python-2.out cloth350k "$(value ms_per_step cloth350k serial | cut -c1-5)"
else
  missing+=(python3-pandas)
fi
/usr/bin/python3 python-3 >python-3.out
expect python-3.out "$(grep -o '[0-9a-f]\{40\}' provenance.json)" 'AMD EPYC'
if command -v Rscript >/dev/null; then
  Rscript r-1 >r-1.out
  expect r-1.out cloth350k "$(value ms_per_step cloth350k serial | cut -c1-4)"
  # A row that is missing has no time, rather than 0 ms.
  mkdir fewer
  grep -v '^cloth350k,[0-9,]*,serial,.*,semi-euler,' timings.csv >fewer/timings.csv
  (cd fewer && Rscript ../r-1) >r-1.out
  expect r-1.out NA
else
  missing+=(r-base-core)
fi
if command -v gnuplot >/dev/null; then
  gnuplot gnuplot-1
  xmllint --noout openmp.svg
  # An error bar for each of the six cloths.
  expect openmp.svg 'ms per step' openmp
  [[ $(grep -c "gpPt0\|<use" openmp.svg) -ge 6 ]]
else
  missing+=(gnuplot-nox)
fi

# What each release wrote is read.
for release in "$source"/tests/archive/*/; do
  "$mssim" report "$release/folder" --out "$place/report.html" >/dev/null 2>&1
  expect "$place/report.html" cloth2500 box-small
  "$mssim" compare "$release/folder" "$release/folder" >compared
  expect compared cloth2500 box-small 12
  "$mssim" render "$release/trace.h5" --time 0.02 --out "$place/picture.png" >/dev/null 2>&1
  mkdir -p "$place/objects"
  "$mssim" export "$release/trace.h5" --format obj --frames all --out "$place/objects/frame.obj" >/dev/null 2>&1
  [[ -s $place/picture.png && $(find "$place" -name '*.obj' | wc -l) -ge 2 ]]
  rm -rf "$place/objects" "$place/picture.png"
done
echo "reading_results_test: all blocks run${missing:+, but for those of missing packages: ${missing[*]}}"
