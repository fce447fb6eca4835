/* known_file.c: see known_file.h. */
#include "known_file.h"

#include <string.h>
#include <strings.h>

/* The first bytes of a kind of file, from `offset` on, or the ending of its name. */
typedef struct Known {
    BpKnownFile file;
    const char *ending, *bytes;
    size_t length, offset;
} Known;

#define BEGINS(bytes) NULL, bytes, sizeof(bytes) - 1, 0
#define HOLDS(bytes, offset) NULL, bytes, sizeof(bytes) - 1, offset
#define NAMED(ending) ending, NULL, 0, 0

static const Known known[] = {{{BP_FILE_SUMS, "the sums of a render (.bpa)"}, BEGINS("{\"ballpark_film\"")},
                              {{BP_FILE_PICTURE, "a PNG picture"}, BEGINS("\x89PNG")},
                              {{BP_FILE_PICTURE, "a JPEG picture"}, BEGINS("\xff\xd8\xff")},
                              {{BP_FILE_PICTURE, "an EXR picture"}, BEGINS("\x76\x2f\x31\x01")},
                              {{BP_FILE_PICTURE, "a PFM picture"}, BEGINS("PF")},
                              {{BP_FILE_PICTURE, "a PFM picture"}, BEGINS("Pf")},
                              {{BP_FILE_PICTURE, "a Radiance picture (.hdr)"}, BEGINS("#?")},
                              {{BP_FILE_IMAGE, "a PPM picture"}, BEGINS("P6")},
                              {{BP_FILE_IMAGE, "a PPM picture"}, BEGINS("P3")},
                              {{BP_FILE_IMAGE, "a GIF picture"}, BEGINS("GIF8")},
                              {{BP_FILE_IMAGE, "a TIFF picture"}, BEGINS("II*\0")},
                              {{BP_FILE_IMAGE, "a TIFF picture"}, BEGINS("MM\0*")},
                              {{BP_FILE_IMAGE, "a WebP picture"}, HOLDS("WEBP", 8)},
                              {{BP_FILE_IMAGE, "a BMP picture"}, BEGINS("BM")},
                              {{BP_FILE_POINTS, "arrays of NumPy (.npz)"}, NAMED(".npz")},
                              {{BP_FILE_POINTS, "a spreadsheet"}, NAMED(".xlsx")},
                              {{BP_FILE_GZIP, "a file packed by gzip"}, BEGINS("\x1f\x8b")},
                              {{BP_FILE_PACKED, "a file packed by bzip2"}, BEGINS("BZh")},
                              {{BP_FILE_PACKED, "a file packed by xz"}, BEGINS("\xfd\x37zXZ")},
                              {{BP_FILE_PACKED, "a file packed by zstd"}, BEGINS("\x28\xb5\x2f\xfd")},
                              {{BP_FILE_PACKED, "a file packed by compress"}, BEGINS("\x1f\x9d")},
                              {{BP_FILE_PACKED, "a file packed by zip"}, BEGINS("PK\x03\x04")},
                              {{BP_FILE_PARTICLES, "a trajectory of GROMACS (XTC)"}, BEGINS("\0\0\x07\xcb")},
                              {{BP_FILE_PARTICLES, "a trajectory of GROMACS (TRR)"}, BEGINS("\0\0\x07\xc9")},
                              {{BP_FILE_PARTICLES, "a trajectory of CHARMM or NAMD (DCD)"}, HOLDS("CORD", 4)},
                              {{BP_FILE_PARTICLES, "a NetCDF file"}, BEGINS("CDF")},
                              {{BP_FILE_PARTICLES, "an HDF5 file"}, BEGINS("\x89HDF\r\n\x1a\n")},
                              {{BP_FILE_PARTICLES, "a file of molecules (MOL2)"}, NAMED(".mol2")},
                              {{BP_FILE_PARTICLES, "a file of molecules (SDF)"}, NAMED(".sdf")},
                              {{BP_FILE_PARTICLES, "a structure of AtomEye (CFG)"}, BEGINS("Number of p")},
                              {{BP_FILE_PARTICLES, "a file of molecules (MOL)"}, NAMED(".mol")},
                              {{BP_FILE_PARTICLES, "a grid of Gaussian (cube)"}, NAMED(".cube")},
                              {{BP_FILE_PARTICLES, "a structure of XCrySDen (XSF)"}, NAMED(".xsf")},
                              {{BP_FILE_PARTICLES, "coordinates of AMBER"}, NAMED(".inpcrd")},
                              {{BP_FILE_PARTICLES, "coordinates of AMBER"}, NAMED(".rst7")},
                              {{BP_FILE_PARTICLES, "a binary file of molecules (MMTF)"}, NAMED(".mmtf")},
                              {{BP_FILE_PARTICLES, "a binary mmCIF file"}, NAMED(".bcif")},
                              {{BP_FILE_POINTS, "a cloud of points of PCL (PCD)"}, BEGINS("# .PCD")},
                              {{BP_FILE_POINTS, "a file of VTK"}, BEGINS("# vtk DataFile")},
                              {{BP_FILE_POINTS, "a cloud of points (LAS)"}, BEGINS("LASF")},
                              {{BP_FILE_POINTS, "an array of NumPy (.npy)"}, BEGINS("\x93NUMPY")},
                              {{BP_FILE_POINTS, "a file of VTK"}, BEGINS("<VTKFile")},
                              {{BP_FILE_POINTS, "a file of VTK"}, NAMED(".vtp")},
                              {{BP_FILE_POINTS, "a file of VTK"}, NAMED(".vtu")},
                              {{BP_FILE_POINTS, "a cloud of points (E57)"}, BEGINS("ASTM-E57")},
                              {{BP_FILE_POINTS, "a table of Parquet"}, BEGINS("PAR1")},
                              {{BP_FILE_POINTS, "a table of Arrow (Feather)"}, BEGINS("ARROW1")},
                              {{BP_FILE_POINTS, "a cloud of points (PTS)"}, NAMED(".pts")},
                              {{BP_FILE_POINTS, "a text"}, NAMED(".asc")},
                              {{BP_FILE_POINTS, "a text"}, NAMED(".dat")},
                              {{BP_FILE_POINTS, "a text"}, NAMED(".txt")},
                              {{BP_FILE_MESH, "a mesh (OBJ)"}, NAMED(".obj")},
                              {{BP_FILE_MESH, "a mesh (glTF)"}, NAMED(".gltf")},
                              {{BP_FILE_MESH, "a mesh (glTF)"}, NAMED(".glb")},
                              {{BP_FILE_MESH, "the materials of a mesh (MTL)"}, NAMED(".mtl")},
                              {{BP_FILE_MESH, "a mesh (STL)"}, NAMED(".stl")},
                              {{BP_FILE_MESH, "a mesh (OFF)"}, NAMED(".off")},
                              {{BP_FILE_SOURCE, "the source text of a program"}, BEGINS("#include")},
                              {{BP_FILE_SOURCE, "the source text of a program"}, NAMED(".cc")},
                              {{BP_FILE_SOURCE, "the source text of a program"}, NAMED(".cpp")},
                              {{BP_FILE_SOURCE, "the source text of a program"}, NAMED(".c")},
                              {{BP_FILE_SOURCE, "the source text of a program"}, NAMED(".h")},
                              {{BP_FILE_SOURCE, "the source text of a program"}, NAMED(".py")}};

