#!/bin/bash
# The list of scripts/mutants names files and texts that are there; and the script says of mutants what becomes of them: in a
# small repository, with stand-ins for the build and the tests. Arguments: mssim (unused), the source folder.
set -euo pipefail
source_folder=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
fail() { printf '%s\n' "$@" >&2 && exit 1; }

listed=$("$source_folder/scripts/mutants" --list) || fail 'the list has rotted'
(($(wc -l <<<"$listed") >= 100)) || fail "only $(wc -l <<<"$listed") mutants"
suites=$(grep -rhoP --include='*.cpp' '^(TYPED_)?TEST(_[FP])?\(\K\w+' "$source_folder/tests" | sort -u)
shell_tests=$(find "$source_folder/tests" -name '*_test.sh' -printf '%f\n')
mapfile -t filters < <(awk -F'\t' '!/^#/ { print $4 }' "$source_folder/scripts/mutants.txt" | sed '/^ctest:/!y/:/\n/' | sort -u)
for filter in "${filters[@]}"; do
  suite=${filter%%.*}
  if [[ $filter == ctest:* ]]; then
    grep -qE -- "${filter#ctest:}" <<<"${shell_tests//.sh/}" || fail "no shell test has the name $filter"
  else
    grep -qx -- "${suite//\*/.*}" <<<"$suites" || fail "no tests have the name $filter"
  fi
done

mkdir -p "$place"/{tools,scripts,src,build/mutants/source/build/release/bin}
cp -r "$source_folder/scripts/mutants" "$source_folder/scripts/lib" "$source_folder/scripts/packages.txt" "$place/scripts"
printf '{}' >"$place/CMakePresets.json"
printf 'first\nright = 1;\n' >"$place/src/a.cpp"
stand_in() { printf '#!/bin/bash\n%s\n' "$2" >"$1" && chmod +x "$1"; }
# shellcheck disable=SC2016 # the stand-ins expand it
{
  stand_in "$place/tools/dpkg-query" 'printf "installed %s\n" "${@:4}"'
  stand_in "$place/tools/cmake" true
  stand_in "$place/tools/ninja" '! grep -q broken "$2/../../src/a.cpp"'
  stand_in "$place/build/mutants/source/build/release/bin/mssim_tests" \
    'cd "${0%/*}/../../.." && [[ $1 == --gtest_list_tests ]] && exec printf "Suite.\n  Case\n"
     grep -q crash src/a.cpp && kill -SEGV $$
     ! grep -q wrong src/a.cpp'
}
export PATH="$place/tools:$PATH"

# mutants CODE MUTANT...: the script ends so with a list of these, each "text>replacement".
mutants() {
  local code=0 wanted=$1 mutant
  shift
  for mutant in "$@"; do printf 'src/a.cpp\t%s\t%s\tSuite.*\n' "${mutant%>*}" "${mutant#*>}"; done >"$place/scripts/mutants.txt"
  said=$("$place/scripts/mutants" "${arguments[@]}" 2>&1) || code=$?
  [[ $code == "$wanted" ]] || fail "exit code $code instead of $wanted:" "$said"
}
says() { [[ $said == *"$1"* ]] || fail "not said: $1" "$said"; }

arguments=()
mutants 1 'right>wrong' '= 1;>= 2;' 'first>crash' 'first>broken'
says '1 killed: src/a.cpp:2: right -> wrong'
says '2 survived: src/a.cpp:2: = 1; -> = 2;'
says '3 killed'
says '4 does not build'
says '4 mutants: 2 killed, 1 survived, 1 did not build'
diff "$place/src/a.cpp" <(printf 'first\nright = 1;\n') || fail 'it changed what is not its own'
arguments=(3 1)
mutants 0 'right>wrong' '= 1;>= 2;' 'first>crash'
says '2 mutants: 2 killed, 0 survived'
arguments=(--random 1)
mutants 0 'right>wrong' 'right>wronger'
says '1 mutants: 1 killed'
arguments=()
mutants 2 'left>wrong' && says 'src/a.cpp does not have the text "left"'
mutants 2 'r>w' && says 'more than once'
