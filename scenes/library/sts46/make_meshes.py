#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes meshes/*.obj and the four scene files of the STS-46 payload bay. Standard library only, same bytes every time.

    python3 make_meshes.py           write everything
    python3 make_meshes.py --check   check the bodies and that the files here are what would be written; write nothing
    python3 make_meshes.py --table   polygons, area and estimated patches of every group
"""
import math
import pathlib
import sys

import fittings
import mesh_kit
import orbiter
import payloads
import scene_files

HERE = pathlib.Path(__file__).resolve().parent
PATCH_EDGE = 0.45  # m, of the estimate in --table
ENVELOPE = 90.0 * mesh_kit.INCH  # payload envelope: this far from the axis [S]


def models():
    """File name -> (title, bodies)."""
    return {
        "orbiter": ("Fuselage around the payload bay, bulkheads, windows, pods, tail", orbiter.bodies()),
        "doors": ("Payload-bay doors, open, with radiators", orbiter.door_bodies()),
        "arm": ("Manipulator arm on its pedestals", fittings.arm()),
        "fittings": ("Antenna, lamps, cameras, latches, sidewall boxes",
                     fittings.bodies() + payloads.latches() + fittings.canisters()),
        "tss": ("Tethered satellite, stowed and raised, deployer, pallet",
                payloads.pallet() + payloads.deployer() + payloads.satellite("tss-stowed", 0.0)
                + payloads.satellite("tss-raised", payloads.BOOM_LENGTH) + payloads.boom("tss-raised")),
        "eureca": ("EURECA", payloads.eureca()),
        "bridge": ("Experiment bridge", payloads.experiment_bridge()),
    }


def group_table(all_models):
    """(file, group) -> [polygons, area, estimated patches]."""
    table = {}
    for file, (_, bodies) in all_models.items():
        for body in bodies:
            for group, _, points in body.faces:
                row = table.setdefault((file, group), [0, 0.0, 0])
                row[0] += 1
                row[1] += mesh_kit.length(mesh_kit.area_vector(points))
                row[2] += mesh_kit.patch_estimate(points, PATCH_EDGE)
    return table


def scene_totals(table):
    """Polygons, area and patches of what a scene file names."""
    rows = [table[(mesh, part)] for _, mesh, part, _, _ in scene_files.OBJECTS]
    return tuple(sum(row[i] for row in rows) for i in range(3))


def outputs(all_models):
    """Path -> text of every generated file."""
    files = {f"meshes/{name}.obj": mesh_kit.obj_text(title, bodies) for name, (title, bodies) in all_models.items()}
    for scene in scene_files.SCENES:
        files[f"{scene}.toml"] = scene_files.scene_text(scene)
    return files


# ---- checks ---------------------------------------------------------------------------------------------------------
def problems_of(all_models):
    problems = scene_files.material_problems()
    known = {m[0] for m in scene_files.MATERIALS}
    used = set()
    for _, bodies in all_models.values():
        for body in bodies:
            problems += mesh_kit.check_body(body)
            used |= {material for _, material, _ in body.faces}
    problems += [f"material {m} is not defined" for m in sorted(used - known)]
    problems += [f"material {m} is not used" for m in sorted(known - used)]
    groups = set(group_table(all_models))
    named = {(mesh, part) for _, mesh, part, _, _ in scene_files.OBJECTS}
    problems += [f"{mesh}.obj has no group {part}" for mesh, part in sorted(named - groups)]
    problems += [f"no scene shows group {part} of {mesh}.obj" for mesh, part in sorted(groups - named)
                 if part != "tss-raised"]
    return problems + clearance_problems(all_models) + lamp_problems(all_models)


def clearance_problems(all_models):
    """Stowed payloads stay inside the 90 in envelope; trunnions and the keel fittings reach out to the latches."""
    problems = []
    for file in ("tss", "eureca", "bridge"):
        for body in all_models[file][1]:
            if "trunnion" in body.name or body.name.startswith("tss-raised"):
                continue
            reach = max(math.hypot(p[1], p[2]) for _, _, points in body.faces for p in points)
            if reach > ENVELOPE:
                problems.append(f"{body.name}: {reach:.3f} m from the axis, envelope {ENVELOPE:.3f} m")
    return problems


def inside(point, body):
    """Is a point inside a closed body? Sum of the solid angles its faces cover."""
    total = 0.0
    for _, _, points in body.faces:
        for i in range(1, len(points) - 1):
            a, b, c = (mesh_kit.sub(p, point) for p in (points[0], points[i], points[i + 1]))
            la, lb, lc = map(mesh_kit.length, (a, b, c))
            above = mesh_kit.dot(a, mesh_kit.cross(b, c))
            below = (la * lb * lc + mesh_kit.dot(a, b) * lc + mesh_kit.dot(b, c) * la + mesh_kit.dot(c, a) * lb)
            total += 2.0 * math.atan2(above, below)
    return total > 2.0 * math.pi


def lamp_problems(all_models):
    """Lamps and camera eyes stand in the open, not inside a body."""
    problems = []
    points = [(lamp[0], fittings.light_position(lamp)) for lamp in fittings.lamp_list()]
    points += [(f"camera {c[0]}", fittings.eye_position(c)) for c in fittings.CAMERAS]
    for _, bodies in all_models.values():
        for body in bodies:
            problems += [f"{name} is inside {body.name}" for name, point in points if inside(point, body)]
    return problems


def main(arguments):
    if arguments not in ([], ["--check"], ["--table"]):
        print(__doc__, file=sys.stderr)
        return 2
    all_models = models()
    table = group_table(all_models)
    if arguments == ["--table"]:
        print(f"{'file':10} {'group':22} {'polygons':>8} {'area m2':>9} {'patches':>8}")
        for (file, group), (count, area, patches) in table.items():
            print(f"{file:10} {group:22} {count:8d} {area:9.3f} {patches:8d}")
        print("a scene: {} polygons, {:.1f} m2, about {} patches at {} m".format(*scene_totals(table), PATCH_EDGE))
        return 0
    problems = problems_of(all_models)
    for path, text in outputs(all_models).items():
        target = HERE / path
        if arguments == ["--check"]:
            if not target.exists() or target.read_text(encoding="utf-8") != text:
                problems.append(f"{path} is not what make_meshes.py writes")
        elif not problems:
            target.parent.mkdir(exist_ok=True)
            target.write_text(text, encoding="utf-8", newline="\n")
    for line in problems:
        print(line, file=sys.stderr)
    bodies = sum(len(bodies) for _, bodies in all_models.values())
    polygons = sum(row[0] for row in table.values())
    if not problems:
        print(f"{bodies} closed bodies, {polygons} polygons in {len(table)} groups: all well")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
