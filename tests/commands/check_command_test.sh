#!/usr/bin/env bash
# mssim check says that a scene is right and what it would be, without running it.
set -euo pipefail
. "$2/tests/support/command_line.sh"
export XDG_CACHE_HOME=$work/cache

# A cloth: every combination, all of them stable and within a memory that bench is content with.
ends 0 check cloth2500 --format csv
[ ! -s "$work/err" ] || fail "a good scene has messages"
cp "$work/out" "$work/cloth.csv"
column() { column_of "$work/cloth.csv" "$@"; }
[ "$(column integrator | sort -u)" = "$(names_of integrators | sort)" ] || fail "not every integrator is told of"
[ "$(column backend | sort -u)" = "$(backends_for cloth | sort)" ] || fail "not every backend is told of"
[ "$(column scene kind nodes springs_unique dt_s | sort -u)" = 'cloth2500 cloth 2500 14502 5e-05' ] || fail "what the scene is"
[ "$(column tetrahedra | sort -u)" = '' ] || fail "a cloth has tetrahedra"
awk -F, 'NR > 1 && !($11 > 1e5 && $11 < 1e8 && $12 > 0 && $13 > 0)' "$work/cloth.csv" | grep . && fail "memory and times"
for integrator in semi-euler midpoint rk4; do
  grep -q ",$integrator,.*,true,openmp," "$work/cloth.csv" || fail "$integrator is not stable"
done
[ "$(grep -c ',\(implicit-euler\|newton-euler\|fast-springs\|xpbd\),,true,' "$work/cloth.csv")" -eq 8 ] || fail "implicit integrators have a limit"
# In the other formats the same.
ends 0 check cloth2500 --format json
ends 0 check cloth2500 torus-small
says '^cloth2500  *cloth  *2500  *14502  *-  *5e-05$'
says '^torus-small  *bodies  *620  *3690  *2800 '
[ "$(grep -c '^rk4  *[0-9.e-]*  *yes  *openmp ' "$work/out")" -eq 2 ] || fail "the tables of their combinations"

# Below the limit a cloth stays whole, far above it blows up, and check says so.
limit=$(awk -F, '$7 == "semi-euler" { print $8; exit }' "$work/cloth.csv")
for factor in 0.9 2; do
  make_scene "cloth-$factor.json" cloth2500 "s/\"dt_s\": 5e-5/\"dt_s\": $(awk -v l="$limit" -v f="$factor" 'BEGIN { printf "%.6e", l * f }')/"
done
ends 0 check "$work/cloth-0.9.json"
grep -q 'limit of .*semi-euler' "$work/err" && fail "a dt below the limit is above it"
ends 0 run --scene "$work/cloth-0.9.json" --duration 0.1 --backend serial
ends 0 check "$work/cloth-2.json"
warns '^mssim: cloth-2: dt_s [0-9.e-]* is above the stability limit of .*semi-euler.*: give at most [0-9.e-]*, or "auto"$'
ends 1 run --scene "$work/cloth-2.json" --duration 0.1 --backend serial

# A garment is dressed with one integrator, by every backend that can.
ends 0 check jeans1k --format csv
[ "$(column_of "$work/out" backend)" = "$(backends_for garment)" ] || fail "backends of a garment: $(cat "$work/out")"
[ "$(grep -c '^jeans1k,garment,1054,.*,semi-euler,' "$work/out")" -eq "$(backends_for garment | wc -l)" ] || fail "combinations of a garment"
# Only some of them let its layers touch each other.
ends 0 check outfit --format csv
[ "$(column_of "$work/out" backend)" = $'serial\nopenmp' ] || fail "backends of touching layers: $(cat "$work/out")"

# Its "auto" is half of its own limit, not of that of methods that cannot dress it.
make_scene jeans-auto.json jeans1k 's/"dt_s": [^,]*/"dt_s": "auto"/'
ends 0 check "$work/jeans-auto.json" --format csv
column_of out dt_s largest_stable_dt_s | awk 'NR == 1 { print $1 / $2 }' | are 'x > 0.499 && x < 0.501' ||
  fail "the automatic step of a garment: $(cat "$work/out")"

# What is wrong is said as run says it, and nothing is printed of the others.
make_scene typo.json cloth2500 's/"rows"/"rowz"/'
expect 2 'typo.json: /cloth/rowz is not a known key.*did you mean "rows"' check cloth2500 "$work/typo.json"
cp "$work/err" "$work/said"
ends 2 run --scene "$work/typo.json"
cmp "$work/err" "$work/said" || fail "run and check differ"
expect 2 'SCENE is missing' check
expect 2 'no scene is named "cloth2501"' check cloth2501
# A file without .json is not meant by its bare name.
cp "$source/scenes/cloth2500.json" "$work/cloth2501"
expect 2 '"cloth2501" is a file.*\./cloth2501' check cloth2501
ends 0 check ./cloth2501

# More than can be meshed or held is refused before it is.
make_scene fine-box.json box-small 's/"cells_\([xyz]\)": [0-9]*/"cells_\1": 1000/'
expect 2 'fine-box.json: /bodies/list/0 has no mesh: its mesh would have 6000[0-9]* points or more, .*; make it of at most 4000000' check "$work/fine-box.json"
make_scene fine-sphere.json sphere-small 's/"frequency": [0-9]*/"frequency": 900/'
expect 2 'fine-sphere.json: .* its mesh would have 8100[0-9]* points or more' run --scene "$work/fine-sphere.json"
make_scene fine-torus.json torus-small 's/"cells_around": [0-9]*/"cells_around": 900/; s/"cells_across": [0-9]*/"cells_across": 900/'
# limited KILOBYTES PATTERN ARGUMENTS...: with so much address space mssim refuses
limited() {
  local kilobytes=$1
  shift
  (failures=0 && ulimit -v "$kilobytes" && expect "$@" && [ "$failures" -eq 0 ]) || fail "in $kilobytes KiB"
}
if runs_limited; then
  limited 2000000 2 'TetGen makes its mesh of 810350 points or more, which needs at least 3.08 GB of memory, but [0-9.]* GB are available' check "$work/fine-torus.json"
  limited 250000 2 'fine-torus.json: /bodies has at least 810350 nodes and 2430694 springs and needs at least 0.27 GB of memory, but 0.[0-9]* GB are available: give fewer bodies' \
    check "$work/fine-torus.json"
fi
