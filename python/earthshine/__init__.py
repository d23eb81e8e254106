# SPDX-License-Identifier: Apache-2.0
"""Earthshine: light in a spacecraft's payload bay, from Python.

    import earthshine
    scene = earthshine.load("scenes/library/sts46/night-lamps.toml")
    frame = scene.render("B", error=0.05, layers=["depth", "object"], per_light=True)
    frame["Z"]                      # (rows, columns) float32, m
    dark = frame.relight({"bay-lamps": 0.5})
    shown = earthshine.degrade(frame, seed=7)

A scene stays loaded: each call recomputes only what its changes affect. The same scene, settings and seed give the same
bytes as the command line. Lengths are in metres, luminances in cd/m2, colours linear with Rec. 709 primaries.
"""
from ._core import Error
from ._core import version as __version__
from .frame import Frame, Monitor, degrade, open_frame
from .scene import FormFactors, Scene, Solution, load, load_dict
from .study import Study, orbit, study, visibility

__all__ = ["Error", "FormFactors", "Frame", "Monitor", "Scene", "Solution", "Study", "__version__", "degrade", "load", "load_dict",
           "open_frame", "orbit", "study", "visibility"]
