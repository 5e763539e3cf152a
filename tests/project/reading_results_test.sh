#!/bin/bash
# The blocks of docs/reading-results.md run in a committed folder and print what its files hold. Languages that are not installed are
# named. What each release wrote is read. Arguments: mssim, the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"
cp "$source"/results/table1/zen4/{timings.csv,samples.csv,provenance.json} .

# NAME-N for the blocks of each language, in their order.
awk '/^```[a-z]/ { name = substr($0, 4); file = name "-" ++count[name]; next } /^```$/ { file = ""; next } file { print > file }' \
  "$source/docs/reading-results.md"
[[ -s python-3 && -s r-1 && -s gnuplot-1 ]]

# holds FILE TEXT...: the file has each text.
holds() {
  local text
  for text in "${@:2}"; do grep -qF -- "$text" "$1" || fail "$1 does not have \"$text\": $(cat "$1")"; done
}
# number COLUMN BACKEND: of its row with cloth350k and semi-euler.
number() {
  column_of timings.csv scene backend integrator "$1" | awk -v row="cloth350k $2 semi-euler" '$1 " " $2 " " $3 == row { printf "%.5g", $4 }'
}

missing=()
if /usr/bin/python3 -c 'import pandas' 2>/dev/null; then
  for block in python-1 python-2; do /usr/bin/python3 "$block" >"$block.out"; done
  holds python-1.out cloth350k "$(number speedup_vs_serial openmp | cut -c1-5)"
  holds python-2.out cloth350k "$(number ms_per_step serial | cut -c1-5)"
else
  missing+=(python3-pandas)
fi
/usr/bin/python3 python-3 >python-3.out
holds python-3.out "$(grep -o '[0-9a-f]\{40\}' provenance.json)" 'AMD EPYC'
if command -v Rscript >/dev/null; then
  Rscript r-1 >r-1.out
  holds r-1.out cloth350k "$(number ms_per_step serial | cut -c1-4)"
  # A row that is missing has no time, rather than 0 ms.
  mkdir fewer
  grep -v '^cloth350k,[0-9,]*,serial,.*,semi-euler,' timings.csv >fewer/timings.csv
  (cd fewer && Rscript ../r-1) >r-1.out
  holds r-1.out NA
else
  missing+=(r-base-core)
fi
if command -v gnuplot >/dev/null; then
  gnuplot gnuplot-1
  xmllint --noout openmp.svg
  # An error bar for each of the six cloths.
  holds openmp.svg 'ms per step' openmp
  [[ $(grep -c "gpPt0\|<use" openmp.svg) -ge 6 ]]
else
  missing+=(gnuplot-nox)
fi

# What each release wrote is read.
for release in "$source"/tests/archive/*/; do
  ends 0 report "$release/folder" --out report.html
  holds report.html cloth2500 box-small
  ends 0 compare "$release/folder" "$release/folder"
  holds out cloth2500 box-small 12
  ends 0 render "$release/trace.h5" --time 0.02 --out picture.png
  mkdir objects
  ends 0 export "$release/trace.h5" --format obj --frames all --out objects/frame.obj
  [[ -s picture.png && $(find objects -name '*.obj' | wc -l) -ge 2 ]] || fail "of the trace of $release is made: $(ls picture.png objects)"
  rm -rf objects picture.png
done
echo "reading_results_test: all blocks run${missing:+, but for those of missing packages: ${missing[*]}}"
