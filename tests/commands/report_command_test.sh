#!/usr/bin/env bash
# mssim report: a page about the committed results is whole, in order, and needs nothing beside it; damaged folders give a page that
# says so; mistakes at the command line are named.
set -euo pipefail
. "$2/tests/support/command_line.sh"
results=$2/results

# check PAGE: every element is closed, ids differ, links lead to one of them, nothing is fetched or run, and the data are JSON
check() {
  python3 - "$1" <<'EOF' || fail "$1 is not a whole page"
import json, re, sys
from html.parser import HTMLParser

void = {"meta", "img", "br", "link", "input", "hr"}
fetching = {"src", "href", "srcset", "data", "action", "poster", "xlink:href"}


class Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.ids, self.links, self.data, self.wrong = [], [], [], "", []

    def handle_starttag(self, tag, attributes):
        self.handle_startendtag(tag, attributes)
        if tag not in void:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.ids.append(value)
            if name in fetching and (value or "").startswith("#"):
                self.links.append(value[1:])
            elif name in fetching and not (tag == "img" and value.startswith("data:image/png;base64,")):
                self.wrong.append(f"{tag} {name}={value[:60]}")
            self.links += re.findall(r"url\(#([^)]*)", value or "")
            if name.startswith("on") or "url(" in (value or "").replace("url(#", ""):
                self.wrong.append(f"{tag} {name}={value[:60]}")
        if tag == "script" and dict(attributes).get("type") != "application/json":
            self.wrong.append("a script")
        if tag in ("link", "iframe", "object", "embed"):
            self.wrong.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if self.open and self.open[-1] == "script":
            self.data += data
        if self.open and self.open[-1] == "style" and ("url(" in data or "@import" in data):
            self.wrong.append("a style that fetches")


text = open(sys.argv[1], encoding="utf-8").read()
page = Page()
page.feed(text)
wrong = page.wrong + [f"<{tag}> is not closed" for tag in page.open]
wrong += [f"two of the id {i}" for i in set(page.ids) if page.ids.count(i) > 1]
wrong += [f"no id {i}" for i in page.links if i not in page.ids]
folders = json.loads(page.data)["folders"]
wrong += [f"{f['name']}: no findings" for f in folders if f["timings"] and not f["findings"]]
print(f"{sys.argv[1]}: {len(text)} bytes, {len(folders)} folders, {len(page.ids)} ids, {text.count('<svg')} charts")
sys.exit("\n".join(wrong) if wrong else 0)
EOF
}

# has PATTERN, lacks PATTERN: what stands in the page that was made last
has() { grep -q -- "$1" "$work/page.html" || fail "the page does not say \"$1\""; }
lacks() { ! grep -q -- "$1" "$work/page.html" || fail "the page says \"$1\""; }

# report FOLDER...: makes and checks a page
report() {
  ends 0 report "$@" --no-runs --out "$work/page.html"
  [ ! -s "$work/out" ] || fail "stdout is not empty"
  check "$work/page.html"
}

# The committed results: folders of folders, sections in order, one claim of each outcome.
report "$results/table1" "$results/table3" "$results/garment"
order=$(grep -o '<section id="[a-z-]*"' "$work/page.html" | cut -d'"' -f2 | tr '\n' ' ')
[ "$order" = "verdict headline machine speed-up published scaling roofline energy pictures provenance " ] || fail "sections: $order"
[ "$(grep -c '<h3>.*results/[a-z0-9]*/zen[45]</h3>' "$work/page.html")" -ge 36 ] || fail "not every folder is in every section"
for outcome in held 'not held' undecided 'not testable here'; do has ">$outcome</td>"; done
data_of page.html >page.json
python3 - <<'EOF'
import json

data = json.load(open("page.json", encoding="utf-8"))
claims = {folder["name"].split("results/")[-1]: {claim["name"]: claim for claim in folder["claims"]} for folder in data["folders"]}
for folder, of_folder in claims.items():
    for name, scenes in (("gpu-10-to-34", "table1"), ("gpu-before-threads", "table1"), ("gpu-and-threads-3-to-4", "table3")):
        assert (name in of_folder) == folder.startswith(scenes), (folder, name)
        if name in of_folder:
            untestable = of_folder[name]["outcome"] == "not testable here"
            assert untestable == ("h100" not in folder), (folder, of_folder[name])
    assert ("jeans-in-two-seconds" in of_folder) == folder.startswith("garment"), folder
