# shellcheck shell=bash disable=SC2154 # root is prepare.sh's
# Newly installed Debian systems, in folders. Sourced after prepare.sh.

# enter_bare_roots: goes to the folder where they are made, or says why not and exits.
enter_bare_roots() {
  ((EUID == 0)) || missing "only root can create such systems"
  ensure_packages bare
  make_folder "$root/build/bare-debian"
  cd -- "$root/build/bare-debian" || exit
}

# new_bare_root RELEASE FOLDER [ARCHITECTURE]: installs Debian 12 or 13 into the folder, or says why not and exits.
new_bare_root() {
  local names=([12]=bookworm [13]=trixie)
  rm -rf -- "$2"
  say "installing Debian $1 (log: $PWD/$2.log)"
  debootstrap --variant=minbase ${3:+"--arch=$3"} "${names[$1]}" "$2" >"$2.log" 2>&1 || {
    tail -n 3 "$2.log" >&2
    missing "Debian $1 cannot be installed; this needs network access and permission to mount${3:+; for $3 on another machine, also binfmt_misc}"
  }
}

# in_bare_root ROOT FOLDER COMMAND ARGUMENT...: runs the command in that folder there, with its own mounts and processes.
in_bare_root() {
  # shellcheck disable=SC2016 # the inner shell expands it
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount --rbind /sys "$0/sys" &&
      exec chroot "$0" /usr/bin/env -i HOME=/root PATH="$PATH" sh -c "cd \"\$1\" && shift && exec \"\$@\"" sh "$@"' "$@" </dev/null
}
