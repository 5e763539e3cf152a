#!/usr/bin/env bash
# mssim table: what a paper in LaTeX needs, of committed results: the values of timings.csv, origins, escaped names, bad input; and that
# the document can be typeset, where TeX Live is installed (scripts/test --paper).
set -euo pipefail
. "$2/tests/support/command_line.sh"
results=$2/results

# check FOLDER PAPER: each time, interval and speed-up that counts is in times.tex, in the table of its scene; each number of a claim and
# of the provenance is where it should be
check() {
  python3 - "$1" "$2" <<'PYTHON' || fail "$2 is not what $1 has"
import csv, json, math, pathlib, re, sys

folder, paper = map(pathlib.Path, sys.argv[1:])
wrong = []


def digits(value):
    """Three significant digits, as all tables have them."""
    before = math.floor(math.log10(value)) + 1 if value > 0 else 1
    return f"{value:.{max(0, 3 - before)}f}"


def demand(condition, what):
    if not condition:
        wrong.append(what)


texts = {file.name: file.read_text() for file in paper.glob("*.tex")}
provenance = json.loads((folder / "provenance.json").read_text())
rows = list(csv.DictReader((folder / "timings.csv").open()))
captions = [caption for text in texts.values() for caption in re.findall(r"\\caption\{(.*)\}\n", text)]
demand(len(captions) > 5, "captions are missing")
for caption in captions:
    for part in (provenance["cpu"]["model"], provenance["cpu"]["generation"], provenance["build"]["commit"][:12], provenance["started_utc"]):
        demand(part in caption, f"no {part} in: {caption}")
    if "Environment" not in caption:
        demand(f"{max(int(row['rounds']) for row in rows)} rounds" in caption, f"no rounds in: {caption}")
blocks = {re.search(r"\\caption\{Times per step\. ([^:]*):", block).group(1): block for block in
          texts["times.tex"].split(r"\begin{table}")[1:]}
for row in rows:
    block = blocks[row["scene"].replace("_", r"\_")]
    lines = [line for line in block.splitlines() if re.search(rf"& {re.escape(row['backend'])}\b[^&]*& {re.escape(row['integrator'])} ", line)]
    demand(lines, f"no line of {row['scene']}, {row['backend']}, {row['integrator']}")
    if row["status"] == "ok" and row["verified"] == "true":
        low, high = digits(float(row["ms_per_step_low"])), digits(float(row["ms_per_step_high"]))
        parts = [rf"\num{{{digits(float(row['ms_per_step']))}}}", rf"\numrange{{{low}}}{{{high}}}", "yes"]
        parts += [rf"\num{{{digits(float(row['speedup_vs_serial']))}}}$\times$"] if row["backend"] != "serial" else []
        parts += [rf"\num{{{row['paper_ms']}}}"] if row["paper_ms"] else []
        demand(any(all(part in line for part in parts) for line in lines), f"{parts}: {lines}")
    else:
        demand(any("& -- &" in line for line in lines), f"a time of a row that does not count: {lines}")
        demand(any(word in lines[0] for word in ("unsupported", "unavailable", "no", "failed")), f"no mark: {lines}")
for name in ("table1", "figure6"):
    if (folder / f"{name}.csv").exists():
        for line in csv.DictReader((folder / f"{name}.csv").open()):
            if line["quantity"] in ("measured_ms", "ms_per_iteration"):
                for scene, value in line.items():
                    if scene[:5] in ("cloth", "jeans") and value:
                        demand(rf"\num{{{digits(float(value))}}}" in texts[f"{name}.tex"], f"{name}: no {value}")
everything = "\n".join(texts.values())
devices = provenance["opencl_devices"]
if all(device.startswith("Portable Computing Language") for device in devices):
    demand("on the CPU (PoCL on" in everything, "OpenCL on the CPU is not called so")
    demand("GPU" not in texts["times.tex"], "PoCL is called a GPU")
artifact = texts["artifact.tex"].replace("-{}-{}", "--").replace(r",\allowbreak{}", ",")
demand(" ".join(provenance["command_line"][1:]) in artifact, "the command")
demand(provenance["build"]["commit"] in artifact and provenance["build"]["commit"] in (paper / "sources.bib").read_text(), "the commit")
samples = sum(int(sample["steps"]) * float(sample["ms_per_step"]) for sample in csv.DictReader((folder / "samples.csv").open()))
demand(rf"\qty{{{digits(samples / 60000)}}}{{\minute}}" in artifact, "the minutes of the samples")
trials = sorted(int(row["warm_up_trials"]) for row in rows if row["warm_up_trials"] and int(row["warm_up_trials"]))
demand(f"({trials[0]} to {trials[-1]} trials)" in texts["methods.tex"] or f"({trials[0]} trials)" in texts["methods.tex"], "the trials")
for svg in paper.glob("*.svg"):
    demand(f"{{{svg.stem}.pdf}}" in texts["figures.tex"], f"{svg.name} is in no figure")
demand(list(paper.glob("*.svg")), "there is no chart")
print(f"{paper}: {len(texts)} files, {len(captions)} captions, {len(rows)} rows")
sys.exit("\n".join(wrong[:20]) if wrong else 0)
PYTHON
}

