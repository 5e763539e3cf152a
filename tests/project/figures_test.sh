#!/bin/bash
# Every figure of README.md and docs/papers.md follows from what is committed in results/: the sentences and tables that it computes must
# stand there, and no other number may, but those of `allowed`. It prints what should stand there. Arguments: mssim, the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"
cd -- "$source"
suites=(table1 table3 garment)
ends 0 report "${suites[@]/#/results/}" --no-runs --out "$work/report.html"
data_of "$work/report.html" >"$work/report.json"
for suite in "${suites[@]}"; do
  ends 0 bench --suite "$suite" --dry-run
  mv "$work/out" "$work/$suite"
done

# Whoever reads a figure can look at the program that made it: the history has every commit that results/ names. A copy without it has none.
mapfile -t commits < <(git grep -hoE '"commit": "[0-9a-f]+' -- results 2>/dev/null | grep -oE '[0-9a-f]+$' | sort -u)
unknown=()
for commit in "${commits[@]}"; do git merge-base --is-ancestor "$commit" HEAD 2>/dev/null || unknown+=("$commit"); done
((${#unknown[@]} == ${#commits[@]} || !${#unknown[@]})) ||
  { echo "results/ names commits that the history does not have: ${unknown[*]}; measure their folders again" && exit 1; }

/usr/bin/python3 - "$work" "${suites[@]}" <<'PYTHON'
import csv, glob, json, math, os, re, sys

work, suites = sys.argv[1], sys.argv[2:]
failures = []


def rows(file):
    with open(file, newline="") as lines:
        return list(csv.DictReader(lines))


def digits(x):
    """Three significant digits, as mssim shows times and ratios."""
    exponent = int(f"{x:.2e}".split("e")[1])
    return f"{x:.{max(0, 2 - exponent)}f}"


def span(values):
    return f"{digits(min(values))} to {digits(max(values))}"


# A folder's name, and the processor that it was measured on. The provenance of some says less.
machines = {"zen3": "Zen 3", "zen4": "Zen 4", "zen5": "Zen 5", "granite-rapids": "Granite Rapids", "emerald-rapids-h100": "Emerald Rapids, H100"}
gpu = "emerald-rapids-h100"
for folder in [folder for suite in suites for folder in glob.glob(f"results/{suite}/*/")]:
    if not os.path.basename(folder[:-1]).startswith(tuple(machines)):
        failures.append(f"{folder} is of a machine that no page names")


def provenance(folder):
    with open(f"{folder}/provenance.json") as file:
        return json.load(file)


def cpus(folder):
    return provenance(folder)["cpu"]["logical_cpus"]


def when(folder):
    found = provenance(folder)
    assert not found["build"]["dirty"], f"{folder} is of no commit"
    return f"commit {found['build']['commit'][:7]}, {found['started_utc'][:10]}"


# What mssim report says of the claims, by folder.
with open(f"{work}/report.json") as file:
    data = json.load(file)
judged = {folder["name"]: {claim["name"]: claim for claim in folder["claims"]} for folder in data["folders"]}
with open("results/published/claims.json") as file:
    claims = json.load(file)["claims"]
testable = [claim for claim in claims if "test" in claim]


# A claim names the scenes that decide it; of these, no suite has the name.
SUITES = {"figure6": "garment"}


def suite_of(claim):
    scenes = claim["test"]["scenes"]
    return SUITES.get(scenes, scenes)


def outcome(claim, folder):
    """None if nothing in the folder can decide the claim."""
    found = judged.get(f"results/{suite_of(claim)}/{folder}", {}).get(claim["name"])
    return found if found and found["outcome"] != "not testable here" else None


def outcomes(claim, machine):
    """The outcomes in the machine's folders (NAME-...), by what their names say besides; first one that decides, if there is one, and
    of these one of a quiet machine."""
    found = [(os.path.basename(folder)[len(machine) + 1:].replace("-", " "), outcome(claim, os.path.basename(folder)))
             for folder in sorted(glob.glob(f"results/{suite_of(claim)}/{machine}*"))]
    return sorted(((remark, one) for remark, one in found if one),
                  key=lambda pair: (pair[1]["outcome"] == "undecided", pair[0].startswith("busy")))


def held(machine):
    found = [all[0][1]["outcome"] for all in (outcomes(claim, machine) for claim in testable) if all]
    undecided = found.count("undecided")
    return f"{found.count('held')} of {len(found)}" + (f" ({undecided} undecided)" if undecided else "")


def published(claim):
    """The published ratios, from their mean on where it is what counts; empty if the paper prints no times."""
    texts = {found["published"] for found in (folder.get(claim["name"]) for folder in judged.values()) if found}
    assert len(texts) == 1, f"{claim['name']}: {texts}"
    return re.sub(r".*\((?=\d+ ratios, geometric mean)", "", texts.pop())


def interval(found):
    """The measured ratios, or the mean where it is what counts; None of no outcome."""
    return found and (re.search(r"geometric mean ([\d.]+)×", found["measured"]) or
                      re.match(r"([\d.]+)×(?: to ([\d.]+)×)?", found["measured"]))


def shown(match):
    if not match:
        return "–"
    mean = "mean " if "mean" in match.group(0) else ""
    return mean + " to ".join(f"{x}×" for x in match.groups() if x)


def cell(claim, machine):
    """The outcome on the machine; in brackets the other folders of it with another one."""
    found = outcomes(claim, machine)
    if not found:
        return "–"
    first, main = found[0]
    others = {}
    for remark, one in found:
        if one["outcome"] != main["outcome"]:
            others.setdefault(one["outcome"], []).append(remark)
    return f"{main['outcome']}: {shown(interval(main))}" + (f" ({first})" if first else "") + "".join(
        f" ({', '.join(filter(None, remarks)) or 'another run'}: {name})" for name, remarks in others.items())


def speedups(table, machine, backend):
    return [float(row["speedup_vs_serial"]) for row in rows(f"results/{table}/{machine}/timings.csv") if row["backend"] == backend]


def table(*lines):
    return "".join("| " + " | ".join(line) + " |\n" if isinstance(line, list) else line + "\n" for line in lines)


def times(values):
    return f"{digits(min(values))}× to {digits(max(values))}×"


# The numbers that are no figures, and what they are.
allowed = {
    "Tables 2 and 3": "of a paper", "Table 1": "of a paper", "Table 2": "of a paper", "Table 3": "of a paper", "Figure 5": "of a paper",
    "Figure 6": "of a paper", "Eqs. (2) to (4)": "of a paper", "(2016)": "its year", "6:23": "its volume and article",
    "2016-11-28": "its day", "SAT-1.405B-1-MIP-05": "its name", "10 parallel threads": "what it says", "4th-order": "a method",
    "Nexus 7": "a device", "Debian 12 or 13": "systems",
    "12 neighbours": "in the grid of a cloth", "a factor of 2 comes from threads": "as many threads as CPUs",
    "At 2,500 nodes the intervals span about a factor of 2.": "intervals of peers.md there", "3–4 times": "of a paper",
    "gives 2 times": "of a paper",
    "on 2 cores": "where CONTRIBUTING.md says what a build takes",
}

# README.md
pages = {"README.md": [], "docs/papers.md": []}
readme, papers = pages["README.md"], pages["docs/papers.md"]
chart = "results/table1/zen4"
sizes = [int(row["nodes"]) for row in rows(f"{chart}/timings.csv")]
readme.append(f"The chart is the part of Table {os.path.dirname(chart)[-1]} of Hong et al.")
readme.append(f"on cloths of {min(sizes):,} to {max(sizes):,} nodes: published")
readme.append(f"It was measured on {cpus(chart)} logical CPUs of an AMD EPYC (Zen 4), {when(chart)}")
readme.append(f"The rows are from {cpus('results/web/zen4-swiftshader')} logical CPUs of an AMD EPYC (Zen 4), "
              f"{when('results/web/zen4-swiftshader')}")
for scene, words in {"cloth40k": "a cloth of {:,} nodes", "bodies20587": "bodies of {:,} nodes", "jeans4k": "jeans of {:,} nodes, draped"}.items():
    folder = "garment" if scene.startswith("jeans") else "table1" if scene.startswith("cloth") else "table3"
    nodes = {int(row["nodes"]) for row in rows(f"results/{folder}/zen4/timings.csv") if row["scene"] == scene}
    readme.append(words.format(nodes.pop()))

without_gpu = [machine for machine in machines if machine != gpu]
assert {cpus(f"results/table1/{machine}") for machine in without_gpu} == {2}
readme.append(f"Of {len(claims)} claims that we count in both papers, {len(testable)} can be decided by a ratio of times.")
by_machine = [f"{held(machine)} on {machines[machine]}" for machine in without_gpu]
readme.append("Each machine's rows test some of these. On 2 CPUs without a GPU these held: " + ", ".join(by_machine[:-1]) + f" and {by_machine[-1]}.")
readme.append(f"On {cpus(f'results/table1/{gpu}')} CPUs of an Intel Xeon (Emerald Rapids) with an NVIDIA H100, {held(gpu)} held;")
busy = sum(all[0][0].startswith("busy") and all[0][1]["outcome"] == "held" for all in (outcomes(claim, gpu) for claim in testable) if all)
readme.append(f"{busy} of these {'was' if busy == 1 else 'were'} measured only while the machine was busy.")
locks = next(claim for claim in testable if claim["name"] == "threads-before-cpu")
slower = [machine for machine in machines
          if (first := outcomes(locks, machine)[0])[1]["outcome"] == "not held" and not first[0].startswith("busy")]
readme.append(f"On {len(slower)} of {len(machines)} machines, threads that share a spring list and a lock took longer than one thread on at least one cloth")
readme.append(f"With 2 threads `openmp` steps cloths {span(speedups('table1', 'zen4', 'openmp'))} times as fast as `serial`, a plain spring list (Zen 4, three integrators)")
shares = [1 / float(row["speedup_vs_serial"]) for threads in ("1-thread", "2-threads")
          for row in rows(f"results/peers/zen4/{threads}/timings.csv") if row["backend"] == "cpp-list" and row["status"] == "ok"]
readme.append(f"The same list with `-O3 -march=native` takes {span(shares)} of the time of `serial` (Zen 4).")
on_gpu = [row for folder in sorted(glob.glob(f"results/table1/{gpu}*")) for row in rows(f"{folder}/timings.csv")]
largest = next(row for row in on_gpu if row["scene"] == "cloth350k" and row["backend"] == "opencl" and row["integrator"] == "semi-euler")
on_cpus = next(row for row in on_gpu if row["scene"] == "cloth350k" and row["backend"] == "openmp" and row["integrator"] == "semi-euler")
times_as_fast = float(on_cpus["ms_per_step"]) / float(largest["ms_per_step"])
readme.append(f"On the H100 a step of {int(largest['nodes']):,} nodes takes {digits(float(largest['ms_per_step']))} ms, "
              f"{digits(float(largest['speedup_vs_serial']))} times as fast as `serial` on one core. "
              f"That is {times_as_fast:.1f} times as fast as `openmp` on {cpus(f'results/table1/{gpu}')} CPUs.")


def gpu_wins(nodes):
    pairs = {}
    for folder in glob.glob(f"results/table1/{gpu}*"):
        for row in rows(f"{folder}/timings.csv"):
            if int(row["nodes"]) == nodes and row["backend"] in ("openmp", "opencl"):
                pairs.setdefault((folder, row["integrator"]), {})[row["backend"]] = float(row["ms_per_step"])
    return all(pair["opencl"] < pair["openmp"] for pair in pairs.values())


winning = [nodes for nodes in sorted(set(sizes)) if all(gpu_wins(n) for n in set(sizes) if n >= nodes)]
readme.append(f"From {winning[0]:,} nodes on it is faster than these CPUs with every integrator ({when(f'results/table1/{gpu}')}).")

# On openmp, which of the paper's integrators has the fastest step, and which is the cheapest at the wished error.
named = ("semi-euler", "midpoint", "rk4")


def best(file, column, wanted):
    """By scene the integrator whose smallest number is the smallest."""
    least = {}
    for row in rows(f"results/guide/zen4/{file}"):
        if row["backend"] == "openmp" and row["integrator"] in named and row[column] and wanted(row):
            numbers = least.setdefault(row["scene"], {})
            numbers[row["integrator"]] = min(float(row[column]), numbers.get(row["integrator"], math.inf))
    return {scene: min(numbers, key=numbers.get) for scene, numbers in least.items()}


fastest = best("guide.csv", "ms_per_step", lambda row: row["status"] == "ok")
cheapest = best("guide-errors.csv", "wall_s_per_s", lambda row: row["position_error"] == "0.001")
readme.append("Of " + "`{}`, `{}` and `{}`".format(*named) + " on `openmp`, the one with the fastest step costs least at equal error on "
              f"{sum(cheapest[scene] == fastest[scene] for scene in cheapest)} of {len(cheapest)} scenes (Zen 4).")
readme.append(f"On Zen 4, {when('results/guide/zen4')}, it says:")
with open("results/guide/zen4/guide.md") as file:
    readme.append(re.search(r"^## cloth10k.*?^(Take [^.]*\.[^.]*\.) ", file.read(), re.DOTALL | re.MULTILINE).group(1))

folder = "results/peers/zen4/2-threads"
measured = provenance(folder)["cpu"]
readme.append("same scenes, verified alike, 2 threads.")
readme.append(f"Measured on {measured['model']} ({measured['generation']}), {when(folder)}")

# docs/papers.md
with open("results/races/granite-rapids/races.md") as file:
    papers.append(re.search(r"taken to add (the forces of \d+ springs)", file.read()).group(1))
papers.append(f"{['no', 'one', 'two', 'three', 'four', 'five'][len(without_gpu)]} machines of {cpus(chart)} CPUs without a GPU")
minutes = {}
for suite in suites:
    with open(f"{work}/{suite}") as file:
        minutes[suite] = round(int(re.search(r"^about (\d+) s in all", file.read(), re.MULTILINE).group(1)) / 60)
columns = [*machines]
papers.append(table(["claim", "published"] + [machines[machine] for machine in columns], "|---|---|" + "---|" * len(columns), *(
    [f"`{claim['name']}`", shown(interval({"measured": published(claim)}))] + [cell(claim, machine) for machine in columns]
    for claim in testable)))
papers.append(table(["claim", "place", "the paper says"], "|---|---|---|", *(
    [f"`{claim['name']}`", claim["place"], claim["says"]] for claim in testable)))
papers.append(f"We count {len(claims)} claims in the papers that a measurement could support or contradict, and {len(testable)} of them")


def expected(claim):
    found = [interval(one) for one in (outcome(claim, machine) for machine in without_gpu) if one]
    bounds = [float(x) for match in found for x in match.groups() if x]
    return ("mean " if "mean" in found[0].group(0) else "") + times(bounds) if found else "–"


def on_both(table, backend, machine_list):
    return times([x for machine in machine_list for x in speedups(table, machine, backend)])


command = lambda suite: [f"`scripts/mssim bench --suite {suite} --out out/{suite}`", str(minutes[suite])]
papers.append(table(
    ["claim", "command", "minutes", "on 2 CPUs", "with an H100"], "|---|---|---:|---|---|",
    *([f"`{claim['name']}`", *command(suite_of(claim)), expected(claim), shown(interval(outcome(claim, gpu)))] for claim in testable),
    *([f"`openmp` over `serial`, {what}", *command(suite), on_both(suite, "openmp", without_gpu), times(speedups(suite, gpu, "openmp"))]
      for suite, what in (("table1", "cloths"), ("table3", "bodies")))))
ratios = {}
for row in rows("results/published/hong2016_table1.csv") + rows("results/published/hong2016_table3.csv"):
    ratios.setdefault((row["nodes"], row["configuration"]), {})[row["integrator"]] = float(row["ms_per_step"])
cost = lambda name: span([ms[name] / ms["semi-euler"] for ms in ratios.values()])
papers.append(f"In the published tables a step of midpoint takes {cost('midpoint')} times as long as one of semi-Euler, and one of "
              f"Runge-Kutta {cost('rk4')} times.")
sums = [row for row in rows("results/table2/table2.csv")]
papers.append(f"All {len(sums)} counts of nodes and of springs agree")


# The example of what bench prints.
example = "results/table1/zen4"
with open("docs/bench.md") as file:
    text = file.read()
where = f"[{example}](../{example}) (AMD EPYC, Zen 4, two threads, {when(example)})"
if where not in text:
    failures.append(f"docs/bench.md should have: {where}")
lines = re.findall(r"^    .*✓.*$", text, re.MULTILINE)
shown = {(row["integrator"], row["backend"]): row for row in rows(f"{example}/timings.csv") if row["scene"] == "cloth40k"}
integrator = None
for line in lines:
    cells = line.split()
    if (cells[0], "serial") in shown:
        integrator = cells.pop(0)
    row = shown[integrator, cells[0]]
    ms, low, high, speedup = (digits(float(row[column])) for column in ("ms_per_step", "ms_per_step_low", "ms_per_step_high",
                                                                        "speedup_vs_serial"))
    if cells[1:5] != [ms, f"{low}–{high}", "✓", f"{speedup}×"]:
        failures.append(f"docs/bench.md: {integrator}, {cells[0]} should have {ms}, {low}–{high}, {speedup}×: {line}")
if len(lines) != 10:
    failures.append(f"docs/bench.md: the example of {example} has {len(lines)} rows with ✓, not 10")


used = set()
for name, wanted in pages.items():
    before = len(failures)
    with open(name) as file:
        text = re.sub(r"^    (?! ).*$", "", file.read(), flags=re.MULTILINE)
    # tabulate_results_test.sh holds these.
    text = re.sub(r"<!-- (.+), made by scripts/tabulate-results -->.*?<!-- end of \1 -->", "", text, flags=re.DOTALL)
    for lines in [lines for lines in wanted if lines.startswith("| ")]:
        if lines not in text:
            failures.append(f"{name} should have this table:\n{lines}")
        text = text.replace(lines, "")
    text = re.sub(r"\]\([^)]*\)", "]", text)
    text = re.sub(r'\b(src|srcset|media|width)="[^"]*"', "", text)
    text = re.sub(r"(^> |\s)+", " ", text, flags=re.MULTILINE)
    for sentence in [sentence for sentence in wanted if not sentence.startswith("| ")]:
        if sentence not in text:
            failures.append(f"{name} should have: {sentence}")
        text = text.replace(sentence, "")
    text = re.sub(r"`[^`]*`", "", text)
    for phrase in sorted(allowed, key=len, reverse=True):
        if phrase in text:
            used.add(phrase)
            text = text.replace(phrase, "")
    if len(failures) > before:
        continue  # the numbers of what is missing would follow
    for number in re.finditer(r"(?<![\w-])\d[\d.,:]*", text):
        failures.append(f"{name}: {number.group()} follows from nothing: …{text[max(0, number.start() - 60):number.end() + 30]}…")
if not failures:
    failures += [f"no page has the allowed {phrase!r} any longer" for phrase in set(allowed) - used]

for failure in failures:
    print("figures_test:", failure, file=sys.stderr)
sys.exit(1 if failures else 0)
PYTHON
