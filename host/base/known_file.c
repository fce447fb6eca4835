/* known_file.c: see known_file.h. */
#include "known_file.h"

#include <ctype.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { LOOKED_AT = 4096, STL_HEAD = 84, STL_TRIANGLE = 50 };

typedef struct Beginning {
    const char *bytes;
    size_t length, offset;
    BpKnownFile file;
} Beginning;

#define STARTS(bytes, kind, what)                                                                            \
    {                                                                                                        \
        bytes, sizeof(bytes) - 1, 0, {                                                                       \
            kind, what                                                                                       \
        }                                                                                                    \
    }

static bool starts_like(const char *bytes, size_t length, BpKnownFile *found) {
    static const Beginning known[] = {
        STARTS("{\"ballpark_film\"", BP_FILE_SUMS, "the sums of a render (.bpa)"),
        STARTS("\x89PNG", BP_FILE_PICTURE, "a PNG picture"),
        STARTS("\x76\x2f\x31\x01", BP_FILE_PICTURE, "an EXR picture"),
        STARTS("PF", BP_FILE_PICTURE, "a PFM picture"),
        STARTS("Pf", BP_FILE_PICTURE, "a PFM picture"),
        STARTS("#?RADIANCE", BP_FILE_PICTURE, "a Radiance picture (.hdr)"),
        STARTS("#?RGBE", BP_FILE_PICTURE, "a Radiance picture (.hdr)"),
        STARTS("P6", BP_FILE_IMAGE, "a PPM picture"),
        STARTS("P3", BP_FILE_IMAGE, "a PPM picture"),
        STARTS("P5\n", BP_FILE_IMAGE, "a PGM picture"),
        STARTS("P2\n", BP_FILE_IMAGE, "a PGM picture"),
        STARTS("\xff\xd8\xff", BP_FILE_IMAGE, "a JPEG picture"),
        STARTS("GIF8", BP_FILE_IMAGE, "a GIF picture"),
        STARTS("II*\0", BP_FILE_IMAGE, "a TIFF picture"),
        STARTS("MM\0*", BP_FILE_IMAGE, "a TIFF picture"),
        STARTS("DDS ", BP_FILE_IMAGE, "a DDS picture"),
        STARTS("\xff\x0a", BP_FILE_IMAGE, "a JPEG XL picture"),
        STARTS("\0\0\0\x0cJXL ", BP_FILE_IMAGE, "a JPEG XL picture"),
        {"WEBP", 4, 8, {BP_FILE_IMAGE, "a WebP picture"}},
        {"ftypavif", 8, 4, {BP_FILE_IMAGE, "an AVIF picture"}},
        {"ftyphei", 7, 4, {BP_FILE_IMAGE, "a HEIF picture"}},
        STARTS("BM", BP_FILE_IMAGE, "a BMP picture"),
        STARTS("\x1f\x8b", BP_FILE_GZIP, "a file packed by gzip"),
        STARTS("BZh", BP_FILE_PACKED, "a file packed by bzip2"),
        STARTS("\xfd\x37zXZ", BP_FILE_PACKED, "a file packed by xz"),
        STARTS("\x28\xb5\x2f\xfd", BP_FILE_PACKED, "a file packed by zstd"),
        STARTS("PK\x03\x04", BP_FILE_PACKED, "a file packed by zip"),
        STARTS("\0\0\x07\xcb", BP_FILE_PARTICLES, "a trajectory of GROMACS (XTC)"),
        STARTS("\0\0\x07\xc9", BP_FILE_PARTICLES, "a trajectory of GROMACS (TRR)"),
        {"CORD", 4, 4, {BP_FILE_PARTICLES, "a trajectory of CHARMM or NAMD (DCD)"}},
        STARTS("CDF\x01", BP_FILE_PARTICLES, "a NetCDF file"),
        STARTS("CDF\x02", BP_FILE_PARTICLES, "a NetCDF file"),
        STARTS("CDF\x05", BP_FILE_PARTICLES, "a NetCDF file"),
        STARTS("\x89HDF\r\n\x1a\n", BP_FILE_PARTICLES, "an HDF5 file"),
        STARTS("# .PCD", BP_FILE_POINTS, "a cloud of points of PCL (PCD)"),
        STARTS("# vtk DataFile", BP_FILE_POINTS, "a file of VTK"),
        STARTS("LASF", BP_FILE_POINTS, "a cloud of points (LAS)"),
        STARTS("ASTM-E57", BP_FILE_POINTS, "a cloud of points (E57)"),
        STARTS("\x93NUMPY", BP_FILE_POINTS, "an array of NumPy (.npy)"),
        STARTS("BLENDER", BP_FILE_WORLD, "a file of Blender"),
        STARTS("glTF", BP_FILE_WORLD, "a glTF file"),
        STARTS("Kaydara FBX", BP_FILE_WORLD, "an FBX file"),
        STARTS("#include", BP_FILE_SOURCE, "the source text of a program"),
        STARTS("#ifndef", BP_FILE_SOURCE, "the source text of a program"),
        STARTS("#pragma", BP_FILE_SOURCE, "the source text of a program"),
        STARTS("#!/", BP_FILE_SOURCE, "the source text of a program")};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const Beginning *const k = &known[i];
        if (length < k->offset + k->length || memcmp(bytes + k->offset, k->bytes, k->length) != 0) continue;
        *found = k->file;
        return true;
    }
    return false;
}

