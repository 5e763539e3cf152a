"""Writes a wheel of an installed mssim that has its own libraries: TREE VERSION PLATFORM FILE. Times: SOURCE_DATE_EPOCH."""
import base64, hashlib, os, sys, time, zipfile
from pathlib import Path

tree, version, platform, target = sys.argv[1:]
tree, here = Path(tree), Path(__file__).parent
info = f"mssim-{version}.dist-info"
when = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]

# The program finds its data beside itself, so the tree stays as it is. The module for own backends can also be imported.
files = {"mssim_backend.py": tree / "share/mssim/python/mssim_backend.py",
         f"{info}/licenses/LICENSE": tree / "share/doc/mssim/LICENSE"}
files.update({f"mssim/{path.relative_to(tree)}": path for path in tree.rglob("*") if path.is_file()})
# The manual page and completions once more, where man and shells look beside an environment's programs.
files.update({f"mssim-{version}.data/data/{path.relative_to(tree)}": path for folder in ("man", "bash-completion", "fish", "zsh")
              for path in (tree / "share" / folder).rglob("*") if path.is_file()})
# Written with one mode; those of a checkout differ.
texts = {
    "mssim/__init__.py": (here / "wheel_package.py").read_text(encoding="utf-8"),
    f"{info}/METADATA": f"""Metadata-Version: 2.1
Name: mssim
Version: {version}
Summary: Benchmark harness for parallel mass-spring simulation
License: MIT
Requires-Python: >=3.9
Provides-Extra: backends
Requires-Dist: numpy; extra == "backends"
Requires-Dist: h5py; extra == "backends"
""",
    f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: scripts/package\nRoot-Is-Purelib: false\nTag: py3-none-{platform}\n",
    f"{info}/entry_points.txt": "[console_scripts]\nmssim = mssim:main\n"}
contents = {name: (path.read_bytes(), path.stat().st_mode & 0o777) for name, path in files.items()}
contents.update({name: (text.encode(), 0o644) for name, text in texts.items()})


def digest(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()


record = [f"{name},sha256={digest(content)},{len(content)}\n" for name, (content, _) in sorted(contents.items())]
with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
    for name, (content, mode) in [*sorted(contents.items()), (f"{info}/RECORD", ("".join(record + [f"{info}/RECORD,,\n"]).encode(), 0o644))]:
        entry = zipfile.ZipInfo(name, when)
        entry.external_attr, entry.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
        wheel.writestr(entry, content)
