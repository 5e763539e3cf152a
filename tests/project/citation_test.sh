#!/bin/bash
# CITATION.cff has the form of the Citation File Format 1.2.0, as far as it uses it, and agrees with CMakeLists.txt, LICENSE and the pages
# that name the papers. Arguments: mssim (unused), the source folder.
set -euo pipefail
cd -- "$2"

# Debian's own interpreter, whose packages are the ones that get installed.
/usr/bin/python3 - <<'PYTHON'
import copy, re, sys
import jsonschema, yaml

text = {"type": "string", "minLength": 1}
authors = {"type": "array", "minItems": 1, "items": {"type": "object", "minProperties": 1, "additionalProperties": False, "properties": {
    "name": text, "family-names": text, "given-names": text}}}
doi = {"type": "string", "pattern": r"^10\.\d{4,9}/\S+$"}
schema = {"type": "object", "additionalProperties": False,
          "required": ["cff-version", "message", "title", "authors", "version", "license"],
          "properties": {
              "cff-version": {"const": "1.2.0"}, "message": text, "title": text, "type": {"const": "software"}, "version": text,
              "license": text, "authors": authors, "abstract": text, "keywords": {"type": "array", "items": text},
              "references": {"type": "array", "minItems": 2, "items": {
                  "type": "object", "additionalProperties": False, "required": ["type", "title", "authors"], "properties": {
                      "type": {"enum": ["article", "generic"]}, "title": text, "authors": authors, "journal": text,
                      "volume": {"type": "integer"}, "number": text, "year": {"type": "integer"}, "doi": doi,
                      "institution": {"type": "object", "required": ["name"], "additionalProperties": False, "properties": {"name": text}}}}}}}
validator = jsonschema.Draft7Validator(schema)


def read(name):
    with open(name) as file:
        return file.read()


def faults(citation):
    found = [f"{error.json_path}: {error.message}" for error in validator.iter_errors(citation)]
    if found:
        return found
    if f"project(mssim VERSION {citation['version']} " not in read("CMakeLists.txt"):
        found.append(f"version: {citation['version']} is not that of CMakeLists.txt")
    if not read("LICENSE").startswith(citation["license"] + " License"):
        found.append(f"license: {citation['license']} is not that of LICENSE")
    if citation["authors"][0].get("name", "-") not in read("LICENSE"):
        found.append(f"authors: {citation['authors'][0]} are not those of LICENSE")
    for page in ("README.md", "docs/papers.md"):
        words = " ".join(read(page).split())
        linked = re.findall(r"https://doi\.org/([^)]+)\)", words)
        cited = [reference["doi"] for reference in citation["references"] if "doi" in reference]
        if linked != cited:
            found.append(f"references: {page} links {linked}, not {cited}")
        found += [f"references: {page} does not name {reference['title']}" for reference in citation["references"]
                  if reference["title"] not in words]
    return found


citation = yaml.safe_load(read("CITATION.cff"))
failures = faults(citation)
for key, value in {"version": "0.0.9", "license": "BSD", "cff-version": "1.1.0", "authors": [], "year": 2026, "references": []}.items():
    changed = copy.deepcopy(citation)
    changed[key] = value
    if not faults(changed):
        failures.append(f"{key} set to {value!r} is accepted")
changed = copy.deepcopy(citation)
changed["references"][0]["doi"] = "10.1186/s13673-016-0079-8"
if not faults(changed):
    failures.append("another DOI is accepted")
for failure in failures:
    print("citation_test: CITATION.cff:", failure, file=sys.stderr)
sys.exit(1 if failures else 0)
PYTHON
