# SPDX-License-Identifier: Apache-2.0
"""Scenes on which an error estimate may fail, with known results."""
import dataclasses
import math

from error_scenes import Text, wall


@dataclasses.dataclass
class Hard:
    name: str
    why: str  # the difficulty
    text: str
    # Mean illuminance (lx) of all surfaces, if known: in closed rooms of uniform reflectance, by
    # conservation.
    mean: float | None = None
    light: float | None = None  # of every pixel, cd/m2
    target: str | None = None
    traced: str | None = None  # scene for the path tracer if paths cannot find some of the light


def closed(text, low, high, material):
    text.thing(material, shape="box", min=list(low), max=list(high), inward=True)


def add_camera(text, position, at, size=(32, 32), fov=60.0):
    text.table("[[camera]]", name="A", position=list(position), look_at=list(at), fov_deg=fov, resolution=list(size))


def quad(axis, at, low, high, turned=False):
    return {"shape": "quad", "corners": wall(axis, at, low, high, turned)}


def small_emitter():
    """A room of 4 x 4 x 3 m, 80 m2, of reflectance 0.5, and 4 cm2 that emit 400 lm: about one in
    200 000 rays of a patch hits them. Shadow rays find them. The different reflectance of the 4 cm2
    is 5e-6 of the surface. Conservation: the landed light is area E = flux + rho area E, hence E =
    flux / (area (1 - rho)) on average."""
    text = Text("small emitter")
    closed(text, (0, 0, 0), (4, 4, 3), text.material(diffuse=0.5))
    text.thing(text.material(diffuse=0.5, emit=1e6), **quad(2, 2.9, (1, 1, 0), (1.02, 1.02, 0), True))
    add_camera(text, (0.4, 0.4, 1.5), (3, 3, 1.2))
    return Hard("small emitter", "400 lm from 4 cm2", str(text), mean=400 / (80 * 0.5))


def sun_spot():
    """A room with a hole of 10 x 10 cm in the ceiling. The vertical Sun puts 1000 lm on a spot of
    the floor, which lights everything else. The 79.99 m2 have the reflectance 0.6 and reflect all
    light except 1 - rho and the share of the hole."""
    text = Text("sun spot")
    paint = text.material(diffuse=0.6)
    low, high = (0, 0, 0), (4, 4, 3)
    for axis in (0, 1):
        for side in (0, 1):
            text.thing(paint, **quad(axis, side * high[axis], low, high, side == 1))
    text.thing(paint, **quad(2, 0, low, high))
    for a, b in (((0, 0), (3, 4)), ((3.1, 0), (4, 4)), ((3, 0), (3.1, 3)), ((3, 3.1), (3.1, 4))):
        text.thing(paint, **quad(2, 3, (*a, 0), (*b, 0), True))
    text.table("[sun]", direction=[0.0, 0.0, 1.0], illuminance=100000.0)
    add_camera(text, (3.6, 3.6, 1.6), (0, 0, 1.4))
    return Hard("sun spot", "1 % of 1 m2 lights the room", str(text))


def wide_emitter():
    """A closed room half a metre high; its emitter is just large enough for form factors."""
    text = Text("carried emitter")
    closed(text, (0, 0, 0), (2, 2, 0.5), text.material(diffuse=0.5))
    edge = math.sqrt(0.06 * 12)
    text.thing(text.material(diffuse=0.0, emit=1000.0), **quad(2, 0.45, (1, 1, 0), (1 + edge, 1 + edge, 0), True))
    add_camera(text, (0.1, 0.1, 0.25), (1.6, 1.6, 0.1))
    return Hard("carried emitter", "an emitter near the ceiling that gather rays must find", str(text))


def pinhole():
    """Two rooms of 2 m with a wall between them. The lamp is in one, the camera in the other, and
    the wall has a hole of 6 cm."""
    text = Text("pinhole")
    paint = text.material(diffuse=0.7)
    sheet = text.material(diffuse=0.7, two_sided=True)
    closed(text, (0, 0, 0), (4, 2, 2), paint)
    for a, b in (((0, 0), (0.97, 2)), ((1.03, 0), (2, 2)), ((0.97, 0), (1.03, 0.97)), ((0.97, 1.03), (1.03, 2))):
        text.thing(sheet, **quad(0, 2, (0, *a), (0, *b)))
    text.light(type="point", position=[1.0, 0.5, 1.8], flux=2000.0)
    add_camera(text, (3.7, 0.3, 1.0), (2.1, 1.5, 0.8))
    return Hard("pinhole", "light comes through 36 cm2", str(text))


