#!/bin/bash
# What scripts/measure-device packs measures from anywhere, finds drivers, and refuses where there is none. Here its programs take
# this machine's C library, and once the pack's. Arguments: the built mssim, the source folder, and what runs a program that
# was built.
set -euo pipefail
. "$2/tests/support/command_line.sh"
# In an emulator the loader of a pack is not the one that runs.
(($# < 3)) || skip "needs programs that run by themselves"
command -v patchelf >/dev/null || skip "needs patchelf"
grep -qs pocl /etc/OpenCL/vendors/*.icd || skip "needs PoCL among the registered drivers"

export TMPDIR=$work/temporary
mkdir "$TMPDIR" none elsewhere
cd elsewhere

# runs CODE PATTERN COMMAND ARGUMENT...: it ends with that code and says that on stderr.
runs() { warning "$2" exits "$1" "${@:3}"; }
build=$(dirname "$(dirname "$mssim")") pack="$work/a pack" measure="$work/a pack/measure"
pack_it=("$source/scripts/measure-device" pack)

runs 2 'the first argument is pack' "$source/scripts/measure-device" bake
runs 2 'name the pack to write' "${pack_it[@]}"
runs 2 'has no bin/mssim' "${pack_it[@]}" "$pack" --build "$work/none"
runs 0 'MiB$' "${pack_it[@]}" "$pack" --build "$build"
runs 2 'exists; name another pack' "${pack_it[@]}" "$pack"

saying '^  ./measure \[OPTIONS\]$' exits 0 "$measure" --help
runs 2 'no part "table9"' "$measure" --parts races,table9
runs 2 '^measure: --minutes takes a number' "$measure" --minutes soon
runs 2 '^measure: --minutes takes a number above 0' "$measure" --minutes 0.0
runs 2 'there is no part "";' "$measure" --parts races,,table1
runs 2 '--parts names none' "$measure" --parts ''
runs 2 'names races twice' "$measure" --parts races,table1,races
# cd prints folders that it finds with CDPATH.
cd ..
CDPATH=.:/tmp runs 3 'there is no OpenCL driver here' \
  env OPENCL_VENDOR_PATH="$work/none" LD_LIBRARY_PATH= "a pack/measure" --out "$work/without"
cd elsewhere
refuses 3 '^measure: there is no OpenCL driver here: .*/none registers none, .*LD_LIBRARY_PATH$' \
  env OPENCL_VENDOR_PATH="$work/none" LD_LIBRARY_PATH= "$measure"
rmdir mssim-results
runs 3 'the device does not take a step .*no OpenCL device' "$measure" --device 'no such device'
rm -r mssim-results

# The driver of a GPU that nothing registers is found by its name.
mkdir "$work/driver"
ln -s "$build/fake_opencl/deviceless_driver.so" "$work/driver/libnvidia-opencl.so.1"
runs 3 'the OpenCL driver "A fake driver" offers no device' \
  env OPENCL_VENDOR_PATH="$work/none" LD_LIBRARY_PATH="$work/driver" "$measure" --out "$work/fake"
grep -qF "driver: libnvidia-opencl.so.1.icd names $work/driver/libnvidia-opencl.so.1" "$work/fake/machine.txt" ||
  fail "the driver is not registered: $(cat "$work/fake/machine.txt")"

# rows PART: the scenes and backends of its verified rows
rows() { awk -F, '/,true,ok/ { print $1, $5 }' "$work/results/$1/timings.csv"; }

# A part of which only the smallest scenes fit, and one for which there is no time.
runs 1 '^measure: scaling, about .* without .*cloth16m$' \
  "$measure" --parts scaling,races --minutes 0.7 --rounds 2 --out "$work/results"
grep -q "C library is this machine's" "$work/results/machine.txt" || fail 'the C library of this machine counts'
[[ $(rows scaling) == *"cloth40k opencl"* ]] || fail 'cloth40k is measured on the device'
grep -q '^| races | 0 | [0-9]* | 1 | not measured: one round takes about' "$work/results/summary.md" || fail 'races does not fit'
(($(du -sk "$work/results" | cut -f1) < 16 * 1024)) || fail 'the results are larger than 16 MiB'

# Where the C library is too old, that of the pack takes its place; here it is not there at all. The device takes its first steps
# with it, and a plan asks TetGen, which needs it too.
echo /no/such/loader >"$pack/lib/glibc/loader-of-programs"
rm -r "$work/results"
exits 1 "$measure" --parts races --minutes 0.3 --out "$work/results"
grep -q "C library is the pack's" "$work/results/machine.txt" || fail 'the C library of the pack counts'
grep -q '^cloth2500 *opencl' "$work/results/log" || fail 'the device takes a step with the C library of the pack'
grep -q '^| races | 0 | .*not measured: one round takes about' "$work/results/summary.md" || fail 'races is planned'
[[ -z $(ls -A "$TMPDIR") ]] || fail "left behind: $(ls -A "$TMPDIR")"
