# SPDX-License-Identifier: Apache-2.0
"""Converts values to TOML and back."""
from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

NAMED = ("material", "object", "light", "area", "camera", "cctv", "range_sensor", "joint", "track")


def request_text(request: Mapping[str, Any]) -> str:
    """A request to the core as JSON; numpy's numbers and arrays are numbers and lists."""
    def plain(value: Any) -> Any:
        if isinstance(value, (np.generic, np.ndarray)):
            return value.tolist()
        raise TypeError(f"{value!r} is no number, text or list")
    return json.dumps(request, default=plain)


def number_text(value: float) -> str:
    """The shortest text that reads back as the number; integers without a point."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def value_text(value: Any) -> str:
    """A Python value, or a numpy array, as a TOML value on one line."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return number_text(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(one) for one in value) + "]"
    raise TypeError(f"{value!r} is no value of a scene file: a number, a text, true or false, or a list of these")


def settings_of(given: Mapping[str, Any] | Iterable[str] | None) -> dict[str, Any]:
    """Settings by key, from a mapping or from "key=value" texts in --set syntax."""
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return dict(given)
    if isinstance(given, str):
        given = [given]
    settings = {}
    for text in given:
        key, equals, value = text.partition("=")
        if not equals:
            raise ValueError(f"{text!r} is not of the form key=value")
        try:
            settings[key] = tomllib.loads("value = " + value)["value"]
        except tomllib.TOMLDecodeError:
            settings[key] = value
    return settings


def document(tree: Mapping[str, Any]) -> str:
    """Nested mappings as the text of a scene file. Named tables are lists of mappings, or mappings from names to mappings."""
    lines = [f"{key} = {value_text(value)}" for key, value in tree.items()
             if not isinstance(value, Mapping) and key not in NAMED]
    for key, value in tree.items():
        if key in NAMED:
            entries = [{"name": name, **entry} for name, entry in value.items()] if isinstance(value, Mapping) else value
            for entry in entries:
                lines += ["", f"[[{key}]]", *(f"{inner} = {value_text(one)}" for inner, one in entry.items())]
        elif isinstance(value, Mapping):
            lines += ["", f"[{key}]", *(f"{inner} = {value_text(one)}" for inner, one in value.items())]
    return "\n".join(lines) + "\n"
