# shellcheck shell=bash
# Completion of mssim in bash, which mssim itself makes (mssim --complete).

_mssim() {
  local word kind before name cut
  local -a words=() lines=()
  # Bash also divides words at = and :, mssim does not.
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    if ((${#words[@]})) && [[ $word == [=:] || ${words[-1]} == *[=:] ]]; then words[-1]+=$word; else words+=("$word"); fi
  done
  # Only what bash takes for the last word is replaced.
  cut=${words[-1]%"${COMP_WORDS[COMP_CWORD]}"}
  [[ ${COMP_WORDS[COMP_CWORD]} != [=:] ]] || cut=${words[-1]}
  # Words are as they were typed; bash quotes what it gets again.
  words=("${words[@]//\\\'/$'\1'}")
  words=("${words[@]//[\"\'\\]/}")
  words=("${words[@]//$'\1'/\'}")
  mapfile -t lines < <("${1/#\~\//$HOME/}" --complete "${words[@]}" 2>/dev/null)
  IFS=$'\t' read -r kind before <<<"${lines[0]-}"
  COMPREPLY=("${lines[@]:1}")
  COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
  if [[ $kind == file || $kind == directory ]]; then
    name=${words[-1]#"$before"}
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -A "$kind" -P "$before" -- "${name//\'/\\\'}")
    compopt -o filenames 2>/dev/null
  fi
  COMPREPLY=("${COMPREPLY[@]#"${cut//\\/}"}")
}
complete -F _mssim mssim
