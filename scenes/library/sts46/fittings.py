# SPDX-License-Identifier: Apache-2.0
"""Arm, antenna, lamps, cameras and latches on the orbiter around the payloads.

Tags as in orbiter.py. scene_files.py reads LAMPS and CAMERAS too, so that each lamp and camera is just outside its own
housing.
"""
import math

from mesh_kit import (add, beam, box, circle, cross, cylinder, loft, mul, oriented_box, solid, station, sub, turned,
                      unit)

# ---- lamps --------------------------------------------------------------------------------------------------------
# name, group, lamp position Xo Yo Zo [S], direction of emission [S]: bay lamps inboard and up, 40
# deg off +Zo
TILT = math.radians(40.0)
BAY_LAMPS = (("bay-1-forward-starboard", 742.9, 56.0, 325.2), ("bay-2-forward-port", 757.1, -48.0, 320.0),
             ("bay-3-mid-starboard", 972.5, 54.3, 323.9), ("bay-4-mid-port", 972.5, -54.3, 323.9),
             ("bay-5-aft-starboard", 1133.6, 56.0, 324.9), ("bay-6-aft-port", 1133.6, -56.0, 324.9))
LAMP_STAND_OFF = 0.025  # m, of the point lamp in front of the position, so that it clears its glass; estimate


def bay_lamp_axis(yo):
    return (0.0, -math.copysign(math.sin(TILT), yo), math.cos(TILT))


def lamp_list():
    """(name, group, seat, axis) in metres; the light itself stands LAMP_STAND_OFF along the axis."""
    lamps = [(name, "bay-lamps", station(xo, yo, zo), bay_lamp_axis(yo)) for name, xo, yo, zo in BAY_LAMPS]
    lamps.append(("forward-bulkhead", "fwd-bulkhead", station(581.9, 0.0, 481.9), (1.0, 0.0, 0.0)))
    lamps.append(("docking", "docking", station(584.2, 0.0, 491.0), (0.0, 0.0, 1.0)))
    return lamps


def light_position(lamp):
    return add(lamp[2], mul(lamp[3], LAMP_STAND_OFF))


def lamp_housings():
    """Shallow case and glass behind each lamp; the case of a bay lamp goes through the liner. Sizes estimated."""
    bodies = []
    for name, group, seat, axis in lamp_list():
        flush = group == "bay-lamps"
        u = (1.0, 0.0, 0.0) if flush else (0.0, 1.0, 0.0)
        v = cross(axis, u)
        half_u, half_v = (0.125, 0.09) if flush else (0.11, 0.07)
        deep = 0.06 if flush else 0.12 if group == "docking" else 0.17  # the flood's case reaches the bulkhead

        def slab(front, back, shrink):
            centre = add(seat, mul(axis, (front + back) / 2))
            return oriented_box(centre, mul(u, half_u * shrink), mul(v, half_v * shrink),
                                mul(axis, (front - back) / 2))

        bodies.append(solid(f"case of {name}", "LampCases", "lamp-case", slab(0.006, -deep, 1.0)))
        if group == "docking":
            wall = station(575.0, 0.0, 0.0)[0]
            bodies.append(solid("docking light bracket", "LampCases", "lamp-case",
                                box((wall, -0.05, seat[2] - 0.09), (seat[0], 0.05, seat[2] - 0.05))))
        bodies.append(solid(f"glass of {name}", "LampGlasses", "lamp-glass", slab(0.01, -deep / 2, 0.8)))
    return bodies


# ---- cameras ------------------------------------------------------------------------------------------------------
# name, base of the pan axis Xo Yo Zo [S], point that it looks at (scene metres, chosen here)
FIELD_OF_VIEW = {"A": 34, "B": 42, "C": 42, "D": 42, "elbow": 44}  # deg, vertical, chosen here
LENS_AHEAD = 0.18   # m ahead of the pan axis [S]
TILT_HEIGHT = 0.20  # m of the tilt axis above the base, estimate
CAMERAS = (("A", (588.76, -71.5, 446.06), (11.0, -0.1, 0.55)), ("B", (1293.76, -87.0, 446.0), (11.2, 0.3, 0.25)),
           ("C", (1293.76, 87.0, 446.0), (8.0, -0.6, 0.0)), ("D", (588.76, 71.5, 446.06), (7.0, -0.9, -0.3)),
           ("elbow", (953.03, -100.59, 468.44), (11.95, 0.3, -0.1)))


def camera_eye(base, target):
    pivot = add(station(*base), (0.0, 0.0, TILT_HEIGHT if base[2] < 460.0 else 0.0))
    return pivot, unit(sub(target, pivot))


def eye_position(camera):
    pivot, ahead = camera_eye(camera[1], camera[2])
    return add(pivot, mul(ahead, LENS_AHEAD))


