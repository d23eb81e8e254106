# SPDX-License-Identifier: Apache-2.0
"""Scenes that stay loaded, their parts, solutions and pictures."""
from __future__ import annotations

import json
import os
import pathlib
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core, toml
from .frame import Frame

_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
# Keys of cameras and lights that the core returns in metres.
_LENGTHS = {"position": "position_m", "look_at": "look_at_m"}


class Entry:
    """One table of the scene: a camera, light, material, object, or [sun], [earth], [orbit], [quality].

    Its attributes are the keys of docs/scene-format.md, in the file's units: reading returns the present value, setting is like
    --set. An invalid value raises Error in the next call, and the scene stays as it was.
    """

    def __init__(self, scene: Scene, table: str, name: str | None = None) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_path", table if name is None else f"{table}.{name}")
        object.__setattr__(self, "_table", table)
        object.__setattr__(self, "name", name)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        value = self._scene._value(self._table, self.name, key)
        if value is None:
            raise AttributeError(f"{self._path} has no {key!r}")
        return np.array(value, dtype=float) if isinstance(value, list) and value and not isinstance(value[0], str) else value

    def __setattr__(self, key: str, value: Any) -> None:
        if isinstance(getattr(type(self), key, None), property):
            object.__setattr__(self, key, value)
        else:
            self._scene.set(f"{self._path}.{key}", value)

    def __repr__(self) -> str:
        return f"<{self._path}>"

    @property
    def info(self) -> dict[str, Any]:
        """The interpreted table, lengths in metres."""
        return self._scene._described(self._table, self.name)


class Camera(Entry):
    """A [[camera]]: position, look_at, up, fov_deg (vertical, full) or K, distortion, fisheye, resolution (columns, rows), focus and aperture (m), exposure_s and line_s (rolling shutter), velocity (m/s), spin (degrees/s), cctv ..."""

    @property
    def to_world(self) -> np.ndarray:
        """4x4: (x right, y down, z forward, 1) in metres to the scene, with OpenCV's axes. Settable."""
        return np.array(self.info["to_world"]).reshape(4, 4)

    @to_world.setter
    def to_world(self, matrix: Any) -> None:
        matrix = _rigid(matrix)
        if self._scene._value("camera", self.name, "joint"):
            raise ValueError(f"to_world: camera {self.name!r} is on a joint; set position, look_at and up in the joint's axes")
        unit = self._scene.unit_m
        ahead = np.linalg.norm(np.subtract(self.info["look_at_m"], self.info["position_m"]))
        self.position = matrix[:3, 3] / unit
        self.look_at = (matrix[:3, 3] + ahead * matrix[:3, 2]) / unit
        self.up = -matrix[:3, 1]

    @property
    def to_world_gl(self) -> np.ndarray:
        """4x4 like to_world, with the axes of OpenGL and Blender: x right, y up, z backward. Settable."""
        return self.to_world @ np.diag([1.0, -1.0, -1.0, 1.0])

    @to_world_gl.setter
    def to_world_gl(self, matrix: Any) -> None:
        self.to_world = np.asarray(matrix, dtype=float) @ np.diag([1.0, -1.0, -1.0, 1.0])

    @property
    def K(self) -> np.ndarray:  # noqa: N802 - the field's name
        """3x3 in pixels of `resolution`, the centre of the top left pixel at (0.5, 0.5): OpenCV's has cx and cy less 0.5.
        Settable; it replaces fov_deg of the scene file."""
        return np.array(self.info["K"]).reshape(3, 3)

    @K.setter
    def K(self, matrix: Any) -> None:  # noqa: N802 - the field's name
        self._scene.set(f"{self._path}.pixel_origin", "corner")
        self._scene.set(f"{self._path}.K", np.asarray(matrix, dtype=float).tolist())


