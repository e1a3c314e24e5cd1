"""The schema that editors get: every model of the project is valid, and what is made wrong is refused at its own place.

usage: schema_test.py STEPLAP MODELS
"""
import copy
import json
import pathlib
import random
import subprocess
import sys
import tomllib

import jsonschema

MUTATIONS = 1500


def is_study(path):
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    return "kind" in data or "extends" in data and is_study(path.parent / data["extends"])


def leaves(tree, path=()):
    """Paths of all keys of tables, with what stands there."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield path + (key,), value
            yield from leaves(value, path + (key,))
    elif isinstance(tree, list):
        for i, value in enumerate(tree):
            yield from leaves(value, path + (i,))


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


def deepest(error):
    """Where it is wrong, of alternatives the one that comes furthest."""
    places = [tuple(error.absolute_path)] + [deepest(inner) for inner in error.context]
    return max(places, key=len)


def is_free(path):
    """Names of parameters are whatever a model says."""
    return "parameters" in path[:-1]


def mutate(model, rng):
    """One thing made wrong; its place, and what was done. None: not possible there."""
    path, value = rng.choice(list(leaves(model)))
    parent, key = at(model, path[:-1]), path[-1]
    if is_free(path):
        return None
    way = rng.choice(["misspelt", "flag", "unknown", "words", "kind", "table"])
    if way == "misspelt":
        parent[key + "x"] = parent.pop(key)
        return path[:-1] + (key + "x",), way
    if way == "unknown":
        parent["no_such_field"] = 1.0
        return path[:-1] + ("no_such_field",), way
    if way == "kind" and key == "kind" and path[0] in ("element", "signal"):
        parent[key] = "springy"
        return path, way
    if way == "flag" and isinstance(value, (int, float)) and not isinstance(value, bool):
        parent[key] = True
        return path, way
    if way == "words" and isinstance(value, (int, float)) and not isinstance(value, bool):
        parent[key] = "about three"
        return path, way
    if way == "table" and not isinstance(value, (dict, list)):
        parent[key] = {"no_such_field": 1}
        return path, way
    return None


def main():
    program, models = sys.argv[1], pathlib.Path(sys.argv[2])
    schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True, text=True).stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    study = jsonschema.Draft202012Validator(json.loads(subprocess.run([program, "schema", "--study"], check=True, capture_output=True, text=True).stdout)) \
        if (pathlib.Path(program).parent.parent / "libexec/steplap-study").exists() else None
    good, wrong = [], 0
    for path in sorted(models.rglob("*.toml")):
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        if is_study(path):
            for error in study.iter_errors(data) if study else []:
                wrong += 1
                print(f"{path}: {deepest(error)}: {error.message[:200]}")
            continue
        for error in validator.iter_errors(data):
            wrong += 1
            print(f"{path}: {deepest(error)}: {error.message[:200]}")
        good.append((path, data))
    rng = random.Random(7)
    ways = {}
    while sum(ways.values()) < MUTATIONS:
        path, data = rng.choice(good)
        changed = copy.deepcopy(data)
        done = mutate(changed, rng)
        if not done:
            continue
        place, way = done
        ways[way] = ways.get(way, 0) + 1
        places = [deepest(error) for error in validator.iter_errors(changed)]
        if not any(found[:len(place)] == place for found in places):
            wrong += 1
            print(f"{path}: '{way}' at {place} is not refused there, but at {places[:3]}")
    print(f"{len(good)} models are valid; {sum(ways.values())} changes: {ways}")
    if len(good) < 60 or min(ways.values()) < 20:
        sys.exit("too few models or changes were tried")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
