#!/usr/bin/env bash
# mssim new-backend: what it writes and refuses. The C++ example is compiled as is said, and is verified with every integrator.
set -euo pipefail
. "$2/tests/support/command_line.sh"
. "$2/tests/support/own_backends.sh"

# said FILE LINE...: the file holds these lines
said() {
  local file=$1
  shift
  printf '%s\n' "$@" | diff - "$file" || fail "new-backend says otherwise in $file"
}

# Python: one file that can be run, with its own name in it.
ends 0 new-backend mine --language python
said out 'mssim bench --scene cloth2500 --backend serial,openmp,./mine.py'
said err 'mssim: wrote ./mine.py'
[ -x mine.py ] || fail "mine.py is not executable"
grep -q 'serial,openmp,./mine.py' mine.py && ! grep -q my_backend mine.py || fail "mine.py has another name in it"
[ "$(wc -l <mine.py)" -le 40 ] || fail "mine.py has $(wc -l <mine.py) lines"

# C++: compiled by the command that is printed, warnings as errors.
mkdir 'a folder'
ends 0 new-backend mine --language C++ --out 'a folder'
said err 'mssim: wrote a folder/mine.cpp' 'mssim: wrote a folder/mssim_backend.h'
said out "c++ -std=c++17 -O3 'a folder/mine.cpp' \$(pkg-config --cflags --libs hdf5) -o 'a folder/mine'" \
  "mssim bench --scene cloth2500 --backend 'serial,openmp,a folder/mine'"
cmp 'a folder/mssim_backend.h' "$2/src/starters/cpp/mssim_backend.h" || fail "another header is written than is installed"
eval "$(head -n 1 out) -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror" || fail "the C++ example does not compile"
warning 'mssim bench --scene' exits 2 'a folder/mine' # run by hand
verified_everywhere 'a folder/mine' mine
ends 0 bench --scene cloth2500 --backend './a folder/mine' --integrator semi-euler --rounds 1 --threads 2 --out one-thread
[ "$(column_of one-thread/timings.csv threads)" = 1 ] || fail "mine has another number of threads: $(cat one-thread/timings.csv)"

# A second one beside it takes the header that is there.
ends 0 new-backend other --language c++ --out 'a folder'
said err 'mssim: wrote a folder/other.cpp'

# What does not go, in a sentence, and nothing is written.
before=$(find . -type f -not -name out -not -name err | sort)
expect 2 './mine.py already exists: give another name or --out$' new-backend mine --language python
expect 2 'a folder/mine.cpp already exists: ' new-backend mine --language c++ --out 'a folder'
echo '// changed' >>'a folder/mssim_backend.h'
expect 2 'a folder/mssim_backend.h is from another version .*--out' new-backend third --language c++ --out 'a folder'
expect 2 'NAME: "" is empty: give a value' new-backend --language python -- ''
for name in mine.py a/b ../b 2fast 'two words' -x.y "$(printf 'a%.0s' {1..65})"; do
  expect 2 'cannot be a backend.s name: give at most 64 letters, ' new-backend --language python -- "$name"
done
for name in openmp mpi mpi-copies; do
  expect 2 "mssim has a backend $name already (mssim list backends): give another name" new-backend $name --language c++
done
expect 2 'numpy is the name of a module that backends need' new-backend numpy --language python
# Modules of Python's library, which the example imports, or what it imports does.
for name in struct tempfile hashlib; do
  expect 2 "$name is the name of a module of python3, .*my_$name" new-backend "$name" --language python
done
expect 2 'NAME is missing' new-backend --language python
expect 2 '^mssim: --language WORD is missing: give .*python.*; see mssim new-backend --help$' new-backend mine
expect 2 'unknown value "pyhton" (did you mean python?): known are c++ and python' new-backend mine --language pyhton
expect 4 'cannot write none/mine.py: .*: No such file or directory; create its folder first' new-backend mine --language python --out none
expect 4 'cannot write mine.py/mine.py: .*: Not a directory' new-backend mine --language python --out mine.py
[ "$(find . -type f -not -name out -not -name err | sort)" = "$before" ] || fail "written: $(find . -type f)"
