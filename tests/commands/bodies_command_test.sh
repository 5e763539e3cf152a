#!/usr/bin/env bash
# What a user of tetrahedral bodies meets at the command line: scenes, meshes of his own, TetGen missing, broken, of another
# make, or interrupted.
set -euo pipefail
. "$2/tests/support/command_line.sh"
export XDG_CACHE_HOME=$work/cache TMPDIR=$work/temporary
mkdir "$TMPDIR" "$work/no-programs"

# succeed_silently ARGUMENTS...: and says nothing on stderr but what it wrote
succeed_silently() {
  ends 0 "$@"
  local line
  while read -r line; do [[ $line == "mssim: wrote "* ]] || fail "mssim $* says $line"; done <"$work/err"  # in no-programs, too
}

# tetgen_that SCRIPT: a folder with a program named tetgen that is this shell script
tetgen_that() {
  local folder
  folder=$(mktemp -d "$work/programs.XXXXXX")
  make_program "$folder/tetgen" <<<"$1"
  echo "$folder"
}

# scene FILE BODY: a scene of one body
scene() {
  bodies_scene "$work/$1" 0 "{$2, \"centre_m\": [0, 0.3, 0], \"velocity_m_per_s\": [0, 0, 0], \"spin_rad_per_s\": [0, 0, 0], \"swell_per_s\": 1}"
}
surface() { scene "$1" "\"shape\": \"surface\", \"surface\": {\"file\": \"$2\", \"unit_m\": ${3:-0.1}, \"largest_tetrahedron_m3\": 0}"; }

# refuse FILE PATTERN: a scene with this surface must be refused with a sentence that names the scene, the body and the file
refuse() {
  surface refused.json "$1"
  expect 2 "refused.json: /bodies/list/0 has no mesh: .*$1.*$2" run --scene "$work/refused.json"
}

# Without TetGen and without a mesh made before.
PATH=$work/no-programs ends 0 list scenes --format csv
[ "$(wc -l <"$work/err")" -eq 1 ] || fail "list scenes does not say once that TetGen is missing"
warns 'torus-small, .* and bodies38233 .*install Debian.s package tetgen'
[ "$(grep -c '^[a-z0-9-]*,bodies,,,,' "$work/out")" -eq 15 ] || fail "not fifteen scenes without counts"
says '^cloth350k,cloth,350000,'
for arguments in 'run --scene torus-small --trace never.h5' 'bench --suite table2 --out never' \
  'bench --scene cloth2500,box-small --out never'; do
  # shellcheck disable=SC2086 # words of their own
  PATH=$work/no-programs ends 3 $arguments
  [ ! -s "$work/out" ] || fail "$arguments without TetGen writes to stdout"
  warns 'install Debian.s package tetgen'
done
[ -z "$(find "$work" -name 'never*')" ] || fail "something half-written is left without TetGen"

# Fifteen scenes with their counts, from a cache that cannot be written, by several at once, and then without TetGen.
touch "$work/no-folder"
XDG_CACHE_HOME=$work/no-folder succeed_silently list scenes --format csv
cp "$work/out" "$work/counted"
for i in 1 2 3; do "$mssim" list scenes --format csv >"$work/list$i" 2>&1 & done
wait
for i in 1 2 3; do cmp "$work/list$i" "$work/counted" || fail "lists made at once differ"; done
PATH=$work/no-programs succeed_silently list scenes --format csv
cmp "$work/out" "$work/counted" || fail "a list from the cache differs"
says '^torus-small,bodies,620,3690,11070,'
says '^bodies38233,bodies,38233,253110,759330,'
[ "$(find "$work/cache/mssim/meshes" -type f | wc -l)" -eq 9 ] || fail "not nine meshes in the cache"

# A body falls: what is lost and what is left balance, and the trace holds its tetrahedra.
succeed_silently run --scene torus-small --backend serial --duration 0.3 --losses --trace "$work/fall.h5"
value energy_imbalance | are 'x < 1e-4 && x > -1e-4' || fail "energy: $(cat "$work/out")"
value friction_loss_j | are 'x > 0' || fail "no friction: $(cat "$work/out")"
[ -s "$work/fall.xdmf" ] || fail "no .xdmf"
if command -v h5dump >/dev/null; then
  h5dump -n "$work/fall.h5" >"$work/names"
  for name in connectivity/tetrahedra connectivity/springs observables/bounce_loss/value particles/bodies/position/value; do
    grep -q "/$name\$" "$work/names" || fail "the trace has no $name"
  done
fi

# The structure of the bodies.
ends 0 bench --suite table2 --out "$work/table2"
[ "$(awk -F, '$NF == "true"' "$work/table2/table2.csv" | wc -l)" -eq 9 ] || fail "table2.csv: $(cat "$work/table2/table2.csv")"

# A surface of the user's own; other files in tests/mesh.
cat >"$work/cube.obj" <<'END'
v 0 0 0
v 0 0 1
v 0 1 0
v 0 1 1
v 1 0 0
v 1 0 1
v 1 1 0
v 1 1 1
f 1 2 4 3
f 5 7 8 6
f 1 5 6 2
f 3 4 8 7
f 1 3 7 5
f 2 6 8 4
END
surface cube-obj.json cube.obj
succeed_silently run --scene "$work/cube-obj.json" --duration 0.001 --backend serial
value elastic_j >"$work/elastic"
are 'x > 0' <"$work/elastic" || fail "no elastic energy"

