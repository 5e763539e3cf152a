#!/bin/bash
# The data flows one way: which room of src/ may include which others, and which of their headers. Arguments: mssim (unused), the
# source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# The rule. A room is a folder with files of its own; a row names one and the rooms that it may include beside itself,
# all of which stand above it. Files in src/ itself are rooms of their own.
# src/starters is what users get to write a backend from; no room of mssim.
rule='
kernels
text
statistics
picture               text
platform              text
geometry              text platform
render                platform geometry picture
charts                text picture platform
hdf5                  platform
laws                  kernels geometry
integrators           geometry laws

garment/contact       kernels text platform geometry laws
garment               geometry garment/contact
model                 text geometry laws integrators garment
mesh                  text platform geometry model
garment/body          text geometry
garment/pattern       text geometry garment garment/body model
garment/layers        text geometry garment

scene/fields          text geometry model
garment/spec          geometry garment mesh garment/body garment/pattern
scene/spec            geometry model mesh garment/body garment/spec
garment/scene         text geometry garment/contact model mesh garment/body garment/pattern scene/fields scene/spec
scene                 text platform geometry model mesh scene/fields scene/spec

backends/interface    kernels text integrators model
backends/vectors      laws integrators backends/interface
backends/threads
backends/layouts      integrators model backends/interface backends/vectors backends/threads
backends/devices      text platform integrators backends/interface
backends/spring_list  laws integrators model backends/interface backends/threads
backends/implicit/nodes        geometry laws integrators model backends/interface backends/vectors backends/threads backends/layouts
backends/implicit/newton       text geometry laws integrators model backends/interface backends/vectors backends/threads backends/layouts backends/implicit/nodes
backends/implicit/local_global platform geometry laws integrators model backends/interface backends/vectors backends/threads backends/layouts backends/implicit/nodes
backends/implicit/constraints  geometry laws integrators model backends/interface backends/vectors backends/threads backends/layouts backends/implicit/nodes
backends/implicit     integrators backends/interface backends/implicit/nodes
backends/openmp       integrators model backends/interface backends/vectors backends/threads backends/layouts
backends/opencl       text kernels integrators model backends/interface backends/layouts backends/devices
backends/hybrid       integrators model backends/interface backends/vectors backends/threads backends/layouts backends/devices
backends/process      text platform hdf5 integrators model backends/interface
backends/described    text platform integrators scene/fields backends/process
garment/stepping      kernels geometry laws integrators garment/contact garment model garment/layers backends/interface backends/vectors backends/threads backends/layouts backends/devices
backends              text platform integrators model backends/interface backends/devices backends/spring_list backends/implicit backends/openmp backends/opencl backends/hybrid backends/process garment/stepping
backends/accumulation integrators model backends/interface backends/vectors backends/threads backends/layouts backends/spring_list backends
garment/fitting       statistics laws model garment/layers garment/stepping

ranks                 text platform integrators model scene/spec scene backends/interface backends/vectors backends/layouts backends/openmp

bench/machine         text platform
bench/results         text statistics platform integrators bench/machine
bench/roofline        platform integrators model
bench/verification    text statistics platform laws integrators model backends/interface backends
bench/windows         text platform integrators model backends/interface backends/layouts backends bench/verification
bench/job             text statistics platform integrators backends/interface backends/devices backends garment/fitting bench/results bench/roofline bench/verification bench/windows
garment/bench         text statistics integrators model backends/interface garment/stepping bench/verification bench/job
bench                 text platform statistics backends garment/stepping bench/roofline bench/verification bench/windows bench/job garment/bench
guide                 text statistics platform laws integrators model backends/interface bench/verification backends

output/tables         text statistics platform bench/machine bench/results
output/guide          text integrators backends guide output/tables
garment/output        text garment garment/stepping bench/results hdf5 output/tables
output/traces         text platform geometry model hdf5 garment/output
output/pictures       text platform geometry render picture model scene/fields garment output/traces
output/exports        text platform geometry model hdf5 output/traces
output/folders        text platform scene/fields bench/machine bench/results output/tables garment/output
report                text platform statistics integrators scene/fields charts bench/machine bench/results bench/roofline bench/verification output/tables garment/output output/folders

application           text platform integrators garment/contact model mesh garment/body scene/spec scene backends/interface backends/devices backends/process backends/described garment/stepping backends garment/fitting bench/machine bench/results bench/verification bench guide output/tables output/guide output/traces output/pictures output/folders
application/bench     text platform integrators scene/spec scene backends/interface backends backends/accumulation bench/machine bench/results bench/verification bench/windows bench/job bench output/tables garment/output output/traces output/folders application
web                   text platform integrators model scene/spec scene bench/machine bench/results bench/verification bench/job output/tables output/folders application application/bench
web/module            kernels laws integrators
commands/arguments    text
commands              text picture platform geometry integrators mesh garment/body garment/pattern scene/fields garment/spec garment/scene scene backends/devices backends/described garment/stepping backends backends/accumulation garment/fitting bench/machine bench/results bench/verification bench output/tables output/folders output/traces output/pictures output/exports report application application/bench web commands/arguments
main.cpp              platform commands
ask_opencl.cpp        backends/devices
supervise.cpp         platform
mssim_mpi.cpp         platform ranks
'

