#!/bin/bash
# The tables of committed results in Markdown pages are what the result folders say, and scripts/tabulate-results sees where they are
# not. Every folder of results/ is on its page. Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# Where a table differs, scripts/tabulate-results makes it anew.
exits 0 "$source/scripts/tabulate-results" --check

for folder in "$source"/results/*/; do
  name=$(basename -- "$folder")
  grep -qF "]($name" "$source/results/README.md" || fail "results/README.md does not name $name"
done

cp -r "$source"/{README.md,scripts,results,scenes,docs} .
tabulate=$work/scripts/tabulate-results
# differs PAGE: --check says that it differs.
differs() { saying "^--- $1" exits 1 "$tabulate" --check; }

for timings in results/table1/*/timings.csv; do
  sed -i 's/^\(cloth350k,.*,openmp,.*,semi-euler,[^,]*,[^,]*,\)[^,]*/\112345/' "$timings"
done
differs docs/hardware.md
exits 0 "$tabulate"
grep -q "^| cloth350k, .openmp. .* 12345 (" docs/hardware.md || fail 'the page has no new time'
exits 0 "$tabulate" --check

# Another scene.
printf ' ' >>scenes/cloth350k.json
differs results/README.md
exits 0 "$tabulate"
# A change of speed after the measurement makes results older.
printf '2099-01-01T00:00:00Z,0000000,serial,bodies,Zen 9,faster,,,\n' >>results/changes.csv
differs results/README.md
exits 0 "$tabulate"
grep -q "^| .table3/.*before 1 change of .serial." results/README.md || fail 'no folder is older'

# Bad input gets one sentence.
refuses 2 'unknown arguments' "$tabulate" --all
timings=results/table1/zen4/timings.csv
cp "$timings" timings.csv
sed -i 's/^\(cloth350k,.*,openmp,.*,semi-euler,[^,]*,[^,]*,\)[^,]*/\1inf/' "$timings"
refuses 2 'inf is no number' "$tabulate"
# A scene whose name begins with a digit.
sed 's/^cloth350k,/350k-cloth,/' timings.csv >"$timings"
refuses 2 "'350k-cloth'" "$tabulate"
cp timings.csv "$timings"
# A study without an earlier program is no mistake, a line without its last field is one.
sed -i '/,before,/d' results/busy_machine/study.csv
exits 0 "$tabulate"
sed -i '$s/,[^,]*$//' results/busy_machine/study.csv
refuses 2 '' "$tabulate"
