/* probe_layout.cl: how this device's compiler lays out the packed structs; the host compares it with its own
 * (host/opencl/layout.c) before the first launch.
 *
 * Out:   sizes and offsets in bytes.   Knows: scene_types.h.   Does not know: what the structs mean. */
#define SIZE_AND_OFFSET(type, member)                                                                                  \
    {                                                                                                                  \
        type object;                                                                                                   \
        *out++ = (uint)sizeof(type);                                                                                   \
        *out++ = (uint)((__private const char *)&object.member - (__private const char *)&object);                     \
    }

__kernel void probe_layout(__global uint *out) {
    SIZE_AND_OFFSET(PackedCamera, ahead)
    SIZE_AND_OFFSET(PackedSky, catcher_light)
    SIZE_AND_OFFSET(PackedMaterial, refraction_index)
    SIZE_AND_OFFSET(PackedMaterialKind, total_reflection)
    *out++ = (uint)sizeof(real);
    *out = (uint)sizeof(refined);
}
