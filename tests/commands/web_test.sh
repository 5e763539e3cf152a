#!/usr/bin/env bash
# mssim web: the page measures and verifies in a real browser, notices wrong kernels, and says when a device is lost or missing; report
# and compare read what it saves, and refuse what is damaged.
# $1: mssim, $2: the source folder
set -euo pipefail
# shellcheck source=tests/support/command_line.sh
. "$2/tests/support/command_line.sh"

expect 2 --serve web
expect 2 html web --out page.txt
expect 2 --serve web --out page.html --serve
expect 2 --serve web --out page.html --port 8000
touch file
expect 4 'file.*folder' web --serve --results file

# Making a page takes one processor seconds, many more with a sanitizer: both are made at once.
chromium=$(command -v chromium) || chromium=''
[[ ! $chromium ]] || { "$mssim" web --serve --once --results sent >address </dev/null 2>serve.log & server=$!; }
ends 0 web --out page.html
(($(stat -c %s page.html) < 8000000)) || fail "the page has more than 8 MB"
if grep -qE '(src|href)="?https?:|@import|import\(' page.html; then fail "the page needs something beside it"; fi

# HEAD is answered like GET, without the body. A Host without a port is that of port 80; another host's page is refused.
begins web --serve
soon 300 test -s "$work/out" || fail "mssim does not serve the page"
python3 - "$(grep -o '[0-9]*' "$work/out")" <<'PYTHON' || fail "requests are not answered as they should be"
import socket, sys

def answer(method, path, host="localhost:1", more=""):
    """Head and body of all that comes until the connection is closed."""
    with socket.create_connection(("localhost", int(sys.argv[1]))) as connection:
        connection.sendall(f"{method} {path} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n".encode())
        return b"".join(iter(lambda: connection.recv(1 << 16), b"")).split(b"\r\n\r\n", 1)

for path, status in (("/", b"200"), ("/?auto=cloth2500", b"200"), ("/nothing", b"404")):
    head, body = answer("GET", path)
    assert status in head.splitlines()[0] and body, head
    assert answer("HEAD", path) == [head, b""], path
for host in "localhost", "127.0.0.1", "127.0.0.1:80":
    assert b"200" in answer("GET", "/", host)[0].splitlines()[0], host
for host in "localhost.example.org", "example.org:80", "":
    head, body = answer("GET", "/", host)
    assert b"403" in head.splitlines()[0] and f'"{host}": open the page as http://localhost:{sys.argv[1]}/'.encode() in body, (head, body)
    assert answer("HEAD", "/", host) == [head, b""], host
head, body = answer("POST", "/results", more="Origin: http://example.org\r\nContent-Length: 9\r\n")
assert b"403" in head.splitlines()[0] and b"example.org" in body, (head, body)
head, body = answer("POST", "/results", more=f"Content-Length: {(64 << 20) + 1}\r\n")
assert b"413" in head.splitlines()[0] and b"64 MiB" in body, (head, body)
PYTHON
is_ended 143 TERM
# Both are packages of the tests. Only a build that was configured before they came has no module.
if grep -q '"wasm":null' page.html; then
  [[ ! $chromium ]] || kill "$server"
  ! type -P clang++ wasm-ld >/dev/null ||
    fail "the page has no row wasm: configure this build again, and see what CMake says of clang++ and wasm-ld"
  skip "clang++ or wasm-ld is missing: the page has no row wasm, and is not opened"
fi

[[ $chromium ]] || skip "chromium is missing: the page is not opened"
python3 "$2/tests/commands/web.py" "$chromium" page.html . || fail "the page in the browser"

/usr/bin/python3 -W ignore "$2/tests/support/check_json.py" "$2/docs/schemas/web-results.schema.json" result.json \
  --maps environment,backend_programs,scenes_fnv1a_64,scene_files_fnv1a_64 --wrong mssim_web_results=2 || fail "result.json by its schema"

# What it saved, beside a folder.
ends 0 report result.json lost.json failed.json without.json "$2/results/table1/zen5" --no-runs --out report.html
grep -q 'webgpu, ' report.html || fail "the report does not name the device"
grep -q 'result.json' report.html || fail "the report does not name the file"
grep -q '<td>wasm-threads<' report.html || fail "the report does not name the threads of the module"
saying javascript ends 0 compare result.json result.json
says wasm-threads