def camera_housings():
    """Pan-and-tilt unit and camera, turned to what the scene's camera looks at. Sizes estimated."""
    bodies = []
    for camera in CAMERAS:
        name, base, target = camera
        pivot, ahead = camera_eye(base, target)
        side = unit(cross(ahead, (0.0, 0.0, 1.0)))
        top = cross(side, ahead)
        label = f"camera {name}"

        def part(what, material, faces):
            bodies.append(solid(f"{label} {what}", f"Camera{name.capitalize()}", material, faces))

        part("body", "camera-blanket", oriented_box(add(pivot, mul(ahead, -0.06)), mul(ahead, 0.16),
                                                     mul(side, -0.075), mul(top, 0.075)))
        part("lens hood", "black-paint", cylinder(add(pivot, mul(ahead, 0.05)), add(pivot, mul(ahead, 0.15)), 0.05, 10))
        part("lens", "lens-glass", cylinder(add(pivot, mul(ahead, 0.1)), add(pivot, mul(ahead, 0.155)), 0.035, 10))
        if name == "elbow":  # rides on a bracket of the arm
            part("bracket", "white-paint", beam(add(pivot, (0.0, -0.1, -0.6)), add(pivot, (0.0, 0.0, -0.06)), 0.12))
            continue
        foot = station(*base)
        part("pan unit", "white-paint", cylinder(add(foot, (0, 0, -0.02)), add(foot, (0, 0, 0.13)), 0.085, 10))
        for s in (1, -1):
            arm = add(pivot, mul(side, 0.095 * s))
            part(f"yoke {s}", "white-paint", beam(add(arm, (0, 0, -0.13)), add(arm, (0, 0, 0.04)), 0.03, 0.08, side))
        wall = station(575.0 if base[0] < 900.0 else 1308.0, base[1], base[2])
        part("bracket", "white-paint", beam(add(wall, (0, 0, -0.06)), add(foot, (0, 0, -0.06)), 0.2, 0.08, (0, 1, 0)))
    return bodies


# ---- the arm --------------------------------------------------------------------------------------------------------
SHOULDER, ELBOW, WRIST, TIP = (station(679.5, -108.0, 444.8), station(930.55, -106.0, 439.1),
                               station(1208.5, -108.0, 444.8), station(1282.5, -108.0, 444.8))  # rolled out [S]
PEDESTALS = (679.5, 911.05, 1189.0, 1256.5)  # Xo [S]
ARM_RADIUS = 0.165  # 13 in booms [B]


def arm():
    bodies = []

    def part(what, material, faces, group="Arm"):
        bodies.append(solid(f"arm {what}", group, material, faces))

    def boom(what, start, end, cuts):
        part(what, "arm-blanket", cylinder(start, end, ARM_RADIUS, 12, cuts=cuts))

    axis_upper, axis_fore = unit(sub(ELBOW, SHOULDER)), unit(sub(WRIST, ELBOW))
    along = (1.0, 0.0, 0.0)
    boom("upper", add(SHOULDER, mul(axis_upper, 0.2)), add(ELBOW, mul(axis_upper, -0.25)), 7)
    boom("fore", add(ELBOW, mul(axis_fore, 0.25)), add(WRIST, mul(axis_fore, -0.2)), 8)
    for what, centre, half in (("shoulder", SHOULDER, 0.24), ("elbow", ELBOW, 0.28), ("wrist", WRIST, 0.22)):
        part(f"{what} gearbox", "arm-blanket", box(sub(centre, (half, 0.19, 0.19)), add(centre, (half, 0.19, 0.19))))
    part("shoulder yaw", "arm-blanket",
         cylinder(add(SHOULDER, (-0.3, 0, -0.62)), add(SHOULDER, (-0.3, 0, -0.1)), 0.2, 12))
    part("shoulder strut", "arm-blanket", beam(add(SHOULDER, (-0.45, 0, -0.05)), add(SHOULDER, (0, 0, -0.05)), 0.26))
    part("wrist pitch", "arm-blanket", cylinder(add(WRIST, mul(along, 0.2)), add(WRIST, mul(along, 0.75)), 0.17, 12))
    part("wrist yaw", "arm-blanket", box(add(WRIST, (0.72, -0.18, -0.18)), add(WRIST, (1.08, 0.18, 0.18))))
    part("wrist roll", "arm-blanket", cylinder(add(WRIST, mul(along, 1.05)), add(TIP, mul(along, -0.5)), 0.15, 12))
    part("end effector", "end-effector",
         turned(add(TIP, mul(along, -0.5)), along, ((0, 0.15), (0.03, 0.18), (0.5, 0.18)), 12), "EndEffector")
    part("end effector mouth", "black-paint", cylinder(add(TIP, (-0.05, 0, 0)), add(TIP, (0.008, 0, 0)), 0.13, 12),
         "EndEffector")
    part("wrist camera", "camera-blanket", box(add(TIP, (-0.73, -0.1, 0.17)), add(TIP, (-0.43, 0.1, 0.36))))
    for k, xo in enumerate(PEDESTALS):
        foot, head = station(xo, -104.0, 414.0), station(xo, -107.5, 437.0)
        name = f"pedestal {k}"
        part(name, "sill-paint", beam(foot, head, 0.3, 0.16, (1, 0, 0)), "Pedestals")
        part(f"{name} saddle", "aluminium", box(station(xo - 5, -114.0, 434.5), station(xo + 5, -100.5, 438.5)),
             "Pedestals")
    return bodies


