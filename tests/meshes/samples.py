"""Files of meshes, made by hand: what tests of them and the fuzz targets begin with."""
import base64
import json
import struct
import zlib

# A cube with corners at 0 and 1, wound outwards.
CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
STRIPS = [[corner for a, b, c, d in SIDES for corner in (b, c, a, d, -1)]]
TRIANGLES = [half for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]

SIZES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}


def ply(form, vertices=CORNERS, faces=SIDES, place="float", count="uchar", index="int", name="vertex_indices", vertex_colors=None,
        face_colors=None, color="uchar", face_first=False, extra=False, element="face"):
    """A PLY file. `form`: ascii, little or big. `extra`: elements and properties, with lists, that mean nothing here."""
    def number(kind, value):
        return (b"%r " % (value,)).replace(b"'", b"") if form == "ascii" else struct.pack("<>"[form == "big"] + SIZES[kind], value)

    end = b"\n" if form == "ascii" else b""
    colors = [f"property {color} {c}" for c in ("red", "green", "blue")]
    vertex_head = [f"element vertex {len(vertices)}"] + [f"property {place} {axis}" for axis in "xyz"]
    vertex_head += (["property list uchar double more", "property float quality"] if extra else []) + (colors if vertex_colors else [])
    face_head = [f"element {element} {len(faces)}"] + (["property list ushort float texcoord", "property char flags"] if extra else [])
    face_head += [f"property list {count} {index} {name}"] + (colors if face_colors else [])
    vertex_rows, face_rows = b"", b""
    for i, vertex in enumerate(vertices):
        vertex_rows += b"".join(number(place, v) for v in vertex)
        if extra:
            vertex_rows += number("uchar", i % 3) + b"".join(number("double", 7.5) for _ in range(i % 3)) + number("float", 0.5)
        vertex_rows += b"".join(number(color, c) for c in vertex_colors[i]) if vertex_colors else b""
        vertex_rows += end
    for i, face in enumerate(faces):
        if extra:
            face_rows += number("ushort", i % 4) + b"".join(number("float", 1.5) for _ in range(i % 4)) + number("char", -5)
        face_rows += number(count, len(face)) + b"".join(number(index, v) for v in face)
        face_rows += b"".join(number(color, c) for c in face_colors[i]) if face_colors else b""
        face_rows += end
    other_head, other_rows = [], b""
    if extra:
        other_head = ["element camera 1", "property list int short shape", "property double focus"]
        other_rows = number("int", 2) + number("short", -1) + number("short", 4) + number("double", 0.25) + end
    heads, rows = [vertex_head, face_head], [vertex_rows, face_rows]
    if face_first:
        heads, rows = heads[::-1], rows[::-1]
    heads, rows = heads[:1] + [other_head] + heads[1:], rows[:1] + [other_rows] + rows[1:]
    forms = {"ascii": "ascii", "little": "binary_little_endian", "big": "binary_big_endian"}
    lines = ["ply", f"format {forms[form]} 1.0", "comment by hand"] + [line for head in heads for line in head] + ["end_header"]
    return "\n".join(lines).encode() + b"\n" + b"".join(rows)


def obj(vertices=CORNERS, faces=SIDES, corner="{0}", base=1):
    """An OBJ file. `corner`: how a face names vertex {0}."""
    return "".join("v %r %r %r\n" % tuple(v) for v in vertices) + "".join(
        "f " + " ".join(corner.format(i + base) for i in face) + "\n" for face in faces)


def stl_binary(vertices=CORNERS, triangles=TRIANGLES, header=b"", count=None, attribute=0):
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for v in t for c in vertices[v]), attribute) for t in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", len(triangles) if count is None else count) + rows


def stl_text(vertices=CORNERS, triangles=TRIANGLES, name="a cube"):
    facets = "".join("facet normal 0 0 0\n  outer loop\n" + "".join("    vertex %r %r %r\n" % tuple(vertices[v]) for v in t) +
                     "  endloop\nendfacet\n" for t in triangles)
    return f"solid {name}\n{facets}endsolid {name}\n"


def off(vertices=CORNERS, faces=SIDES, keyword="OFF", behind_vertex="", behind_face="", counts=None):
    counts = counts or "\n%d %d 0\n" % (len(vertices), len(faces))
    return keyword + counts + "".join("%r %r %r%s\n" % (*v, behind_vertex) for v in vertices) + "".join(
        f"{len(face)} " + " ".join(map(str, face)) + f"{behind_face}\n" for face in faces)


COMPONENTS = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}


