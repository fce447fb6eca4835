"""What trimesh finds in files of meshes, as JSON. Run by test_mesh_files.py, in a Python that has it; exit code 77: it has not.

python3 independent_meshes.py read FILE...      counts, area, box, closedness, and the places of the vertices that faces have, of each
python3 independent_meshes.py write FOLDER      writes meshes of its own in all formats, and says what they hold
"""
import json
import logging
import os
import sys
import warnings

try:
    import numpy
    import trimesh
except ImportError:
    sys.exit(77)
warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)


def read(paths):
    found = {}
    for path in paths:
        try:
            mesh = trimesh.load(path, process=False, force="mesh")
        except Exception:  # what it cannot read, it refuses in many ways
            found[path] = None
            continue
        if len(mesh.faces) == 0:
            found[path] = None
            continue
        flat = mesh.area_faces <= 1e-9 * max(mesh.area_faces, default=0)
        used = mesh.vertices[numpy.unique(mesh.faces[~flat])]
        found[path] = {"triangles": len(mesh.faces), "vertices": len(mesh.vertices), "area": float(mesh.area), "box": mesh.bounds.tolist(),
                       "closed": bool(mesh.is_watertight and mesh.is_winding_consistent),
                       "places": sorted({tuple(round(float(c), 5) + 0.0 for c in place) for place in used})}
    return found


def write(folder):
    random = numpy.random.default_rng(5)
    ball, box = trimesh.creation.icosphere(subdivisions=3), trimesh.creation.box((1, 2, 3))
    ring = trimesh.creation.torus(2, 0.5)
    opened = trimesh.Trimesh(ball.vertices, ball.faces[:-7], process=False)
    for name, mesh in {"ball": ball, "box": box, "ring": ring, "open": opened}.items():
        for ending, options in ((".ply", {}), (".ply", {"encoding": "ascii"}), (".obj", {}), (".stl", {}), (".off", {})):
            path = os.path.join(folder, f"{name}-{len(os.listdir(folder))}{ending}")
            mesh.export(path, **options)
            yield {"path": path, "triangles": len(mesh.faces), "area": float(mesh.area), "volume": float(mesh.volume),
                   "closed": bool(mesh.is_watertight and mesh.is_winding_consistent)}
    for kind, count in (("vertex_colors", len(ball.vertices)), ("face_colors", len(ball.faces))):
        colors = random.integers(0, 256, (count, 4), dtype=numpy.uint8)
        colored = trimesh.Trimesh(ball.vertices, ball.faces, process=False, **{kind: colors})
        path = os.path.join(folder, f"{kind}.ply")
        colored.export(path)
        yield {"path": path, "triangles": len(ball.faces), "area": float(ball.area), "volume": float(ball.volume), "closed": True,
               kind: colors[:, :3].tolist()}


if __name__ == "__main__":
    print(json.dumps(read(sys.argv[2:]) if sys.argv[1] == "read" else list(write(sys.argv[2]))))