# typeset PAPER: the document has no error, no undefined reference or citation, no character without a glyph, and nothing beyond its margin
typeset() {
  command -v pdflatex >/dev/null && command -v bibtex >/dev/null || { echo "SKIPPED: pdflatex is not installed, $1 is not typeset" && return; }
  local log=$1/mssim.log
  (cd "$1" && pdflatex -interaction=nonstopmode -halt-on-error mssim && bibtex mssim && for _ in 1 2; do
    pdflatex -interaction=nonstopmode -halt-on-error mssim
  done) >"$work/tex" 2>&1 || fail "$1: $(grep -A3 '^!' "$log" || tail -n 20 "$work/tex")"
  ! grep -E 'undefined|multiply defined|Missing character|siunitx Warning' "$log" || fail "$1: warnings"
  ! awk -F'[(]' '/^Overfull .hbox/ && $2 + 0 > 2 { print; found = 1 } END { exit !found }' "$log" || fail "$1: lines are too wide"
  [ -s "$1/mssim.pdf" ] || fail "$1: no document"
}

# Several devices, and a long command.
ends 0 table "$results/garment/emerald-rapids-h100-busy" --format latex --out "$work/h100"
typeset "$work/h100"

for folder in table1 garment; do
  ends 0 table "$results/$folder/zen4" --format latex --out "$work/$folder"
  [ ! -s "$work/out" ] || fail "stdout is not empty"
  check "$results/$folder/zen4" "$work/$folder"
  typeset "$work/$folder"
  if command -v rsvg-convert >/dev/null; then
    for svg in "$work/$folder"/*.svg; do
      [ "$(head -c 5 "${svg%.svg}.pdf")" = %PDF- ] || fail "$svg has no PDF"
    done
  else
    warns 'librsvg2-bin'
  fi
done
grep -q 'parallel-iterations\|An iteration is faster with parallelisation' "$work/garment/artifact.tex" || fail "a claim is missing"
! grep -q 'on the GPU than with several threads' "$work/table1/artifact.tex" || fail "a claim about a GPU is decided without one"
[ "$(grep -c '^@' "$work/table1/sources.bib")" -eq 4 ] || fail "sources: $(cat "$work/table1/sources.bib")"

# The sources are those of CITATION.cff.
python3 - "$2/CITATION.cff" "$work/table1/sources.bib" <<'PYTHON' || fail "the sources are not those of CITATION.cff"
import re, sys
citation, sources = (open(name).read() for name in sys.argv[1:])
cited = re.findall(r"^ *(?:title|doi): (.*)$", citation, re.M)
missing = [text for text in cited if text not in sources]
sys.exit(f"missing: {missing}" if len(cited) < 4 or missing else 0)
PYTHON

# Without rsvg-convert, all but the PDF files is written.
mkdir "$work/no-programs"
PATH=$work/no-programs ends 0 table "$results/table1/zen4" --format latex --out "$work/svg"
warns 'librsvg2-bin'
[ -s "$work/svg/mssim.tex" ] && [ -z "$(find "$work/svg" -name '*.pdf')" ] || fail "without rsvg-convert: $(ls "$work/svg")"
# The PDF of an earlier chart does not stay under the caption of the new one; nor is one replaced unasked.
rm "$work"/svg/*.tex "$work"/svg/*.svg "$work/svg/sources.bib"
echo old >"$work/svg/chart-roofline.pdf"
PATH=$work/no-programs ends 2 table "$results/table1/zen4" --format latex --out "$work/svg"
warns 'chart-roofline.pdf already exists.*--overwrite'
PATH=$work/no-programs ends 0 table "$results/table1/zen4" --format latex --out "$work/svg" --overwrite
[ ! -e "$work/svg/chart-roofline.pdf" ] || fail "an old PDF stands under a new caption"
# A full disk leaves a paper as it was.
cp -r "$work/svg" "$work/before"
# shellcheck disable=SC2016 # the inner shell expands them
exits 4 bash -c 'ulimit -f 8 && PATH=$0 exec "$@"' "$work/no-programs" "$mssim" table "$results/garment/zen5" --format latex --out "$work/svg" \
  --overwrite
diff -r "$work/before" "$work/svg" || fail "a paper is half new"

# A program that ends well but writes nothing is not believed; nor is the PDF of the chart before taken for that of the next.
mkdir "$work/lazy"
# shellcheck disable=SC2016 # the program expands it
make_program lazy/rsvg-convert <<<'[ -e "$0.once" ] || { : >"$0.once" && echo %PDF- >"${2#--output=}"; }'
refuses 3 'lazy/rsvg-convert has ended without an error, but has written no PDF of chart.*; install' \
  env PATH="$work/lazy" "$mssim" table "$results/table1/zen4" --format latex --out "$work/never"

# What a page measured: how to measure it again, and no check that the page does not make.
ends 0 table "$results/web/zen4-swiftshader" --format latex --out "$work/web"
grep -qF 'scripts/mssim web -{}-{}out web.html' "$work/web/artifact.tex" || fail "how to make the page: $(cat "$work/web/artifact.tex")"
! grep -q 'end of one round' "$work/web/methods.tex" || fail "the page does not compare the ends of samples"
grep -q 'end of one round' "$work/table1/methods.tex" || fail "the check of samples is missing"
# How rows were timed has no number that the files lack: of a run in which all rows failed, and of one of an older version.
for folder in failed old others; do cp -r "$results/table1/zen4" "$work/$folder"; done
python3 - "$work" <<'PYTHON'
import csv, pathlib, sys

work = pathlib.Path(sys.argv[1])


def change(folder, change_row):
    file = work / folder / "timings.csv"
    header, *rows = csv.reader(file.open(newline=""))
    with file.open("w", newline="") as changed:
        csv.writer(changed, lineterminator="\n").writerows([change_row(header, header), *(change_row(header, row) for row in rows)])


def failed(header, row):
    empty = {name: "" for name in header if name.startswith("ms_per_step") or name == "speedup_vs_serial"}
    new = empty | {"rounds": "0", "warm_up_trials": "0", "outliers": "0", "verified": "false", "status": "failed: step 3"}
    return row if row is header else [new.get(name, value) for name, value in zip(header, row)]


change("failed", failed)
samples = work / "failed/samples.csv"
samples.write_text(samples.read_text().splitlines()[0] + "\n")
change("old", lambda header, row: row[:24])
change("others", lambda header, row: ["7" if name == "nodes" and row is not header else value for name, value in zip(header, row)])
PYTHON
for folder in failed old others; do ends 0 table "$work/$folder" --format latex --out "$work/$folder-paper"; done
grep -q 'beyond Tukey' "$work/table1/methods.tex" || fail "the outliers are missing"
! grep 'paragraph{Timing' "$work/failed-paper/methods.tex" || fail "nothing was timed"
! grep -h '[^0-9]0 rounds' "$work/failed-paper"/*.tex || fail "rounds that were not taken"
grep -q 'paragraph{Timing' "$work/old-paper/methods.tex" || fail "the paragraph on times is missing"
! grep -E '\(0 trials|the 0 beyond' "$work/old-paper/methods.tex" || fail "a number that an older file lacks"
grep -q 'Neither paper has .*cloth200k} or .*cloth350k}\.' "$work/others-paper/methods.tex" || fail "other scenes: $(cat "$work/others-paper/methods.tex")"
# A garment is in a paper, though some of its rows are not dressed.
! grep -q 'Neither paper' "$work/garment/methods.tex" || fail "jeans are in no paper: $(cat "$work/garment/methods.tex")"
# A commit that is not known cannot be checked out.
cp -r "$results/table1/zen4" "$work/no-commit"
sed -i 's/"commit": "[^"]*"/"commit": "unknown"/' "$work/no-commit/provenance.json"
ends 0 table "$work/no-commit" --format latex --out "$work/no-commit-paper"
! grep -q 'git checkout' "$work/no-commit-paper/artifact.tex" || fail "an unknown commit is checked out"

# Each program has its own source, also those of one commit or of none. The one with changes comes first: its key begins with the other's.
cp -r "$results/table1/zen4" "$work/changed"
sed -i 's/"dirty": false/"dirty": true/' "$work/changed/provenance.json"
cp -r "$work/no-commit" "$work/older"
sed -i 's/"version": "[^"]*"/"version": "0.0.9"/' "$work/older/provenance.json"
ends 0 table "$work/changed" "$results/table1/zen4" "$work/no-commit" "$work/older" --format latex --out "$work/four"
[ "$(grep -o '^@misc{mssim-[^,]*' "$work/four/sources.bib" | sort -u | wc -l)" -eq 4 ] || fail "sources: $(cat "$work/four/sources.bib")"
for key in -changed '' 0.0.9; do grep -q "^@misc{mssim-[0-9a-f.]*$key,$" "$work/four/sources.bib" || fail "no source $key"; done
for methods in "$work"/four/*-methods.tex; do
  grep -qF "{$(grep -o 'mssim-[0-9a-f.]*\(-changed\)\{0,1\}' "$methods" | head -n 1)," "$work/four/sources.bib" || fail "$methods cites no source"
done

# One absurd number spoils no page, and is named.
cp -r "$results/table1/zen4" "$work/absurd"
sed -i '2s/^\(\([^,]*,\)\{5\}\)[^,]*/\11e299/' "$work/absurd/samples.csv"
sed -i '3s/^\(\([^,]*,\)\{11\}\)[^,]*/\11e-300/' "$work/absurd/timings.csv"
ends 0 table "$work/absurd"
warns 'absurd/samples.csv: round 1 of cloth.* is 1e+299, not between 1e-12 and 1e12; the row.s samples are left out'
warns 'absurd/timings.csv: ms_per_step_low of cloth.* is 1e-300, not between'

