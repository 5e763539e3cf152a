#!/bin/bash
# What docs/ci.md says of a CI: the steps of action.yml and of the example for GitLab run as a shell runs them, in a repository with a
# backend that becomes slower, with mssim from an archive; and git bisect finds the commit. Arguments: mssim, the source folder, and what
# runs a program that was built (nothing where it runs by itself).
set -euo pipefail
. "$2/tests/support/command_line.sh"
[[ $# -lt 3 || -z $3 ]] || skip "an emulated program measures nothing"
mssim=$(realpath -e -- "$mssim")
build=${mssim%/bin/mssim}
place=$(pwd -P)
mkdir tools mssim-0 runner
export PATH=$place/tools:$PATH GIT_CONFIG_GLOBAL=$place/gitconfig GIT_CONFIG_NOSYSTEM=1
printf '[user]\nname = t\nemail = t@localhost\n[advice]\ndetachedHead = false\n' >"$place/gitconfig"
# It keeps one comment, and its number is 5.
make_program tools/gh <<'END'
place=${0%/tools/gh} last=${!#}
echo "$*" >>"$place/gh"
case " $* " in
  *' --paginate '*) ! head -qn 1 "$place/comment" 2>/dev/null | grep -qxF -- "$MARKER" || echo 5 ;;
  *) cp "${last#body=@}" "$place/comment" ;;
esac
END
make_program tools/apt-get <<<'echo "$*" >>'"$place"'/apt-get'
# shellcheck disable=SC2016 # the stand-in expands it
make_program tools/make <<<'cp mine.in "$1" && chmod +x "$1"'

cmake --install "$build" --prefix mssim-0 >/dev/null
tar -czf mssim.tar.gz mssim-0
# The repository of mssim, as the action and a clone have it.
mkdir action
cp -r "$source"/{action.yml,CMakeLists.txt,scripts} action
git -C action init --quiet --initial-branch main
git -C action add -A
git -C action commit --quiet -m mssim

# The user's repository: on the branch `change`, the third of four commits makes the backend slower.
repository=$place/builds/mine
mkdir -p "$repository"
cd "$repository"
# backend WORD: what mine.in says then
backend() { printf '#!/bin/sh\nexec %q/bin/own_backend %s\n' "$build" "$1" >mine.in; }
commit() { git add -A && git commit --quiet -m "$1"; }
git init --quiet --initial-branch main
printf 'mine\nmssim-comparison\n' >.gitignore
backend right
commit first
git checkout --quiet -b change
echo 1 >notes && commit second
backend slower && commit third
slow=$(git rev-parse HEAD)
echo 2 >notes && commit fourth
git clone --quiet --bare . "$place/origin.git"
git remote add origin "$place/origin.git"
git fetch --quiet origin
brief='--scene cloth2500 --threads 1 --threshold 40 --time-budget 200'

# The action. GitHub runs each step so, and hands on what a step writes to GITHUB_PATH.
cat >"$place/run_action.py" <<'PYTHON'
import json, os, re, subprocess, sys
import yaml

source, place, given = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
action = yaml.safe_load(open(source + "/action.yml"))
inputs = {name: given.get(name, field.get("default", "")) for name, field in action["inputs"].items()}
assert set(given) <= set(inputs), given
assert all(name in given for name, field in action["inputs"].items() if field.get("required")), given
values = {"github.server_url": "https://localhost", "github.action_repository": "a/mssim", "github.token": "secret",
          "github.event_name": "pull_request", "github.event.pull_request.number": "7"}
values |= {"inputs." + name: value for name, value in inputs.items()}
name_of_value = r"(?:inputs|github|steps)\.[a-z_.]+"


def text_of(text):
    return re.sub(r"\$\{\{ (" + name_of_value + r") \}\}", lambda found: values[found[1]], text)


def holds(condition):
    inner = re.fullmatch(r"\$\{\{ (.*) \}\}", condition)[1].replace("!cancelled()", "True").replace("&&", "and")
    return eval(re.sub(name_of_value, lambda found: repr(values[found[0]]), inner))


environment = os.environ | {"GITHUB_ACTION_PATH": source, "GITHUB_BASE_REF": "main", "GITHUB_REPOSITORY": "a/mine",
                            "GITHUB_STEP_SUMMARY": place + "/summary.md", "GITHUB_PATH": place + "/path", "RUNNER_TEMP": place + "/runner",
                            "GITHUB_OUTPUT": place + "/output"}
failed = False
steps = action["runs"]["steps"]
# The comment once more, as a later run does.
for step in steps + [step for step in steps if step["name"].startswith("Comment")]:
    if not holds(step["if"]) if "if" in step else failed:
        continue
    print("step:", step["name"], flush=True)
    if "uses" in step:
        kept = {key: text_of(str(value)) for key, value in step["with"].items()}
        assert step["uses"].startswith("actions/upload-artifact@") and os.path.isdir(kept["path"]), (step, kept)
        assert kept["name"] == kept["path"].replace("/", "-") and kept["overwrite"] == "True", kept
        continue
    assert step["shell"] == "bash" and "${{" not in step["run"], step
    open(place + "/step", "w").write(step["run"])
    open(place + "/output", "w").close()
    own = {key: text_of(value) for key, value in step.get("env", {}).items()}
    code = subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", place + "/step"], env=environment | own).returncode
    if code and not step.get("continue-on-error"):
        print("exit code", code)
        failed = True
    for line in open(place + "/output"):
        name, value = line.rstrip("\n").split("=", 1)
        values[f"steps.{step['id']}.outputs.{name}"] = value
    if os.path.exists(place + "/path"):
        environment["PATH"] = open(place + "/path").read().strip() + ":" + os.environ["PATH"]
sys.exit(failed)
PYTHON
acts() { # CODE JSON
  rm -f "$place"/{path,summary.md,gh}
  exits "$1" /usr/bin/python3 "$place/run_action.py" "$place/action" "$place" "$2"
}
acts 1 '{"archive": "'"$place"'/mssim.tar.gz", "build": "make mine", "folder": "kept/mssim-comparison",
  "options": "--backend ./mine '"$brief"'"}'
