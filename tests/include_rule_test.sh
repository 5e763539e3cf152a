#!/bin/bash
# The data flows one way: which folder of src/ may include which others. Arguments: mssim (unused), the source folder.
set -euo pipefail

# The rule. A row: a folder and what it may include beside itself, a folder or a single header. `mssim` are the headers
# that the build generates, `*` is anything.
rule='
kernels
model        kernels
process
mesh         model process
garment      model mesh
contact      model kernels mesh/surface.h
scene        model mesh garment contact
integrators
backends     model process integrators kernels contact
fitting      backends model contact
bench        backends model integrators fitting mssim
output       model mesh/surface.h bench/result.h bench/provenance.h bench/statistics.h bench/outliers.h bench/comparison.h
commands     *
main.cpp     *
ask_opencl.cpp
'

# offences ROOT: prints FILE:LINE: what is wrong with each include under ROOT/src and ROOT/kernels that breaks the rule.
offences() {
  (cd "$1" && find src kernels -type f | sort | xargs grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]') |
    awk -v rule="$rule" '
      BEGIN {
        rows = split(rule, row, "\n")
        for (r = 1; r <= rows; ++r) {
          words = split(row[r], word, " ")
          if (!words) continue
          known[word[1]] = 1
          for (w = 1; w <= words; ++w) may[word[1], word[w]] = 1
        }
        known["mssim"] = 1
      }
      {
        split($0, part, ":")
        file = part[1]
        place = file ":" part[2]
        from = file
        sub(/^src\//, "", from)
        sub(/\/.*/, "", from)
        match($0, /include[ \t]*[<"][^>"]*/)
        header = substr($0, RSTART, RLENGTH)
        quoted = header ~ /"/
        sub(/^include[ \t]*[<"]/, "", header)
        to = header
        sub(/\/.*/, "", to)
        if (!(from in known))
          print place ": src/" from " has no row in the include rule"
        else if (!(to in known) && quoted)
          print place ": \"" header "\" is neither written from src/ on nor a library header in <>"
        else if ((to in known) && !((from, to) in may) && !((from, header) in may) && !((from, "*") in may))
          print place ": " from " may not include " header
      }'
}

# The check finds what it is there for.
made_up=$(mktemp -d)
trap 'rm -rf "$made_up"' EXIT
mkdir -p "$made_up"/src/{model,output,commands,gadgets,bench} "$made_up/kernels"
printf '#include <vector>\n#include "model/b.h"\n  #  include "scene/scene_spec.h"\n#include <backends/backend.h>\n' \
  >"$made_up/src/model/a.h"
printf '#include "bench/result.h"\n#include "bench/plan.h"\n#include "../bench/plan.h"\n' >"$made_up/src/output/a.cpp"
printf '#include "mssim/version.h"\n#include <hwy/highway.h>\n' >"$made_up/src/bench/a.cpp"
printf '#include "scene/builder.h"\n#include "bench/plan.h"\n' >"$made_up/src/commands/a.cpp"
printf '#include <vector>\n' >"$made_up/src/gadgets/a.h"
printf '#include "model/vec3.h"\n' >"$made_up/kernels/a.h"
printf '#include "commands/bench.h"\n' >"$made_up/src/main.cpp"
expected='kernels/a.h:1: kernels may not include model/vec3.h
src/gadgets/a.h:1: src/gadgets has no row in the include rule
src/model/a.h:3: model may not include scene/scene_spec.h
src/model/a.h:4: model may not include backends/backend.h
src/output/a.cpp:2: output may not include bench/plan.h
src/output/a.cpp:3: "../bench/plan.h" is neither written from src/ on nor a library header in <>'
if ! diff <(printf '%s\n' "$expected") <(offences "$made_up"); then
  echo "The check does not find the made-up offences (< expected, > found)." >&2
  exit 1
fi

found=$(offences "$2")
if [[ $found ]]; then
  printf '%s\n' "$found" "The rule stands in tests/include_rule_test.sh." >&2
  exit 1
fi
