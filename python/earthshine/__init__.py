# SPDX-License-Identifier: Apache-2.0
"""Earthshine: light in a spacecraft's payload bay, from Python.

    import earthshine
    scene = earthshine.load("scenes/library/sts46/night-lamps.toml")
    frame = scene.render("B", error=0.05, layers=["depth", "object"], per_light=True)
    frame["Z"]                      # (rows, columns) float32, m
    dark = frame.relight({"bay-lamps": 0.5})
    shown = earthshine.degrade(frame, seed=7)

A scene stays loaded: each call computes again only what its changes touch. The same scene, settings and seed give the bytes of the
command line. Lengths of outputs are metres, luminances cd/m2, colours linear with Rec. 709 primaries.
"""
from ._core import Error
from ._core import version as __version__
from .frame import Frame, Monitor, degrade, open_frame
from .scene import FormFactors, Scene, Solution, load, load_dict
from .study import Study, orbit, study, visibility

__all__ = ["Error", "FormFactors", "Frame", "Monitor", "Scene", "Solution", "Study", "__version__", "degrade", "load", "load_dict",
           "open_frame", "orbit", "study", "visibility"]
