#!/bin/bash
# find_package(mssim) gives a program of another project scenes, backends and their verification, wherever the library was moved.
# Arguments: the built mssim, the source folder, and what runs a program that was built.
set -euo pipefail
(($# < 3)) || { echo "skipped: needs a compiler of its own" && exit 77; }
build=$(dirname "$(dirname "$1")")
# setting NAME: its value in the cache of that build
setting() { sed -n "s/^$1:[^=]*=//p" "$build/CMakeCache.txt"; }
[[ $(setting CMAKE_BUILD_TYPE) == Release ]] || { echo "skipped: needs a library without sanitizers" && exit 77; }

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$build" --component library --prefix "$place/first" >/dev/null
mv "$place/first" "$place/second"
cmake -S "$2/tests/library/example" -B "$place/build" -G Ninja -D CMAKE_PREFIX_PATH="$place/second" \
  -D CMAKE_CXX_COMPILER="$(setting CMAKE_CXX_COMPILER)" >"$place/out" 2>&1 || { cat "$place/out" && exit 1; }
ninja -C "$place/build" >"$place/out" 2>&1 || { cat "$place/out" && exit 1; }
# Of this clone's sources it has seen nothing.
! grep -rlF "$2/" "$place/second/include" "$place/second/lib/cmake" || exit 1

for backend in serial openmp; do
  "$place/build/verify_scene" "$2/scenes/cloth2500.json" "$backend" | grep "^cloth2500 $backend "
done
code=0
"$place/build/verify_scene" "$place/none.json" 2>"$place/err" || code=$?
[[ $code == 2 ]] && grep -q 'none.json' "$place/err"
