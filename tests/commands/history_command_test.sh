#!/usr/bin/env bash
# mssim history: result folders, made up here, become lines of a file; the commit of a slowdown and rows that vanish are named.
set -euo pipefail
. "$2/tests/support/command_line.sh"
source_run=$2/results/table1/zen5

# Twelve commits, and five that are 8 % slower with openmp.
for number in {10..26}; do
  factor=1
  [ "$number" -lt 22 ] || factor=1.08
  make_run run "serial=$(awk -v i="$number" 'BEGIN { print 1 + 0.002 * (i % 4) }')" \
    "openmp=$(awk -v i="$number" -v f="$factor" 'BEGIN { print 0.1 * f * (1 + 0.001 * (i % 3)) }')"
  warning "h.jsonl has $((number - 9)) entr" ends 0 history add run --file h.jsonl --commit "commit-$number"
done
[ "$(wc -l <h.jsonl)" -eq 17 ] || fail "the file has not a line per folder: $(cat h.jsonl)"
saying 'openmp .* cpu AVX3  *2500 .* commit-22 .* slower' ends 1 history show --file h.jsonl
warns '^mssim: cloth2500, openmp, semi-euler: slower since commit commit-22, 1\.0[78]'
[ "$(grep -c . err)" -eq 1 ] || fail "more than the one slowdown is told: $(cat err)"
saying 'within 10 %' ends 0 history show --file h.jsonl --threshold 10
ends 0 history show --file h.jsonl --last 4
ends 1 history show --file h.jsonl --last 5 --format json
/usr/bin/python3 - out <<'END' || fail "the JSON is not what it should be: $(cat out)"
import json, sys
levels = json.load(open(sys.argv[1]))
assert [(row["backend"], row["since"], row["commits"]) for row in levels] == [
    ("serial", "commit-10", 17), ("openmp", "commit-10", 12), ("openmp", "commit-22", 5)], levels
assert levels[2]["low"] <= levels[2]["ratio"] <= levels[2]["high"] and abs(levels[2]["ratio"] - 1.08) < 0.01, levels
END

# A commit has one entry per machine. Without --commit it is that of the program.
expect 2 'commit-26.*--replace' history add run --file h.jsonl --commit commit-26
ends 0 history add run --file h.jsonl --commit commit-26 --replace
[ "$(wc -l <h.jsonl)" -eq 17 ] || fail "--replace does not replace"
cp h.jsonl odd.jsonl
ends 0 history add run --file odd.jsonl --commit $'two\nlines'
expect 2 '--replace' history add run --file odd.jsonl --commit $'two\nlines'
ends 0 history add run/timings.csv --file own.jsonl
grep -q "\"commit\":\"$(grep -o '"commit": "[0-9a-f]*' run/provenance.json | cut -d'"' -f4)" own.jsonl || fail "the commit is not the program's"

# Another machine is another series: its times, ten times as long, change nothing.
cp h.jsonl mixed.jsonl
make_run other serial=10 openmp=1
sed -i 's/"model": "[^"]*"/"model": "Another CPU"/' other/provenance.json
ends 0 history add other --file mixed.jsonl --commit commit-26
saying '^Another CPU.*: 1 commit$' ends 1 history show --file mixed.jsonl
says '^[^ ].*: 17 commits$'
[ "$(grep -c . err)" -eq 1 ] || fail "machines are mixed: $(cat err)"

# A row that vanishes is an error, named; and so is one that is no longer verified.
head -n 12 h.jsonl >gone.jsonl
make_run run serial=1
ends 0 history add run --file gone.jsonl --commit without
warning 'cloth2500, openmp, semi-euler.*without' ends 1 history show --file gone.jsonl
says 'openmp .* without .* vanished'
make_run run serial=1 openmp=0.1
sed -i '/,openmp,/s/,true,ok,/,false,failed: step 7 is not finite,/' run/timings.csv
ends 0 history add run --file gone.jsonl --commit without --replace
warning 'cloth2500, openmp, semi-euler.*without' ends 1 history show --file gone.jsonl
ends 0 history add other --file gone.jsonl --commit later
ends 1 history show --file gone.jsonl --last 1
make_run run serial=1 openmp=0.1
ends 0 history add run --file gone.jsonl --commit back
ends 0 history show --file gone.jsonl

# The report has its levels and a chart, and the entries as data.
ends 0 report "$source_run" --no-runs --history h.jsonl --out with.html
for text in 'id="history"' 'commit-22' 'time per step by commit' '"history": \['; do
  grep -q -- "$text" with.html || fail "the report has no $text"
done
ends 0 report "$source_run" --no-runs --out plain.html
! grep -q 'id="history"' plain.html || fail "a report without a history has its section"

# A machine without any verified row has no lines, and takes no column from the others.
make_run run serial=1
sed -i 's/,true,ok,/,false,ok,/' run/timings.csv
ends 0 history add run --file unverified.jsonl --commit first
ends 0 history show --file unverified.jsonl --format csv
says '^machine,scene,backend,integrator,device,nodes,since,commits,ms,ratio,low,high,verdict$'
ends 0 history add other --file unverified.jsonl --commit first
ends 0 history show --file unverified.jsonl --format csv
says '^machine,scene,backend,integrator,device,nodes,since,commits,ms,ratio,low,high,verdict$'
saying '"scene": "cloth2500"' ends 0 history show --file unverified.jsonl --format json

# Bad files and bad usage.
cat h.jsonl h.jsonl >bad.jsonl
lines=$(wc -l <h.jsonl)
expect 2 "bad.jsonl, line $((lines + 1)): an earlier line has commit .*remove" history show --file bad.jsonl
printf '\n' >bad.jsonl
ends 0 history add run --file bad.jsonl --commit first
sed '3s/"threads":[0-9]*/"threads":"two"/' h.jsonl >bad.jsonl
expect 2 'bad.jsonl, line 3: /threads.*two.*give' history show --file bad.jsonl
expect 2 'bad.jsonl, line 3: /threads' history add run --file bad.jsonl --commit new
cut -c 1-200 h.jsonl >bad.jsonl
expect 2 'bad.jsonl, line 1: malformed JSON' report "$source_run" --no-runs --history bad.jsonl --out bad.html
[ ! -e bad.html ] || fail "a report of a damaged history is written"
true >bad.jsonl
expect 2 'bad.jsonl has no entries.*history add' history show --file bad.jsonl
expect 2 'bad.jsonl has no entries' report "$source_run" --no-runs --history bad.jsonl --out bad.html
ends 0 history add run --file bad.jsonl --commit first
expect 2 'show takes no --commit' history show --file h.jsonl --commit commit-26
expect 2 'add takes no --last' history add run --file h.jsonl --commit new --last 3
expect 2 'none.jsonl: there is no such file.*history add' history show --file none.jsonl
expect 2 'FOLDER.*bench --out' history add --file h.jsonl
expect 2 'no FOLDER.*--file' history show run --file h.jsonl
expect 2 'there is no nowhere' history add nowhere --file h.jsonl
expect 2 'remove.*add and show' history remove --file h.jsonl
sed -i 's/"commit": "[^"]*"/"commit": "unknown"/' run/provenance.json
expect 2 'git.*--commit' history add run --file h.jsonl
expect 4 'nowhere' history add other --file nowhere/h.jsonl --commit x