def baffle():
    """The lamp is hidden by a sheet below the ceiling: visible surfaces are lit by the ceiling
    only."""
    text = Text("baffle")
    closed(text, (0, 0, 0), (4, 4, 3), text.material(diffuse=0.6))
    text.thing(text.material(diffuse=0.6, two_sided=True), **quad(2, 2.5, (0.5, 0.5, 0), (3.5, 3.5, 0)))
    text.light(type="point", position=[2, 2, 2.7], flux=2000.0)
    add_camera(text, (0.3, 0.3, 1.2), (3, 3, 0.6))
    return Hard("baffle", "all light is indirect", str(text))


def shadowed_target():
    """A box in the full shadow of a roof, beside a sunlit floor: its light is reflected by the
    floor to the underside of the roof."""
    text = Text("shadowed target")
    text.thing(text.material(diffuse=0.5), **quad(2, 0, (-3, -3, 0), (3, 3, 0)))
    text.thing(text.material(diffuse=0.1, two_sided=True), **quad(2, 0.8, (-1.2, -1.2, 0), (1.2, 1.2, 0)))
    text.thing(text.material(diffuse=0.3), shape="box", min=[-0.2, -0.2, 0.0], max=[0.2, 0.2, 0.3], target=True)
    text.table("[sun]", direction=[0.0, 0.0, 1.0], illuminance=100000.0)
    add_camera(text, (3, -4, 0.7), (0, 0, 0.2), fov=40.0)
    return Hard("shadowed target", "bright around, dark itself", str(text), target=f"o{text.names}")


def caustic():
    """A mirror ball reflects sunlight in all directions, also onto the floor. No method of the
    program carries this light; it must be named. The ball reflects 0.9 of its light."""
    text = Text("caustic")
    text.thing(text.material(diffuse=0.5), **quad(2, 0, (-2, -2, 0), (2, 2, 0)))
    text.thing(text.material(diffuse=0.0, mirror=0.9), shape="sphere", center=[0, 0, 1], radius=0.5)
    text.table("[sun]", direction=[1.0, 0.0, 1.0], illuminance=20000.0)
    add_camera(text, (2.5, -2.5, 1.5), (0, 0, 0.3), fov=50.0)
    return Hard("caustic", "a mirror lights the floor", str(text))


def white_room():
    """In a closed room of reflectance 0.99 that emits M = 1, E = B = M / (1 - rho) = 100
    everywhere."""
    text = Text("white room")
    closed(text, (0, 0, 0), (2, 2, 2), text.material(diffuse=0.99, emit=1.0))
    add_camera(text, (0.3, 0.3, 1.0), (1.5, 1.8, 0.8))
    return Hard("white room", "a hundred reflections", str(text), mean=100.0, light=100 / math.pi)


def lit_white_room():
    """The same room with a lamp of 100 lm instead of the exitance: 24 m2, hence E = flux / (area (1
    - rho)) on average."""
    text = Text("lit white room")
    closed(text, (0, 0, 0), (2, 2, 2), text.material(diffuse=0.99))
    text.light(type="point", position=[1.2, 1.2, 1.5], flux=100.0)
    add_camera(text, (0.3, 0.3, 1.0), (1.5, 1.8, 0.8))
    return Hard("lit white room", "a hundred reflections of a lamp", str(text), mean=100 / (24 * 0.01))


