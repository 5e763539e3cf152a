# shellcheck shell=bash disable=SC2154 # root is prepare.sh's
# The shared libraries of programs, for packs that take them along. Sourced after prepare.sh.

# Parts of the C library, which only fit each other and its loader.
# shellcheck disable=SC2034 # read by those who source this
readonly c_libraries=(libc.so.6 libm.so.6 libmvec.so.1 libpthread.so.0 libdl.so.2 librt.so.1 libutil.so.1 libanl.so.1 libresolv.so.2)

# The system that the programs are for: this one, or the folder of arm64_root.sh.
target_root=''

# libraries_of PROGRAM...: name and file of each shared library that they load, also indirectly, but for the C library and the loader.
libraries_of() {
  local program
  for program in "$@"; do
    if [[ $target_root ]]; then
      "$root/scripts/lib/run_arm64" "$target_root/lib/ld-linux-aarch64.so.1" --list "$program" # as ldd does
    else
      ldd "$program"
    fi
  done | awk -v parts=" ${c_libraries[*]} " -v folder="$target_root" \
    '$2 == "=>" && $1 !~ "/" && !index(parts, " " $1 " ") { print $1, folder $3 }' | sort -u
}

# copy_libraries FOLDER PROGRAM...: copies them into the folder, or names one that is missing and exits.
copy_libraries() {
  local folder=$1 name file
  shift
  while read -r name file; do
    [[ -e $file ]] || missing "the library $name, which mssim needs, is not found here"
    cp -L -- "$file" "$folder/$name"
  done < <(libraries_of "$@")
}

# owners_of FILE...: the Debian packages that these files belong to; fails, and names it, if one belongs to none.
owners_of() {
  local file found owner
  local -a files=() paths=()
  for file in "$@"; do
    file=$(readlink -f -- "$file")
    file=${file#"$target_root"}
    files+=("${file#/usr}")
    # A package may list a file under a folder that is a link into /usr today.
    paths+=("${file#/usr}" "/usr${file#/usr}")
  done
  found=$(dpkg-query -S "${paths[@]}" 2>/dev/null) || true
  for file in "${files[@]}"; do
    owner=$(awk -v file="$file" '{ path = $NF; sub(/^\/usr/, "", path); if (path == file) { sub(/[:,].*/, ""); print; exit } }' <<<"$found")
    [[ $owner ]] || { say "$file belongs to no Debian package" && return 1; }
    printf '%s\n' "$owner"
  done | sort -u
}
