"""What the program says of slips that people make: each message names the place, what was found, and what to write instead.

In:    documents with one slip, files of other programs, options of other renderers.   Out: the messages.
"""
import gzip
import struct

from cli import ProgramTest, main, scene


class Messages(ProgramTest):
    def refused(self, text, place, says):
        """`text` is a scene's; `place` is LINE:COLUMN."""
        self.write("s.json", text)
        result = self.fail_with(2, "render", "s.json", "-o", "x.png", says=[f"s.json:{place}: ", says])
        self.assertNotIn("x.png", self.files())
        return result.errors

    def test_numbers(self):
        for written, place in ((".5", 20), ("-.5", 20), ("5.", 20), ("+1", 20), ("007.50", 20), ("1e+", 20), ("0x10", 21), ("20deg", 22), ("1,5", 22)):
            for rest in ("}}", ', "max_depth": 3}}', " }\n}"):
                self.refused('{"camera":{"vfov": ' + written + rest, f"1:{place}", "digits on both sides of the point and without a unit")
        for written in ("NaN", "-inf", "Infinity"):
            self.refused('{"camera":{"vfov": %s}}' % written, "1:20", "JSON has no NaN and no Infinity: expected a finite number")
        self.write("s.json", scene(spheres=[]))
        self.fail_with(2, "render", "s.json", "--set", "camera.vfov=.5", says="the value is not JSON; numbers are written like 20, 0.5")

    def test_signs_and_words(self):
        for text, place, says in (
                ('{"camera":{"lookat": [1,2,3,]}}', "1:29", "is there a comma too many before it?"),
                ('{"camera":{"vfov": 1,\n}}', "2:1", "is there a comma too many before it?"),
                ('{"camera":{"vfov": 1,,"a":2}}', "1:22", "a comma too many: remove it"),
                ('{"camera":{"lookat": [,1,2,3]}}', "1:23", "a comma too many: remove it"),
                ('{"camera":{"vfov":,"a":2}}', "1:19", "a value is missing after the colon"),
                ('{"camera":{"vfov":}}', "1:19", "a value is missing after the colon"),
                ('{"camera"}', "1:10", "a colon and a value are missing"),
                ("{'camera':{'vfov': 1}}", "1:2", "double quotes"), ("{\"camera\":{\"view\": 'front'}}", "1:20", "double quotes"),
                ('{camera:{"vfov": 1}}', "1:2", "double quotes"), ('{"camera":{vfov: 1}}', "1:12", "double quotes"),
                ('{"camera":{"fit": True}}', "1:19", "true, false and null are written like that"),
                ('// a\n{"camera":{}}', "1:1", "JSON has no comments"), ('# a\n{"camera":{}}', "1:1", "JSON has no comments"),
                ('{"camera":{"vfov": 1 /* a */}}', "1:22", "JSON has no comments"),
                ('{"camera":{"lookat": (1,2,3)}}', "1:22", "square brackets: [1, 2, 3]"),
                ('{"camera":{"vfov"= 1}}', "1:18", "a colon stands between a name and its value"),
                ('{"camera":{"vfov": 1};"a":2}', "1:22", "is there a comma or a colon missing before it?"),
                ('{"camera":{"vfov": 1} "title": "a"}', "1:23", "is there a comma or a colon missing before it?"),
                ('{"camera":{"lookat": [1 2 3]}}', "1:25", "is there a comma or a colon missing before it?"),
                ('{"camera":{"vfov" 1}}', "1:19", "is there a comma or a colon missing before it?"),
                ('{"title": "a\nb"}', "1:11", "is its closing quote missing?")):
            self.refused(text, place, says)

    def test_brackets(self):
        for text, place, says in (
                ('{"camera":{"vfov": 1}\n', "2:1", "the { of line 1 is not closed, or the file is truncated"),
                ('{"camera":\n{"lookat":\n[1,2', "3:5", "the [ of line 3 is not closed"),
                ('{"title": "[abc', "1:16", "the quote of line 1 is not closed"),
                ('{"camera":{"lookat": [1,\n2,3}}', "2:4", "the [ of line 1 is not closed before it"),
                ('{"camera":\n{"vfov": 1]}', "2:11", "the { of line 2 is not closed before it"),
                ('{"camera":{"vfov": 1}}}', "1:23", "expected nothing after the closing brace")):
            self.refused(text, place, says)

    def test_shapes(self):
        for name in ("triangle", "box", "mesh", "cylinders", "planes"):
            said = self.refused('{"camera": {},\n "%s": []}' % name, "2:2", f"{name}: unknown member; shapes are written in")
            self.assertIn('"spheres", "triangles", "quads", "boxes" and "capsules", and files of them named in "clouds", "particles" or "meshes"', said)

    def test_a_former_name(self):
        self.refused('{"camera": {}, "light": "soft"}', "1:16", 'light: unknown member; "light" is now "lighting"')

    def test_near_names(self):
        """A suggestion is near, and never a name that is there already."""
        for name, near in (("spheers", "spheres"), ("spere", "spheres"), ("textur", "textures"), ("lihgting", "lighting"), ("backgroud", "background"),
                           ("material", "materials"), ("transfr", "transfer")):
            self.refused('{"camera": {}, "%s": []}' % name, "1:16", f'unknown member; did you mean "{near}"?')
        for name in ("transformations", "shading", "lookat", "pictures", "tone"):
            said = self.refused('{"camera": {}, "%s": []}' % name, "1:16", "unknown member; expected one of format, ")
            self.assertNotIn("did you mean", said)
        sphere = '{"camera": {}, "materials": {"alu": {"type": "metal", "albedo": [1, 1, 1]}},\n "spheres": [{"center": [0, 0, 0], %s}]}'
        said = self.refused(sphere % '"center2": [1, 1, 1], "radius": 1, "material": "alu"', "2:36", "unknown member; expected one of ")
        self.assertIn("center_end", said)
        said = self.refused(sphere % '"radius": 1, "material": "gold"', "2:61", 'found the material "gold", expected a name from "materials": "alu"')
        self.assertNotIn("did you mean", said)
        self.refused(sphere % '"radius": 1, "material": "aul"', "2:61", 'did you mean "alu"?')

    def test_options(self):
        self.write("s.json", scene())
        for option, says in (("--height", 'the height follows from --width and the scene\'s "aspect_ratio" or "image_height"'),
                             ("--samples", "--spp sets the samples per pixel"), ("--gpu", "--device gpu"),
                             ("--lamps", "--lamps is now --light-sampling"), ("--light", "--light is now --lighting"), ("--widht", "did you mean --width?"),
                             ("--tranfser", "did you mean --transfer?")):
            self.fail_with(2, "render", "s.json", option, "3", says=[f"unknown option {option}", says])
        for option in ("--weight", "--aperture", "--lens", "--sun"):
            said = self.fail_with(2, "render", "s.json", option, "3", says=[f"unknown option {option}; see `ballpark help render`"])
            self.assertNotIn("did you mean", said.errors)
        # merge has no width.
        self.assertNotIn("--width", self.fail_with(2, "merge", "s.bpa", "--height", "3").errors)

    CONVERT = "convert it, with ASE or MDAnalysis, to extended XYZ"
    TABLE = "convert it, to CSV or PLY"
    MESH = "give the path of a file named .ply, .obj, .stl, .off, .gltf or .glb"
    FILES = (("a.mtl", b"newmtl a\nKd 1 1 1\n", "the materials of a mesh (MTL)", MESH),
             ("a.xtc", struct.pack(">ii", 1995, 3) + bytes(90), "a trajectory of GROMACS (XTC)", CONVERT),
             ("unnamed", struct.pack(">ii", 1993, 3) + bytes(90), "a trajectory of GROMACS (TRR)", CONVERT),
             ("a.dcd", struct.pack("<i", 84) + b"CORD" + bytes(90), "a trajectory of CHARMM or NAMD (DCD)", CONVERT),
             ("a.nc", b"CDF\1" + bytes(90), "a NetCDF file", CONVERT), ("a.h5", b"\x89HDF\r\n\x1a\n" + bytes(90), "an HDF5 file", CONVERT),
             ("a.pcd", b"# .PCD v0.7 - Point Cloud Data file format\n", "a cloud of points of PCL", TABLE), ("a.las", b"LASF" + bytes(90), "a cloud of points (LAS)", TABLE),
             ("a.vtk", b"# vtk DataFile Version 3.0\n", "a file of VTK", TABLE), ("a.npy", b"\x93NUMPY\1\0" + bytes(90), "an array of NumPy (.npy)", TABLE),
             ("a.npz", b"PK\3\4" + bytes(90), "arrays of NumPy (.npz)", TABLE), ("a.xlsx", b"PK\3\4" + bytes(90), "a spreadsheet", TABLE),
             ("a.vtp", b'<?xml version="1.0"?>\n<VTKFile type="PolyData">\n', "a file of VTK", TABLE), ("unnamed", b'<VTKFile type="PolyData">\n', "a file of VTK", TABLE),
             ("a.vtu", b"<?xml", "a file of VTK", TABLE), ("a.e57", b"ASTM-E57" + bytes(90), "a cloud of points (E57)", TABLE),
             ("a.parquet", b"PAR1" + bytes(90), "a table of Parquet", TABLE), ("a.feather", b"ARROW1\0\0", "a table of Arrow (Feather)", TABLE),
             ("a.pts", b"1\n1 2 3 4 5 6 7\n", "a cloud of points (PTS)", TABLE), ("a.asc", b"1 2 3\n", "a text", TABLE), ("a.txt", b"1 2 3\n", "a text", TABLE),
             ("a.dat", b"1 2 3\n", "a text", TABLE), ("a.cfg", b"Number of particles = 8\n", "a structure of AtomEye (CFG)", CONVERT),
             ("a.mol", b"\n\n\n  1  0\n", "a file of molecules (MOL)", CONVERT), ("a.cube", b"c\nc\n", "a grid of Gaussian (cube)", CONVERT),
             ("a.xsf", b"CRYSTAL\n", "a structure of XCrySDen (XSF)", CONVERT), ("a.rst7", b"t\n 1\n", "coordinates of AMBER", CONVERT),
             ("a.inpcrd", b"t\n 1\n", "coordinates of AMBER", CONVERT), ("a.mmtf", b"\x8b\xa0", "a binary file of molecules (MMTF)", CONVERT),
             ("a.bcif", b"\x83\xa0", "a binary mmCIF file", CONVERT), ("a.pdb.Z", b"\x1f\x9d\x90" + bytes(20), "a file packed by compress", "unpack it first"),
             ("a.zip", b"PK\3\4" + bytes(90), "a file packed by zip", "unpack it first"),
             ("main.cc", b"// A picture\nint main() {}\n", "the source text of a program", "write the scene as JSON"),
             ("unnamed", b'#include "rtweekend.h"\n', "the source text of a program", "write the scene as JSON"),
             ("a.test.gz", gzip.compress(b"hello"), "a file packed by gzip", "whose name shows the format, as in FILE.xyz.gz; rename it, or unpack"),
             ("a.json.gz", gzip.compress(b"{}"), "a file packed by gzip", "unpack it"),
             ("a.xyz.bz2", b"BZh91AY&SY" + bytes(20), "a file packed by bzip2", "unpack it first"),
             ("a.jpg", b"\xff\xd8\xff\xe0" + bytes(90), "a JPEG picture", "a scene can name it in"))

    def test_files(self):
        for name, content, what, remedy in self.FILES:
            self.write(name, content)
            said = self.fail_with(2, "render", name, "-o", "x.png", says=[f"{name}:1:1: found {what}", remedy]).errors
            self.assertNotIn("not JSON", said)
            self.write("s.json", scene(particles=[{"file": name}]))
            said = self.fail_with(2, "render", "s.json", "-o", "x.png", says=["s.json:1:", f"particles[0].file: found {what}"]).errors
            self.assertEqual("convert it" in said, remedy in (self.CONVERT, self.TABLE))
        # A scene is a scene by what is in it, whatever it is called.
        for name in ("POSCAR", "scene.obj", "scene.c"):
            self.write(name, scene(spheres=[]))
            self.succeed("render", name, "-o", "x.png")

    def test_images(self):
        for name, head, what in (("a.webp", b"RIFF\0\0\0\0WEBPVP8 ", "a WebP picture"),
                                 ("a.tif", b"II*\0", "a TIFF picture"), ("a.tif", b"MM\0*", "a TIFF picture"), ("a.gif", b"GIF89a", "a GIF picture"),
                                 ("a.bmp", b"BM\x99\0", "a BMP picture")):
            self.write(name, head + bytes(90))
            self.write("s.json", scene(background={"image": name}))
            self.fail_with(2, "render", "s.json", "-o", "x.png",
                           says=[f"{name}: found {what}, expected an image: ", "ImageMagick converts it: convert FILE FILE.png"])


if __name__ == "__main__":
    main()
