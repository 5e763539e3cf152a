# shellcheck shell=bash disable=SC2154 # root is prepare.sh's
# The Python that tests read traces with. Sourced after prepare.sh.
# shellcheck source=scripts/lib/python_packages.sh
. "$root/scripts/lib/python_packages.sh"

# ensure_readers: build/readers with the packages of scripts/readers.txt, from PyPI, or says why not and exits.
ensure_readers() { ensure_python readers "Python's readers of traces"; }
