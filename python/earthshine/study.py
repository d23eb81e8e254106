# SPDX-License-Identifier: Apache-2.0
"""Studies of scenes, with a folder of output files and tables."""
from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _core, toml


class Study:
    """Results of a visibility study: one row per condition, camera and target (docs/visibility.md has the columns)."""

    def __init__(self, folder: str, found: Mapping[str, Any]) -> None:
        self.folder = folder
        self.json: dict[str, Any] = found["study"]
        self.records: np.ndarray = records_of(found["table"])

    def to_pandas(self) -> Any:
        """The records as a pandas.DataFrame, if pandas is installed."""
        import pandas  # noqa: PLC0415 - optional
        return pandas.DataFrame.from_records(self.records)


def records_of(table: str) -> np.ndarray:
    """Comma-separated values as a structured array: numbers as float64 (NaN for empty cells), true and false as bool."""
    head, *rows = csv.reader(io.StringIO(table))
    columns = []
    for cells in zip(*rows) if rows else ([] for _ in head):
        columns.append(_column(list(cells)))
    return np.rec.fromarrays(columns, names=head)


def _column(cells: list[str]) -> np.ndarray:
    filled = {cell for cell in cells if cell}
    if filled and filled <= {"true", "false"} and all(cells):
        return np.array([cell == "true" for cell in cells])
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells]) if filled else np.array(cells, dtype=str)
    except ValueError:
        return np.array(cells, dtype=str)


def _run(folder: str | os.PathLike[str], request: Mapping[str, Any]) -> Study:
    name = os.fspath(folder)
    return Study(name, json.loads(_core.study(toml.request_text({**request, "folder": name}))))


def study(path: str | os.PathLike[str], folder: str | os.PathLike[str], *, seed: int = 1) -> Study:
    """Runs a study file into a folder, as `study run`; continues an interrupted run."""
    return _run(folder, {"kind": "run", "path": os.fspath(path), "seed": seed})


def visibility(path: str | os.PathLike[str], folder: str | os.PathLike[str], *, set: Mapping[str, Any] | Iterable[str] | None = None,  # noqa: A002
               error: float | None = None, cameras: Sequence[str] = (), size: tuple[int, int] | None = None,
               wanted: Sequence[str] = (), seed: int = 1) -> Study:
    """How well each camera of a scene file sees each target, as `study visibility`."""
    return _run(folder, _request("visibility", path, set, error, cameras, size, wanted, seed))


def orbit(path: str | os.PathLike[str], folder: str | os.PathLike[str], *, positions: int = 36,
          set: Mapping[str, Any] | Iterable[str] | None = None, error: float | None = None, cameras: Sequence[str] = (),  # noqa: A002
          size: tuple[int, int] | None = None, wanted: Sequence[str] = (), seed: int = 1) -> Study:
    """Visibility at `positions` along the scene's orbit, as `study orbit`."""
    if positions < 1:
        raise ValueError("positions: 1 or more places along the orbit")
    return _run(folder, {**_request("orbit", path, set, error, cameras, size, wanted, seed), "positions": positions})


def _request(kind: str, path: str | os.PathLike[str], given: Mapping[str, Any] | Iterable[str] | None, error: float | None,
             cameras: Sequence[str], size: tuple[int, int] | None, wanted: Sequence[str], seed: int) -> dict[str, Any]:
    settings = [f"{key}={toml.value_text(value)}" for key, value in toml.settings_of(given).items()]
    return {"kind": kind, "path": os.fspath(path), "set": settings, "error": error, "cameras": list(cameras), "size": size,
            "wanted": list(wanted), "seed": seed}
