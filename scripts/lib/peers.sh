# shellcheck shell=bash disable=SC2154 # root is prepare.sh's
# The peers that mssim is compared with. Sourced after prepare.sh.
# shellcheck source=scripts/lib/python_packages.sh
. "$root/scripts/lib/python_packages.sh"

compiled_peers=(cpp-list cpp-gather cpp-gather-clang halide-window)

# compile_peer NAME PROGRAM: compiles a peer. The gathers are compiled with -ffast-math, which mssim itself never uses: like Numba's peers
# with fastmath, they represent the fastest form. It reorders sums and estimates reciprocal roots. The effect on the error is small: after
# 100 steps cloth2500 was 2.036e-5 of a rest length from the reference and cloth350k 6.676e-4, and the list of springs 2.034e-5 and
# 6.669e-4. tests/commands/peers_test.sh checks mssim's tolerance, and each row's note names the flag.
compile_peer() {
  local compiler=c++ way='spring list' version source=$root/scripts/lib/peers/${1%-clang}.cpp flags=(-std=c++17 -O3 -march=native) libraries lines
  [[ $1 != *-clang ]] || compiler=clang++
  [[ $1 != cpp-gather* ]] || { way='gather from padded rows by component' && flags+=(-ffast-math -fopenmp); }
  [[ $1 != cpp-gather* || $(uname -m) != x86_64 ]] || flags+=(-mprefer-vector-width=512)
  version=$("$compiler" -dumpfullversion 2>/dev/null || "$compiler" -dumpversion)
  read -ra libraries <<<"$(pkg-config --cflags --libs hdf5)"
  [[ $1 != halide-window ]] || {
    local halide=("$root"/build/peers/lib/python3*/site-packages/halide)
    way="Halide $(sed -n 's/^halide==//p' "$root/scripts/peers.txt"), strict_float off; each spring once in a sliding window"
    libraries+=(-isystem "${halide[0]}/include" -L "${halide[0]}/lib64" -lHalide "-Wl,-rpath,${halide[0]}/lib64")
  }
  lines=$(grep -cvE '^ *(//|$)' "$source")
  "$compiler" "${flags[@]}" -I "$root/src/starters/cpp" \
    -DPEER_NOTE="\"${compiler/#c++/g++} $version, ${flags[*]:1}; $way; $lines lines\"" "$source" "${libraries[@]}" -o "$2"
}

# ensure_peers: makes build/peers with the packages of scripts/peers.txt and the compiled peers, or exits with a message.
ensure_peers() {
  ensure_python peers 'the peers, in Python'
  local log=$root/build/peers-cpp.log name
  for name in "${compiled_peers[@]}"; do
    compile_peer "$name" "$root/build/peers/$name" </dev/null >"$log" 2>&1 || {
      missing "the peer $name could not be compiled; the compiler's messages are in $log"
    }
  done
}
