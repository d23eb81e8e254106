# SPDX-License-Identifier: Apache-2.0
"""Scenes for the validation of stated errors: shipped ones, and random rooms."""
import math
import pathlib
import random

LIBRARY = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "library"

# A luminaire with a beam of 60 degrees.
IES = """IESNA:LM-63-2002
[LUMINAIRE] flood
TILT=NONE
1 1000 1 4 1 1 2 0.1 0.1 0
1 1 50
0 30 60 90
0
400 300 80 0
"""


class Text:
    """A scene file to which tables are appended."""

    def __init__(self, name):
        self.lines = ["format = 1", f'name = "{name}"', 'unit = "m"']
        self.names = 0

    def table(self, head, **keys):
        self.lines += ["", head]
        for key, value in keys.items():
            if isinstance(value, str):
                shown = f'"{value}"'
            elif isinstance(value, bool):
                shown = str(value).lower()
            else:
                shown = numbers(value)
            self.lines.append(f"{key} = {shown}")

    def material(self, **keys):
        self.names += 1
        self.table("[[material]]", name=f"m{self.names}", **keys)
        return f"m{self.names}"

    def thing(self, material, **keys):
        self.names += 1
        self.table("[[object]]", name=f"o{self.names}", material=material, **keys)

    def light(self, **keys):
        self.names += 1
        self.table("[[light]]", name=f"l{self.names}", **keys)

    def __str__(self):
        return "\n".join(self.lines) + "\n"


def numbers(value):
    """A number, point or list of points as TOML."""
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(numbers(v) for v in value) + "]"
    return f"{value:.6g}"


def wall(axis, at, low, high, turned):
    """A rectangle across an axis; its front is toward +axis, or -axis if turned."""
    u, v = [(1, 2), (2, 0), (0, 1)][axis]
    corners = []
    for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
        p = [0.0, 0.0, 0.0]
        p[axis], p[u], p[v] = at, (low[u], high[u])[s], (low[v], high[v])[t]
        corners.append(p)
    return corners[::-1] if turned else corners