class Gltf:
    """A glTF file, put together by hand: accessors first, then what uses them."""

    def __init__(self):
        self.bytes, self.document = b"", {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "buffers": []}

    def view(self, content, **members):
        self.bytes += bytes(-len(self.bytes) % 4)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(content), **members})
        self.bytes += content
        return len(self.document["bufferViews"]) - 1

    def accessor(self, rows, kind="f", form="VEC3", normalized=False, gap=0, **members):
        """Rows of numbers; `gap`: bytes between them."""
        rows = [row if isinstance(row, (tuple, list)) else (row,) for row in rows]
        packed = [struct.pack(f"<{len(row)}{kind}", *row) for row in rows]
        view = self.view(bytes(gap).join(packed), **({"byteStride": len(packed[0]) + gap} if gap else {}))
        self.document["accessors"].append({"bufferView": view, "componentType": COMPONENTS[kind], "count": len(rows), "type": form,
                                           **({"normalized": True} if normalized else {}), **members})
        return len(self.document["accessors"]) - 1

    def add(self, **members):
        """Members at the top of the document."""
        self.document.update(members)
        return self

    def text(self, uri=None):
        """In JSON; `uri`: of the numbers, which are in the document where it is not given."""
        uri = uri or "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        return json.dumps({**self.document, "buffers": [{"byteLength": len(self.bytes), "uri": uri}]}).encode()

    def binary(self):
        text = json.dumps({**self.document, "buffers": [{"byteLength": len(self.bytes)}]}).encode()
        text += b" " * (-len(text) % 4)
        numbers = self.bytes + bytes(-len(self.bytes) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(numbers), b"BIN\0") + numbers
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def gltf(vertices=CORNERS, triangles=TRIANGLES, index="H", node=(), mode=None, primitive=(), attributes=(), **members):
    """One mesh at one node, of which the members are given; attributes: (name, rows, arguments of accessor())."""
    made = Gltf()
    uses = {"POSITION": made.accessor(vertices)}
    for name, rows, more in attributes:
        uses[name] = made.accessor(rows, **more)
    corners = [corner for triangle in triangles for corner in triangle]
    of_mesh = {"attributes": uses, **({"indices": made.accessor(corners, index, "SCALAR")} if index else {}),
               **({} if mode is None else {"mode": mode}), **dict(primitive)}
    return made.add(**{"meshes": [{"primitives": [of_mesh]}], "nodes": [{"mesh": 0, **dict(node)}], "scenes": [{"nodes": [0]}], "scene": 0,
                       **members})


L_SHAPE = [(0, 0, 0), (4, 0, 0), (4, 1, 0), (1, 1, 0), (1, 4, 0), (0, 4, 0)]
MTL = """# a library
newmtl red
Kd 0.8 0.1 0.1
Ke 0 0 0
Ni 1.5
d 0.5
newmtl lamp light
Kd 0
Ke 4 4 3
map_Kd wood.png
Tr 0.25
"""
OBJ_WITH_MTL = "mtllib m\n" + obj(faces=[]) + """vt 0 0
vn 0 0 1
o cube
usemtl red
f 1/1/1 2/1/1 4/1/1 3/1/1
f -4//1 -2//1 \\
  -1//1 -3//1
usemtl lamp light
f 1/1 5/1 6/1 2/1
l 1 2
p 3
"""
COLORS = [(255, 0, 0), (0, 128, 255)] * 4


def gzip_of(content):
    """Packed by gzip in stored blocks: the same bytes with every zlib."""
    blocks = b"".join(struct.pack("<BHH", at + 65535 >= len(content), len(part), 0xffff - len(part)) + part
                      for at in range(0, len(content), 65535) for part in [content[at:at + 65535]])
    return b"\x1f\x8b\x08\0\0\0\0\0\0\xff" + blocks + struct.pack("<II", zlib.crc32(content), len(content))


