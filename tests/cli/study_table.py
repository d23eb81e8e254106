# SPDX-License-Identifier: Apache-2.0
"""Converts the results of a study.json, which are a table, to a list of objects and back."""
SHARES = {"lit_by", "light_by", "light_from", "light_by_way_of"}  # objects that are one cell


def cells(entry, path=""):
    for key, value in entry.items():
        if isinstance(value, dict) and key not in SHARES:
            yield from cells(value, f"{path}{key}.")
        else:
            yield path + key, value


def nested(columns, row):
    entry = {}
    for column, cell in zip(columns, row, strict=True):
        *way, key = column.split(".")
        part = entry
        for step in way:
            part = part.setdefault(step, {})
        part[key] = cell

    def without_empty(value):
        if not isinstance(value, dict):
            return value
        value = {key: part if key in SHARES else without_empty(part) for key, part in value.items()}
        return value if any(part is not None for part in value.values()) else None
    return without_empty(entry)


def opened(study):
    """The study with a list of objects as its results."""
    table = study["results"]
    return study | {"results": [nested(table["columns"], row) for row in table["rows"]]}


def closed(study):
    """The study in the form of study.json."""
    if not isinstance(study, dict) or not isinstance(study.get("results"), list):
        return study
    flat = [dict(cells(entry)) for entry in study["results"]]
    columns = list(dict.fromkeys(key for entry in flat for key in entry))
    return study | {"results": {"columns": columns, "rows": [[entry.get(key) for key in columns] for entry in flat]}}
