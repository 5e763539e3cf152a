#!/usr/bin/python3
"""check_json.py SCHEMA[#DEFINITION] FILE... [--lines] [--optional KEY,...] [--maps KEY,...] [--wrong PATH=VALUE...] [--right PATH[=VALUE]...]

The JSON in each FILE is valid by the schema, and damaged JSON is not: without a member, with an additional one, or with a value of another
type. With --lines each line is a document. --optional names members that may be missing, --maps those whose own members have any name.
--wrong names values of the right type that are not valid, as JSON, and --right such as are, or members without which a document is. By
Debian's own interpreter, for which python3-jsonschema gets installed.
"""
import argparse
import copy
import json
import pathlib
import sys

import jsonschema


def other_type(value):
    """A value of a type that no schema allows in place of this one."""
    if isinstance(value, bool):
        return 7
    return [] if isinstance(value, dict) else True if isinstance(value, (str, int, float)) else {}


def shortened(value):
    """The same with at most three elements in each list, as points have, because every value is damaged on its own."""
    if isinstance(value, list):
        return [shortened(element) for element in value[:3]]
    return {key: shortened(member) for key, member in value.items()} if isinstance(value, dict) else value


def damages(value, arguments, path=()):
    """Each way to damage a document: the path to a value, and its damage."""
    def with_change(change):
        changed = copy.copy(value)
        change(changed)
        return changed

    if path:
        yield path, other_type(value)
    if isinstance(value, dict):
        if not path or path[-1] not in arguments.maps:
            yield path, with_change(lambda changed: changed.update(surprise=1))
            for key in value.keys() - arguments.optional:
                yield path, with_change(lambda changed, key=key: changed.pop(key))
    for key, member in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from damages(member, arguments, (*path, key))


def path_of(text):
    """"rows/0/ratio": the keys and indices on the way to a value."""
    return tuple(int(word) if word.isdigit() else word for word in text.split("/"))


REMOVED = object()


def damaged(document, path, damage):
    """The document with that damage, which may be a member that it had not, or one that is REMOVED."""
    if not path:
        return damage
    changed = copy.copy(document)
    changed[path[0]] = damaged(changed[path[0]], path[1:], damage) if len(path) > 1 else damage
    if changed[path[0]] is REMOVED:
        del changed[path[0]]
    return changed


def changes(texts):
    """PATH=VALUE or PATH: the path, and the value or REMOVED."""
    return [(path_of(path), json.loads(value) if value else REMOVED) for path, _, value in (text.partition("=") for text in texts)]


def problems_of(document, validator, arguments):
    """What is wrong with the document, or with a schema that takes a damaged one."""
    if not document:
        yield "holds nothing"
    for error in validator.iter_errors(document):
        yield f"{error.json_path}: {error.message[:300]}"
    small = shortened(document)
    for place, damage in [*damages(small, arguments), *changes(arguments.wrong)]:
        if validator.is_valid(damaged(small, place, damage)):
            yield f"/{'/'.join(map(str, place))} may be {json.dumps(damage)[:300]}"
    for place, value in changes(arguments.right):
        if not validator.is_valid(damaged(small, place, value)):
            yield f"/{'/'.join(map(str, place))} may not be {'left out' if value is REMOVED else json.dumps(value)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("schema")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--lines", action="store_true")
    for name in ("optional", "maps"):
        parser.add_argument(f"--{name}", type=lambda words: set(words.split(",")), default=set())
    for name in ("wrong", "right"):
        parser.add_argument(f"--{name}", nargs="+", action="extend", default=[])
    arguments = parser.parse_args()
    path, _, definition = arguments.schema.partition("#")
    schema = json.loads(pathlib.Path(path).read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    resolver = jsonschema.RefResolver(pathlib.Path(path).resolve().as_uri(), schema)
    if definition:
        schema = {"$ref": f"#/definitions/{definition}"}
    validator = jsonschema.Draft7Validator(schema, resolver=resolver)

    problems = [f"{file} by {arguments.schema}: {problem}" for file in arguments.files
                for text in [pathlib.Path(file).read_text()] for document in (text.splitlines() if arguments.lines else [text])
                for problem in problems_of(json.loads(document), validator, arguments)]
    sys.exit("\n".join(problems) or 0)


if __name__ == "__main__":
    main()
