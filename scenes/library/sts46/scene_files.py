# SPDX-License-Identifier: Apache-2.0
"""The four scene files, from one template, so that materials, objects and cameras cannot drift apart."""
import fittings
from mesh_kit import number

# name, diffuse, share reflected in the lobe (hemispherical), lobe exponent n, further keys, where the figures are from.
# The file's `specular` is the factor at the mirror direction, k_s = share (n + 2) / 2 (docs: pi f = k_d + k_s cos^n).
# alpha_s: solar absorptance; [S], [D], [B] and "estimate" as in README.md.
MATERIALS = (
    ("beta-cloth", (0.73, 0.72, 0.69), 0.02, 6, "", "liner: alpha_s 0.22 new, 0.30 in one model [S]; split and tint [B]"),
    ("frame-paint", (0.62, 0.62, 0.60), 0.03, 10, "", "ring frames where the liner ends: estimate"),
    ("sill-paint", (0.70, 0.70, 0.68), 0.03, 10, "", "longeron sills and pedestals, white paint: alpha_s 0.26 [S], split [B]"),
    ("bulkhead-blanket", (0.68, 0.67, 0.64), 0.03, 8, "", "quilted beta-cloth blankets of the bulkheads: estimate from the liner"),
    ("radiator", (0.12, 0.12, 0.12), 0.60, 400, "", "silvered Teflon: alpha_s 0.08 to 0.12 [S], lobe of a few degrees [B]; aged and perforated, so 0.72 in all: estimate"),
    ("panel-edge", (0.55, 0.55, 0.55), 0.10, 20, "", "radiator edges and gaps: estimate"),
    ("door-structure", (0.58, 0.58, 0.57), 0.05, 12, "", "inner door face beside the panels, painted graphite-epoxy: estimate"),
    ("white-blanket", (0.67, 0.67, 0.66), 0.02, 8, "", "FRSI / AFRSI: alpha_s 0.32, aged about 0.4 [S]; split [B]"),
    ("white-tile", (0.65, 0.65, 0.65), 0.03, 20, "", "LRSI white tile: k_d 0.65 to 0.70, k_s 0.02 [B]"),
    ("black-tile", (0.08, 0.08, 0.08), 0.03, 20, "", "HRSI black tile: k_d 0.08, glossy 0.03 [B]"),
    ("window-glass", (0.02, 0.02, 0.02), 0.0, 1, "mirror = 0.10", "several panes in front of a dim cabin: estimate"),
    ("lens-glass", (0.02, 0.02, 0.02), 0.0, 1, "mirror = 0.04", "coated front glass: estimate"),
    ("lamp-glass", (0.35, 0.35, 0.36), 0.10, 30, "", "lamp front with the reflector behind it: estimate"),
    ("lamp-case", (0.45, 0.45, 0.45), 0.10, 20, "", "lamp housing: estimate"),
    ("white-paint", (0.72, 0.72, 0.71), 0.03, 10, "", "white silicone paint: alpha_s 0.26 [S], split [B]"),
    ("z93", (0.85, 0.85, 0.84), 0.0, 1, "", "white silicate paint: alpha_s 0.12 to 0.17, chosen to be diffuse [S]"),
    ("black-paint", (0.04, 0.04, 0.04), 0.02, 10, "", "alpha_s 0.95 [S], split [B]"),
    ("yellow-paint", (0.77, 0.58, 0.09), 0.03, 10, "", "trunnion shields: (0.80, 0.60, 0.10) from photographs [S]"),
    ("aluminium", (0.25, 0.25, 0.26), 0.40, 40, "", "machined, anodised thinly: between alpha_s 0.21 and 0.45 [S]; split estimate"),
    ("trunnion", (0.20, 0.20, 0.20), 0.45, 60, "", "polished trunnion: estimate"),
    ("copper", (0.32, 0.17, 0.10), (0.45, 0.25, 0.15), 30, "", "TSS interface ring: copper-coloured [S], figures estimate"),
    ("kapton", (0.17, 0.11, 0.04), (0.50, 0.34, 0.10), 60, "", "aluminised Kapton, Kapton out: alpha_s 0.38 [S], R 0.75 G 0.50 B 0.15 and crinkle 5 to 15 deg [B]"),
    ("gold-foil", (0.20, 0.15, 0.05), (0.60, 0.46, 0.16), 80, "", "gold-coloured foil: estimate"),
    ("osr", (0.03, 0.03, 0.03), 0.0, 1, "mirror = 0.88", "quartz-silver mirrors: alpha_s 0.07 [S]"),
    ("solar-cell", (0.04, 0.04, 0.05), 0.0, 1, "mirror = 0.04", "cells: alpha_s 0.75 in all, k_d 0.03 to 0.05 and glass 0.04 in the visible [B]"),
    ("mli-white", (0.72, 0.71, 0.68), 0.04, 8, "", "white outer layer of multilayer insulation, as the liner [S/B]"),
    ("mli-silver", (0.30, 0.30, 0.30), 0.50, 30, "", "aluminised outer layer: alpha_s 0.14 to 0.16 [S], crinkled: split estimate"),
    ("pallet-paint", (0.68, 0.68, 0.66), 0.03, 10, "", "Spacelab pallet inside, white paint: alpha_s 0.26 aged 0.29 [S]"),
    ("pallet-blanket", (0.70, 0.69, 0.66), 0.04, 8, "", "pallet outside in multilayer insulation [B]"),
    ("eureca-blanket", (0.77, 0.76, 0.72), 0.03, 8, "", "EURECA blankets (0.80, 0.79, 0.75) from photographs [S]"),
    ("tss-paint", (0.68, 0.68, 0.68), 0.02, 20, "", "TSS satellite light grey, about 0.70 [S]"),
    ("tss-seam", (0.12, 0.12, 0.12), 0.02, 20, "", "dark seams between its gores [S], figure estimate"),
    ("boom-composite", (0.08, 0.08, 0.08), 0.04, 20, "", "lattice boom: estimate; bare graphite-epoxy has alpha_s 0.88 [S]"),
    ("arm-blanket", (0.71, 0.71, 0.70), 0.02, 8, "", "white blankets of the arm: alpha_s 0.26 [S] for white paint, estimate"),
    ("end-effector", (0.35, 0.35, 0.36), 0.25, 30, "", "end effector shell: estimate"),
    ("camera-blanket", (0.70, 0.70, 0.69), 0.03, 8, "", "camera covers, white: estimate"),
)

