#!/usr/bin/env bash
# Names that are no UTF-8, hold control characters, commas or what readers of a trace misread: taken and written as escapes,
# or refused before anything begins.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# one_scene FILE NAME: a bench of it makes files of valid UTF-8 in which it is called NAME, here and in its trace
one_scene() {
  rm -rf "$work/results"
  ends 0 bench --scene "$1" --backend serial --integrator semi-euler --rounds 1 --threads 1 --out "$work/results"
  [ "$(column_of "$work/results/timings.csv" scene | head -n 1)" = "$2" ] || fail "$2 is called otherwise: $(cat "$work/results/timings.csv")"
  local file
  for file in "$work"/results/*; do iconv -f UTF-8 -t UTF-8 "$file" >/dev/null || fail "$file is no UTF-8"; done
  ends 0 run --scene "$1" --duration 0.001 --trace "$work/t.h5" --energy-curve "$work/e.csv"
  iconv -f UTF-8 -t UTF-8 "$work/e.csv" >/dev/null || fail "the energy curve is no UTF-8"
  [[ $(h5dump -d /parameters/provenance "$work/t.h5") == *"${2//\\/\\\\}"* ]] || fail "the trace does not name $2"
  ends 0 check "$1" --format json
}

cp "$source/scenes/cloth2500.json" "$work/caf"$'\xe9'".json"
one_scene "$work/caf"$'\xe9'".json" 'caf\xe9'
cp "$source/scenes/cloth2500.json" "$work/two"$'\n'"lines.json"
one_scene "$work/two"$'\n'"lines.json" 'two\x0alines'
expect 2 'names traces after their scene, and "caf.xe9.h5" has a .\\., which readers' \
  bench --scene "$work/caf"$'\xe9'".json" --trace --out "$work/never"

# Words that are no UTF-8 anywhere else.
ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 1 --format json --out "$work/f"$'\xfe'
[ -s "$work/f"$'\xfe'/provenance.json ] || fail "there is no provenance in a folder of that name"
expect 3 'there are' list backends --format json --device $'\xff'
OMP_DISPLAY_AFFINITY=$'\xff' ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 1 --out "$work/g"
expect 2 'no scene is named' run --scene $'\xff\x1b'
expect 2 'unknown backend' run --scene cloth2500 --backend $'\xff\x1b'
expect 2 'unknown command' $'\xff\x1b'
expect 4 'no/f' bench --scene cloth2500 --backend serial --out "$work/two"$'\n'"lines.json/no/f"
grep -q $'\x1b' "$work/err" && fail "a terminal would take what is said for a command"

# Names that would make one file of two rows, or that no file can have.
# shellcheck disable=SC2016 # the program expands it
make_program z <<<'echo "${0##*/}"; exit 3'
cp "$work/z" "$work/y-z"
long=$(printf 'n%.0s' $(seq 240))
for scene in x x-y "$long"; do cp "$source/scenes/cloth2500.json" "$work/$scene.json"; done
ends 1 bench --scene ./x.json,./x-y.json,"./$long.json" --backend serial,./z,./y-z --integrator semi-euler --rounds 1 --trace --out colliding
[ "$(wc -l <"$work/colliding/timings.csv")" -eq 10 ] || fail "rows are missing: $(cat "$work/colliding/timings.csv")"
[ "$(cat "$work"/colliding/programs/x-*.txt | sort)" = $'y-z\ny-z\nz\nz' ] || fail "outputs: $(tail -n 9 "$work"/colliding/programs/*)"
[ -s "$work/colliding/programs/x-y-z-semi-euler.txt" ] && [ -s "$work/colliding/traces/x-serial-semi-euler.h5" ] ||
  fail "usual names: $(ls "$work"/colliding/*)"
[ "$(find "$work/colliding" -name 'nnn*.txt' | wc -l)" -eq 2 ] && [ "$(find "$work/colliding/traces" -name 'nnn*.h5' | wc -l)" -eq 1 ] ||
  fail "long names: $(ls "$work"/colliding/*)"
rm -r "$work/colliding"

# The traces of a bench have names that readers of an XDMF file take, and the precision of their backend.
ends 0 bench --scene cloth2500 --backend serial,serial:double --integrator semi-euler --rounds 1 --trace --out precise
ends 0 export precise/traces/cloth2500-serial_double-semi-euler.h5 --format ply --out double.ply
ends 0 export precise/traces/cloth2500-serial-semi-euler.h5 --format ply --out single.ply
grep -qa 'property double x' double.ply && grep -qa 'property float x' single.ply || fail "traces have another precision than their backends"
grep -q 'cloth2500-serial_double-semi-euler.h5:/' precise/traces/cloth2500-serial_double-semi-euler.xdmf || fail "the XDMF has another name"
ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 1 --overwrite --out precise
[ ! -e precise/traces ] || fail "traces of earlier rows are left: $(ls precise/traces)"

# Commas.
cp "$source/scenes/cloth2500.json" "$work/a,b.json"
ends 0 bench --scene "$work/a,b.json,cloth4900" --dry-run
[ "$(grep -c '^a,b \|^cloth4900 ' "$work/out")" -eq 2 ] || fail "a comma in a path: $(cat "$work/out")"

# Names of traces.
mkdir "$work/fol:der"
ends 0 run --scene cloth2500 --duration 0.001 --trace "$work/fol:der/the 'trace' & more.h5"
expect 2 '^mssim: --trace: "t.txt" is not a name of the form NAME.h5: give t.h5$' run --scene cloth2500 --trace t.txt
cp "$source/scenes/cloth2500.json" a:b.json
expect 2 'names traces after their scene, and "a:b.h5" has a' bench --scene a:b.json --trace --out never
[ ! -e never ] && [ -z "$(find . -name '*.txt' -o -name 'a:b.h5*' -o -name '*.part')" ] || fail "something was written: $(ls)"
