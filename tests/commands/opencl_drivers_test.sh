#!/usr/bin/env bash
# OpenCL drivers that offer nothing, end the process that asks them or in which they compile, or cannot write their cache.
set -euo pipefail
. "$2/tests/support/command_line.sh"
fakes=$(cd "${mssim%/*}/../fake_opencl" && pwd)
mkdir tmp
export TMPDIR=$work/tmp

pocl=$(grep -ls pocl /etc/OpenCL/vendors/*.icd | head -n 1 || true)
[ -n "$pocl" ] || skip "needs PoCL among the registered drivers"

# drivers NAME...: only these are registered; a fake, a missing one, or pocl
drivers() {
  rm -rf vendors
  mkdir vendors
  for name in "$@"; do
    if [ "$name" = pocl ]; then cp "$pocl" vendors/pocl.icd; else echo "$fakes/$name.so" >"vendors/$name.icd"; fi
  done
  export OCL_ICD_VENDORS=$work/vendors
}

# devices COUNT PATTERN: so many are listed, and stderr is one line that matches, or nothing
devices() {
  ends 0 list devices --format csv
  echo "list devices: $(cat err)"
  local found
  found=$(awk 'NR > 1' out | wc -l)
  [ "$found" -eq "$1" ] || fail "$found devices instead of $1"
  if [ -z "$2" ]; then
    [ ! -s err ] || fail "stderr is not empty: $(cat err)"
  else
    [ "$(wc -l <err)" -eq 1 ] || fail "stderr has not one line: $(cat err)"
    warns "^mssim: $2"
  fi
  [ -z "$(ls tmp)" ] || fail "left in TMPDIR: $(ls tmp)"
}

# No driver, or none that offers anything.
drivers
devices 0 'there is no OpenCL device here; Debian.s pocl-opencl-icd makes the processor one$'
drivers missing
missing='the OpenCL driver .*/missing.so cannot be loaded: .*/missing.so: cannot open shared object file.* (.*/missing.icd registers it)$'
devices 0 "$missing"
drivers missing pocl
devices 1 "$missing"
drivers pocl
: >vendors/empty.icd
devices 1 'the OpenCL driver .*/empty.icd names no library$'
echo "$fakes/changing_layer.so" >vendors/empty.icd
devices 1 'the OpenCL driver .*/changing_layer.so is not a driver that OpenCL.s loader can use (.*/empty.icd registers it)$'
drivers deviceless_driver
devices 0 'the OpenCL driver "A fake driver" offers no device$'
expect 3 'the OpenCL driver "A fake driver" offers no device$' run --scene cloth2500 --backend opencl
drivers deviceless_driver pocl
devices 1 'the OpenCL driver "A fake driver" offers no device$'

# One that ends whoever asks it.
drivers aborting_driver
end='the OpenCL driver .*/aborting_driver.so ended with signal 6 when queried for devices: Not enough memory to run on this device\.'
devices 0 "$end\$"
expect 3 "$end\$" run --scene cloth2500 --backend opencl --duration 0.01
ends 0 list backends --format csv
[ "$(grep -c "^\(opencl\|hybrid\),.*,false,.*$end" out)" -eq 2 ] || fail "list backends: $(cat out err)"
ends 0 bench --scene cloth2500 --integrator semi-euler --rounds 2 --threads 1 --out results
[ "$(column_of results/timings.csv verified | grep -c true)" -eq 3 ] || fail "not three rows: $(cat results/timings.csv)"
[ "$(grep -c "unavailable: $end" results/timings.csv)" -eq 2 ] || fail "not two rows without a device: $(cat results/timings.csv)"
drivers aborting_device_driver
devices 0 'the OpenCL driver .*/aborting_device_driver.so ended with signal 6 when queried for devices$'
drivers aborting_driver pocl
devices 1 "$end\$"
OCL_ICD_VENDORS=$work/vendors/aborting_driver.icd devices 0 "$end\$"
OCL_ICD_VENDORS=$fakes/aborting_driver.so devices 0 "$end\$"
ends 0 run --scene cloth2500 --backend opencl --duration 0.01
warns "^mssim: $end\$"

# Nobody asks who needs no device.
drivers aborting_driver
export FAKE_OPENCL_LOADED=$work/loaded
ends 0 list backends
[ -e loaded ] || fail "the fake driver leaves no trace"
rm loaded
ends 0 list scenes
ends 0 bench --scene cloth2500 --backend serial,openmp --integrator semi-euler --rounds 2 --out few
ends 0 run --scene cloth2500 --backend openmp --duration 0.01 --trace fall.h5
[ ! -e loaded ] || fail "drivers are asked by commands that need no device"
unset FAKE_OPENCL_LOADED

# One that ends the process in which it compiles leaves the other rows alone.
drivers pocl
export OPENCL_LAYERS=$fakes/changing_layer.so
scene=(bench --scene cloth2500 --integrator semi-euler --rounds 2 --threads 1)
died='the OpenCL driver "Portable Computing Language" ended with signal 6 when it compiled the kernels of \(opencl\|hybrid\) with semi-euler: LLVM ERROR: cannot select fma'
FAKE_OPENCL=dies ends 3 "${scene[@]}" --backend hybrid,openmp,opencl --out dying
[ "$(column_of dying/timings.csv verified | grep -c true)" -eq 1 ] || fail "openmp is not verified: $(cat dying/timings.csv)"
[ "$(tr -s '"' <dying/timings.csv | grep -c "unavailable: $died")" -eq 2 ] || fail "timings.csv does not say who died: $(cat dying/timings.csv)"
FAKE_OPENCL=dies expect 3 "^mssim: opencl: $died\$" run --scene cloth2500 --backend opencl --duration 0.01
# One that compiles for ever: mssim says what it waits for, and a signal ends both.
FAKE_OPENCL=hangs begins "${scene[@]}" --backend opencl --out hanging
soon 60 grep -q 'the OpenCL driver "Portable Computing Language" is compiling the kernels of opencl with semi-euler' err ||
  fail "nobody says that a driver is compiling: $(cat err)"
compiler=$(pgrep -P "$process" || true)
is_ended 143 TERM
[ -n "$compiler" ] && is_gone "$compiler" || fail "the process in which the driver compiles (${compiler:-none}) is left"
# Vectors are those that a device has where its driver prefers single numbers.
FAKE_OPENCL=float-8 ends 0 list devices --format csv
[ "$(column_of out float_width)" = 8 ] || fail "float_width is not 8: $(cat out)"
unset OPENCL_LAYERS

# What was verified beside a device counts for those of its backends that need none.
ends 0 "${scene[@]}" --backend serial,opencl --out both
ends 0 "${scene[@]}" --backend serial --verified both --out part

# PoCL's cache. The user's own that cannot be written is named; no other is taken in its place.
drivers pocl
cache='the OpenCL driver "Portable Computing Language" offers no device: its cache /dev/null/mine cannot be written (Not a directory); set POCL_CACHE_DIR to a folder that can be, or unset it$'
POCL_CACHE_DIR=/dev/null/mine devices 0 "$cache"
POCL_CACHE_DIR=/dev/null/mine expect 3 "$cache" run --scene cloth2500 --backend hybrid
unset POCL_CACHE_DIR XDG_CACHE_HOME
# Where PoCL would take a folder that cannot be written: mssim's own beside it, or a temporary one.
mkdir -p home/.cache xdg
echo "a file" >home/.cache/pocl
echo "a file" >xdg/pocl
HOME=$work/home devices 1 ''
[ -d home/.cache/mssim/pocl ] || fail "no cache below HOME"
HOME=/dev/null XDG_CACHE_HOME=$work/xdg devices 1 ''
[ -d xdg/mssim/pocl ] || fail "no cache below XDG_CACHE_HOME"
costs="PoCL's cache /dev/null/.cache/pocl/kcache cannot be written (Not a directory), so every run compiles its kernels again; set POCL_CACHE_DIR to a folder that can be\$"
HOME=/dev/null devices 1 "$costs"
HOME=/dev/null TMPDIR=/dev/null devices 0 'the OpenCL driver "Portable Computing Language" offers no device: its cache /dev/null/.cache/pocl/kcache cannot be written (Not a directory), and mssim cannot make a temporary folder in /dev/null (Not a directory); set TMPDIR'
exits 0 env -u HOME "$mssim" list devices --format csv
[ "$(wc -l <out)" -eq 2 ] || fail "no device without HOME: $(cat out err)"
POCL_CACHE_DIR='' HOME=$work/home2 devices 1 ''
HOME=/dev/null ends 0 run --scene cloth2500 --backend opencl --duration 0.01
warns "^mssim: $costs"
[ -z "$(ls tmp)" ] || fail "run leaves $(ls tmp)"

# A missing /dev/null is named, and not the program that needs it. clang's OpenMP ends a process that has no /dev/shm.
if [[ $(ldd "$mssim") == *libomp* ]]; then
  echo "not tried: no /dev/null (mssim has clang's OpenMP)"
elif unshare --mount --map-root-user mount -t tmpfs none /dev 2>err; then
  # shellcheck disable=SC2016 # the inner shell expands $0
  unshare --mount --map-root-user sh -c 'mount -t tmpfs none /dev && exec "$0" list devices' "$mssim" >out 2>err </dev/null || true
  warns 'opening /dev/null failed (No such file or directory)$'
else
  echo "not tried: no /dev/null ($(cat err))"
fi

# Also where a signal ends it.
has_kernels() { [ -n "$(find tmp -name '*.so')" ]; }
HOME=/dev/null begins bench --scene cloth2500 --backend opencl --integrator semi-euler --threads 1 --rounds 100000
is_ended 143 TERM 60 has_kernels
[ -z "$(ls tmp)" ] || fail "an interrupted bench leaves $(ls tmp)"
