#!/usr/bin/env bash
# What shells complete and the manual page explains is what --help and the listings have. bash is run, and fish and zsh are if they are
# installed.
set -euo pipefail
. "$2/tests/support/command_line.sh"
completions=$2/src/completion
export XDG_CONFIG_HOME=$work/config
mkdir -p "$work/config/mssim/backends" "$work/pages" "$work/here/few" "$work/here/fewer-folders" "$work/here/two words"
echo '{"command": ["true"], "description": "my own"}' >"$work/config/mssim/backends/mine.json"
echo '{' >"$work/config/mssim/backends/broken.json" # costs the others nothing
cd "$work/here"
touch few.json fewer.json

# completed WORDS...: what bash has for the last of them, as it divides a command line into words, sorted
completed() {
  # shellcheck disable=SC2016 # the inner shell expands them
  bash -c '. "$0" && COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) && _mssim "$1" && printf "%s\n" "${COMPREPLY[@]}"' \
    "$completions/mssim.bash" "$mssim" "$@" | sort
}
# completes WANTED WORDS...: these lines are completed
completes() {
  local found
  found=$(completed "${@:2}")
  [ "$found" = "$(sort <<<"$1")" ] || fail "$(printf '%q ' "${@:2}"): $(paste -sd ' ' <<<"$found") instead of $(sort <<<"$1" | paste -sd ' ')"
}
# options_of PAGE: the long options on a help page
options_of() { sed -nE 's/^  (-[a-zA-Z],)?(--[a-z-]+).*/\2/p' "$1"; }

# Every command, and every option of each.
"$mssim" --help >../pages/mssim
commands=$(sed -nE 's/^  ([a-z-]+)  +[A-Z].*/\1/p' ../pages/mssim | grep -v '^-')
grep -qx doctor <<<"$commands" || fail "no command doctor: $commands"
completes "$commands" ""
completes "$(options_of ../pages/mssim)" --
completes "$commands" help ""
for command in $commands; do
  "$mssim" "$command" --help >"../pages/$command"
  options=$(options_of "../pages/$command")
  grep -qx -e --help <<<"$options" || fail "no option --help of $command"
  completes "$options" "$command" --
done

# The names of the tables.
scenes=$(names_of scenes)
cloths=$(grep ^cloth2 <<<"$scenes")
completes "$cloths" run --scene cloth2
completes "$cloths" bench --suite table1 --scene cloth2
completes "${cloths//cloth/bodies3858,cloth}" bench --scene bodies3858,cloth2
completes "$cloths" check cloth2
completes "$(names_of integrators | sed 's/^/rk4,/')" guide --integrator rk4,
names_of backends | grep -qx mine || fail "a described backend is not listed"
completes "$(names_of backends | grep ^o | sed 's/^/serial,/')" bench --backend serial,o
completes mine run --backend min
completes "$({ names_of suites && echo tables; } | grep ^t)" bench --suite t
completes "$({ names_of suites && echo tables; })" bench --suite ""
completes "$(printf '%s\n' csv json table)" list scenes --format ""
completes "$(printf '%s\n' backend-schema backends)" list back

# Files and folders where a value is one, also after a comma. bash takes = and : for words.
completes "$(printf '%s\n' few few.json fewer.json fewer-folders)" run --trace few
completes "$(printf '%s\n' few fewer-folders)" bench --out few
completes "$(printf '%s\n' few few.json fewer.json fewer-folders)" report few few
completes "$(printf '%s\n' few few.json fewer.json fewer-folders)" history add few
completes "$(printf 'cloth2500,%s\n' few few.json fewer.json fewer-folders)" bench --scene cloth2500,few
# Words are as they were typed, with quotes.
completes "$(printf 'few.json,%s\n' few few.json fewer.json fewer-folders)" bench --scene 'few.json\,few'
completes "$cloths" run --scene '"cloth2'
completes "two words" report 'two\ w'
completes "two words" bench --out = '"two w'
completes "$cloths" run --scene = cloth2
completes "$(echo "$scenes" && ls)" run --scene =
completes "" bench --backend openmp : x
completes "" bench --no-such-option=x
completes "" benhc ""
mssim=$work/none completes "" ""

# fish and zsh. (zsh completes only at a terminal; stand-ins for its own functions print what they are given.)
if command -v fish >/dev/null; then
  PATH="${mssim%/*}:$PATH" fish --no-config -c "source $completions/mssim.fish; complete -C 'mssim bench --scene bodies3858,cloth2'" | sort >../found
  sort <<<"${cloths//cloth/bodies3858,cloth}" | cmp - ../found || fail "fish: $(cat ../found)"
  PATH="${mssim%/*}:$PATH" fish --no-config -c "source $completions/mssim.fish; complete -C 'mssim report two\\\\ w'" >../found
  grep -q "^two words" ../found || fail "fish: $(cat ../found)"
  mkdir '../h.me (+x' && touch '../h.me (+x/fewest.json' # a name that is no regular expression
  for word in \~/few cloth2500,\~/few; do
    HOME="$work/h.me (+x" PATH="${mssim%/*}:$PATH" fish --no-config -c "source $completions/mssim.fish; complete -C 'mssim bench --scene $word'" >../found
    [ "$(cut -f 1 ../found)" = "${word}est.json" ] || fail "fish in the home folder: $(cat ../found)"
  done
else
  echo "not tried: fish (not installed)"
fi
if command -v zsh >/dev/null; then
  # shellcheck disable=SC2016 # zsh expands them
  zsh -fc 'compset() { : }; _files() { print files }; _describe() { print -l -- "${found[@]%%:*}" }
    file=$1; shift; complete() { words=("$@") CURRENT=$#; source $file }; complete "$@"' \
    zsh "$completions/_mssim" "$mssim" bench --scene bodies3858,cloth2 | sort >../found
  printf '%s\n' "${cloths//cloth/bodies3858,cloth}" files | sort | cmp - ../found || fail "zsh: $(cat ../found)"
else
  echo "not tried: zsh (not installed)"
fi

# The manual page: each command in a part of its own, with each of its options; and it can be set.
ends 0 help --manual
cd ..
cp out mssim.1
for command in $commands; do
  awk -v head=".SS mssim ${command/-/\\\\-}" '$0 == head { on = 1; next } /^\.S/ { on = 0 } on' mssim.1 >part
  options_of "pages/$command" | while read -r option; do
    grep -qF -e "\\fB${option//-/\\-}\\fR" -e "${option//-/\\-}\\fR" part || echo "$command $option"
  done
done >lost
[ ! -s lost ] || fail "not on the manual page: $(cat lost)"
grep -q '^\.SH EXIT CODES' mssim.1 || fail "no exit codes on the manual page"
expect 2 'exclude' help bench --manual
if command -v groff >/dev/null; then
  groff -man -ww -Tascii mssim.1 2>err >text || fail "groff exits with $?"
  [ ! -s err ] || fail "groff: $(cat err)"
else
  echo "not tried: groff (not installed)"
fi
