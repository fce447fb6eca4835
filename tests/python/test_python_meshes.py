"""Meshes from arrays: the same pictures as from triangles of a document, colours of faces and vertices, quads, and what is refused.

Usage: test_python_meshes.py SOURCE_DIR BUILD_DIR
"""

import sys

import package
from package import refused

ballpark, np = package.load(*sys.argv[1:])

CORNERS = np.array([[corner >> axis & 1 for axis in range(3)] for corner in range(8)], np.float64)
QUADS = np.array([(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)])
FACES = QUADS[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
CAMERA = {"image_width": 24, "vfov": 35, "lookfrom": [4, 3, 5], "lookat": [0.5, 0.5, 0.5]}
DOCUMENT = {"camera": CAMERA, "materials": {"clay": {"type": "lambertian", "albedo": [0.5, 0.25, 0.125]},
                                            "glass": {"type": "dielectric", "refraction_index": 1.5}}}


def rgb(scene, spp=4):
    return np.array(ballpark.render(scene, spp=spp).radiance)


def with_mesh(*arguments, **named):
    return ballpark.Scene(DOCUMENT, ballpark.Mesh(*arguments, **named))


def listed(materials, names):
    """The cube as triangles of the document."""
    triangles = [{"vertices": CORNERS[face].tolist(), "material": name} for face, name in zip(FACES, names)]
    return ballpark.Scene({**DOCUMENT, "materials": {**DOCUMENT["materials"], **materials}, "triangles": triangles})


# Every type and layout of the arrays is the picture of the same triangles in a document, bit for bit.
for material in ("clay", "glass"):
    expected = rgb(listed({}, [material] * 12))
    for vertices in (CORNERS, CORNERS.astype(np.float32), np.asfortranarray(CORNERS), CORNERS.tolist(), CORNERS.astype(int),
                     np.repeat(CORNERS, 2, axis=1)[:, ::2]):
        assert np.array_equal(rgb(with_mesh(vertices, FACES, material=material)), expected)
    for faces in (FACES.astype(np.uint8), FACES.astype(np.int16), FACES.astype(np.uint64), FACES.tolist(), np.asfortranarray(FACES), QUADS):
        assert np.array_equal(rgb(with_mesh(CORNERS, faces, material=material)), expected)
assert with_mesh(CORNERS, QUADS, material="glass").triangles == 12
sphere = ballpark.Spheres([[3.0, 0, 0]], 0.5, material="clay")
both = ballpark.Scene(DOCUMENT, [ballpark.Mesh(CORNERS, FACES, material="clay"), sphere, ballpark.Mesh(CORNERS + 2, QUADS, material="glass")])
assert (both.spheres, both.triangles) == (1, 24)

# Colours are those of faces, or of vertices, of which each face has the mean; materials in a document say the same.
shades = np.arange(12) / 16
materials = {f"m{k}": {"type": "lambertian", "albedo": [shade, 0.5, 0.25]} for k, shade in enumerate(shades)}
expected = rgb(listed(materials, list(materials)))
colors = np.stack([shades, np.full(12, 0.5), np.full(12, 0.25)], axis=1)
assert np.array_equal(rgb(with_mesh(CORNERS, FACES, colors, material="clay")), expected)
assert np.array_equal(rgb(with_mesh(CORNERS, FACES, colors.astype(np.float32), material="clay")), expected)
of_vertices = np.stack([CORNERS[:, 0], np.full(8, 0.5), np.full(8, 0.25)], axis=1)
means = {f"m{k}": {"type": "lambertian", "albedo": [k / 3, 0.5, 0.25]} for k in range(4)}
expected = rgb(listed(means, [f"m{int(CORNERS[face][:, 0].sum())}" for face in FACES]))
assert np.allclose(rgb(with_mesh(CORNERS, FACES, of_vertices, material="clay")), expected, atol=1e-6)
of_quads = np.repeat(shades[:6], 3).reshape(6, 3)
materials = {f"m{k}": {"type": "lambertian", "albedo": [shade] * 3} for k, shade in enumerate(shades[:6])}
expected = rgb(listed(materials, np.repeat(list(materials), 2).tolist()))
assert np.array_equal(rgb(with_mesh(CORNERS, QUADS, of_quads, material="clay")), expected)
assert np.array_equal(rgb(with_mesh(CORNERS, FACES, (0.5, 0.25, 0.125), material="clay")), rgb(with_mesh(CORNERS, FACES, material="clay")))

# Normals of vertices are those of a document's triangles, of any length and layout; without them, those of faces.
normals = (CORNERS - 0.5) * 2
smooth = [{"vertices": CORNERS[face].tolist(), "normals": normals[face].tolist(), "material": "clay"} for face in FACES]
expected = rgb(ballpark.Scene({**DOCUMENT, "triangles": smooth}))
for given in (normals, normals.astype(np.float32), (normals * 4).tolist(), np.asfortranarray(normals)):
    assert np.allclose(rgb(with_mesh(CORNERS, FACES, normals=given, material="clay")), expected, atol=1e-4)
assert not np.allclose(rgb(with_mesh(CORNERS, FACES, material="clay")), expected, atol=0.01)
by_faces = rgb(with_mesh(CORNERS, FACES, smooth=True, material="clay"))  # a cube's corners have three right angles
assert np.allclose(by_faces, expected, atol=1e-4)
refused(ballpark.SceneError, "normals: found an array of shape (7, 3), expected (8, 3)", with_mesh, CORNERS, FACES, normals=normals[:7], material="clay")
refused(ballpark.SceneError, "normals: found no finite number for vertex 1", with_mesh, CORNERS, FACES, normals=np.where(normals > 0, np.nan, normals), material="clay")
framed = ballpark.render(vertices=CORNERS, faces=FACES, normals=normals, width=24, spp=4)
assert np.array_equal(np.array(framed.radiance), np.array(ballpark.render(ballpark.Mesh(CORNERS, FACES, normals=normals), width=24, spp=4).radiance))

# What fills a mesh is a medium of the document, by its name or as a dict, and of this mesh alone.
FOG = {"scattering": [3, 2, 1], "absorption": 0.5, "anisotropy": 0.25}
FOGGY = {**DOCUMENT, "media": {"thin": {"scattering": 0.25}, "fog": FOG}, "materials": {**DOCUMENT["materials"], "edge": {"type": "interface"}}}
apart = CORNERS + [0, 0, 1.5]
filled = [{"vertices": (CORNERS if k < 12 else apart)[FACES[k % 12]].tolist(), "material": "edge", "interior": "fog" if k < 12 else "thin"} for k in range(24)]
expected = rgb(ballpark.Scene({**FOGGY, "triangles": filled}))
for first in ("fog", FOG):
    assert np.array_equal(rgb(ballpark.Scene(FOGGY, [ballpark.Mesh(CORNERS, FACES, material="edge", interior=first),
                                                     ballpark.Mesh(apart, QUADS, material="edge", interior="thin")])), expected)
refused(ballpark.SceneError, 'mesh: interior: found the medium "fogg", expected a name from "media"; did you mean "fog"?', ballpark.Scene, FOGGY,
        ballpark.Mesh(CORNERS, FACES, material="edge", interior="fogg"))
refused(ballpark.SceneError, "no material of the mesh lets light in", ballpark.Scene, FOGGY, ballpark.Mesh(CORNERS, FACES, material="clay", interior="fog"))
refused(ballpark.SceneError, "the edge from", ballpark.Scene, FOGGY, ballpark.Mesh(CORNERS, FACES[:11], material="edge", interior="fog"))
refused(TypeError, "interior: found int", ballpark.Scene, FOGGY, ballpark.Mesh(CORNERS, FACES, material="edge", interior=3))
framed = ballpark.render(vertices=CORNERS, faces=FACES, material={"type": "interface"}, interior="fog", media={"fog": FOG}, width=24, spp=4)
alone = ballpark.Mesh(CORNERS, FACES, material={"type": "interface"}, interior=FOG)
assert np.array_equal(np.array(framed.radiance), np.array(ballpark.render(alone, width=24, spp=4).radiance))

# Texture coordinates of vertices, and of corners, are those of a document's triangles.
TEXTURES = {"map": {"type": "checker", "mapping": "surface", "colors": [0.1, [0.9, 0.5, 0.2]], "repeat": [3, 2]}}
PAINTED = {"painted": {"type": "lambertian", "albedo": {"texture": "map"}}}
uvs = CORNERS[:, :2] * 0.75 + CORNERS[:, 2:] * 0.125
of_corners = np.random.default_rng(5).uniform(-2, 3, (12, 3, 2)).astype(np.float32)


def with_uvs(faces, given, **more):
    document = {**DOCUMENT, "materials": {**DOCUMENT["materials"], **PAINTED}, "textures": TEXTURES}
    return rgb(ballpark.Scene(document, ballpark.Mesh(CORNERS, faces, uvs=given, material="painted", **more)))


def painted(pairs):
    listed_ = [{"vertices": CORNERS[face].tolist(), "uvs": np.asarray(pair, float).tolist(), "material": "painted"} for face, pair in zip(FACES, pairs)]
    return rgb(ballpark.Scene({**DOCUMENT, "materials": {**DOCUMENT["materials"], **PAINTED}, "textures": TEXTURES, "triangles": listed_}))


for given in (uvs, uvs.astype(np.float32), uvs.tolist(), np.asfortranarray(uvs), uvs[FACES]):
    assert np.array_equal(with_uvs(FACES, given), painted(uvs[FACES]))
assert np.array_equal(with_uvs(FACES, of_corners), painted(of_corners))
quads = np.random.default_rng(6).uniform(-2, 3, (6, 4, 2)).astype(np.float32)
assert np.array_equal(with_uvs(QUADS, quads), painted(quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, 2)))
assert np.array_equal(with_uvs(QUADS, uvs), painted(uvs[FACES]))
refused(ballpark.SceneError, "uvs: found an array of shape (8, 3), expected (8, 2), a pair for each vertex, or (12, 3, 2)", with_uvs, FACES, CORNERS)
refused(ballpark.SceneError, "uvs: found no finite number for face 2", with_uvs, FACES, np.where(np.arange(72).reshape(12, 3, 2) == 13, np.nan, of_corners))
refused(ballpark.SceneError, "vertex 3 (from 0) of mesh: texture coordinates: found 2e+06", with_uvs, FACES, np.where(np.arange(16).reshape(8, 2) == 7, 2e6, uvs))
refused(ballpark.SceneError, "no texture coordinates", with_uvs, FACES, None)
one = ballpark.render(vertices=CORNERS, faces=FACES, uvs=uvs, material="painted", materials=PAINTED, textures=TEXTURES, width=24, spp=4)
assert np.array_equal(np.array(one.radiance), np.array(ballpark.render(ballpark.Mesh(CORNERS, FACES, uvs=uvs, material="painted"), materials=PAINTED, textures=TEXTURES, width=24, spp=4).radiance))