# object, mesh, part, target, comment
OBJECTS = (
    ("liner", "orbiter", "Liner", False, "bays 1 to 12, Xo 576 to 1249"),
    ("floor-13", "orbiter", "Floor13", False, "bay 13 with its raised floor, Xo 1249 to 1307"),
    ("frames", "orbiter", "Frames", False, "ring frames between the bays"),
    ("sills", "orbiter", "Sills", False, "longeron sills"),
    ("forward-bulkhead", "orbiter", "FwdBulkhead", False, "Xo 576, with the flight deck's rear wall above the sills"),
    ("aft-bulkhead", "orbiter", "AftBulkhead", False, "Xo 1307"),
    ("hull", "orbiter", "Hull", False, "outside of the fuselage below the doors' hinges"),
    ("cabin", "orbiter", "Cabin", False, "outside of the cabin, cut off at Xo 515"),
    ("aft-fuselage", "orbiter", "AftFuselage", False, "outside, cut off at Xo 1400"),
    ("window-frames", "orbiter", "WindowFrames", False, ""),
    ("windows", "orbiter", "Windows", False, "the two aft windows of the flight deck"),
    ("hatch", "orbiter", "Hatch", False, "airlock hatch"),
    ("handrails", "orbiter", "Handrails", False, ""),
    ("oms-pods", "orbiter", "OmsPods", False, "fronts of the pods, cut off at Xo 1400"),
    ("tail", "orbiter", "Tail", False, ""),
    ("door-port", "doors", "DoorPort", False, "open 175.5 deg"),
    ("door-starboard", "doors", "DoorStarboard", False, ""),
    ("radiators-port", "doors", "RadiatorsPort", False, "four panels, stowed on the door"),
    ("radiators-starboard", "doors", "RadiatorsStarboard", False, ""),
    ("hinges", "doors", "Hinges", False, ""),
    ("arm", "arm", "Arm", False, "rolled out, latched on the port sill"),
    ("end-effector", "arm", "EndEffector", True, ""),
    ("pedestals", "arm", "Pedestals", False, ""),
    ("ku-antenna", "fittings", "KuAntenna", False, "stowed, forward starboard"),
    ("lamp-cases", "fittings", "LampCases", False, ""),
    ("lamp-glasses", "fittings", "LampGlasses", False, ""),
    ("camera-a", "fittings", "CameraA", False, "housings; the eyes are the [[camera]] entries"),
    ("camera-b", "fittings", "CameraB", False, ""),
    ("camera-c", "fittings", "CameraC", False, ""),
    ("camera-d", "fittings", "CameraD", False, ""),
    ("camera-elbow", "fittings", "CameraElbow", False, ""),
    ("latches", "fittings", "Latches", True, "longeron and keel latches"),
    ("canisters", "fittings", "Canisters", True, "two sidewall canisters"),
    ("cargo-bay-camera", "fittings", "CargoBayCamera", False, ""),
    ("tss-pallet", "tss", "Pallet", False, ""),
    ("tss-deployer", "tss", "Deployer", True, ""),
    ("tss-trunnions", "tss", "TssTrunnions", True, ""),
    ("tss", "tss", "tss-stowed", True,
     "swap in \"tss-raised\" for the satellite 12 m up on its boom"),
    ("eureca", "eureca", "Eureca", True, ""),
    ("eureca-deck", "eureca", "EurecaDeck", True, "instruments, antennas, thrusters"),
    ("eureca-arrays", "eureca", "EurecaArrays", True, "solar arrays, folded"),
    ("eureca-grapple-fixture", "eureca", "GrappleFixture", True, "what the arm takes hold of"),
    ("eureca-trunnions", "eureca", "EurecaTrunnions", True, ""),
    ("bridge", "bridge", "Bridge", True, ""),
    ("bridge-experiments", "bridge", "Experiments", True, "trays with material samples"),
    ("bridge-trunnions", "bridge", "BridgeTrunnions", True, ""),
)

