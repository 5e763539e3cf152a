#!/usr/bin/env bash
# mssim export: what other programs read of it (exports.py), and what is refused. Python's modules may be missing: see readers_test.sh.
set -euo pipefail
. "$2/tests/support/command_line.sh"

make_traces
for trace in cloth double bodies garment; do
  ends 0 export "$trace.h5" --format vtkhdf --frames all
  [ "$(cat err)" = "mssim: wrote ./$trace.vtkhdf" ] || fail "export says $(cat err)"
  for format in obj ply; do ends 0 export "$trace.h5" --format "$format" --frames all; done
  ends 0 export "$trace.h5" --format vtkhdf --out "$trace-last.vtkhdf"
done
[ "$(cat err)" = "mssim: wrote garment-last.vtkhdf" ] || fail "export says $(cat err)"

# One frame of one file each, by its number, by its time, and the last unasked.
mkdir one
ends 0 export cloth.h5 --format ply --out one/last.ply
cmp -s one/last.ply cloth-000004.ply || fail "not the last frame is written"
ends 0 export cloth.h5 --format ply --frames 1 --out one/first.ply
cmp -s one/first.ply cloth-000001.ply || fail "frame 1 is not what is written"
ends 0 export cloth.h5 --format OBJ --time 0.051 --out one/time.obj
cmp -s one/time.obj cloth-000002.obj || fail "the frame nearest to 0.051 s is not frame 2"
ends 0 export cloth.h5 --format obj --frames last,0-1,0 --out one/some.obj
[ "$(cat err)" = "mssim: wrote one/some-000000.obj to some-000004.obj, 3 files" ] || fail "export says $(cat err)"
[ "$(echo one/*)" = "one/first.ply one/last.ply one/some-000000.obj one/some-000001.obj one/some-000004.obj one/time.obj" ] ||
  fail "written: $(echo one/*)"

# What does not go, in a sentence, and nothing is written.
mkdir never
expect 2 '--format WORD is missing: give .*obj.*; see mssim export --help' export cloth.h5
expect 2 'TRACE is missing' export --format ply
expect 2 'unknown value "stl": known are obj, ply and vtkhdf' export cloth.h5 --format stl
expect 2 '--time and --frames exclude each other' export cloth.h5 --format ply --frames 0 --time 0
expect 2 'there is no frame 5; the last one is 4' export cloth.h5 --format ply --frames 0,5 --out never/a.ply
expect 2 '1 s is after the last frame, at 0.1 s' export cloth.h5 --format vtkhdf --time 1 --out never/a.vtkhdf
expect 2 'no such file' export nope.h5 --format obj
expect 2 'give the trace, cloth.h5' export cloth.xdmf --format obj
expect 2 'cloth.vtkhdf: .*H5MD' export cloth.vtkhdf --format obj --out never/a.obj
expect 2 'the same file' export cloth.h5 --format vtkhdf --out ./cloth.h5
cp cloth.h5 same-000001.ply
expect 2 'the same file' export same-000001.ply --format ply --frames 0,1 --out same.ply
cp cloth.h5 fall.vtkhdf.part
expect 2 'temporary file of --out and the trace .*fall.vtkhdf.part; give them different names' \
  export fall.vtkhdf.part --format vtkhdf --out fall.vtkhdf
cmp -s cloth.h5 fall.vtkhdf.part || fail "export has replaced the trace that it reads"
expect 2 '--out is never/a.ply, .*OBJ: give never/a.obj' export cloth.h5 --format obj --out never/a.ply
expect 2 '--out is cloth.xdmf, .*VTKHDF: give cloth.vtkhdf' export cloth.h5 --format vtkhdf --out cloth.xdmf
expect 4 'cannot write no/such/a.ply' export cloth.h5 --format ply --out no/such/a.ply
expect 4 'cannot write no/such/a.vtkhdf' export cloth.h5 --format vtkhdf --out no/such/a.vtkhdf
expect 4 'never' export cloth.h5 --format vtkhdf --out never
head -c 5000 cloth.h5 >cut.h5
expect 2 'cut.h5' export cut.h5 --format ply --out never/a.ply
[ -z "$(ls never)" ] || fail "left: $(ls never)"
# Files of frames before the one that fails stay, and are told of.
mkdir part-000002.ply.part
ends 4 export cloth.h5 --format ply --frames 0-2 --out part.ply
{ grep -q 'cannot write part-000002.ply' err && grep -q 'wrote part-000000.ply to part-000001.ply, 2 files' err; } ||
  fail "export says $(cat err)"

# A file that nobody has named stays, unless it is an export: it may be the surface of the scene.
for format in obj ply; do
  printf 'v 0 0 0\n' >"cloth.$format"
  expect 2 "cloth.$format already exists, .*--out" export cloth.h5 --format $format
  [ "$(cat "cloth.$format")" = "v 0 0 0" ] || fail "export replaces cloth.$format"
  ends 0 export cloth.h5 --format $format --out "cloth.$format"
  ends 0 export cloth.h5 --format $format
done

# A disk that is full, as a limit on the size of files: what stood there before stays.
for format in obj ply vtkhdf; do
  echo before >"full.$format"
  on_full_disk 100 "cannot write full.$format: .* failed: File too large; raise the limit" \
    export cloth.h5 --format "$format" --out "full.$format" --frames last
  [ "$(cat "full.$format")" = before ] && [ ! -e "full.$format.part" ] || fail "a full disk leaves $(ls full.*)"
done

run_python "$2" commands/exports.py cloth double bodies garment