class Room:
    """A room, closed or with an opening in its ceiling, and its contents."""

    def __init__(self, number):
        self.chance = random.Random(1000 + number).random  # equal for every version of Python
        self.number = number
        self.text = Text(f"room {number}")
        self.size = [self.between(2.5, 6), self.between(2.5, 6), self.between(2.2, 4)]

    def between(self, low, high):
        return low + (high - low) * self.chance()

    def grey(self, low=0.05, high=0.9):
        """A reflectance, sometimes coloured."""
        if self.chance() < 0.6:
            return self.between(low, high)
        return [self.between(low, high) for _ in range(3)]

    def walls(self, opening):
        """opening: "" (closed), "window" (a hole in the ceiling) or "open" (no ceiling)."""
        sx, sy, sz = self.size
        zero = [0.0, 0.0, 0.0]
        paints = [self.text.material(diffuse=self.grey()) for _ in range(3)]
        for axis in range(3):
            for side in range(2):
                if axis == 2 and side == 1:
                    continue
                self.text.thing(paints[axis], shape="quad",
                                corners=wall(axis, side * self.size[axis], zero, self.size, side == 1))
        if opening == "":
            self.text.thing(paints[2], shape="quad", corners=wall(2, sz, zero, self.size, True))
        if opening == "window":
            x0, y0 = sx * self.between(0.25, 0.45), sy * self.between(0.25, 0.45)
            x1, y1 = x0 + sx * self.between(0.1, 0.3), y0 + sy * self.between(0.1, 0.3)
            for low, high in (((0, 0), (x0, sy)), ((x1, 0), (sx, sy)), ((x0, 0), (x1, y0)), ((x0, y1), (x1, sy))):
                self.text.thing(paints[2], shape="quad", corners=wall(2, sz, [*low, 0], [*high, 0], True))

    def bodies(self, count, finish):
        """finish: additional keys of the first body's material."""
        sx, sy, sz = self.size
        for k in range(count):
            paint = self.text.material(**({"diffuse": self.grey()} | (finish if k == 0 else {})))
            x, y = sx * self.between(0.35, 0.75), sy * self.between(0.35, 0.75)
            r = min(sx, sy) * self.between(0.06, 0.16)
            z = 0.0 if self.chance() < 0.5 else sz * self.between(0.1, 0.4)
            kind = int(4 * self.chance())
            if kind == 0:
                self.text.thing(paint, shape="box", min=[x - r, y - r * 0.7, z], max=[x + r, y + r * 0.7, z + 2 * r])
            elif kind == 1:
                self.text.thing(paint, shape="sphere", center=[x, y, z + 1.05 * r], radius=r, segments=16)
            elif kind == 2:
                self.text.thing(paint, shape="cylinder", **{"from": [x, y, z + 0.01], "to": [x + r, y, z + 2.5 * r]},
                                radius=r / 2, segments=12)
            else:
                sheet = self.text.material(diffuse=self.grey(), two_sided=True)
                self.text.thing(sheet, shape="quad", corners=[[x - r, y - r, z + r], [x + r, y - r, z + r],
                                                              [x + r, y + r, z + 1.6 * r], [x - r, y + r, z + 1.6 * r]])

    def place(self):
        """Position of a lamp: below the ceiling, away from the picture's centre."""
        return [self.size[0] * self.between(0.3, 0.9), self.size[1] * self.between(0.3, 0.9),
                self.size[2] * self.between(0.88, 0.96)]

    def lamp(self, kind):
        at, flux = self.place(), self.between(500, 3000)
        below = [at[0] + self.between(-1, 1), at[1] + self.between(-1, 1), 0.0]
        u, v = self.between(0.1, 0.6), self.between(0.1, 0.6)
        if kind == "point":
            self.text.light(type=kind, position=at, flux=flux)
        elif kind == "spot":
            self.text.light(type=kind, position=at, aim=below, beam_deg=30.0, field_deg=70.0, flux=flux)
        elif kind == "rectangle":
            self.text.light(type=kind, center=at, edge_u=[u, 0, 0], edge_v=[0, -v, 0], flux=flux)
        elif kind == "disk":
            self.text.light(type=kind, center=at, normal=[0, 0, -1], radius=u / 2, flux=flux)
        elif kind == "ies":
            self.text.light(type=kind, file="flood.ies", position=at, aim=below)
        elif kind in ("small emitter", "wide emitter"):
            # Emitters below 5 % of the surface get shadow rays; form factors carry the light of
            # larger ones.
            share = 0.004 if kind == "small emitter" else 0.08
            paint = self.text.material(diffuse=0.3, emit=1000.0)
            sx, sy, sz = self.size
            edge = math.sqrt(share * 2 * (sx * sy + sy * sz + sz * sx))
            self.text.thing(paint, shape="quad", corners=wall(
                2, 0.97 * sz, [0.9 * sx - edge, 0.9 * sy - edge, 0], [0.9 * sx, 0.9 * sy, 0], True))

    def sky(self, kind):
        if kind in ("sun", "wide sun", "sun and earth"):
            self.text.table("[sun]", direction=[self.between(-0.4, 0.4), self.between(-0.4, 0.4), 1.0],
                            illuminance=20000.0, angular_radius_deg=4.0 if kind == "wide sun" else 0.2666)
        if kind == "earth":
            self.text.table("[earth]", direction=[self.between(-0.5, 0.5), 0.2, 1.0], model="uniform",
                            radiance=1500.0, half_angle_deg=self.between(10, 65))
        if kind == "sun and earth":
            self.text.table("[earth]", direction=[0.4, 0.2, 1.0], altitude_km=425.0)

    def camera(self):
        at = [s * self.between(0.06, 0.12) for s in self.size[:2]] + [self.size[2] * self.between(0.3, 0.8)]
        self.text.table("[[camera]]", name="A", position=at, fov_deg=self.between(50, 80), resolution=[64, 64],
                        look_at=[self.size[0] * 0.7, self.size[1] * 0.7, self.size[2] * self.between(0.15, 0.4)])


