#!/bin/bash
# The commands on README.md and docs/*.md run, as far as they are quick, and each is written so that it can be pasted into a fresh clone.
# Arguments: mssim, the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"
commands=$source/scripts/page-commands
"$commands" --quick "$mssim"

# What it must notice, on pages of its own.
# wrong COMMAND WHAT: a page with that command is refused, and the message names WHAT.
wrong() {
  printf '# A page\n\n    %s\n' "$1" >page.md
  warning "$2" exits 1 "$commands" --quick "$mssim" "$work/page.md"
}
wrong 'mssim list scenes' 'mssim list scenes'
wrong 'scripts/mssim list scene' 'exit code 2'
wrong 'scripts/mssim bench --scene cloth2501' 'cloth2501'
wrong 'scripts/mssim bench --suite table1     # 4000 minutes' 'the dry run says'
wrong 'scripts/mssim bench --scene cloth2500 --dry-run     # a few minutes' 'a few minutes'
wrong 'scripts/mssim bench --suite table1 --dry-run     # half a minute' 'the dry run says'
wrong 'scripts/mssim bench --suite table1 --dry-run     # a minute and a half' 'the dry run says'
wrong 'scripts/mssim list guides' 'guides'
wrong 'scripts/mssim list compilers' 'exit code 2'

# A page without commands is an error of every mode.
printf '# A page\n' >page.md
warning 'no command' exits 1 "$commands" --list "$work/page.md"
# So is a page that does not exist, also beside one that does.
warning "no page $work/none.md" exits 1 "$commands" --list README.md "$work/none.md"