static bool is_called_like(const char *name, BpKnownFile *found) {
    static const struct {
        const char *end;
        BpKnownFile file;
    } known[] = {{".blend", {BP_FILE_WORLD, "a file of Blender"}},
                 {".obj", {BP_FILE_MESH, "a mesh (OBJ)"}},
                 {".mtl", {BP_FILE_MESH, "the materials of a mesh (MTL)"}},
                 {".stl", {BP_FILE_MESH, "a mesh (STL)"}},
                 {".off", {BP_FILE_MESH, "a mesh (OFF)"}},
                 {".fbx", {BP_FILE_WORLD, "an FBX file"}},
                 {".gltf", {BP_FILE_WORLD, "a glTF file"}},
                 {".dae", {BP_FILE_WORLD, "a Collada file"}},
                 {".usd", {BP_FILE_WORLD, "a USD file"}},
                 {".usda", {BP_FILE_WORLD, "a USD file"}},
                 {".pov", {BP_FILE_WORLD, "a scene of POV-Ray"}},
                 {".pbrt", {BP_FILE_WORLD, "a scene of pbrt"}},
                 {".xtc", {BP_FILE_PARTICLES, "a trajectory of GROMACS (XTC)"}},
                 {".trr", {BP_FILE_PARTICLES, "a trajectory of GROMACS (TRR)"}},
                 {".tpr", {BP_FILE_PARTICLES, "a run input file of GROMACS (TPR)"}},
                 {".dcd", {BP_FILE_PARTICLES, "a trajectory of CHARMM or NAMD (DCD)"}},
                 {".nc", {BP_FILE_PARTICLES, "a NetCDF file"}},
                 {".ncdf", {BP_FILE_PARTICLES, "a NetCDF file"}},
                 {".h5", {BP_FILE_PARTICLES, "an HDF5 file"}},
                 {".h5md", {BP_FILE_PARTICLES, "an HDF5 file"}},
                 {".hdf5", {BP_FILE_PARTICLES, "an HDF5 file"}},
                 {".mol", {BP_FILE_PARTICLES, "a file of molecules (MOL)"}},
                 {".mol2", {BP_FILE_PARTICLES, "a file of molecules (MOL2)"}},
                 {".sdf", {BP_FILE_PARTICLES, "a file of molecules (SDF)"}},
                 {".vasp", {BP_FILE_PARTICLES, "a structure of VASP (POSCAR)"}},
                 {".poscar", {BP_FILE_PARTICLES, "a structure of VASP (POSCAR)"}},
                 {".vtp", {BP_FILE_POINTS, "a file of VTK"}},
                 {".vtu", {BP_FILE_POINTS, "a file of VTK"}},
                 {".laz", {BP_FILE_POINTS, "a cloud of points (LAS)"}},
                 {".npz", {BP_FILE_POINTS, "arrays of NumPy (.npz)"}},
                 {".xlsx", {BP_FILE_POINTS, "a spreadsheet"}},
                 {".xls", {BP_FILE_POINTS, "a spreadsheet"}},
                 {".ods", {BP_FILE_POINTS, "a spreadsheet"}},
                 {".cc", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".cpp", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".cxx", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".c", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".h", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".hpp", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".py", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".rs", {BP_FILE_SOURCE, "the source text of a program"}},
                 {".js", {BP_FILE_SOURCE, "the source text of a program"}}};
    const char *const slash = strrchr(name, '/'), *const base = slash != NULL ? slash + 1 : name;
    const char *const end = strrchr(base, '.');
    if (strncasecmp(base, "POSCAR", 6) == 0 || strncasecmp(base, "CONTCAR", 7) == 0) {
        *found = (BpKnownFile){BP_FILE_PARTICLES, "a structure of VASP (POSCAR)"};
        return true;
    }
    for (size_t i = 0; end != NULL && i < sizeof known / sizeof *known; i++)
        if (strcasecmp(end, known[i].end) == 0) {
            *found = known[i].file;
            return true;
        }
    return false;
}

