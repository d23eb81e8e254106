# SPDX-License-Identifier: Apache-2.0
"""Bodies made of planar faces: primitives, checks and the OBJ file.

A Body is one solid (its faces enclose it and look outward). Each of its faces belongs to a named group, the
`g` of the OBJ file, and has a material. Bodies may pass through each other, as a bolt passes through a plate.
Lengths in metres: x aft, y starboard, z up.
"""
import math

INCH = 0.0254
DIGITS = 9  # decimals of a written coordinate: parallelograms stay parallelograms to a millionth of their size


# ---- vectors ------------------------------------------------------------------------------------------------
def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return mul(a, 1.0 / length(a))


def mix(a, b, t):
    return tuple(a[i] + (b[i] - a[i]) * t for i in range(3))


def centroid(points):
    n = len(points)
    return tuple(sum(p[i] for p in points) / n for i in range(3))


def area_vector(points):
    """Newell's normal: direction of the face (counter-clockwise is the front), length = area."""
    total = (0.0, 0.0, 0.0)
    for i in range(1, len(points) - 1):
        total = add(total, cross(sub(points[i], points[0]), sub(points[i + 1], points[0])))
    return mul(total, 0.5)


def across(axis):
    """Two unit vectors u, v with u x v = axis, the same ones every time."""
    axis = unit(axis)
    helper = (0.0, 0.0, 1.0) if abs(axis[2]) < 0.9 else (1.0, 0.0, 0.0)
    u = unit(cross(helper, axis))
    return u, cross(axis, u)


def station(xo, yo, zo):
    """Orbiter station in inches (Xo, Yo, Zo) -> scene metres."""
    return ((xo - 582.0) * INCH, yo * INCH, (zo - 400.0) * INCH)


# ---- bodies -------------------------------------------------------------------------------------------------
class Body:
    def __init__(self, name):
        self.name = name
        self.faces = []  # (group, material, points)

    def face(self, group, material, points, facing=None):
        """A planar polygon; with `facing` its front is turned to that direction."""
        points = [tuple(p) for p in points]
        if facing is not None and dot(area_vector(points), facing) < 0.0:
            points.reverse()
        self.faces.append((group, material, points))

    def add(self, group, material, faces):
        """Faces of a primitive. `material` is a name, or a function of the face's number and points."""
        for i, points in enumerate(faces):
            name = material(i, points) if callable(material) else material
            self.face(group, name, points)
        return self


def solid(name, group, material, faces):
    return Body(name).add(group, material, faces)


# ---- primitives: lists of faces, counter-clockwise from outside -----------------------------------------------
def box(lo, hi, cuts=(1, 1, 1)):
    """Axis-aligned box; `cuts` divides its faces along x, y, z."""
    centre = mix(lo, hi, 0.5)
    half = mul(sub(hi, lo), 0.5)
    return oriented_box(centre, (half[0], 0, 0), (0, half[1], 0), (0, 0, half[2]), cuts)