gpu = claims["table1/zen4"]["gpu-10-to-34"]
assert gpu["published"].startswith("10.7× to 34.9×") and gpu["measured"] == "needs a GPU", gpu
EOF
has 'all are verified against the double-precision reference'
for label in '>opencl on the CPU, measured<' '>opencl, NVIDIA H100 80GB HBM3, measured<' '>GPU, Nexus 7, published<' '>350,000<'; do has "$label"; done
lacks 'AVX3 vectors'
lacks '>opencl, measured<'
lacks 'What changed'
[ "$(grep -c '<svg' "$work/page.html")" -ge 20 ] || fail "charts are missing"
lacks 'no chart, because '
cp "$work/page.html" "$work/first.html"
report "$results/table1" "$results/table3" "$results/garment" "$results/../results/table1/zen4"
cmp "$work/page.html" "$work/first.html" || fail "the same folders, one of them twice, give another page"

# Two folders: what changed.
cp -r "$results/table1/zen5" "$work/base"
cp -r "$work/base" "$work/next"
report "$work/base" "$work/next"
has '<h2>What changed</h2>'

# An energy curve and its reference; a picture; the scene's name is no element.
cp "$results/reference/cloth2500.csv" "$work/base/cloth2500-rk4.csv"
printf '\x89PNG\r\n\x1a\nno more' >"$work/base/<b>.png"
sed -i 's/cloth2500/<script>alert(1)<\/script>/' "$work/base/timings.csv"
report "$work/base"
has 'alt="&lt;b&gt;.png" src="data:image/png;base64,iVBORw0KGg'
has '&lt;script&gt;alert(1)&lt;/script&gt;'
lacks '<script>'
lacks 'No folder has an energy curve'
has 'reference of cloth2500'

# Scenes are drawn that come with mssim and are as they were measured; the others are no damage.
ends 0 report "$results/table1/zen5" --out "$work/page.html"
check "$work/page.html"
has 'alt="cloth[0-9a-z]*, [0-9,]* nodes, after 0.50 s" src="data:image/png;base64,'
has 'Total energy: cloth4900, openmp, semi-euler'
[ ! -s "$work/out" ] || fail "stdout is not empty"
sed -i '/"cloth2500": /!s/"cloth\([0-9a-z]*\)": "[0-9a-f]*"/"cloth\1": "0123456789abcdef"/' "$work/next/provenance.json"
ends 0 report "$work/next" --out "$work/page.html"
check "$work/page.html"
has 'alt="cloth2500, 2,500 nodes, after 0.50 s"'
lacks 'alt="cloth4900'
lacks 'What is missing or damaged'
sed -i 's/"cloth2500": "[0-9a-f]*"/"cloth2500": "0123456789abcdef"/' "$work/next/provenance.json"
report "$work/next"
has 'No row .* scene of the papers'

# A user's own scene is none of the papers', though it has the nodes, the springs and the name of one.
mkdir "$work/own"
make_scene own/cloth2500.json cloth2500 's/"stiffness_n_per_m": 200/"stiffness_n_per_m": 100/'
ends 0 bench --scene own/cloth2500.json --backend serial,openmp --integrator semi-euler --rounds 2 --out own/out
! grep -q 'ms/step.*published' "$work/out" || fail "a scene of the user's has a published time: $(cat "$work/out")"
[ ! -e "$work/own/out/table1.md" ] || fail "a scene of the user's is in Table 1"
report "$work/own/out"
has 'No row .* scene of the papers'
ends 0 bench --scene own/cloth2500.json,cloth4900 --backend serial,openmp --integrator semi-euler --rounds 2 --resume --out own/out
grep -q '^,,,nodes,4900$' "$work/own/out/table1.csv" || fail "--resume puts a scene of the user's into Table 1: $(cat "$work/own/out/table1.csv")"

