#!/bin/bash
# scripts/fuzz says what is wrong with its arguments before it installs or builds anything. Arguments: mssim (unused), the
# source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"
fuzz=$source/scripts/fuzz

refuses 2 '--seconds needs a whole number above 0, not "soon"' "$fuzz" --seconds soon
refuses 2 '--runs needs a whole number above 0, not "0"' "$fuzz" --runs 0
refuses 2 '--runs needs a whole number above 0, not ""' "$fuzz" scene --runs
refuses 2 'unknown option --fast' "$fuzz" --fast
refuses 2 'there is no target cloth, that is, no file tests/fuzz/cloth_fuzz.cpp' "$fuzz" scene cloth
