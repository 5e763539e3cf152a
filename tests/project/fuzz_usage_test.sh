#!/bin/bash
# scripts/fuzz says what is wrong with its arguments before it installs or builds anything. Arguments: mssim (unused), the
# source folder.
set -euo pipefail
source_folder=$2

# expect SENTENCE ARGUMENT...: the script exits with 2 and says this.
expect() {
  local sentence=$1 said status=0
  shift
  said=$("$source_folder/scripts/fuzz" "$@" 2>&1) || status=$?
  [[ $status == 2 && $said == *"$sentence"* && $said != *$'\n'* ]] ||
    { printf 'scripts/fuzz %s: status %s, "%s"\n' "$*" "$status" "$said" >&2 && exit 1; }
}

expect '--seconds needs a whole number above 0, not "soon"' --seconds soon
expect '--runs needs a whole number above 0, not "0"' --runs 0
expect '--runs needs a whole number above 0, not ""' scene --runs
expect 'unknown option --fast' --fast
expect 'there is no target cloth, that is, no file tests/fuzz/cloth_fuzz.cpp' scene cloth