FINISHES = ({}, {"specular": 1.5, "shininess": 20}, {"diffuse": 0.1, "mirror": 0.7},
            {"diffuse": 0.0, "mirror": 0.06, "transmit": 0.9, "ior": 1.5}, {}, {})
LAMPS = (["point"], ["rectangle"], ["wide emitter"], ["disk", "point"], ["small emitter"], ["spot"], ["ies"],
         ["rectangle", "spot"])
SKIES = (("window", "sun"), ("open", "earth"), ("window", "wide sun"), ("open", "sun and earth"), ("window", "earth"),
         ("open", "sun"))


def room(number):
    """The text of random room `number`. Rooms 2, 5, 8, ... are lit from outside, the others by
    lamps."""
    made = Room(number)
    turn = number // 3
    outside = number % 3 == 2
    opening, sky = SKIES[turn % len(SKIES)] if outside else ("", "")
    made.walls(opening)
    made.bodies(1 + int(5 * made.chance()), FINISHES[number % len(FINISHES)])
    for kind in [] if outside else LAMPS[(2 * turn + number % 3) % len(LAMPS)]:
        made.lamp(kind)
    made.sky(sky)
    made.camera()
    return str(made.text)


def knobs(**values):
    return [word for key, value in values.items() for word in ("--set", f"quality.{key}={value}")]


# Settings that users may choose: a wanted error with or without one fixed setting, or settings
# only; and a wanted error of pictures without a solution.
ASKED = {
    **{f"picture within {error}": ["--error", error] for error in ("0.05", "0.02", "0.01")},
    "error 0.1": ["--error", "0.1"],
    "error 0.05": ["--error", "0.05"],
    "error 0.03": ["--error", "0.03"],
    "error, 8 gather rays": ["--error", "0.05", *knobs(gather_rays=8)],
    "error, even patches": ["--error", "0.1", *knobs(refine="false")],
    "coarse patches": knobs(patch_edge=0.8),
    "few form-factor rays": knobs(patch_edge=0.4, form_factor_rays=32),
    "few patches": knobs(max_patches=500, form_factor_rays=128, gather_rays=16),
    "not denoised": knobs(patch_edge=0.5, denoise="false", gather_rays=64),
}
PICTURES = [asked for asked in ASKED if asked.startswith("picture")]
PAIRS = (("error 0.1", "coarse patches"), ("error 0.05", "few patches"), ("error 0.1", "few form-factor rays"),
         ("error 0.03", "not denoised"), ("error, even patches", "error, 8 gather rays"))

SMALL = ["--size", "48x48"]
# Shipped scenes: settings, and the picture.
SHIPPED = {
    "cornell-box/scene.toml": (["error 0.1", "error 0.05"], SMALL),
    "still-life/scene.toml": (["error 0.1", "few patches"], SMALL),
    "furnace/scene.toml": (["error 0.1"], SMALL),
    "closed-box/scene.toml": (["error 0.1"], SMALL),
    "sts46/day-sun.toml": (["error 0.1"], ["--camera", "B", *SMALL]),
    "sts46/day-earthshine.toml": (["error 0.1"], ["--camera", "B", *SMALL]),
    "sts46/night-lamps.toml": (["error 0.1"], ["--camera", "B", *SMALL]),
}
# Pictures of these scenes only, by another camera.
ASIDE = [name for name in SHIPPED if name.startswith("sts46")]
ROOMS = 22


def with_pictures(asked):
    """Adds pictures for each error that is not in the list."""
    return [*asked, *(one for one in PICTURES if ASKED[one] not in [ASKED[other] for other in asked])]


def cases(quick=False):
    """Yields (name, path or text, further arguments, names of settings)."""
    for number in range(4 if quick else ROOMS):
        yield f"room {number}", room(number), [], with_pictures(PAIRS[number % len(PAIRS)])
    for name, (asked, more) in SHIPPED.items():
        if not quick or name.startswith("cornell"):
            yield name.replace("/scene.toml", "").replace(".toml", ""), LIBRARY / name, more, with_pictures(asked)
    for name in [] if quick else ASIDE:
        yield name.replace(".toml", ", camera A"), LIBRARY / name, ["--camera", "A", *SMALL], PICTURES