# From another folder, with blanks and quotes in every name, and as the shape of another scene.
mkdir "$work/a \"folder\"" "$work/elsewhere"
mv "$work/cube.obj" "$work/a \"folder\"/the cube's.obj"
surface "a \"folder\"/the scene's.json" "the cube's.obj"
scene "a \"folder\"/borrowed.json" "\"shape\": \"scene\", \"scene\": {\"name\": \"the scene's.json\"}"
cd "$work/elsewhere"
for name in "the scene's" borrowed; do
  succeed_silently run --scene "../a \"folder\"/$name.json" --duration 0.001 --backend serial --trace "the 'trace'.h5"
  grep -q "$(cat "$work/elastic")" "$work/out" || fail "$name from another folder: $(cat "$work/out")"
done
[ -s "the 'trace'.h5" ] || fail "no trace with quotes in its name"
cd "$work"
cp "a \"folder\"/the cube's.obj" cube.obj

# Files that are none: refused, and said where. More of them in tests/mesh.
sed '$d' cube.obj >open.obj && refuse open.obj 'belongs to one triangle only'
refuse missing.obj 'there is no such file'
surface millimetres.json cube.obj 100
expect 2 'which is 100 m high, would start at -49.7' run --scene millimetres.json
surface nothing.json cube.obj 0
expect 2 '/bodies/list/0/surface/unit_m is 0' run --scene nothing.json
sed 's/"centre_m": \[0, 0.3/"centre_m": [0, -0.3/' cube-obj.json >below.json
expect 2 'below.json: /bodies/list/0/centre_m/1 is -0.3.*raise it' run --scene below.json
scene cloth.json '"shape": "scene", "scene": {"name": "cloth2500"}'
expect 2 'cloth.json: /bodies/list/0 has no mesh: .*cloth2500" has no bodies' run --scene cloth.json
mkfifo pipe.json && expect 2 'not a regular file' run --scene pipe.json

# Another TetGen makes another mesh: said on stderr and in the note, and no published time stands beside it.
other=$(tetgen_that "exec '$(command -v tetgen)' \"\${1}q\" \"\$2\"")
PATH=$other:$PATH ends 0 bench --scene bodies3858 --backend serial --integrator semi-euler --rounds 1 --out other
difference='the mesh of /bodies/list/0 has 700 nodes and [0-9]* springs where the scene states 700 and 4307'
warns "bodies3858: $difference"
grep -q ",ok,\"\?$difference" other/timings.csv || fail "another mesh is not noted: $(cat other/timings.csv)"
[ -z "$(column_of other/timings.csv paper_ms)" ] || fail "a published time stands beside another mesh"
[ ! -e other/table3.md ] || fail "another mesh stands in Table 3"
PATH=$other:$PATH ends 0 run --scene torus-small --duration 0.001
warns 'torus-small: the mesh of /bodies/list/0 has 620 nodes and .* where the scene states 620 and 3690'

# Programs that are no TetGen.
# One that cannot be started concerns only scenes that need it.
mkdir "$work/broken"
echo '#!/no/such/sh' >"$work/broken/tetgen"
chmod +x "$work/broken/tetgen"
PATH=$work/broken:$PATH ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 1 --out "$work/without"
grep -q '"tetgen": "cannot be started"' "$work/without/provenance.json" ||
  fail "$(grep tetgen "$work/without/provenance.json")"
PATH=$(tetgen_that 'echo no licence >&2; exit 7'):$PATH expect 2 \
  'torus-small.json: /bodies/list/0 has no mesh: .*ended with exit code 7 after writing "no licence"' run --scene torus-small --duration 0.001
PATH=$(tetgen_that 'echo garbage >body.1.node; echo garbage >body.1.ele'):$PATH expect 2 \
  'torus-small.json: /bodies/list/0 has no mesh: .*/tetgen cannot be used: .*"garbage"' run --scene torus-small --duration 0.001
[ "$(find "$work/cache/mssim/meshes" -type f | wc -l)" -ge 9 ] || fail "the cache has shrunk"

# Ctrl-C while TetGen runs: mssim ends by the signal, and neither TetGen nor its folder is left behind.
slow=$(tetgen_that "echo \$\$ >'$work/slow-tetgen'; sleep 60; exit 1")
for signal in INT TERM; do
  rm -f slow-tetgen
  PATH=$slow:$PATH begins run --scene torus-small
  soon 5 test -s slow-tetgen || fail "TetGen does not start"
  is_ended $((128 + $(kill -l "$signal"))) "$signal"
  soon 5 is_gone "$(cat slow-tetgen)" || fail "TetGen goes on after SIG$signal"
done
[ -z "$(ls -A "$TMPDIR")" ] || fail "temporary files are left: $(ls "$TMPDIR")"
[ -z "$(find "$work/cache/mssim/meshes" -type f ! -name '*.mesh')" ] || fail "half-written meshes are left in the cache"