# Bodies of Table 2 have no times.
ends 0 table "$results/table2" --format latex --out "$work/bodies"
grep -q '12921' "$work/bodies/table2.tex" || fail "Table 2: $(cat "$work/bodies/table2.tex")"
typeset "$work/bodies"
# Several folders, one of them of a guide.
ends 0 table "$results/table1/zen4" "$results/guide/zen4" --format latex --out "$work/both"
[ -s "$work/both/1-table1-zen4-table1.tex" ] && [ -s "$work/both/2-guide-zen4-guide.tex" ] || fail "two folders: $(ls "$work/both")"
! grep -h 'U+' "$work"/both/*.tex || fail "a sign of mssim's own tables is not known to LaTeX"
typeset "$work/both"

# Names with what LaTeX takes for its own, on rows that are not verified, too.
cp -r "$results/table1/zen4" "$work/odd"
# shellcheck disable=SC2016 # a dollar sign
name='a_b%c\&d#e$f{g}~h^i\\jЖ[k'
sed -i "s/^cloth2500,/$name,/" "$work/odd/timings.csv" "$work/odd/samples.csv"
sed -i '/^cloth4900,.*,openmp,.*,rk4,/s/,true,ok,/,false,ok,/' "$work/odd/timings.csv"
ends 0 table "$work/odd" --format latex --out "$work/odd-paper"
# shellcheck disable=SC2016
escaped='a\_b\%c\&d\#e\$f\{g\}\textasciitilde{}h\textasciicircum{}i\textbackslash{}j{[}U+0416]{[}k'
for file in times.tex methods.tex; do grep -qF "$escaped" "$work/odd-paper/$file" || fail "$file does not have $escaped"; done
grep -F 'cloth4900' "$work/odd-paper/times.tex" | grep 'openmp & rk4' | grep -q '& -- &.*\\textbf{no}' || fail "a row that is not verified is not marked"
typeset "$work/odd-paper"

# What is printed.
saying '^# Figure 6 of Vassilev' ends 0 table "$results/garment/zen4"
ms=$(awk -F, '$1 == "jeans1k" && $5 == "serial" { printf "%.3g", $11 }' "$results/garment/zen4/timings.csv")
says "^| jeans1k | $ms | serial |"
saying '\\label{tab:figure6-1}' ends 0 table "$results/garment/zen4" --format latex
[ "$(grep -c 'caption.*rounds' "$work/out")" -eq "$(grep -c caption "$work/out")" ] || fail "a caption has no rounds"

# Bad input.
expect 2 'no folder .*none.*give' table "$work/none" --format latex --out "$work/never"
mkdir "$work/empty"
expect 2 'empty has no results: give' table "$work/empty" --format latex --out "$work/never"
expect 2 'mssim.tex\|[a-z0-9-]*\.[a-z]* already exists: give another --out, or --overwrite' \
  table "$results/table1/zen4" --format latex --out "$work/table1"
expect 2 '--format latex' table "$results/table1/zen4" --out "$work/never"
expect 2 '--format' table "$results/table1/zen4" --format word
cp -r "$results/table1/zen4" "$work/unknown"
rm "$work/unknown/provenance.json"
warning 'unknown has no provenance.json' ends 2 table "$work/unknown" --format latex --out "$work/never"
cp "$results/table1/zen4/provenance.json" "$work/unknown"
head -n 1 "$results/table1/zen4/timings.csv" >"$work/unknown/timings.csv"
warning 'unknown has no row .*give' ends 2 table "$work/unknown" --format latex --out "$work/never"
[ ! -e "$work/never" ] || fail "something was written"
: >"$work/file"
warning 'file' ends 4 table "$results/table1/zen4" --format latex --out "$work/file/paper"
echo mine >"$work/table1/notes.tex"
ends 0 table "$results/table1/zen4" --format latex --out "$work/table1" --overwrite
[ "$(cat "$work/table1/notes.tex")" = mine ] || fail "--overwrite removes a file of the user's"