# Damaged folders.
cp -r "$results/table3/zen5" "$work/damaged"
truncate -s 5000 "$work/damaged/timings.csv"
truncate -s 3000 "$work/damaged/samples.csv"
echo '{' >"$work/damaged/provenance.json"
report "$work/damaged"
has 'What is missing or damaged'
mkdir -p "$work/empty/further"
cp -r "$work/damaged" "$work/empty/further/down"
echo before >"$work/kept.html"
expect 2 'empty has no results: give .*further$' report "$work/empty" --out "$work/kept.html"
[ "$(cat "$work/kept.html")" = before ] || fail "a refused report has replaced a page"

# A guide: charts, words of its page and tables to unfold; damaged, it says so.
guide=$work/guides/one
mkdir -p "$guide"
cp "$results/table1/zen5/provenance.json" "$guide"
{
  echo 'scene,nodes,springs_unique,integrator,backend,dt_s,steps,horizon_s,position_error,energy_error,solver_error,step_error,reference_error,ms_per_step,wall_s_per_s,force_evaluations_per_s,samples,diverged,on_front,status,note'
  echo 'cloth,9,20,rk4,serial,0.004,5,0.02,,,,,1e-08,2,0.5,1000,9,true,false,diverged,'
  echo 'cloth,9,20,rk4,serial,0.002,10,0.02,0.01,0.1,,,1e-08,2,1,2000,9,false,true,ok,'
  echo 'cloth,9,20,rk4,serial,0.001,20,0.02,4e-07,0.1,,,1e-08,2,2,4000,9,false,false,within the reference'"'"'s error,'
  echo 'cloth,9,20,newton-euler,openmp,0.01,2,0.02,0.2,0.1,,,1e-08,20,2,,9,false,false,ok,'
  echo 'cloth,9,20,xpbd,openmp,,,0.02,,,,,,,,,,,,"no time, and no <b>",'
} >"$guide/guide.csv"
printf 'scene,integrator,backend,dt_s,nodes,ms_per_step\ncloth,rk4,serial,0.001,256,1\ncloth,rk4,serial,0.001,529,2\n' >"$guide/guide-sizes.csv"
printf '# Which\n\n*x* is y.\n\n## cloth: 9 nodes\n\nTake rk4.\n\n| a |\n|---|\n| b |\n\n### The front\n\n| c |\n|---|\n| d |\n' >"$guide/guide.md"
report "$work/guides" "$work/next"
has '<section id="guide">'
lacks 'timings.csv: there is no such file'
for chart in work-precision error-step error-evaluations sizes-explicit; do
  has "<svg id=\"f1-guide-1-$chart\" class=\"chart\" .*role=\"img\""
done
has '<figcaption>Crosses at an error of 1 .*Points in squares are not compared'
has 'No points: xpbd (no time, and no &lt;b&gt;)'
truncate -s -30 "$guide/guide.csv"
rm "$guide/guide.md"
report "$guide"

# Mistakes.
expect 2 '^mssim: DIR is missing' report
expect 2 '^mssim: there is no folder /no/such: give folders that mssim bench --out wrote' report /no/such
expect 2 'there is no folder .*timings.csv' report "$results/table1/zen5/timings.csv"
mkdir "$work/later"
cp "$work/base"/*.csv "$work/later"
echo '{"format_version": 99}' >"$work/later/provenance.json"
expect 2 'later/provenance.json: /format_version is 99.*newer mssim' report "$work/base" "$work/later" --out "$work/later.html"
[ ! -e "$work/later.html" ] || fail "a report of a folder that a later mssim wrote"
expect 4 'cannot write' report "$work/base" --out "$work/no/such/page.html"
expect 4 'cannot write' report "$work/base" --out "$work/empty"
expect 2 'timings.csv, .*HTML: give .*/timings.html' report "$work/base" --out "$work/base/timings.csv"
ln -s base/timings.csv "$work/alias.html"
expect 2 'timings.csv, .*HTML: give .*/timings.html' report "$work/base" --out "$work/alias.html"
[ ! -e "$work/page.html.part" ] || fail "a temporary file stays"
(cd "$work" && "$mssim" report base 2>/dev/null && [ -s report.html ]) || fail "--out is not report.html"