class Body(Entry):
    """An [[object]]: translate, rotate (degrees about x, then y, then z), scale, material, target, velocity (m/s), spin (degrees/s) ..."""

    @property
    def pose(self) -> np.ndarray:
        """4x4, metres: the mesh's own coordinates to the scene (of an object on a joint, to the joint's axes). Settable: rotation, scales along the mesh's axes, translation."""
        unit = self._scene.unit_m
        scale = np.broadcast_to(np.asarray(self._known("scale", 1.0), dtype=float), 3)
        matrix = np.eye(4)
        matrix[:3, :3] = _turn(np.asarray(self._known("rotate", [0.0, 0.0, 0.0]), dtype=float)) * scale
        matrix[:3, 3] = unit * np.asarray(self._known("translate", [0.0, 0.0, 0.0]), dtype=float)
        return matrix

    @pose.setter
    def pose(self, matrix: Any) -> None:
        matrix = _affine(matrix)
        scale = np.linalg.norm(matrix[:3, :3], axis=0)
        turn = matrix[:3, :3] / scale
        if not np.allclose(turn.T @ turn, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0:
            raise ValueError("pose: a turn, scales above 0 along the mesh's axes and a shift; no shear, no mirror image")
        before = np.broadcast_to(np.asarray(self._known("scale", 1.0), dtype=float), 3)
        self.rotate = _angles(turn)
        self.translate = matrix[:3, 3] / self._scene.unit_m
        if not np.allclose(scale, before, rtol=1e-9):
            self.scale = scale

    def _known(self, key: str, otherwise: Any) -> Any:
        value = self._scene._value("object", self.name, key)
        return otherwise if value is None else value


def _turn(degrees: np.ndarray) -> np.ndarray:
    """R_z R_y R_x."""
    x, y, z = np.radians(degrees)
    cx, sx, cy, sy, cz, sz = np.cos(x), np.sin(x), np.cos(y), np.sin(y), np.cos(z), np.sin(z)
    return (np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]) @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
            @ np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]]))


def _angles(turn: np.ndarray) -> np.ndarray:
    """Degrees about x, y and z that give the rotation matrix: the inverse of _turn."""
    y = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    if abs(turn[2, 0]) < 1 - 1e-12:
        return np.degrees([np.arctan2(turn[2, 1], turn[2, 2]), y, np.arctan2(turn[1, 0], turn[0, 0])])
    # Gimbal lock: x and z rotate about the same axis.
    return np.degrees([np.arctan2(-turn[1, 2], turn[1, 1]), y, 0.0])


def _affine(matrix: Any) -> np.ndarray:
    matrix = np.asarray(matrix, dtype=float)
    if matrix.shape != (4, 4) or not np.allclose(matrix[3], [0, 0, 0, 1]):
        raise ValueError("a pose is a 4x4 matrix whose last row is 0 0 0 1")
    return matrix


