#!/bin/bash
# Each script prints its usage for --help and -h, and does nothing else: stand-ins for what it would call only note that they were
# called. Arguments: mssim (unused), the source folder.
set -euo pipefail

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/repository" "$place/tools"
cp -r "$2/scripts" "$place/repository"
for program in dpkg-query apt-get sudo cmake ninja ctest git flock mkdir clang-format shellcheck h5dump; do
  # shellcheck disable=SC2016 # the stand-ins expand it
  printf '#!/bin/sh\necho "${0##*/} $*" >>"%s/called"\n' "$place" >"$place/tools/$program"
done
chmod +x "$place"/tools/*
export PATH="$place/tools:$PATH"

fail() { echo "$1" && cat "$place/out" "$place/err" && exit 1; } >&2
# helps SCRIPT ARGUMENT...: it prints its usage on stdout and ends with 0.
helps() {
  local script=$1 status=0
  shift
  "$place/repository/scripts/$script" "$@" >"$place/out" 2>"$place/err" </dev/null || status=$?
  [[ $status == 0 ]] || fail "scripts/$script $*: exit code $status"
  [[ ! -s $place/err ]] || fail "scripts/$script $*: a message on stderr"
  grep -q "^  scripts/$script" "$place/out" || fail "scripts/$script $*: no usage"
  ! grep -qE '^(#|set |$)' "$place/out" || fail "scripts/$script $*: more than its comment"
  [[ ! -e $place/called ]] || fail "scripts/$script $*: called $(cat "$place/called")"
  [[ ! -e $place/repository/build ]] || fail "scripts/$script $*: made a build folder"
}

scripts=0
for file in "$place"/repository/scripts/*; do
  [[ -f $file && -x $file ]] || continue
  scripts=$((scripts + 1))
  helps "${file##*/}" --help
  helps "${file##*/}" -h
done
((scripts >= 9)) || fail "only $scripts scripts were tried"
helps test -R GridPatch --help
helps ci-regression origin/main --help
