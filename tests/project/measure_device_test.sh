#!/bin/bash
# What scripts/measure-device packs measures from anywhere, finds drivers, and refuses where there is none. Here its programs take
# this machine's C library, and once the pack's. Arguments: the built mssim, the source folder, and what runs a program that
# was built.
set -euo pipefail
# In an emulator the loader of a pack is not the one that runs.
(($# < 3)) || { echo "skipped: needs programs that run by themselves" && exit 77; }
command -v patchelf >/dev/null || { echo "skipped: needs patchelf" && exit 77; }
grep -qs pocl /etc/OpenCL/vendors/*.icd || { echo "skipped: needs PoCL among the registered drivers" && exit 77; }

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
# Kernels compile for seconds.
POCL_CACHE_DIR=$(dirname "$(dirname "$1")")/pocl
export POCL_CACHE_DIR TMPDIR=$place/temporary
mkdir "$TMPDIR" "$place/none" "$place/elsewhere"
cd "$place/elsewhere"

fail() { echo "$1" && cat "$place/out" "$place/err" && exit 1; } >&2
# runs CODE PATTERN COMMAND ARGUMENT...: it ends with that code and says that on stderr.
runs() {
  local expected=$1 pattern=$2 code=0
  shift 2
  "$@" >"$place/out" 2>"$place/err" </dev/null || code=$?
  [[ $code == "$expected" ]] || fail "$*: exit code $code instead of $expected"
  [[ ! $pattern ]] || grep -q -- "$pattern" "$place/err" || fail "$*: stderr does not say \"$pattern\""
}
pack="$place/a pack" measure="$place/a pack/measure"
pack_it=("$2/scripts/measure-device" pack)

runs 2 'the first argument is pack' "$2/scripts/measure-device" bake
runs 2 'name the pack to write' "${pack_it[@]}"
runs 2 'has no bin/mssim' "${pack_it[@]}" "$pack" --build "$place/none"
runs 0 'MiB$' "${pack_it[@]}" "$pack" --build "$(dirname "$(dirname "$1")")"
runs 2 'exists; name another pack' "${pack_it[@]}" "$pack"

runs 0 '' "$measure" --help
grep -q '^  ./measure \[OPTIONS\]$' "$place/out" || fail 'its help shows how to call it'
runs 2 'no part "table9"' "$measure" --parts races,table9
runs 2 '^measure: --minutes takes a number' "$measure" --minutes soon
runs 2 '^measure: --minutes takes a number above 0' "$measure" --minutes 0.0
runs 2 'there is no part "";' "$measure" --parts races,,table1
runs 2 '--parts names none' "$measure" --parts ''
runs 2 'names races twice' "$measure" --parts races,table1,races
# cd prints folders that it finds with CDPATH.
(cd "$place" && CDPATH=.:/tmp runs 3 'there is no OpenCL driver here' \
  env OPENCL_VENDOR_PATH="$place/none" LD_LIBRARY_PATH= "a pack/measure" --out "$place/without")
runs 3 '^measure: there is no OpenCL driver here: .*/none registers none, .*LD_LIBRARY_PATH$' \
  env OPENCL_VENDOR_PATH="$place/none" LD_LIBRARY_PATH= "$measure"
[[ $(wc -l <"$place/err") == 1 && ! -s $place/out ]] || fail 'the refusal is one sentence'
rmdir mssim-results
runs 3 'the device does not take a step .*no OpenCL device' "$measure" --device 'no such device'
rm -r mssim-results

# The driver of a GPU that nothing registers is found by its name.
mkdir "$place/driver"
ln -s "$(dirname "$(dirname "$1")")/fake_opencl/deviceless_driver.so" "$place/driver/libnvidia-opencl.so.1"
runs 3 'the OpenCL driver "A fake driver" offers no device' \
  env OPENCL_VENDOR_PATH="$place/none" LD_LIBRARY_PATH="$place/driver" "$measure" --out "$place/fake"
grep -qF "driver: libnvidia-opencl.so.1.icd names $place/driver/libnvidia-opencl.so.1" "$place/fake/machine.txt" ||
  fail "the driver is not registered: $(cat "$place/fake/machine.txt")"

# rows PART: the scenes and backends of its verified rows
rows() { awk -F, '/,true,ok/ { print $1, $5 }' "$place/results/$1/timings.csv"; }

# A part of which only the smallest scenes fit, and one for which there is no time.
runs 1 '^measure: scaling, about .* without .*cloth16m$' \
  "$measure" --parts scaling,races --minutes 0.7 --rounds 2 --out "$place/results"
grep -q "C library is this machine's" "$place/results/machine.txt" || fail 'the C library of this machine counts'
[[ $(rows scaling) == *"cloth40k opencl"* ]] || fail 'cloth40k is measured on the device'
grep -q '^| races | 0 | [0-9]* | 1 | not measured: one round takes about' "$place/results/summary.md" || fail 'races does not fit'
(($(du -sk "$place/results" | cut -f1) < 16 * 1024)) || fail 'the results are larger than 16 MiB'

# Where the C library is too old, that of the pack takes its place; here it is not there at all. The device takes its first steps
# with it, and a plan asks TetGen, which needs it too.
echo /no/such/loader >"$pack/lib/glibc/loader-of-programs"
rm -r "$place/results"
runs 1 '' "$measure" --parts races --minutes 0.3 --out "$place/results"
grep -q "C library is the pack's" "$place/results/machine.txt" || fail 'the C library of the pack counts'
grep -q '^cloth2500 *opencl' "$place/results/log" || fail 'the device takes a step with the C library of the pack'
grep -q '^| races | 0 | .*not measured: one round takes about' "$place/results/summary.md" || fail 'races is planned'
[[ -z $(ls -A "$TMPDIR") ]] || fail "left behind: $(ls -A "$TMPDIR")"