ON_AXIS = 1152.0  # cd: 18 fc at 8 ft [S] -> 18 x 8^2 [D]
METAL_HALIDE = (0.949, 0.988, 1.0)  # linear RGB, up to a factor [S]

VIEW = {"A": "forward port, down the bay", "B": "aft port, forward over the satellite",
        "C": "aft starboard", "D": "forward starboard, along the arm", "elbow": "elbow camera of the stowed arm"}

SCENES = {
    "day-earthshine": dict(
        title="STS-46 payload bay, day, bay to the Earth",
        intro=("Orbit noon, the bay toward the Earth: the Sun is behind the orbiter, and all light in the bay comes from",
               "the Earth's disc (69.6 deg half angle at 425 km [D]) and from what it lights."),
        sky="orbit-noon", lamps="off"),
    "day-sun": dict(
        title="STS-46 payload bay, day, bay to space",
        intro=("The Sun stands 30 deg off the bay's +z, toward forward starboard; the Earth is behind the orbiter.",
               "The bay sees sunlight, hard shadows, and what the lit surfaces pass on to the shadowed ones."),
        sky="sun-30", lamps="off"),
    "night-lamps": dict(
        title="STS-46 payload bay, night, lamps on",
        intro=("Orbit midnight: the Earth covers the Sun, and its side toward the bay is dark. Six bay floods and the",
               "forward bulkhead flood are the only light."),
        sky="orbit-midnight", lamps="on"),
    "night-lamp-failed": dict(
        title="STS-46 payload bay, night, one lamp failed",
        intro=("As night-lamps.toml, but the aft port bay lamp has failed: the side of the satellite that camera B sees",
               "loses its nearest lamp. The only difference is that lamp's intensity."),
        sky="orbit-midnight", lamps="failed"),
}
FAILED_LAMP = "bay-6-aft-port"


