# SPDX-License-Identifier: Apache-2.0
"""Pictures in memory, and the CCTV camera chain."""
from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from . import _core, toml

_UNITS = {"Z": "m", "range": "m", "P": "m", "N": "1", "albedo": "1", "object": "number in frame.objects",
          "material": "number in frame.materials", "variance": "(cd/m2)^2"}


class Frame(Mapping[str, np.ndarray]):
    """A picture: layers by channel name, each (rows, columns) float32, row 0 at the top; read-only views.

    R, G, B are radiance in cd/m2, linear Rec. 709; other channels as in the EXR file: "light_sun.R", "Z", "N.X", "object" ...
    """

    def __init__(self, core: Any) -> None:
        self._core = core
        self._layers: dict[str, np.ndarray] = core.layers
        self.report: dict[str, Any] = json.loads(core.report)

    def __getitem__(self, channel: str) -> np.ndarray:
        return self._layers[channel]

    def __iter__(self) -> Iterator[str]:
        return iter(self._layers)

    def __len__(self) -> int:
        return len(self._layers)

    def __repr__(self) -> str:
        return f"<Frame {self.shape[1]} x {self.shape[0]}: {', '.join(self)}>"

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self._core.shape

    def layer(self, name: str = "") -> np.ndarray:
        """(rows, columns, channels) float32, a copy: "" for R, G, B; "light_sun", "N", "albedo" ... for layers."""
        for parts in ("RGB", "XYZ"):
            channels = [f"{name}.{part}" if name else part for part in parts]
            if all(channel in self._layers for channel in channels):
                return np.stack([self._layers[channel] for channel in channels], axis=-1)
        raise KeyError(f"{name!r}; channels are {', '.join(self)}")

    @property
    def rgb(self) -> np.ndarray:
        """(rows, columns, 3) float32, cd/m2, a copy."""
        return self.layer()

    @property
    def luminance(self) -> np.ndarray:
        """(rows, columns) float32, cd/m2: 0.2126 R + 0.7152 G + 0.0722 B."""
        return (self.rgb @ np.array([0.2126, 0.7152, 0.0722])).astype(np.float32)

    def unit(self, channel: str) -> str:
        """A channel's values."""
        return _UNITS.get(channel.split(".")[0], "1" if channel.startswith("Crypto") else "cd/m2")

    colour_space = "linear Rec. 709, white D65; luminance in cd/m2"

    @property
    def header(self) -> dict[str, Any]:
        """The EXR header's data: scene, settings, seed, camera, samples, stated error."""
        return self._core.header

    @property
    def error(self) -> dict[str, Any]:
        """The stated error, relative: "estimate", "bound_95", "wanted", "limit", "parts", "targets", "not_captured"."""
        return self.report.get("error", {})

    @property
    def objects(self) -> list[str]:
        """Object names by number in the layer "object"."""
        return self.report.get("objects", json.loads(self.header.get("earthshine:objects", "[]")))

    @property
    def materials(self) -> list[str]:
        """Material names by number in the layer "material"."""
        return self.report.get("materials", json.loads(self.header.get("earthshine:materials", "[]")))

    def mask(self, name: str) -> np.ndarray:
        """(rows, columns) bool: pixels whose centre shows the object; needs the layer "object"."""
        return self["object"] == self.objects.index(name)

    @property
    def K(self) -> np.ndarray:  # noqa: N802 - the field's name
        """3x3: camera coordinates (x right, y down, z forward) to pixels from the top left corner, centres at +0.5."""
        return self._matrix("earthshine:camera.K", 3)

    @property
    def to_world(self) -> np.ndarray:
        """4x4: camera coordinates in m to the scene's."""
        return self._matrix("earthshine:camera.to_world", 4)

    @property
    def to_camera(self) -> np.ndarray:
        """4x4: the scene's coordinates in m to the camera's; K @ (to_camera @ (X, Y, Z, 1))[:3] is the pixel times the depth."""
        return np.linalg.inv(self.to_world)

    def relight(self, factors: Mapping[str, float | Sequence[float]]) -> Frame:
        """The picture with its light groups multiplied by one or three (R, G, B) factors; needs per_light=True."""
        settings = [f"{group}={','.join(map(toml.number_text, np.atleast_1d(factor)))}" for group, factor in factors.items()]
        frame = Frame(_core.relight(self._core, settings))
        # Error and rays were reported for the original picture only.
        frame.report = {key: self.report[key] for key in ("camera", "groups", "objects", "materials") if key in self.report}
        return frame

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes all layers as OpenEXR, with the same bytes as the command line, or a tone-mapped PNG."""
        _core.write_frame(self._core, os.fspath(path))

    def _matrix(self, name: str, size: int) -> np.ndarray:
        return np.array([float(one) for one in self.header[name].split()]).reshape(size, size)


def open_frame(path: str | os.PathLike[str]) -> Frame:
    """Reads an EXR file of any origin; its channels keep their names."""
    return Frame(_core.read_frame(os.fspath(path)))


class Monitor:
    """The displayed picture of a CCTV camera's monitor."""

    def __init__(self, core: Any) -> None:
        self._core = core
        self.report: dict[str, Any] = json.loads(core.report)

    @property
    def pixels(self) -> np.ndarray:
        """(rows, columns) or (rows, columns, 3) uint8, sRGB."""
        return self._core.pixels

    @property
    def viewed(self) -> dict[str, np.ndarray]:
        """The picture as luminance on the screen, cd/m2: channel Y, or R, G, B."""
        return self._core.viewed

    @property
    def signal(self) -> dict[str, np.ndarray]:
        """The line signal on the sensor's grid, 1 = white."""
        return self._core.signal

    @property
    def twin(self) -> dict[str, np.ndarray]:
        """With twin=True: noise-free picture, mean, variance, SNR, probability of detection, as in `degrade --twin`."""
        return self._core.twin

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a PNG, or an EXR in cd/m2."""
        _core.write_monitor(self._core, os.fspath(path))


def degrade(frame: Frame | np.ndarray | Mapping[str, np.ndarray], camera: str | None = None, *, seed: int = 1, frame_number: int = 0,
            twin: bool = False, target_resels: int = 5, off: Sequence[str] = (), fov_deg: float | None = None,
            before: Monitor | None = None) -> Monitor:
    """Applies a CCTV camera and its monitor to a picture, as `degrade` does.

    frame: a Frame, an array (rows, columns) or (rows, columns, 3) in cd/m2, or channels by name. camera: a built-in one
    ("sit-monochrome"), FILE.toml or FILE.toml:NAME; default: the CCTV of the frame's own camera. frame_number: selects the noise.
    before: the previous frame, for cameras with lag or a slow iris.
    """
    if isinstance(frame, Frame):
        core = frame._core
    else:
        planes = dict(frame) if isinstance(frame, Mapping) else _planes(np.asarray(frame))
        core = _core.frame_of(planes, fov_deg or 0.0)
    request = {"camera": camera, "seed": seed, "frame": frame_number, "twin": twin, "target_resels": target_resels, "off": list(off),
               "fov_deg": fov_deg}
    return Monitor(_core.degrade(core, toml.request_text(request), None if before is None else before._core))


def _planes(array: np.ndarray) -> dict[str, np.ndarray]:
    if array.ndim == 2:
        return {"Y": array}
    if array.ndim == 3 and array.shape[2] == 3:
        return {channel: np.ascontiguousarray(array[:, :, k]) for k, channel in enumerate("RGB")}
    raise ValueError(f"a picture has the shape (rows, columns) or (rows, columns, 3), not {array.shape}")