# ---- Ku-band antenna ------------------------------------------------------------------------------------------------
def antenna():
    """Stowed forward starboard; pivot Xo 589 Yo 99.6 Zo 422 [S], 36 in dish [B], the pose is an estimate."""
    bodies = []
    pivot = station(589.0, 99.6, 422.0)
    hub = station(632.0, 97.0, 442.0)
    axis = unit((0.15, -0.45, 0.88))

    def part(what, material, faces):
        bodies.append(solid(f"antenna {what}", "KuAntenna", material, faces))

    part("mount", "aluminium", box(add(pivot, (-0.14, -0.12, -0.33)), add(pivot, (0.14, 0.12, 0.12))))
    part("arm", "aluminium", beam(add(pivot, (0.05, 0, 0.04)), add(hub, mul(axis, -0.12)), 0.12))
    part("electronics", "white-paint", box(add(pivot, (0.22, -0.16, -0.22)), add(pivot, (0.78, 0.18, 0.2))))
    dish = ((-0.12, 0.12), (-0.1, 0.24), (0.0, 0.457), (0.02, 0.457), (-0.05, 0.26), (-0.085, 0.0))
    rim = [[add(hub, mul(axis, d))] if r == 0.0 else circle(add(hub, mul(axis, d)), axis, r, 16) for d, r in dish]
    part("dish", "white-paint", loft(rim))
    part("feed", "black-paint", cylinder(add(hub, mul(axis, -0.095)), add(hub, mul(axis, 0.19)), 0.025, 6))
    part("subreflector", "white-paint", cylinder(add(hub, mul(axis, 0.185)), add(hub, mul(axis, 0.205)), 0.07, 8))
    return bodies


# ---- latches and canisters ------------------------------------------------------------------------------------------
LATCH_HEIGHT = 414.0  # Zo of the longeron latch centre, at Yo +-94 [S]
KEEL_LATCH = 305.025  # Zo of the keel latch [S]


def longeron_latches(stations_x):
    """Split boxes around the trunnions, on the sills; stations in scene metres, (x, side). Sizes estimated."""
    bodies = []
    for x, side in stations_x:
        _, y, z = station(0.0, 94.0 * side, LATCH_HEIGHT)
        for s in (1, -1):
            bodies.append(solid(f"latch {x} {side} {s}", "Latches", "aluminium",
                                box((x + s * 0.13 - 0.05, y - 0.10, z - 0.14),
                                    (x + s * 0.13 + 0.05, y + 0.16, z + 0.09))))
        bodies.append(solid(f"latch {x} {side} base", "Latches", "aluminium",
                            box((x - 0.2, y - 0.07, z - 0.19), (x + 0.2, y + 0.13, z - 0.07))))
    return bodies


def keel_latches(stations_x):
    bodies = []
    for x in stations_x:
        z = station(0.0, 0.0, 306.0)[2]
        for s in (1, -1):
            bodies.append(solid(f"keel latch {x} {s}", "Latches", "aluminium",
                                box((x - 0.18, s * 0.12 - 0.05, z - 0.04), (x + 0.18, s * 0.12 + 0.05, z + 0.13))))
    return bodies


def canisters():
    """Two sidewall canisters (CONCAP class) to starboard and the cargo-bay camera box (ICBC) to port; estimates."""
    bodies = []
    for k, x in enumerate((2.05, 2.75)):
        low, high = (x, 1.72, -0.75), (x, 1.72, 0.12)
        bodies.append(solid(f"canister {k}", "Canisters", "white-paint", cylinder(low, high, 0.26, 14, cuts=2)))
        bodies.append(solid(f"canister lid {k}", "Canisters", "aluminium",
                            cylinder(add(high, (0, 0, -0.01)), add(high, (0, 0, 0.05)), 0.28, 14)))
    bodies.append(solid("canister beam", "Canisters", "aluminium", box((1.55, 1.95, -0.5), (3.25, 2.14, -0.2))))
    bodies.append(solid("canister beam hook", "Canisters", "aluminium", box((1.6, 2.08, -0.3), (3.2, 2.2, 0.3))))
    bodies.append(solid("camera box", "CargoBayCamera", "white-paint", box((2.0, -2.1, -0.55), (2.8, -1.45, 0.1))))
    bodies.append(solid("camera box port", "CargoBayCamera", "lens-glass",
                        cylinder((2.4, -1.75, 0.09), (2.4, -1.75, 0.13), 0.17, 12)))
    bodies.append(solid("camera box beam", "CargoBayCamera", "aluminium", box((1.9, -2.2, -0.3), (2.9, -2.05, 0.3))))
    return bodies


def bodies():
    return lamp_housings() + camera_housings() + antenna()