def _rigid(matrix: Any) -> np.ndarray:
    matrix = _affine(matrix)
    turn = matrix[:3, :3]
    if not np.allclose(turn.T @ turn, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0:
        raise ValueError("a camera's pose is a turn and a shift")
    return matrix


class Entries(Mapping[str, Any]):
    """The tables of one kind by name, in scene order."""

    def __init__(self, scene: Scene, table: str, kind: type[Entry]) -> None:
        self._scene, self._table, self._kind = scene, table, kind

    def __getitem__(self, name: str) -> Any:
        if name not in self._names():
            raise KeyError(f"{name!r}; there are {', '.join(self._names())}")
        return self._kind(self._scene, self._table, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def _names(self) -> list[str]:
        return [one["name"] for one in self._scene.description[self._table + "s"]]


@dataclass(frozen=True)
class FormFactors:
    """F[i, j]: share of diffuse light from object i, uniform over it, that arrives at object j; no unit."""

    objects: list[str]
    F: np.ndarray  # (n, n)
    std_error: np.ndarray  # (n, n)
    sky: np.ndarray  # (n,): share to the sky
    black: np.ndarray  # (n,): share absorbed by black backs
    area_m2: np.ndarray  # (n,)
    report: dict[str, Any]


class Solution:
    """The radiosity of a scene, one row per patch; arrays are read-only."""

    def __init__(self, scene: Scene, core: Any) -> None:
        self._scene, self._core = scene, core
        self.report: dict[str, Any] = json.loads(core.report)
        self.error: dict[str, Any] = self.report["error"]
        self.groups: list[str] = core.groups

    @property
    def radiosity(self) -> np.ndarray:
        """(patches, groups, 3) float32, lm/m2: reflected light and exitance carried by form factors."""
        return self._core.radiosity

    @property
    def direct(self) -> np.ndarray:
        """(patches, groups, 3) float32, lx: direct illuminance from lamps, Sun and Earth."""
        return self._core.direct

    @property
    def indirect(self) -> np.ndarray:
        """(patches, groups, 3) float32, lx: indirect illuminance."""
        return self._core.indirect

    @property
    def area(self) -> np.ndarray:
        """(patches,) float64, m2."""
        return self._core.area

    @property
    def centre(self) -> np.ndarray:
        """(patches, 3) float64, m."""
        return self._core.centre

    @property
    def normal(self) -> np.ndarray:
        """(patches, 3) float64, unit, on the patch's side."""
        return self._core.normal

    @property
    def object(self) -> np.ndarray:
        """(patches,) uint32, index in scene.objects."""
        return self._core.object

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the HDF5 file of `solve -o`."""
        self._scene._sync().write_light(self._core, os.fspath(path))


class Scene:
    """A scene that stays loaded; made by load() and load_dict()."""

    def __init__(self, path: str, text: str | None, tree: Mapping[str, Any], settings: Mapping[str, Any]) -> None:
        self._core = _core.Session(path, text)
        self._tree = tree
        self._settings = dict(settings)
        self._good: dict[str, Any] = {}
        self._description: dict[str, Any] | None = None
        self.path = path
        self.threads = 0  # per call; 0: all cores. Results do not depend on it.
        self._sync()

    # Contents.

    @property
    def description(self) -> dict[str, Any]:
        """The scene as read: cameras, lights, materials, objects with bounds (m), light groups, warnings."""
        self._sync()
        if self._description is None:
            self._description = json.loads(self._core.describe())
        return self._description

    @property
    def unit_m(self) -> float:
        """Metres per `unit` of the scene."""
        return _METRES[self._settings.get("unit", self._tree.get("unit", "m"))]

    @property
    def warnings(self) -> list[str]:
        """Likely mistakes in the input, and repairs."""
        return self.description["warnings"]

    @property
    def light_groups(self) -> list[str]:
        """Names of the active light groups, for frame.relight."""
        return self.description["light_groups"]

    @property
    def cameras(self) -> Mapping[str, Camera]:
        """[[camera]] by name."""
        return Entries(self, "camera", Camera)

    @property
    def lights(self) -> Mapping[str, Entry]:
        """[[light]] by name."""
        return Entries(self, "light", Entry)

    @property
    def materials(self) -> Mapping[str, Entry]:
        """[[material]] by name, followed by materials of mesh files."""
        return Entries(self, "material", Entry)

    @property
    def objects(self) -> Mapping[str, Body]:
        """[[object]] by name."""
        return Entries(self, "object", Body)

    @property
    def sun(self) -> Entry:
        """[sun]: direction (toward the Sun), illuminance (lx), angular_radius_deg."""
        return Entry(self, "sun")

    @property
    def earth(self) -> Entry:
        """[earth]: direction (toward its centre), altitude_km, albedo ..."""
        return Entry(self, "earth")

    @property
    def orbit(self) -> Entry:
        """[orbit]: altitude_km, beta_deg, position_deg, attitude ..."""
        return Entry(self, "orbit")

    @property
    def quality(self) -> Entry:
        """[quality]: error, gather_rays, patch_edge ..."""
        return Entry(self, "quality")

    # Changes.

    def set(self, key: str, value: Any) -> None:
        """Changes a key as --set does: set("camera.B.fov_deg", 30)."""
        toml.value_text(value)  # raises for values without a TOML form
        self._settings.pop(key, None)
        self._settings[key] = value
        self._description = None

    @property
    def settings(self) -> list[str]:
        """All changes in --set syntax: with them the command line gives the same bytes."""
        return [f"{key}={toml.value_text(value)}" for key, value in self._settings.items()]

    # Work.

    def render(self, camera: str | None = None, *, error: float | None = None, size: tuple[int, int] | None = None,
               layers: Sequence[str] = (), per_light: bool = False, seed: int = 1, solution: Solution | None = None,
               state_error: bool = True, time_limit: float | None = None, crop: tuple[int, int, int, int] | None = None,
               indirect: str = "radiosity", caustics: bool = True, distributed_lights: int | None = None,
               distributed_over: str | None = None, all_effects: bool = False) -> Frame:
        """Renders one camera (default: the first), as `render` does with the options of the same names.

        error: wanted relative error; default: the scene's, else 5 %. size: (columns, rows). layers: "depth", "normal", "object" ...
        per_light: a layer per light group, for relight(). solution: from solve(), instead of the scene's own solve, with the
        samples of [quality]. crop: (x, y, columns, rows). state_error=False: --no-error. time_limit: s.
        """
        request = {"cameras": [] if camera is None else [camera], "error": error, "size": size, "layers": list(layers),
                   "per_light": per_light, "seed": seed, "no_error": not state_error, "time_limit": time_limit, "crop": crop,
                   "indirect": indirect, "no_caustics": not caustics, "distributed_lights": distributed_lights,
                   "distributed_over": distributed_over, "all_effects": all_effects}
        core = self._sync()
        return Frame(core.render(self._request(request), None if solution is None else solution._core))

    def solve(self, *, error: float | None = None, seed: int = 1, time_limit: float | None = None) -> Solution:
        """Solves the radiosity alone, as `solve` does. error: wanted over the surfaces, relative; time_limit: s."""
        core = self._sync()
        return Solution(self, core.solve(self._request({"error": error, "seed": seed, "time_limit": time_limit})))

    def plan(self, cameras: str | Sequence[str] = (), *, error: float | None = None, size: tuple[int, int] | None = None,
             layers: Sequence[str] = (), per_light: bool = False, seed: int = 1, indirect: str = "radiosity",
             cctv: bool = False, ranks: int = 0) -> dict[str, Any]:
        """Predicts which effects will run and why, and the rays, seconds and MiB: the report of `plan --json`."""
        request = {"cameras": [cameras] if isinstance(cameras, str) else list(cameras), "error": error, "size": size,
                   "layers": list(layers), "per_light": per_light, "seed": seed, "indirect": indirect, "cctv": cctv, "ranks": ranks}
        return json.loads(self._sync().plan(self._request(request)))

    def form_factors(self, method: str = "auto", *, raw: bool = False, seed: int = 1) -> FormFactors:
        """Form factors between objects. method: "rays", "exact" (analytic), or "auto": exact if it is fast."""
        found = json.loads(self._sync().form_factors(self._request({"method": method, "raw": raw, "seed": seed})))
        arrays = {key: np.array(found.pop(key)) for key in ("F", "std_error", "sky", "black", "area_m2")}
        return FormFactors(objects=found.pop("objects"), report=found, **arrays)

    @property
    def work(self) -> dict[str, int]:
        """Counts of scene reads, ray structures, solves and pictures."""
        return json.loads(self._core.work())

    # Internal.

    def _request(self, request: Mapping[str, Any]) -> str:
        return toml.request_text({**request, "threads": self.threads})

    def _sync(self) -> Any:
        """The core with all changes read. If a change is rejected, the changes since the last call are undone."""
        if self._description is None:
            self._core.set(self.settings)
            try:
                self._description = json.loads(self._core.describe())
            except _core.Error:
                self._settings = dict(self._good)
                self._core.set(self.settings)
                raise
            self._good = dict(self._settings)
        return self._core

    def _described(self, table: str, name: str | None) -> dict[str, Any]:
        if name is None:
            return self.description.get(table, {})
        return next((one for one in self.description[table + "s"] if one["name"] == name), {})

    def _value(self, table: str, name: str | None, key: str) -> Any:
        setting = f"{table}.{key}" if name is None else f"{table}.{name}.{key}"
        if setting in self._settings:
            value = self._settings[setting]
            return value.tolist() if isinstance(value, np.ndarray) else list(value) if isinstance(value, tuple) else value
        written = self._tree.get(table, {})
        if name is not None:
            written = next((one for one in written if one.get("name") == name), {}) if isinstance(written, list) else written.get(name, {})
        if key in written:
            return written[key]
        known = self._described(table, name)
        if key in _LENGTHS and _LENGTHS[key] in known:
            return [one / self.unit_m for one in known[_LENGTHS[key]]]
        return known.get(key)


def load(path: str | os.PathLike[str], set: Mapping[str, Any] | Iterable[str] | None = None) -> Scene:  # noqa: A002
    """Loads a scene file. set: changes by key, {"camera.B.fov_deg": 30}, or in --set syntax, ["camera.B.fov_deg=30"]."""
    name = os.fspath(path)
    try:
        tree = tomllib.loads(pathlib.Path(name).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        tree = {}  # the core reports the error with its line
    return Scene(name, None, tree, toml.settings_of(set))


def load_dict(tree: Mapping[str, Any], folder: str | os.PathLike[str] = ".", set: Mapping[str, Any] | Iterable[str] | None = None) -> Scene:  # noqa: A002
    """A scene from nested mappings with the keys of the scene file.

    Named tables are lists of mappings, or mappings by name: {"camera": {"A": {"position": ...}}}. Meshes are relative to `folder`.
    """
    tree = {"format": 1, **tree}
    return Scene(os.path.join(os.fspath(folder), "scene"), toml.document(tree), tree, toml.settings_of(set))