# shellcheck disable=SC2016 # the backquotes are Markdown's
grep -q '`mine`.*\*\*slower\*\*' "$place/summary.md" || fail "the summary has no slower row: $(cat "$place/summary.md")"
cmp kept/mssim-comparison/comparison.md "$place/summary.md"
grep -q '"base_samples_ms"' kept/mssim-comparison/comparison.json || fail "the samples are not kept"
issues=repos/a/mine/issues
look="api $issues/7/comments --paginate --jq .[] | select(.body | startswith(env.MARKER)) | .id"
body="--silent --field body=@$place/runner/comment.md"
diff - "$place/gh" <<<"$look
api $issues/7/comments --method POST $body
$look
api $issues/comments/5 --method PATCH $body" || fail "the comment is not made once and then replaced"
diff <(echo '<!-- mssim: kept/mssim-comparison -->' && cat "$place/summary.md") "$place/comment" || fail "the comment is not the table"
[[ -z $(git status --porcelain) ]] || fail "files are left in the repository: $(git status --porcelain)"
# Nothing that failed before the comparison is hidden.
rm -r kept "$place/runner/mssim"
# shellcheck disable=SC2016
make_program "$place/tools/curl" <<<'echo "$*" >"${0%/tools/curl}/curl" && exit 22'
acts 1 '{"comment": "false", "options": "--backend ./mine", "folder": "."}'
rm "$place/tools/curl"
grep -qE ' https://localhost/a/mssim/releases/download/v([0-9.]+)/mssim-\1-linux-[^ ]+\.tar\.gz$' "$place/curl" ||
  fail "not the archive of its release: $(cat "$place/curl")"
[[ ! -e $place/gh && ! -e $place/summary.md ]] || fail "a table is shown of nothing"

# The example for GitLab, with fewer nodes and seconds; and that for GitHub names only inputs that there are.
cat >"$place/gitlab.py" <<'PYTHON'
import sys
import yaml

source, brief = sys.argv[1:]
page = open(source + "/docs/ci.md").read()


def example(heading):
    lines = page.split(heading + "\n", 1)[1].split("\n## ", 1)[0].split("\n")
    return yaml.safe_load("\n".join(line[4:] for line in lines if line.startswith("    ")))


steps = example("## A pull request on GitHub")["jobs"]["speed"]["steps"]
inputs = yaml.safe_load(open(source + "/action.yml"))["inputs"]
assert set(steps[-1]["with"]) <= set(inputs), steps
job = example("## A merge request on GitLab")["speed"]
assert set(job) == {"image", "rules", "variables", "before_script", "script", "artifacts"}, job
assert job["artifacts"]["paths"] == ["mssim-comparison"] and job["artifacts"]["when"] == "always", job
text = "\n".join(job["before_script"] + job["script"])
long = "--scene cloth40k --time-budget 600"
assert long in text, text
print("set -eo pipefail\n" + text.replace(long, brief))
PYTHON
/usr/bin/python3 "$place/gitlab.py" "$source" "$brief" >"$place/gitlab"
mkdir -p ../mssim-{source,installed}/earlier
MSSIM_REPOSITORY=file://$place/action MSSIM_ARCHIVE=file://$place/mssim.tar.gz CI_MERGE_REQUEST_TARGET_BRANCH_NAME=main \
  exits 1 bash "$place/gitlab"
grep -q slower mssim-comparison/comparison.md || fail "the job of GitLab keeps no table"
grep -q 'install.* curl' "$place/apt-get" || fail "the job of GitLab installs nothing"

# Bisecting, with the script of the page.
awk '/^    #!\/bin\/bash/ { inside = 1 } inside && !/^    / { exit } inside { print substr($0, 5) }' "$source/docs/ci.md" |
  sed "s#/path/to/mssim#$place/action#" >"$place/tools/bisect-speed"
chmod +x "$place/tools/bisect-speed"
exits 0 git bisect start change main
# shellcheck disable=SC2086 # the options are words of their own
exits 0 git bisect run bisect-speed main --mssim "$mssim" --build 'make mine' --backend ./mine $brief
[[ $(git rev-parse refs/bisect/bad) == "$slow" ]] || fail "git bisect names another commit than $slow"
exits 125 bisect-speed no-such-revision # git bisect skips what cannot be compared
