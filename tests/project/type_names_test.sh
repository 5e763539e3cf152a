#!/bin/bash
# No two headers define a type of one name: all are in one namespace, where that is undefined behaviour that no compiler
# reports. What own backends are written with has a namespace of its own. Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# twice FOLDER: the names of types that the headers in it define more than once.
twice() {
  find "$1" -path '*/src/starters' -prune -o -name '*.h' -print0 | xargs -0 sed -nE 's/^(template <.*> )?(struct|class|enum class|union) ([A-Za-z0-9_]+)([^;]*|.*\{.*)$/\3/p' |
    sort | uniq -d
}

# The check finds what it is there for.
printf 'struct Box {\n};\nclass Ball;\nenum class Kind { one };\n' >a.h
printf 'struct Ball {\n};\nclass Box final : public Ball {\n};\nstruct Kind { int a; };\n' >b.h
[ "$(twice . | paste -sd ' ')" = 'Box Kind' ] || fail "not found: a type of which two headers define one each"

found=$(twice "$source/src")
[ -z "$found" ] || fail "types that two headers define: $found"
