#!/bin/bash
# The list of scripts/mutants names files and texts that are there; and the script says of mutants what becomes of them: in a
# small repository, with stand-ins for the build and the tests. Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

exits 0 "$source/scripts/mutants" --list
(($(wc -l <out) >= 100)) || fail "only $(wc -l <out) mutants"
suites=$(grep -rhoP --include='*.cpp' '^(TYPED_)?TEST(_[FP])?\(\K\w+' "$source/tests" | sort -u)
shell_tests=$(find "$source/tests" -name '*_test.sh' -printf '%f\n')
mapfile -t filters < <(awk -F'\t' '!/^#/ { print $4 }' "$source/scripts/mutants.txt" | sed '/^ctest:/!y/:/\n/' | sort -u)
for filter in "${filters[@]}"; do
  suite=${filter%%.*}
  if [[ $filter == ctest:* ]]; then
    grep -qE -- "${filter#ctest:}" <<<"${shell_tests//.sh/}" || fail "no shell test has the name $filter"
  else
    grep -qx -- "${suite//\*/.*}" <<<"$suites" || fail "no tests have the name $filter"
  fi
done

mkdir -p tools repository/{scripts,src,build/mutants/source/build/release/bin}
cp -r "$source"/scripts/{mutants,lib,packages.txt} repository/scripts
printf '{}' >repository/CMakePresets.json
printf 'first\nright = 1;\n' >repository/src/a.cpp
# shellcheck disable=SC2016 # the stand-ins expand it
{
  make_program tools/dpkg-query <<<'printf "installed %s\n" "${@:4}"'
  make_program tools/cmake <<<true
  make_program tools/ninja <<<'! grep -q broken "$2/../../src/a.cpp"'
}
make_program repository/build/mutants/source/build/release/bin/mssim_tests <<'END'
cd "${0%/*}/../../.." && [[ $1 == --gtest_list_tests ]] && exec printf "Suite.\n  Case\n"
grep -q crash src/a.cpp && kill -SEGV $$
! grep -q wrong src/a.cpp
END
export PATH="$work/tools:$PATH"

# mutants CODE MUTANT...: the script ends so with a list of these, each "text>replacement".
mutants() {
  local mutant
  for mutant in "${@:2}"; do printf 'src/a.cpp\t%s\t%s\tSuite.*\n' "${mutant%>*}" "${mutant#*>}"; done >repository/scripts/mutants.txt
  exits "$1" repository/scripts/mutants "${arguments[@]}"
}

arguments=()
mutants 1 'right>wrong' '= 1;>= 2;' 'first>crash' 'first>broken'
says '1 killed: src/a.cpp:2: right -> wrong'
says '2 survived: src/a.cpp:2: = 1; -> = 2;'
says '3 killed'
says '4 does not build'
says '4 mutants: 2 killed, 1 survived, 1 did not build'
diff repository/src/a.cpp <(printf 'first\nright = 1;\n') || fail 'it changed what is not its own'
arguments=(3 1)
mutants 0 'right>wrong' '= 1;>= 2;' 'first>crash'
says '2 mutants: 2 killed, 0 survived'
arguments=(--random 1)
mutants 0 'right>wrong' 'right>wronger'
says '1 mutants: 1 killed'
arguments=()
warning 'src/a.cpp does not have the text "left"' mutants 2 'left>wrong'
warning 'more than once' mutants 2 'r>w'