def colour(value):
    if isinstance(value, tuple):
        return "[" + ", ".join(f"{v:.5g}" for v in value) + "]"
    return f"{value:.5g}"


def material_text(material):
    name, diffuse, share, n, more, note = material
    grey = len(set(diffuse)) == 1
    lines = ["[[material]]", f'name = "{name}"  # {note}', f"diffuse = {colour(diffuse[0] if grey else diffuse)}"]
    shares = share if isinstance(share, tuple) else (share,)
    if any(shares):
        factor = tuple(s * (n + 2) / 2 for s in shares)
        whole = ", ".join(f"{s:g}" for s in shares)
        lines.append(f"specular = {colour(factor if len(factor) > 1 else factor[0])}  # {whole} in the lobe's hemisphere")
        lines.append(f"shininess = {n}")
    if more:
        lines.append(more)
    return "\n".join(lines)


# Objects whose mesh is a coarse polygon approximation of a round body: smooth_deg, the angle below
# which an edge is round (the arm's 12 sides turn by 30), and round_deg, the largest angle between
# faces of the refined mesh.
ROUND_DEG = {"tss": (30, 1), "tss-deployer": (30, 5), "canisters": (30, 5), "arm": (35, 5), "ku-antenna": (30, 5)}


def object_text(entry):
    name, mesh, part, target, note = entry
    lines = ["[[object]]", f'name = "{name}"' + (f"  # {note}" if note and name != "tss" else ""),
             f'mesh = "meshes/{mesh}.obj"', f'part = "{part}"' + (f"  # {note}" if name == "tss" else "")]
    if name in ROUND_DEG:
        smooth, fine = ROUND_DEG[name]
        lines += [f"smooth_deg = {smooth}", f"round_deg = {fine}"]
    if target:
        lines.append("target = true")
    return "\n".join(lines)


def vector(values, digits=4):
    return "[" + ", ".join(number(round(v, digits)) for v in values) + "]"


def lamp_text(lamp, mode):
    name, group, seat, axis = lamp
    position = fittings.light_position(lamp)
    aim = tuple(p + 5.0 * a for p, a in zip(position, axis))
    luminance = 0.2126 * METAL_HALIDE[0] + 0.7152 * METAL_HALIDE[1] + 0.0722 * METAL_HALIDE[2]
    intensity = colour(tuple(round(ON_AXIS * c / luminance, 1) for c in METAL_HALIDE))
    note = "18 fc at 8 ft [S]: 1152 cd [D], metal halide (0.949, 0.988, 1) [S]"
    beam, field = (120, 150), "135 deg wide [S], taken as its half-value width: estimate"
    if group == "fwd-bulkhead":
        note = "as the bay floods: estimate"
    if group == "docking":
        intensity, note = "0.0", "fitted but unlit: payload views do without it"
    if mode == "failed" and name == FAILED_LAMP:
        intensity, note = "0.0", "failed; " + note.replace("18 fc", "in order it has 18 fc")
    return "\n".join([
        "[[light]]", f'name = "{name}"', f'group = "{group}"', 'type = "spot"',
        f"position = {vector(position)}  # [S], {fittings.LAMP_STAND_OFF * 1000:.0f} mm in front of the glass's seat",
        f"aim = {vector(aim)}  # direction [S]", f"intensity = {intensity}  # cd; {note}",
        f"beam_deg = {beam[0]}", f"field_deg = {beam[1]}  # {field}"])


