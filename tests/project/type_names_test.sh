#!/bin/bash
# No two headers define a type of one name: all are in one namespace, where that is undefined behaviour that no compiler
# reports. What own backends are written with has a namespace of its own. Arguments: mssim (unused), the source folder.
set -euo pipefail

# twice FOLDER: the names of types that the headers in it define more than once.
twice() {
  find "$1" -path '*/src/starters' -prune -o -name '*.h' -print0 | xargs -0 sed -nE 's/^(template <.*> )?(struct|class|enum class|union) ([A-Za-z0-9_]+)([^;]*|.*\{.*)$/\3/p' |
    sort | uniq -d
}

# The check finds what it is there for.
made_up=$(mktemp -d)
trap 'rm -rf "$made_up"' EXIT
printf 'struct Box {\n};\nclass Ball;\nenum class Kind { one };\n' >"$made_up/a.h"
printf 'struct Ball {\n};\nclass Box final : public Ball {\n};\nstruct Kind { int a; };\n' >"$made_up/b.h"
[ "$(twice "$made_up" | paste -sd ' ')" = 'Box Kind' ] || { echo "not found: a type of which two headers define one each" && exit 1; }

found=$(twice "$2/src")
[ -z "$found" ] || { echo "types that two headers define: $found" && exit 1; }