static bool has_ending(const char *name, const char *ending) {
    const size_t length = strlen(name), size = strlen(ending);
    return length >= size && strcasecmp(name + length - size, ending) == 0;
}

bool bp_known_file(const char *name, const char *bytes, size_t length, BpKnownFile *found) {
    size_t start = 0;
    while (start < length && strchr(" \t\r\n", bytes[start]) != NULL) start++;
    const bool is_scene = start < length && bytes[start] == '{'; /* whatever its name */
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const Known *const k = &known[i];
        if (k->bytes != NULL
                ? length < k->offset + k->length || memcmp(bytes + k->offset, k->bytes, k->length) != 0
                : is_scene || !has_ending(name, k->ending))
            continue;
        *found = k->file;
        return true;
    }
    return false;
}

const char *bp_known_file_remedy(const BpKnownFile *file) {
    switch (file->kind) {
    case BP_FILE_SUMS:
        return ": `ballpark merge FILE.bpa -o FILE.png` makes the picture, and "
               "`ballpark render SCENE --resume FILE.bpa` continues the render";
    case BP_FILE_PICTURE:
        return "; a scene can name it in \"background\" or \"textures\"";
    case BP_FILE_IMAGE:
        return "";
    case BP_FILE_GZIP:
        return " or particles whose name shows the format, as in FILE.xyz.gz; rename it, or unpack it first";
    case BP_FILE_PACKED:
        return "; unpack it first";
    case BP_FILE_PARTICLES:
        return " or a file of particles in a format of docs/PARTICLES.md; convert it, with ASE or "
               "MDAnalysis, to "
               "extended XYZ for example";
    case BP_FILE_POINTS:
        return " or a file of particles in a format of docs/PARTICLES.md; convert it, to CSV or PLY for "
               "example";
    case BP_FILE_MESH:
        return "; give the path of a file named .ply, .obj, .stl, .off, .gltf or .glb, with its MTL files "
               "beside it, or "
               "name it in "
               "a scene's \"meshes\"";
    case BP_FILE_SOURCE:
        return "; write the scene as JSON: scenes/README.md has its members, and scenes/ the pictures of the "
               "book";
    }
    return "";
}

bool bp_is_picture(const void *bytes, size_t length) {
    BpKnownFile found;
    return bp_known_file("", bytes, length, &found) && found.kind == BP_FILE_PICTURE;
}