# What a room shows to the others: headers that read as its documentation. All others of these rooms are private. Rooms that are
# not here show all that they have; they are to be added when they show few.
shown='
text                  text error
statistics            statistics
charts                chart
picture               picture legend movie
render                draw
hdf5                  hdf5 hdf5_table
laws                  host_laws laws-inl
garment               garment
garment/contact       body_maps solid
garment/body          body_profile mannequin stance
garment/pattern       garment_build jeans
garment/spec          garment_spec
garment/scene         garment_scene
garment/bench         garment_bench
garment/fitting       fitting
garment/layers        cloth_contacts cloth_cloth
garment/output        garment_tables h5md_garment
garment/stepping      dressing_backend published_dressing
platform              files process supervised_process machine counters
mesh                  meshing surface_file tetgen
model                 system node_shape
scene/fields          fields
scene/spec            scene_spec
scene                 scene_file scene_kinds builders
backends              backends
backends/interface    backend
backends/vectors      step_kernels instruction_sets lanes-inl
backends/openmp       openmp bodies
backends/accumulation accumulation_methods
backends/implicit     implicit
backends/opencl       opencl
backends/hybrid       hybrid
backends/process      process_backend
backends/described    backend_description
ranks                 requests
bench/machine         provenance
bench/results         result comparison history
bench/roofline        roofline
bench/verification    verification reference_cache
bench/windows         windows
bench/job             job
bench                 bench_scene estimates
guide                 guide
output/guide          guide_tables
output/pictures       painter
output/tables         table results suite_tables
output/traces         h5md_trace trace_reader energy_curve
output/exports        exports
output/folders        result_folder provenance_file history_file
report                report
application           prepared_scene choices console outputs run guide_run
application/bench     suites bench_plan bench_results bench_run ab_comparison
web                   web
commands/arguments    arguments program_parser
commands              command
'

# offences ROOT: prints FILE:LINE: what is wrong with each include under ROOT/src and ROOT/kernels that breaks the rule or
# takes what its room does not show, and with each row of the rule that names a room which does not stand above it.
offences() {
  (cd "$1" && find src kernels -path src/starters -prune -o -type f -print | sort | xargs grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*[<"]') |
    awk -v rule="$rule" -v shown="$shown" '
      function room_of(path) {
        sub(/^src\//, "", path)
        if (path ~ /\//) sub(/\/[^\/]*$/, "", path)
        return path
      }
      BEGIN {
        rows = split(rule, row, "\n")
        for (r = 1; r <= rows; ++r) {
          words = split(row[r], word, " ")
          if (!words) continue
          for (w = 2; w <= words; ++w) {
            if (!(word[w] in known)) print "the rule: " word[1] " names " word[w] ", which does not stand above it"
            may[word[1], word[w]] = 1
          }
          known[word[1]] = may[word[1], word[1]] = 1
        }
        rows = split(shown, row, "\n")
        for (r = 1; r <= rows; ++r) {
          words = split(row[r], word, " ")
          for (w = 2; w <= words; ++w) {
            shows[word[1], word[w]] = 1
            list[word[1]] = list[word[1]] (w > 2 ? ", " : "") word[w] ".h"
          }
        }
      }
      {
        split($0, part, ":")
        place = part[1] ":" part[2]
        from = room_of(part[1])
        match($0, /include[ \t]*[<"][^>"]*/)
        header = substr($0, RSTART, RLENGTH)
        quoted = header ~ /"/
        sub(/^include[ \t]*[<"]/, "", header)
        to = room_of(header)
        if (!(from in known))
          print place ": " from " has no row in the include rule"
        else if (!(to in known) && quoted)
          print place ": \"" header "\" is neither written from src/ on nor a library header in <>"
        else if ((to in known) && !((from, to) in may))
          print place ": " from " may not include " header
        else if (to != from && (to in list)) {
          name = substr(header, length(to) + 2)
          sub(/\.h$/, "", name)
          if (!((to, name) in shows)) print place ": " header " is private to its room, which shows " list[to]
        }
      }'
}

# The check finds what it is there for.
mkdir -p src/{model,output/tables,application,gadgets,bench/machine} kernels
printf '#include <vector>\n#include "model/b.h"\n  #  include "scene/spec/scene_spec.h"\n#include <backends/backends.h>\n' \
  >src/model/a.h
printf '#include "bench/results/result.h"\n#include "bench/job/plan.h"\n#include "../bench/plan.h"\n' \
  >src/output/tables/a.cpp
printf '#include "text/text.h"\n#include <hwy/highway.h>\n' >src/bench/machine/a.cpp
printf '#include "scene/scene_file.h"\n#include "commands/command.h"\n' >src/application/a.cpp
printf '#include <vector>\n' >src/gadgets/a.h
mkdir -p src/bench/verification
printf '#include "text/text.h"\n#include "text/words.h"\n' >src/bench/verification/a.h
printf '#include "model/system.h"\n' >kernels/a.h
printf '#include "commands/command.h"\n' >src/main.cpp
expected='kernels/a.h:1: kernels may not include model/system.h
src/application/a.cpp:2: application may not include commands/command.h
src/bench/verification/a.h:2: text/words.h is private to its room, which shows text.h, error.h
src/gadgets/a.h:1: gadgets has no row in the include rule
src/model/a.h:3: model may not include scene/spec/scene_spec.h
src/model/a.h:4: model may not include backends/backends.h
src/output/tables/a.cpp:2: output/tables may not include bench/job/plan.h
src/output/tables/a.cpp:3: "../bench/plan.h" is neither written from src/ on nor a library header in <>'
diff <(printf '%s\n' "$expected") <(offences .) || fail "The check does not find the made-up offences (< expected, > found)."

found=$(offences "$source")
while read -r room headers; do
  for header in $headers; do
    [[ -e $source/src/$room/$header.h ]] || found+=$'\n'"what rooms show: there is no src/$room/$header.h"
  done
done <<<"$shown"
[[ ! $found ]] || fail "$found"$'\n'"The rule stands in tests/project/include_rule_test.sh."
