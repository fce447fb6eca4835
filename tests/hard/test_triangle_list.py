#!/usr/bin/env python3
"""The hard cases of triangles: what each must show, and which tests show it. Fails if one of these tests has gone.

Run as: python3 test_triangle_list.py SOURCE_DIR
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else ".")
EDGES, CASES = "tests/hard/test_triangles.c", "tests/hard/test_triangle_cases.c"
TRIANGLES, OPTICS, MESHES = "tests/agree/test_triangles.py", "tests/agree/test_triangle_optics.py", "tests/meshes/test_mesh_scenes.py"
FILES, READ, FORMS = "tests/meshes/test_mesh_files.py", "tests/meshes/test_mesh_read.c", "tests/render/test_render_same.c"

# Capsules have theirs in test_capsules.c. Normals between vertices (their fold, their furnace) would have cases of their own;
# Ballpark does not have them.
HARD_CASES = {
    "a million rays at edges of closed meshes, and as many at vertices: none is lost, with double and with pairs of floats": [(EDGES, "main")],
    "size a millionth of the distance: no decision is wrong beyond 1e-5 of an edge": [(CASES, "small_from_afar"), (CASES, "far_from_the_camera")],
    "a ground of 2e6 in two triangles, 1 below: distances to 5e-7": [(CASES, "ground"), (CASES, "leaning_ground")],
    "along the diagonal of a quad: one event": [(CASES, "diagonal"), (TRIANGLES, "test_exactly_on_an_edge")],
    "in the plane of a triangle: none": [(CASES, "in_its_plane")],
    "grazing by 1e-7: a finite distance, or none": [(CASES, "grazing")],
    "a sliver of 1 : 1e6: distances to 1e-12 in double": [(CASES, "sliver")],
    "sizes 1e-9 and 1e9: all finite": [(CASES, "tiny"), (CASES, "huge")],
    "moved by 1e6: the same picture": [(OPTICS, "test_moved")],
    "along axes, with -0, with two largest components: the same bits in all forms": [(CASES, "along_axes"), (OPTICS, "test_axes")],
    "boxes of no thickness, with an origin in their plane": [(CASES, "no_thickness"), (CASES, "edges_of_boxes")],
    "left outward, a convex mesh is not met again; left inward, always": [(EDGES, "main")],
    "concave edges: none is passed": [(CASES, "concave_edge")],
    "neighbours in one plane: not met": [(CASES, "coplanar")],
    "two triangles in one place: as one": [(CASES, "duplicate"), (TRIANGLES, "test_first_of_two")],
    "boxes of glass back to back: refused; a millionth apart: into one, out of it, into the other, out of it": [
        (TRIANGLES, "test_refusals"), (OPTICS, "test_a_millionth_apart")],
    "a matte box in one plane with the floor: as a millionth above, to 0.1 %; of glass: refused": [
        (OPTICS, "test_box_on_floor"), (TRIANGLES, "test_refusals"), (MESHES, "test_glass_on_a_floor")],
    "a slab at 45 degrees: 0.329142 aside, not turned": [(OPTICS, "test_slab")],
    "a prism of 60 degrees: 37.1808 degrees": [(TRIANGLES, "test_prism")],
    "index 1: not there, to 1e-6": [(TRIANGLES, "test_index_one")],
    "three mirrors: back, to 1e-6": [(OPTICS, "test_corner_reflector"), (TRIANGLES, "test_three_mirrors")],
    "furnaces: rho; E (1 - rho^K) / (1 - rho); 1": [(OPTICS, "test_convex_furnace"), (OPTICS, "test_closed_room"), (OPTICS, "test_glass_furnace")],
    "a ball of glass of 1.3 million triangles: as the sphere, to 0.1 %": [(OPTICS, "test_large_ball_of_glass"), (OPTICS, "test_ball_of_glass")],
    "points lie in their planes to 2^-45 (|p| + the longest edge)": [(CASES, "on_their_planes")],
    "the other winding: the same matte picture; of glass, its bubble": [(OPTICS, "test_winding"), (OPTICS, "test_bubble")],
    "glass that is open: refused": [(MESHES, "test_open_glass"), (TRIANGLES, "test_refusals")],
    "no area: dropped; a vertex twice: dropped; not a number: refused": [(READ, "no_area"), (FILES, "test_no_area"), (FILES, "test_hostile")],
    "the camera on a triangle: refused": [(TRIANGLES, "test_refusals")],
    "solid angles: 2.094395, 1.047198, 0.628319": [(OPTICS, "test_solid_angles")],
    "a lamp of side 1: 0.239456, 0.968340, 0.138532; seen from near its edge: by its closed form": [(OPTICS, "test_square_lamp")],
    "the middle of the Cornell box's floor, by the light alone: 0.152701": [(OPTICS, "test_cornell_floor")],
    "a lamp in one plane with what it would light: 0; a point on its edge: finite": [(OPTICS, "test_lamp_in_its_own_plane")],
    "a ball that touches a triangle: both events": [(OPTICS, "test_touching_ball"), (CASES, "ball_on_a_floor"), (CASES, "ball_in_a_corner")],
    "leaves of spheres and of triangles, list, tree and brute force: the same": [(FORMS, "triangles_are_the_same"), (TRIANGLES, "test_reference")],
    "the order of triangles: the same bits": [(OPTICS, "test_order")],
    "quads of PLY as triangles, ASCII as binary": [(FILES, "test_forms")]}


class HardCases(unittest.TestCase):
    def test_exist(self):
        for case, tests in HARD_CASES.items():
            for file, name in tests:
                self.assertRegex((ROOT / file).read_text(), re.compile(rf"^ *(def|static \w+|int) {name}\(", re.M), f"{case}: {file} has no {name}")


if __name__ == "__main__":
    unittest.main()