# damaged PATTERN EDIT: a result changed by a statement of Python on its document d is refused
damaged() {
  python3 -c 'import json, sys
d = json.load(open("result.json"))
exec(sys.argv[1])
json.dump(d, open("damaged.json", "w"))' "$2"
  expect 2 "$1" report damaged.json --no-runs --out damaged.html
  [[ ! -e damaged.html ]] || fail "a report of a damaged file: $2"
}
damaged 'damaged.json' 'd["mssim_web_results"] = 2'
damaged 'my-gpu' 'd["timings_csv"] = d["timings_csv"].replace("javascript", "my-gpu"); d["samples_csv"] = d["samples_csv"].replace("javascript", "my-gpu")'
damaged 'best-euler' 'd["timings_csv"] = d["timings_csv"].replace("semi-euler", "best-euler")'
damaged 'samples' 'd["samples_csv"] = d["samples_csv"].splitlines()[0] + "\n"'
damaged 'samples' 'd["samples_csv"] = d["samples_csv"].replace(d["samples_csv"].splitlines()[1].split(",")[5], "1e-6")'
damaged 'samples_csv' 'del d["samples_csv"]'
damaged 'build' 'd["provenance"]["build"] = 1'
head -c 1000 result.json >cut.json
expect 2 cut.json report cut.json --no-runs --out damaged.html

# Results are taken from the page alone, into a folder for each device; who is slow keeps nobody waiting.
begins web --serve --results taken
soon 300 test -s "$work/out" || fail "mssim does not serve the page"
python3 - "$(grep -o '[0-9]*' "$work/out")" <<'PYTHON' || fail "results that were sent"
import json, pathlib, socket, sys, threading, time

port = int(sys.argv[1])
results = json.load(open("result.json"))

def answer(text, origin):
    with socket.create_connection(("localhost", port), timeout=40) as connection:
        body = text.encode()
        request = f"POST /results HTTP/1.1\r\nHost: localhost:{port}\r\n{origin}Content-Length: {len(body)}\r\n\r\n"
        connection.sendall(request.encode() + body)
        return b"".join(iter(lambda: connection.recv(1 << 16), b"")).decode()

def sent(model, started, origin=f"Origin: http://localhost:{port}\r\n"):
    results["provenance"]["cpu"]["model"], results["provenance"]["started_utc"] = model, started
    return answer(json.dumps(results), origin)

start = "2026-01-31T12:00:00Z"
with socket.create_connection(("localhost", port)) as slow:
    def drip():
        try:
            for byte in b"GET / HTTP/1.1\r\nX: " + 60 * b"x":
                slow.sendall(bytes([byte]))
                time.sleep(1)
        except OSError:
            pass  # given up, as it should be
    threading.Thread(target=drip, daemon=True).start()
    time.sleep(1)
    for model, folder in (("phone A", ""), ("phone B", "-2"), ("phone A", ""), ("phone B", "-2")):
        assert "taken/2026-01-31T12-00-00Z" + folder == sent(model, start).split("\r\n\r\n")[1], model
assert "403" in (said := sent("phone C", start, "Origin: https://example.org\r\n")) and "localhost" in said, said
for wrong in ("", "../..", "2026-01-31"):
    assert "400" in (said := sent("phone C", wrong)) and "started_utc" in said, said
assert sorted(path.name for path in pathlib.Path("taken").iterdir()) == ["2026-01-31T12-00-00Z", "2026-01-31T12-00-00Z-2"]
PYTHON
is_ended 143 TERM

# The page sends its results to mssim.
soon 300 test -s address || fail "mssim does not serve the page: $(<serve.log)"
address=$(<address) port=$(grep -o '[0-9]*' address)
expect 2 "cannot serve on port $port.*--port" web --serve --port "$port"
profile=$(mktemp -d)
"$chromium" --headless=new --no-sandbox --user-data-dir="$profile" --remote-debugging-port=0 \
  "$address?auto=cloth2500&rounds=2&seconds=0.002&integrators=semi-euler&threads=2" >/dev/null 2>&1 &
browser=$!
soon 60 is_gone "$server" || { kill "$server" && fail "mssim takes no result"; }
kill "$browser"
wait "$browser" || true
rm -rf "$profile"
grep -q '^cloth2500,2500,.*,javascript,cpu,1,semi-euler,.*,true,ok' sent/*/timings.csv || fail "mssim has not written what it was sent"
grep -q '^cloth2500,2500,.*,wasm-threads,cpu,2,semi-euler,.*,true,ok' sent/*/timings.csv || fail "the served page is not isolated"
ends 0 report sent --no-runs --out sent.html
