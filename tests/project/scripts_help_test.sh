#!/bin/bash
# Each script prints its usage for --help and -h, and does nothing else: stand-ins for what it would call only note that they were
# called. Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

mkdir repository tools
cp -r "$source/scripts" repository
for program in dpkg-query apt-get sudo cmake ninja ctest git flock mkdir clang-format shellcheck h5dump; do
  # shellcheck disable=SC2016 # the stand-ins expand it
  make_program "tools/$program" <<<'echo "${0##*/} $*" >>'"$work/called"
done
export PATH="$work/tools:$PATH"

# helps SCRIPT ARGUMENT...: it prints its usage on stdout and ends with 0.
helps() {
  saying "^  scripts/$1" exits 0 "repository/scripts/$1" "${@:2}"
  [[ ! -s err ]] || fail "scripts/$*: a message on stderr: $(cat err)"
  ! grep -E '^(#|set |$)' out || fail "scripts/$*: more than its comment"
  [[ ! -e called ]] || fail "scripts/$*: called $(cat called)"
  [[ ! -e repository/build ]] || fail "scripts/$*: made a build folder"
}

scripts=0
for file in repository/scripts/*; do
  [[ -f $file && -x $file ]] || continue
  scripts=$((scripts + 1))
  helps "${file##*/}" --help
  helps "${file##*/}" -h
done
((scripts >= 9)) || fail "only $scripts scripts were tried"
helps test -R GridPatch --help
helps ci-regression origin/main --help
