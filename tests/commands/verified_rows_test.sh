#!/usr/bin/env bash
# mssim bench --verified: a process that only samples what an earlier one has verified, and calls nothing verified that was
# not.
set -euo pipefail
. "$2/tests/support/command_line.sh"

cp "$2/scenes/cloth2500.json" "$work/mine.json"
asked=(bench --scene "$work/mine.json" --backend openmp --integrator semi-euler --threads 1)
ends 0 "${asked[@]}" --rounds 1 --out "$work/verified"
only() { column_of "$work/$1/timings.csv" "$2"; }
error=$(only verified position_error)

ends 0 "${asked[@]}" --rounds 3 --verified "$work/verified" --out "$work/sampled"
[ "$(only sampled verified)" = true ] || fail "what was verified is not"
[ "$(only sampled position_error)" = "$error" ] || fail "the position error is another"
[ "$(only sampled rounds)" = 3 ] || fail "there are not three samples"
[ "$(only sampled note)" = "verified by an earlier process" ] || fail "the row does not say who has verified it"
[ -z "$(only sampled roofline_fraction)" ] || fail "peaks are measured"
# A row that was sampled so is as good as the one it rests on.
ends 0 "${asked[@]}" --rounds 1 --verified "$work/sampled/timings.csv"

# What is not the same is refused, and nothing is written.
refuse() { # PATTERN OPTIONS...
  local pattern=$1
  shift
  expect 2 "$pattern" "${asked[@]}" --out "$work/no" --verified "$@"
  [ ! -e "$work/no" ] || fail "something was written"
}
refuse 'there is no .*missing: give a folder' "$work/missing"
asked[-1]=2
refuse 'the number of threads was 1 and is 2' "$work/verified"
asked[-1]=1
refuse '--memory was shared and is copy' "$work/verified" --memory copy
refuse 'has no row of .*, openmp, rk4' "$work/verified" --integrator rk4
refuse 'has no row of .*, serial, semi-euler' "$work/verified" --backend openmp,serial
refuse 'it has no scene cloth4900' "$work/verified" --scene cloth4900
make_scene mine.json cloth2500 's/"rows": 50/"rows": 49/'
refuse 'the hash of scene .* was' "$work/verified"
cp "$2/scenes/cloth2500.json" "$work/mine.json"
# doctored FILE SED: the folder with one of its files changed
doctored() {
  rm -rf "$work/doctored"
  cp -r "$work/verified" "$work/doctored"
  sed -i "$2" "$work/doctored/$1"
  if cmp -s "$work/doctored/$1" "$work/verified/$1"; then fail "$1 is not changed"; fi
}
doctored provenance.json 's/\("program_fnv1a_64": "\)..../\10000/'
refuse 'it was written by another program' "$work/doctored"
doctored provenance.json '/program_fnv1a_64/d'
refuse 'it was written by another program' "$work/doctored"

doctored timings.csv 's/,true,ok,,/,true,ok,its samples are not checked yet,/'
refuse 'the samples of mine, openmp, semi-euler are not checked.*--resume' "$work/doctored"

# A row that was not verified is not sampled and not verified.
for wrong in 's/,true,ok,/,false,ok,/' 's/,true,ok,/,false,failed: too far,/'; do
  doctored timings.csv "$wrong"
  rm -rf "$work/wrong"
  ends 1 "${asked[@]}" --verified "$work/doctored" --out "$work/wrong"
  [ "$(only wrong verified)" = false ] || fail "what was not verified is"
  [ -z "$(only wrong ms_per_step)" ] || fail "what was not verified is timed"
done
# One that was verified but not timed does not become a failure.
doctored timings.csv 's/,true,ok,/,true,not timed: too many ranks,/'
rm -rf "$work/untimed"
ends 0 "${asked[@]}" --verified "$work/doctored" --out "$work/untimed"
[ "$(only untimed verified)" = true ] || fail "what was verified is not"
[ -z "$(only untimed ms_per_step)" ] || fail "what was not to be timed is timed"

# A file that the scene names, or that the scene of its shape names, and that was replaced by another one, makes another scene.
# solid HEIGHT: the files of a tetrahedron that is so high
solid() {
  printf '4 3 0 0\n1 0 0 0\n2 0.1 0 0\n3 0 0 0.1\n4 0 %s 0\n' "$1" >"$work/solid.node"
  printf '1 4 0\n1 1 3 2 4\n' >"$work/solid.ele"
}
start='"centre_m": [0, 1, 0], "velocity_m_per_s": [0, 0, 0], "spin_rad_per_s": [0, 0, 0], "swell_per_s": 1'
bodies_scene "$work/by-file.json" 0 '{"shape": "tetgen", "tetgen": {"node_file": "solid.node", "ele_file": "solid.ele", "unit_m": 1}, '"$start}"
bodies_scene "$work/by-scene.json" 0 '{"shape": "scene", "scene": {"name": "./by-file.json"}, '"$start}"
for scene in by-file by-scene; do
  solid 0.1
  asked=(bench --scene "$work/$scene.json" --backend serial --integrator semi-euler)
  ends 0 "${asked[@]}" --rounds 1 --out "$work/$scene"
  solid 0.2
  refuse "the hash of the files of scene $scene was" "$work/$scene"
  expect 2 "the hash of the files of scene $scene was" "${asked[@]}" --rounds 2 --out "$work/$scene" --resume
  solid 0.1
  ends 0 "${asked[@]}" --rounds 2 --out "$work/$scene" --resume
  ends 0 "${asked[@]}" --rounds 1 --verified "$work/$scene"
done
