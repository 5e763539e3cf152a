#!/bin/bash
# The tables of committed results in Markdown pages are what the result folders say, and scripts/tabulate-results sees where they are
# not. Every folder of results/ is on its page. Arguments: mssim (unused), the source folder.
set -euo pipefail

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
fail() { echo "$1" && cat "$place/out" && exit 1; } >&2

status=0
"$2/scripts/tabulate-results" --check >"$place/out" 2>&1 || status=$?
[[ $status == 0 ]] || fail "scripts/tabulate-results makes other tables: run it (exit code $status)"

for folder in "$2"/results/*/; do
  name=$(basename -- "$folder")
  grep -qF "]($name" "$2/results/README.md" || fail "results/README.md does not name $name"
done

cp -r "$2/README.md" "$2/scripts" "$2/results" "$2/scenes" "$2/docs" "$place"
# differs PAGE WHAT: --check says that PAGE differs.
differs() {
  local status=0
  "$place/scripts/tabulate-results" --check >"$place/out" 2>&1 || status=$?
  [[ $status == 1 ]] || fail "$2: exit code $status"
  grep -q "^--- $1" "$place/out" || fail "$2: no word of $1"
}

for timings in "$place"/results/table1/*/timings.csv; do
  sed -i 's/^\(cloth350k,.*,openmp,.*,semi-euler,[^,]*,[^,]*,\)[^,]*/\112345/' "$timings"
done
differs docs/hardware.md 'another time'
"$place/scripts/tabulate-results" || fail 'the tables cannot be made'
grep -q "^| cloth350k, .openmp. .* 12345 (" "$place/docs/hardware.md" || fail 'the page has no new time'
"$place/scripts/tabulate-results" --check >"$place/out" || fail 'the tables differ from what was just made'

printf ' ' >>"$place/scenes/cloth350k.json"
differs results/README.md 'another scene'
"$place/scripts/tabulate-results"
# A change of speed after the measurement makes results older.
printf '2099-01-01T00:00:00Z,0000000,serial,bodies,Zen 9,faster,,,\n' >>"$place/results/changes.csv"
differs results/README.md 'a new change of speed'
"$place/scripts/tabulate-results"
grep -q "^| .table3/.*before 1 change of .serial." "$place/results/README.md" || fail 'no folder is older'

# refuses WHAT ARGUMENT...: bad input gets one sentence.
refuses() {
  local status=0
  "$place/scripts/tabulate-results" "${@:2}" >"$place/out" 2>&1 || status=$?
  [[ $status == 2 && $(wc -l <"$place/out") == 1 ]] || fail "$1: exit code $status"
}
refuses 'an unknown argument' --all
timings=$place/results/table1/zen4/timings.csv
cp "$timings" "$place/timings.csv"
sed -i 's/^\(cloth350k,.*,openmp,.*,semi-euler,[^,]*,[^,]*,\)[^,]*/\1inf/' "$timings"
refuses 'an infinite time'
grep -q 'inf is no number' "$place/out" || fail 'it does not name the number'
sed 's/^cloth350k,/350k-cloth,/' "$place/timings.csv" >"$timings"
refuses 'a scene whose name begins with a digit'
grep -q "'350k-cloth'" "$place/out" || fail 'it does not name the scene'
cp "$place/timings.csv" "$timings"
sed -i '/,before,/d' "$place/results/busy_machine/study.csv"
"$place/scripts/tabulate-results" || fail 'a study without an earlier program'
sed -i '$s/,[^,]*$//' "$place/results/busy_machine/study.csv"
refuses 'a line without its last field'
