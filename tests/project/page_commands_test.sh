#!/bin/bash
# The commands on README.md and docs/*.md run, as far as they are quick, and each is written so that it can be pasted into a fresh clone.
# Arguments: mssim, the source folder.
set -euo pipefail
commands=$2/scripts/page-commands
"$commands" --quick "$1"

# What it must notice, on pages of its own.
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
# refuses LINE WHAT: a page with that command is refused, and the message names WHAT.
refuses() {
  printf '# A page\n\n    %s\n' "$1" >"$place/page.md"
  ! "$commands" --quick "$mssim" "$place/page.md" 2>"$place/err" || { echo "accepted: $1" && exit 1; }
  grep -qF -- "$2" "$place/err" || { echo "$1: $(cat "$place/err")" && exit 1; }
}
mssim=$1
refuses 'mssim list scenes' 'mssim list scenes'
refuses 'scripts/mssim list scene' 'exit code 2'
refuses 'scripts/mssim bench --scene cloth2501' 'cloth2501'
refuses 'scripts/mssim bench --suite table1     # 4000 minutes' 'the dry run says'
refuses 'scripts/mssim bench --scene cloth2500 --dry-run     # a few minutes' 'a few minutes'
refuses 'scripts/mssim bench --suite table1 --dry-run     # half a minute' 'the dry run says'
refuses 'scripts/mssim bench --suite table1 --dry-run     # a minute and a half' 'the dry run says'
refuses 'scripts/mssim list guides' 'guides'
refuses 'scripts/mssim list compilers' 'exit code 2'

# A page without commands is an error of every mode.
printf '# A page\n' >"$place/page.md"
! "$commands" --list "$place/page.md" 2>"$place/err" || { echo "--list of no command passes" && exit 1; }
grep -q 'no command' "$place/err" || { echo "--list: $(cat "$place/err")" && exit 1; }
# So is a page that does not exist, also beside one that does.
! "$commands" --list README.md "$place/none.md" >/dev/null 2>"$place/err" || { echo "--list of no page passes" && exit 1; }
grep -qF "no page $place/none.md" "$place/err" || { echo "--list: $(cat "$place/err")" && exit 1; }
