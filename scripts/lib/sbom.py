"""Writes a list of what mssim's packages hold, as SPDX 2.3: VERSION COMMIT. Reads lines "PACKAGE contained" (its files are in the package) or
"PACKAGE linked" (its headers or static libraries are in the program); facts of a Debian package come from dpkg. Time: SOURCE_DATE_EPOCH."""
import datetime, json, os, re, subprocess, sys

version, commit = sys.argv[1:]
roles = [line.split() for line in sys.stdin]
created = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
fields = ("Version", "Architecture", "source:Package", "source:Version", "binary:Summary")


def identifier(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def package(name):
    form = "\t".join(f"${{{field}}}" for field in fields)
    listed = subprocess.run(["dpkg-query", "-W", "-f", form + "\n", name], check=True, text=True, capture_output=True).stdout
    number, architecture, source, source_number, summary = listed.splitlines()[0].split("\t")
    return {"SPDXID": identifier(name), "name": name, "versionInfo": number, "summary": summary,
            "supplier": "Organization: Debian", "filesAnalyzed": False,
            "downloadLocation": f"https://snapshot.debian.org/package/{source}/{source_number}/",
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
            "licenseComments": f"share/doc/mssim/licences/{name}",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}@{number}?arch={architecture}"}]}


mssim = {"SPDXID": identifier("mssim"), "name": "mssim", "versionInfo": version, "sourceInfo": "commit " + commit,
         "supplier": "Organization: The mssim authors", "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
         "licenseConcluded": "MIT", "licenseDeclared": "MIT", "copyrightText": "NOASSERTION"}
described = {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": mssim["SPDXID"]}
relations = {"contained": "CONTAINS", "linked": "STATIC_LINK"}
json.dump({
    "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"mssim-{version}",
    "documentNamespace": f"https://spdx.org/spdxdocs/mssim-{version}-{commit}",
    "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: scripts/package"]},
    "packages": [mssim] + [package(name) for name, _ in roles],
    "relationships": [described] + [{"spdxElementId": mssim["SPDXID"], "relationshipType": relations[role],
                                     "relatedSpdxElement": identifier(name)} for name, role in roles]}, sys.stdout, indent=1)
print()