def seeds():
    """{folder: {name: bytes}} for the fuzz targets."""
    text = ply("ascii", extra=True, face_colors=COLORS[:6])
    cube = obj()
    return {
        "meshes_ply": {"ascii": text, "little": ply("little", extra=True, vertex_colors=COLORS), "big": ply("big", index="ushort"),
                       "faces-first": ply("little", face_first=True, count="int"), "cut": ply("little")[:-5],
                       "huge": text.replace(b"face 6", b"face 1000000000"), "l": ply("ascii", L_SHAPE, [range(6)]),
                       "strips": ply("little", faces=STRIPS, element="tristrips"), "strip": ply("ascii", faces=STRIPS, element="tristrips"),
                       "coordinates": b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n"
                                      b"element face 2\nproperty list uchar float texcoord\nproperty list uchar int vertex_indices\nend_header\n"
                                      b"0 0 0 0.5 nan\n1 0 0 1 0\n0 1 0 0 1\n6 0 0 1 0 0.5 1e9 3 0 1 2\n2 1 1 3 2 1 0\n",
                       "gz": gzip_of(text)},
        "meshes_obj": {"plain": cube.encode(), "mtl": OBJ_WITH_MTL.encode() + b"\0" + MTL.encode(), "l": obj(L_SHAPE, [range(6)]).encode(),
                       "colours": b"v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n", "no-corners": b"v 0 0 0\nf\n", "curve": b"v 0 0 0\ncstype bezier\n",
                       "coordinates": b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5 0.25\nvt 2 -1 7\nvt x\nf 1/1 2/2/1 3/-1 4/9\nf 1 2/2 3/3\nvt 0.125\n",
                       "images": b"mtllib m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n\0newmtl a\nmap_Kd -s 1 2 -clamp on -mm 0 1 maps\\a b.png\n"
                                 b"newmtl b\nmap_Kd -o\nmap_Kd -blendu\nmap_Kd -\nmap_Kd -s 1 2 3 4 5\nmap_Kd  \n",
                       "bow": b"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n",
                       "holed": b"v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 2 2 0\nv 2 6 0\nv 6 6 0\nv 6 2 0\nf 1 2 3 4 1 5 6 7 8 5\n"},
        "meshes_stl": {"text": stl_text(triangles=TRIANGLES[:3]).encode(), "binary": stl_binary(triangles=TRIANGLES[:4], attribute=3),
                       "solid": stl_binary(triangles=TRIANGLES[:2], header=b"solid binary"), "liar": stl_binary(triangles=TRIANGLES[:2], count=10 ** 9)},
        "meshes_gltf": {"text": gltf().text(), "binary": gltf(index="B").binary(),
                        "turned": gltf(node={"rotation": [0, 0.6, 0, 0.8], "scale": [1, -2, 3], "children": [1]},
                                       attributes=[("NORMAL", CORNERS, {}), ("COLOR_0", [(9, 8, 7, 255)] * 8, {"kind": "B", "form": "VEC4", "normalized": True})],
                                       nodes=[{"mesh": 0, "matrix": [2.0 * (i % 5 == 0) for i in range(16)], "children": [1]}, {"translation": [1, 2, 3], "mesh": 0}],
                                       materials=[{"name": "a", "emissiveFactor": [1, 0, 0]}], primitive={"material": 0}).binary(),
                        "skin": gltf(attributes=[("JOINTS_0", [(0, 1, 0, 0)] * 8, {"kind": "B", "form": "VEC4"}),
                                                 ("WEIGHTS_0", [(0.5, 0.5, 0, 0)] * 8, {"form": "VEC4"})],
                                     nodes=[{"mesh": 0, "skin": 0, "children": [1, 2]}, {"translation": [1, 0, 0]}, {"scale": [2, 2, 2]}],
                                     skins=[{"joints": [1, 2]}]).binary(),
                        "coordinates": gltf(attributes=[("TEXCOORD_0", [(i, 0.25 * i) for i in range(8)], {"form": "VEC2"})], primitive={"material": 0},
                                            materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {
                                                "KHR_texture_transform": {"offset": [0.5, 1], "rotation": 0.3, "scale": [2, -1]}}}}}]).binary(),
                        "images": gltf(primitive={"material": 0}, materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
                                       textures=[{"source": 0, "sampler": 0}], samplers=[{"wrapS": 33071}],
                                       images=[{"uri": "data:image/png;base64,iVBORw0KGgo="}, {"uri": "a%20b.png"}, {"bufferView": 0}]).text(),
                        "strip": gltf(triangles=[(0, 1, 2, 3)], mode=5, index="B").text(), "fan": gltf(index=None, mode=6).binary()},
        "meshes_off": {"plain": off().encode(), "colours": off(keyword="COFF", behind_vertex=" 255 0 9 255").encode(),
                       "faces": off(behind_face=" 0.5 0.25 1").encode(), "all": off(keyword="STCNOFF", behind_vertex=" 0 0 1 1 0 0 1 0.5 0.5").encode(),
                       "counts": off(counts=" 8 6 # many\n").encode(), "huge": off(counts=" 1000000000 1000000000 0\n").encode()},
    }
