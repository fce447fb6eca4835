/* ply_type.c: see ply_type.h. */
#include "ply_type.h"

const char *const ply_type_names[PLY_TYPE_NAMES] = {
    "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
    "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};

/* Two names a type, in the order of the types. */
PlyType ply_type_named(const char *name) {
    for (int i = 0; i < PLY_TYPE_NAMES; i++)
        if (strcmp(ply_type_names[i], name) == 0) return (PlyType)(PLY_INT8 + i / 2);
    return PLY_NONE;
}
