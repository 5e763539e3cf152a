#!/bin/bash
# find_package(mssim) gives a program of another project scenes, backends and their verification, wherever the library was moved.
# Arguments: the built mssim, the source folder, and what runs a program that was built.
set -euo pipefail
. "$2/tests/support/command_line.sh"
(($# < 3)) || skip "needs a compiler of its own"
build=$(dirname "$(dirname "$mssim")")
# setting NAME: its value in the cache of that build
setting() { sed -n "s/^$1:[^=]*=//p" "$build/CMakeCache.txt"; }
[[ $(setting CMAKE_BUILD_TYPE) == Release ]] || skip "needs a library without sanitizers"

cmake --install "$build" --component library --prefix "$work/first" >/dev/null
mv first second
exits 0 cmake -S "$source/tests/library/example" -B build -G Ninja -D CMAKE_PREFIX_PATH="$work/second" \
  -D CMAKE_CXX_COMPILER="$(setting CMAKE_CXX_COMPILER)"
exits 0 ninja -C build
# Of this clone's sources it has seen nothing.
! grep -rlF "$source/" second/include second/lib/cmake || fail "the library names the sources"

for backend in serial openmp; do saying "^cloth2500 $backend " exits 0 build/verify_scene "$source/scenes/cloth2500.json" "$backend"; done
warning 'none.json' exits 2 build/verify_scene none.json
