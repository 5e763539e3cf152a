#!/usr/bin/env bash
# Backends in Python: the example of mssim new-backend is verified with every integrator, and the module does what it says
# (python_backend.py). The modules that they need may be missing: see readers_test.sh.
set -euo pipefail
. "$2/tests/support/command_line.sh"
. "$2/tests/support/own_backends.sh"
# The examples ask the environment for python3.
export PATH=$2/build/readers/bin:$PATH PYTHONDONTWRITEBYTECODE=1
python3 -c 'import numpy, h5py' 2>err || skip "$(tail -n 1 err)"

ends 0 new-backend mine --language python
verified_everywhere ./mine.py mine.py

# The steps and the floor of the module against formulas written out, with what mssim sends; see there.
cp "$2/tests/commands/python_backend.py" checked.py
verified_everywhere ./checked.py checked.py
column_of results/timings.csv note | grep -q 'checked rk4$' || fail "what prepare says is not in the row: $(cat results/timings.csv)"

# fails_with PATTERN TEXT: a program of this text has a row that is not verified, which says PATTERN
fails_with() {
  local pattern=$1 status=0
  printf '#!/usr/bin/env python3\nimport mssim_backend\n%s\nmssim_backend.serve(prepare)\n' "$2" >faulty.py
  chmod +x faulty.py
  "$mssim" bench --scene cloth2500 --backend ./faulty.py --integrator semi-euler --rounds 1 --format csv >out 2>err || status=$?
  echo "$status: $(tail -n 1 out)"
  says "$pattern"
}
fails_with '"": line 4: ZeroDivisionError: division by zero' 'def prepare(system, method):
    return 1 / 0'
fails_with '"": line 4: ValueError: no good' 'def prepare(system, method):
    def step(x, v, count): raise ValueError("no\n good")
    return step'
fails_with 'did not return the new x and v' 'def prepare(system, method): return lambda x, v, count: x'
fails_with 'the state is an array \[2\] instead of \[2500, 3\]' 'def prepare(system, method): return lambda x, v, count: ([1, 2], [3, 4])'
fails_with 'prepare returned neither a function' 'def prepare(system, method): return 3'
fails_with 'unsupported.*not semi-euler' 'def prepare(system, method): raise mssim_backend.Unsupported("not " + method.name)'
fails_with 'unavailable.*no such device' 'def prepare(system, method): raise mssim_backend.Unavailable("no such device")'
fails_with 'unsupported: no reason given' 'def prepare(system, method): raise mssim_backend.Unsupported'
# The module is found beside folders of a description's own, and an empty text says nothing.
mkdir described
sed 's/^mssim_backend.serve.*/mssim_backend.serve(prepare, note="", device=" ", precision="\\n")/' mine.py >described/silent.py
chmod +x described/silent.py
printf '{"command": ["./silent.py"], "environment": {"PYTHONPATH": "/nowhere"}}' >described/silent.json
ends 0 bench --scene cloth2500 --backend silent --backend-folder described --integrator semi-euler --rounds 1
# The examples use one thread, whatever is requested.
ends 0 bench --scene cloth2500 --backend ./mine.py --integrator semi-euler --rounds 1 --threads 2 --out one-thread
[ "$(column_of one-thread/timings.csv threads)" = 1 ] || fail "mine.py has another number of threads: $(cat one-thread/timings.csv)"
# A module that is missing is what the system lacks, not a mistake of the program.
for module in numpy h5py; do
  mkdir "no-$module"
  echo "raise ModuleNotFoundError('No module named $module', name='$module')" >"no-$module/$module.py"
  PYTHONPATH=$work/no-$module ends 3 bench --scene cloth2500 --backend ./mine.py --integrator semi-euler --rounds 1
  says "unavailable: .* has no module $module: install python3-$module"
done
# Run by hand it says what it is.
PYTHONPATH=$2/src/starters/python exits 1 ./mine.py
[ "$(cat err)" = 'mine.py is a backend of mssim: mssim bench --scene cloth2500 --backend serial,openmp,./mine.py' ] ||
  fail "run by hand, it says $(cat err)"