def lamp_at_a_wall():
    """A lamp 1 mm from a wall: half of its light lands on a spot of some millimetres, which lights
    the room. With reflectance 0.6 of 24 m2 the mean illuminance is flux / (area (1 - rho)). Random
    paths do not find the spot. The path tracer gets a black square of 5 cm instead, and a disc that
    emits the light that the square would reflect."""
    half, distance, reflectance, flux = 0.025, 0.001 - 5e-5, 0.6, 1000.0
    seen_sr = 4 * math.atan(half**2 / (distance * math.sqrt(2 * half**2 + distance**2)))

    def room(traced):
        text = Text("lamp at a wall")
        closed(text, (0, 0, 0), (2, 2, 2), text.material(diffuse=reflectance))
        text.light(type="point", position=[1.0, 1.999, 1.2], flux=flux)
        if traced:
            text.thing(text.material(diffuse=0.0), shape="quad", corners=[[1 + x * half, 1.99995, 1.2 + z * half]
                                                                          for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
            text.light(type="disk", center=[1.0, 1.9999, 1.2], normal=[0, -1, 0], radius=0.001,
                       flux=reflectance * flux * seen_sr / (4 * math.pi))
        add_camera(text, (0.3, 0.3, 1.0), (1.5, 1.0, 0.4))
        return str(text)

    return Hard("lamp at a wall", "half of the light in a spot of 4 mm", room(False), mean=flux / (24 * (1 - reflectance)),
                traced=room(True))


def corridor():
    """Twenty rooms of 2 m in a row, with doors of 0.8 x 1.6 m at alternating sides. The lamp is in
    the first room, the camera in the last but sixteen. Light falls by about a factor of ten per
    room."""
    text = Text("corridor")
    paint = text.material(diffuse=0.7)
    sheet = text.material(diffuse=0.7, two_sided=True)
    closed(text, (0, 0, 0), (40, 2, 2), paint)
    for k in range(1, 20):
        door = 0.1 if k % 2 else 1.1
        for a, b in (((0, 1.6), (2, 2)), ((0, 0), (door, 1.6)), ((door + 0.8, 0), (2, 1.6))):
            text.thing(sheet, **quad(0, 2 * k, (0, *a), (0, *b)))
    text.light(type="point", position=[1.0, 1.0, 1.8], flux=2000.0)
    add_camera(text, (7.7, 0.3, 1.2), (6.2, 1.6, 0.8))
    return Hard("corridor", "light through three doors", str(text))


def black_picture():
    """Nearly black surfaces that reflect a ten-thousandth of little light."""
    text = Text("black picture")
    closed(text, (0, 0, 0), (2, 2, 2), text.material(diffuse=1e-4))
    text.light(type="point", position=[1.2, 1.2, 1.9], flux=1e-6)
    add_camera(text, (0.3, 0.3, 1.0), (1.5, 1.8, 0.5))
    return Hard("black picture", "next to nothing to see", str(text))


def one_pixel():
    text = Text("one pixel")
    closed(text, (0, 0, 0), (2, 2, 2), text.material(diffuse=0.6))
    text.light(type="rectangle", center=[1.5, 1.5, 1.95], edge_u=[0.3, 0, 0], edge_v=[0, -0.3, 0], flux=1000.0)
    text.thing(text.material(diffuse=0.3), shape="box", min=[0.8, 0.8, 0.0], max=[1.2, 1.2, 0.7])
    add_camera(text, (0.3, 0.3, 1.5), (1.2, 1.2, 0.2), size=(1, 1), fov=30.0)
    return Hard("one pixel", "no neighbours, no crowd of pixels", str(text))


def sky_alone():
    text = Text("sky alone")
    text.thing(text.material(diffuse=0.6), **quad(2, 0, (-1, -1, 0), (1, 1, 0)))
    text.table("[sun]", direction=[0.3, 0.1, 1.0], illuminance=100000.0)
    add_camera(text, (0, 0, 1), (0.2, 5, 6))
    return Hard("sky alone", "no surface in the picture", str(text), light=0.0)


def no_light():
    text = Text("no light")
    closed(text, (0, 0, 0), (2, 2, 2), text.material(diffuse=0.6))
    add_camera(text, (0.3, 0.3, 1.0), (1.5, 1.8, 0.5))
    return Hard("no light", "nothing shines", str(text), mean=0.0, light=0.0)


def all_of_them():
    return [make() for make in (small_emitter, sun_spot, wide_emitter, pinhole, baffle, shadowed_target, caustic, white_room,
                                lit_white_room, lamp_at_a_wall, corridor, black_picture, one_pixel, sky_alone, no_light)]