/* ---- text without a mark at its beginning -------------------------------------------------------------- */

/* The words of a line at `*at`, 4 at most; *at goes to the next line. */
static int count_words(const char *text, size_t *at, double numbers[4], int *number_count) {
    int words = 0;
    *number_count = 0;
    const char *c = text + *at;
    while (*c != '\0' && *c != '\n' && words < 4) {
        while (*c == ' ' || *c == '\t' || *c == '\r') c++;
        if (*c == '\0' || *c == '\n') break;
        char *end = NULL;
        const double number = strtod(c, &end);
        const size_t length = strcspn(c, " \t\r\n");
        if (end == c + length) numbers[(*number_count)++] = number;
        words++;
        c += length;
    }
    c += strcspn(c, "\n");
    *at = (size_t)(c - text) + (*c == '\n');
    return words;
}

/* A title, a scale and three vectors. */
static bool is_poscar(const char *text) {
    size_t at = strcspn(text, "\n");
    double numbers[4];
    int found = 0;
    if (text[at] == '\0') return false;
    at++;
    if (count_words(text, &at, numbers, &found) != 1 || found != 1) return false;
    for (int line = 0; line < 3; line++)
        if (count_words(text, &at, numbers, &found) != 3 || found != 3) return false;
    return true;
}

/* Vertices, groups and the like, behind comments. */
static bool is_obj(const char *text) {
    static const char *const words[] = {"mtllib ", "v ", "vn ", "vt ", "o ", "g "};
    while (*text == '#' || isspace((unsigned char)*text)) {
        text += *text == '#' ? strcspn(text, "\n") : 1;
        if (*text == '\0') return false;
    }
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strncmp(text, words[i], strlen(words[i])) == 0) return strstr(text, "v ") != NULL;
    return false;
}

/* Whether a file in the binary form has as many triangles as it says. */
static bool is_binary_stl(const char *bytes, size_t length, size_t size) {
    if (length < STL_HEAD) return false;
    uint64_t count = 0;
    for (int i = 3; i >= 0; i--) count = count << 8 | (unsigned char)bytes[STL_HEAD - 4 + i];
    return count > 0 && STL_HEAD + count * STL_TRIANGLE == size;
}

static bool contains_source(const char *text) {
    return strstr(text, "\n#include ") != NULL || strstr(text, "\nint main(") != NULL ||
           strncmp(text, "int main(", 9) == 0 || strstr(text, "make_shared<") != NULL;
}

bool bp_known_file(const char *name, const char *bytes, size_t length, size_t size, BpKnownFile *found) {
    char text[LOOKED_AT + 1];
    const size_t count = length < LOOKED_AT ? length : LOOKED_AT;
    memcpy(text, bytes, count);
    text[count] = '\0';
    const bool is_scene = text[strspn(text, "\xef\xbb\xbf \t\r\n")] == '{';
    if (starts_like(bytes, length, found)) {
        BpKnownFile called; /* Blender, spreadsheets and NumPy pack their files */
        if ((found->kind == BP_FILE_PACKED || found->kind == BP_FILE_GZIP) && is_called_like(name, &called) &&
            (called.kind == BP_FILE_WORLD || called.kind == BP_FILE_POINTS))
            *found = called;
        return true;
    }
    if (is_scene) return false;
    if (is_called_like(name, found)) return true;
    if (is_binary_stl(bytes, length, size) ||
        (strncmp(text, "solid", 5) == 0 && strstr(text, "facet") != NULL))
        *found = (BpKnownFile){BP_FILE_MESH, "a mesh (STL)"};
    else if (is_poscar(text))
        *found = (BpKnownFile){BP_FILE_PARTICLES, "a structure of VASP (POSCAR)"};
    else if (is_obj(text))
        *found = (BpKnownFile){BP_FILE_MESH, "a mesh (OBJ)"};
    else if (contains_source(text))
        *found = (BpKnownFile){BP_FILE_SOURCE, "the source text of a program"};
    else
        return false;
    return true;
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
        return " or particles whose format the name tells, as in FILE.xyz.gz; rename it, or unpack it first";
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
        return "; give the path of a file named .ply, .obj, .stl or .off, with its MTL files beside it, or "
               "name it in "
               "a scene's \"meshes\"";
    case BP_FILE_WORLD:
        return "; export its meshes as PLY, OBJ, STL or OFF";
    case BP_FILE_SOURCE:
        return "; write the scene as JSON: scenes/README.md has its members, and scenes/ the pictures of the "
               "book";
    }
    return "";
}