# Numbers go through a map.
mapped = rgb(with_mesh(CORNERS, FACES, np.arange(12.0), material="clay", cmap="viridis"))
assert len(np.unique(mapped.round(3), axis=0)) > 3

# Alone, a mesh is framed and lit; everything of it is in the picture.
picture = ballpark.render(vertices=CORNERS, faces=FACES, width=40, spp=8)
image = np.array(picture.radiance)
dark = np.argwhere(image[..., 2] < 0.62 * image.max())
assert 0.2 < len(dark) / image[..., 0].size < 0.8
assert dark.min() > 0 and (dark.max(axis=0) < np.array(image.shape[:2]) - 1).all()
same = ballpark.render(ballpark.Mesh(CORNERS, FACES), width=40, spp=8)
assert np.array_equal(image, np.array(same.radiance))
scene = ballpark.make_scene(vertices=CORNERS, faces=FACES, up="z")
assert scene.camera.vup == (0, 0, 1)
ballpark.render(vertices=CORNERS, faces=FACES, colors="#4477aa", material={"type": "metal", "albedo": [1, 1, 1]}, width=16, spp=1)

# What is wrong is named.
bad = CORNERS.copy()
bad[3, 1] = np.nan
for words, vertices, faces in (("expected (N, 3)", CORNERS[:, :2], FACES), ("as in vertices.T", CORNERS.T, FACES),
                               ("in vertex 3 (from 0)", bad, FACES), ("in vertex 5 (from 0)", np.where(np.arange(8)[:, None] == 5, np.inf, CORNERS), FACES),
                               ("expected (F, 3) or (F, 4)", CORNERS, FACES[0]), ("as in faces.T", CORNERS, FACES.T),
                               ("expected whole numbers", CORNERS, FACES.astype(float)), ("expected whole numbers", CORNERS, FACES > 2),
                               ("found vertex 8 in face 2 (from 0), expected numbers from 0 to 7", CORNERS, np.vstack([FACES[:2], [[0, 1, 8]]])),
                               ("found vertex -1 in face 0 (from 0)", CORNERS, [[0, 1, -1]])):
    refused(ballpark.SceneError, words, with_mesh, vertices, faces, material="clay")
    refused(ballpark.SceneError, words, ballpark.render, vertices=vertices, faces=faces)
refused(ballpark.SceneError, ["open", "from vertex", "lets light in"], with_mesh, CORNERS, FACES[:-1], material="glass")
refused(ballpark.SceneError, "expected (3,), (12, 3)", with_mesh, CORNERS, FACES, np.zeros((5, 3)), material="clay")
refused(ballpark.SceneError, "vertex 2 (from 0)", with_mesh, CORNERS, FACES, np.where(np.arange(8)[:, None] == 2, np.nan, of_vertices), material="clay")
refused(ballpark.SceneError, 'found the material "gold"', with_mesh, CORNERS, FACES, material="gold")
refused(TypeError, "expected them beside vertices", ballpark.render, vertices=CORNERS)
refused(TypeError, "or vertices= and faces=", ballpark.render)
refused(TypeError, "one or the other", ballpark.render, CORNERS, vertices=CORNERS, faces=FACES)
refused(ballpark.SceneError, "expected colors", ballpark.render, vertices=CORNERS, faces=FACES, color="#fff")