def sky_text(kind):
    if kind == "sun-30":
        return "\n".join([
            "[sun]", "direction = [-0.353553, 0.353553, 0.866025]  # 30 deg off +z, toward forward starboard",
            "illuminance = 129100  # lx: 133 100 at 1 AU [B], x 0.970 for 1.0145 AU on the date [D]",
            "angular_radius_deg = 0.2628  # 0.2666 / 1.0145 [D]", "",
            "[earth]", "direction = [0, 0, -1]  # behind the orbiter", "altitude_km = 425  # [S]",
            "albedo = 0.3  # mean [S]", 'model = "lambert"'])
    position = "0  # orbit noon" if kind == "orbit-noon" else "180  # orbit midnight"
    orbit = "\n".join([
        "[orbit]", "altitude_km = 425  # [S] EURECA phase", "beta_deg = 6  # [D] two days into the flight",
        f"position_deg = {position}", 'attitude = "bay-to-earth"  # chosen; the flight\'s attitudes were not found', "",
        "[sun]", "illuminance = 129100  # lx: 133 100 at 1 AU [B], x 0.970 for 1.0145 AU on the date [D]",
        "angular_radius_deg = 0.2628  # 0.2666 / 1.0145 [D]", "",
        "[earth]", "albedo = 0.3  # mean [S]"])
    return orbit + "\n\n" + FIGURE_7_AREA if kind == "orbit-noon" else orbit


FIGURE_7_AREA = """[[area]]
name = "overhead"  # for study compare --distributed-over: Figure 7's area; its size and height are chosen
center = [9.1, 0, 33]
edge_u = [0, 165, 0]
edge_v = [165, 0, 0]"""


def camera_text(camera):
    name, _, target = camera
    return "\n".join([
        "[[camera]]", f'name = "{name}"  # {VIEW[name]}',
        f"position = {vector(fittings.eye_position(camera))}  # pan axis [S], lens 0.18 m ahead [S], tilt axis: estimate",
        f"look_at = {vector(target)}", f"fov_deg = {fittings.FIELD_OF_VIEW[name]}  # zoom ran from about 9 to 50 deg [B]",
        "resolution = [512, 512]", 'cctv = "sit-monochrome"'])


OVERVIEW = """[[camera]]
name = "overview"  # from outside, above forward starboard
position = [-7.5, 8.5, 13]
look_at = [10.5, 0.8, 2.2]
fov_deg = 52
resolution = [512, 512]"""

HEAD = """# SPDX-License-Identifier: Apache-2.0
# {title}
# {intro}
#
# Written by make_meshes.py from scene_files.py, together with its three sisters; edit those, or a copy of this file.
# x aft from Xo 582, y starboard, z up from Zo 400 (orbiter stations in inches x 0.0254). Behind a figure:
# [S] seen in a source, [D] derived from such, [B] background knowledge, or "estimate". README.md has the sources.
format = 1
name = "{title}"
unit = "m\""""

QUALITY = """[monitor]
rows = 300  # the 1990 report's monitor
columns = 400
spread = "gaussian"

[quality]
error = 0.05  # of the picture"""


def scene_text(name):
    scene = SCENES[name]
    parts = [HEAD.format(title=scene["title"], intro="\n# ".join(scene["intro"])),
             "# ---- light", sky_text(scene["sky"])]
    if scene["lamps"] != "off":
        parts += [lamp_text(lamp, scene["lamps"]) for lamp in fittings.lamp_list()]
    parts += ["# ---- cameras"] + [camera_text(c) for c in fittings.CAMERAS] + [OVERVIEW]
    parts += [QUALITY]
    parts += ["# ---- objects; target: visibility studies measure it"] + [object_text(o) for o in OBJECTS]
    parts += ["# ---- materials"] + [material_text(m) for m in MATERIALS]
    return "\n\n".join(parts) + "\n"


def material_problems():
    """Energy k_d + share + mirror must not exceed 1; every object's material must be here."""
    problems = []
    for name, diffuse, share, _, more, _ in MATERIALS:
        shares = share if isinstance(share, tuple) else (share,) * 3
        mirror = float(more.split("=")[1]) if more.startswith("mirror") else 0.0
        if max(d + s for d, s in zip(diffuse, shares)) + mirror > 1.0:
            problems.append(f"material {name} gives back more light than it gets")
    return problems
