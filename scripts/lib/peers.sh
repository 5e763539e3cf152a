# shellcheck shell=bash disable=SC2154 # root and exit_missing are prepare.sh's
# The peers that mssim is held against. Sourced after prepare.sh.
# shellcheck source=scripts/lib/python_packages.sh
. "$root/scripts/lib/python_packages.sh"

# compile_cpp_peer PROGRAM: compiles scripts/lib/peers/cpp-list.cpp.
compile_cpp_peer() {
  local source=$root/scripts/lib/peers/cpp-list.cpp flags=(-std=c++17 -O3 -march=native) libraries lines
  read -ra libraries <<<"$(pkg-config --cflags --libs hdf5)"
  lines=$(grep -cvE '^ *(//|$)' "$source")
  c++ "${flags[@]}" -I "$root/src/starters/cpp" -DPEER_NOTE="\"g++ $(c++ -dumpfullversion), ${flags[*]:1}; spring list; $lines lines\"" \
    "$source" "${libraries[@]}" -o "$1"
}

# ensure_peers: build/peers with the packages of scripts/peers.txt and the compiled peer, or says why not and exits.
ensure_peers() {
  ensure_python peers 'the peers, in Python'
  local log=$root/build/peers-cpp.log
  compile_cpp_peer "$root/build/peers/cpp-list" </dev/null >"$log" 2>&1 || {
    say "scripts/lib/peers/cpp-list.cpp could not be compiled; the compiler's messages are in $log"
    exit "$exit_missing"
  }
}
