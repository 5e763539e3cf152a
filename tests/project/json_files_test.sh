#!/bin/bash
# All JSON that mssim writes, or reads from users, is valid by its schema in docs/schemas, and damaged JSON is not. schema_test.sh does
# so for scene files, and web_test.sh for what the page of mssim web saves. The committed schemas, and the columns in docs/bench.md, are
# those of this program's tables. Arguments: mssim, the source folder.
set -euo pipefail
# shellcheck source=tests/support/command_line.sh
. "$2/tests/support/command_line.sh"

# valid SCHEMA ARGUMENTS...: the arguments of check_json.py; the schema without docs/schemas/ and .schema.json. What is valid by a
# definition is valid by the whole schema, which is all that an editor is pointed at.
valid() {
  local name=${1%%#*}
  [[ $1 == "$name" ]] || /usr/bin/python3 -W ignore -c 'import json, jsonschema, sys
jsonschema.validate(*(json.load(open(file)) for file in sys.argv[1:]))' "$2" "$source/docs/schemas/$name.schema.json" >whole 2>&1 ||
    fail "$1 by the whole schema: $(grep -m 1 Error whole)"
  /usr/bin/python3 -W ignore "$source/tests/support/check_json.py" "$source/docs/schemas/$name.schema.json${1#"$name"}" "${@:2}" || fail "$*"
}

"$source/scripts/write-schemas" --check "$mssim" || fail "a committed schema, or docs/bench.md, differs"

for file in "$source"/docs/schemas/*; do
  grep -q "(schemas/${file##*/})" "$source/docs/reading-results.md" || fail "docs/reading-results.md does not name $file"
done

# Two folders, and what is made of them.
bench=(bench --scene cloth2500 --backend "serial,openmp" --integrator semi-euler --threads 1 --rounds 6)
ends 0 "${bench[@]}" --format json --out base
valid bench out --wrong 0/nodes=-1
valid provenance base/provenance.json --maps environment,backend_programs,scenes_fnv1a_64,scene_files_fnv1a_64 \
  --wrong format_version=2 --wrong 'started_utc="today"' --wrong cpu/logical_cpus=-1 --wrong 'scenes_fnv1a_64/cloth2500="x"'
valid benchmark base/benchmark.json --wrong 'benchmarks/0/run_type="warm-up"' --wrong 'benchmarks/0/time_unit="ms"'
ends 0 "${bench[@]}" --format github --verified base --out next
valid github out --wrong '0/unit="s"'
cmp out next/github.json || fail "another github.json is printed"

sed -i '/openmp/s/,ok,/,failed: ended,/' next/timings.csv # a lost row is not like others
ends 1 compare base next --format json --out compared
valid comparison out --wrong 'rows/0/verdict="better"' --wrong threshold=0
cmp out compared/comparison.json || fail "another comparison is printed"
grep -q '"lost"' out || fail "no row is lost: $(cat out)"

for commit in first second; do ends 0 history add base --commit "$commit" --file times; done
valid history times --lines --optional ms_per_step,ms_per_step_low,ms_per_step_high --wrong 'rows/0/verified="maybe"'
ends 0 history show --file times --format json
valid listings#history-show out

rm next/provenance.json
ends 0 report base "$source/results/guide/zen4" next --history times --no-runs --out page.html
data_of page.html >page.json
valid report page.json --optional guide,history,ms_per_step,ms_per_step_low,ms_per_step_high \
  --maps environment,backend_programs,scenes_fnv1a_64,scene_files_fnv1a_64 --wrong 'folders/0/claims/0/outcome="maybe"' --wrong 'folders/0/timings/0/state_hash="x"'

valid ../../results/published/claims "$source/results/published/claims.json" \
  --optional needs,test,integrators,slow_integrator,gains_more_than,device,of --wrong 'claims/0/test/device="phone"'

# Listings.
for subject in scenes suites backends methods integrators devices claims columns; do
  ends 0 list "$subject" --format json
  valid "listings#list-$subject" out
done
ends 0 check cloth2500 box-small --format json
valid listings#check out
"$mssim" doctor --format json >out 2>err || true # what is missing here is valid, too
valid listings#doctor out --wrong '0/state="good"'
ends 0 measure jeans4k --format json
valid listings#measure out
ends 0 bench --suite table2 --format json
valid listings#bench-structure out
ends 0 "${bench[@]}" --dry-run --format json
valid listings#bench-plan out

# Descriptions of backends.
optional=\$schema,description,scenes,integrators,environment,time_limit_s,install,processes,states
for description in "$source"/src/ranks/*.json "$source"/scripts/lib/peers/*.json; do
  valid backend "$description" --maps environment --optional "$optional"
done
# shellcheck disable=SC2016 # a key
echo '{"$schema": "backend.schema.json", "command": ["./mine"], "description": "mine", "scenes": ["cloth"], "integrators": ["rk4"],
  "environment": {"A": "b"}, "time_limit_s": 9, "install": "make it", "processes": "ranks", "states": "windows"}' >mine.json
valid backend mine.json --maps environment --optional "$optional" --wrong time_limit_s=0 --wrong 'command=[]' --wrong 'processes="two"'