def oriented_box(centre, a, b, c, cuts=(1, 1, 1)):
    """Box from its centre and three half edges with a x b along c."""
    faces = []
    for u, v, w, nu, nv in ((a, b, c, cuts[0], cuts[1]), (b, c, a, cuts[1], cuts[2]), (c, a, b, cuts[2], cuts[0])):
        for sign in (1.0, -1.0):
            middle = add(centre, mul(w, sign))
            for i in range(nu):
                for j in range(nv):
                    quad = [add(middle, add(mul(u, 2 * s / nu - 1), mul(v, 2 * t / nv - 1)))
                            for s, t in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
                    faces.append(quad if sign > 0 else quad[::-1])
    return faces


def beam(start, end, width, depth=None, side=None, cuts=1):
    """Rectangular bar from start to end; `side` is a direction of its width."""
    depth = depth or width
    axis = sub(end, start)
    if side is None:
        u, v = across(axis)
    else:
        v = unit(cross(axis, side))
        u = cross(v, unit(axis))
    return oriented_box(mix(start, end, 0.5), mul(u, width / 2), mul(v, depth / 2), mul(axis, 0.5), (1, 1, cuts))


def ladder(ring):
    """A convex ring of points filled with quads (and a triangle where the count is odd)."""
    n = len(ring)
    faces = []
    for i in range((n - 1) // 2):
        quad = [ring[i], ring[i + 1], ring[n - 2 - i], ring[n - 1 - i]]
        if i + 1 == n - 2 - i:
            quad = [ring[i], ring[i + 1], ring[n - 1 - i]]
        faces.append(quad)
    return faces


def ring_fill(ring, centre, steps):
    """Fills a flat ring that is seen whole from `centre`, counter-clockwise as the ring is.

    steps: [(scale, every)] of the rings inside it, each scaled about the centre and keeping every n-th point (1 or 2)
    of the ring before; triangles to the centre close the last one.
    """
    rings = [ring]
    kept = ring
    faces = []
    for scale, every in steps:
        kept = kept[::every]
        inner, outer = [mix(centre, p, scale) for p in kept], rings[-1]
        n, m = len(outer), len(inner)
        if every == 1:
            faces += [[outer[i], outer[(i + 1) % n], inner[(i + 1) % n], inner[i]] for i in range(n)]
        else:
            for i in range(m):
                a, b, c = outer[2 * i], outer[2 * i + 1], outer[(2 * i + 2) % n]
                faces += [[a, b, inner[i]], [b, inner[(i + 1) % m], inner[i]], [b, c, inner[(i + 1) % m]]]
        rings.append(inner)
    last = rings[-1]
    faces += [[last[i], last[(i + 1) % len(last)], centre] for i in range(len(last))]
    whole = area_vector(ring)
    if any(dot(area_vector(f), whole) <= 0.0 for f in faces):
        raise ValueError("ring_fill: a face folds over; the ring is not seen whole from the centre")
    return faces


def is_planar(points, tolerance=1e-9):
    normal = area_vector(points)
    size = length(normal)
    if size == 0.0:
        return True
    return all(abs(dot(sub(p, points[0]), normal)) / size <= tolerance for p in points)


def bridge(first, second, closed=True):
    """Faces between two rings of the same count, the second further along the axis they turn about."""
    n = len(first)
    faces = []
    for i in range(n if closed else n - 1):
        j = (i + 1) % n
        quad = [first[i], first[j], second[j], second[i]]
        quad = [p for k, p in enumerate(quad) if p != quad[k - 1]]
        if len(quad) < 3:
            continue
        if is_planar(quad):
            faces.append(quad)
        else:
            faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    return faces


def loft(rings, cap_first=ladder, cap_last=ladder):
    """A solid through rings that turn counter-clockwise seen from the last one. A one-point ring is a tip."""
    faces = []
    for a, b in zip(rings, rings[1:]):
        n = max(len(a), len(b))
        faces += bridge(a if len(a) > 1 else a * n, b if len(b) > 1 else b * n)
    if len(rings[0]) > 1:
        faces += cap_first(rings[0][::-1])
    if len(rings[-1]) > 1:
        faces += cap_last(rings[-1])
    return faces


def circle(centre, axis, radius, count, start=0.0):
    """Points counter-clockwise seen from the tip of `axis`."""
    u, v = across(axis)
    points = []
    for i in range(count):
        t = 2 * math.pi * (i + start) / count
        points.append(add(centre, add(mul(u, radius * math.cos(t)), mul(v, radius * math.sin(t)))))
    return points


def cylinder(start, end, radius, count=8, end_radius=None, cuts=1):
    end_radius = radius if end_radius is None else end_radius
    axis = sub(end, start)
    rings = [circle(mix(start, end, k / cuts), axis, radius + (end_radius - radius) * k / cuts, count, 0.5)
             for k in range(cuts + 1)]
    return loft(rings)


def turned(start, axis, profile, count=12):
    """A solid of revolution: profile is [(distance along axis, radius)], from the first end to the last."""
    axis = unit(axis)
    rings = []
    for along, radius in profile:
        centre = add(start, mul(axis, along))
        rings.append([centre] if radius == 0.0 else circle(centre, axis, radius, count, 0.5))
    return loft(rings)


def prism(outline, x0, x1, cuts=1, cap=ladder):
    """Outline [(y, z)] counter-clockwise seen from aft (from +x), drawn out along x."""
    rings = [[(x0 + (x1 - x0) * k / cuts, y, z) for y, z in outline] for k in range(cuts + 1)]
    return loft(rings, cap, cap)


# ---- checks -------------------------------------------------------------------------------------------------
def snap(point):
    return tuple(round(c, DIGITS) + 0.0 for c in point)


def check_body(body):
    """The faults of a body as written: a list of lines, empty if there are none."""
    problems = []
    edges = {}
    volume = 0.0
    for group, material, points in body.faces:
        ring = [snap(p) for p in points]
        where = f"{body.name}/{group} at ({', '.join(f'{c:.3f}' for c in centroid(ring))})"
        if len(set(ring)) < len(ring) or length(area_vector(ring)) < 1e-7:
            problems.append(f"{where}: degenerate face")
            continue
        if len(ring) > 3 and not is_planar(ring, 1e-6):
            problems.append(f"{where}: not planar")
        if not is_convex(ring):
            problems.append(f"{where}: not convex")
        volume += dot(ring[0], area_vector(ring)) / 3.0
        for i, p in enumerate(ring):
            edges[(p, ring[(i + 1) % len(ring)])] = edges.get((p, ring[(i + 1) % len(ring)]), 0) + 1
    open_edges = [e for e, n in edges.items() if edges.get((e[1], e[0]), 0) != n]
    if open_edges:
        p, q = open_edges[0]
        problems.append(f"{body.name}: {len(open_edges)} edges without their opposite, first {p} -> {q}")
    if volume <= 0.0:
        problems.append(f"{body.name}: volume {volume:.6f} m3, the normals look inward")
    return problems


def is_convex(ring):
    normal = area_vector(ring)
    n = len(ring)
    return all(dot(cross(sub(ring[i], ring[i - 1]), sub(ring[(i + 1) % n], ring[i])), normal)
               >= -1e-9 * length(normal) for i in range(n))


def patch_estimate(points, edge):
    """Patches a face becomes when its edges are divided to `edge`: parallelograms whole, others as triangles."""
    def pieces(a, b):
        return max(1, math.ceil(a / edge - 1e-9)) * max(1, math.ceil(b / edge - 1e-9))
    ring = [snap(p) for p in points]
    sides = [length(sub(ring[i], ring[i - 1])) for i in range(len(ring))]
    if len(ring) == 4:
        gap = length(sub(add(ring[0], ring[2]), add(ring[1], ring[3])))
        if gap <= 1e-6 * length(sub(ring[2], ring[0])):
            return pieces(sides[0], sides[1])
    total = 0
    for i in range(1, len(ring) - 1):
        corners = (ring[0], ring[i], ring[i + 1])
        edges = sorted(length(sub(corners[k], corners[k - 1])) for k in range(3))
        total += pieces(edges[0], edges[2])
    return total


# ---- the OBJ file -------------------------------------------------------------------------------------------
def number(value):
    text = f"{value:.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def obj_text(title, bodies):
    """One OBJ file: vertices shared, faces gathered by group and material in order of appearance."""
    index = {}
    vertex_lines = []
    groups = {}
    for body in bodies:
        for group, material, points in body.faces:
            ids = []
            for point in map(snap, points):
                if point not in index:
                    index[point] = len(index) + 1
                    vertex_lines.append("v " + " ".join(number(c) for c in point))
                ids.append(index[point])
            groups.setdefault(group, {}).setdefault(material, []).append(ids)
    lines = ["# SPDX-License-Identifier: Apache-2.0",
             f"# {title}. Metres: x aft, y starboard, z up. Written by make_meshes.py."]
    lines += vertex_lines
    for group, materials in groups.items():
        lines.append(f"g {group}")
        for material, faces in materials.items():
            lines.append(f"usemtl {material}")
            lines += ["f " + " ".join(map(str, ids)) for ids in faces]
    return "\n".join(lines) + "\n"
