/* scene_faults.c: see scene_faults.h. */
#include "scene_faults.h"

#include "scene/scene_fault.h"

#include <string.h>

/* The member of `object` that is at fault, or the object where the member is absent (a default). */
static BpStatus fail_member(const BpNode *object, const char *member, const char *text, BpError *err) {
    const BpNode node = bp_node_member(object, member);
    if (node.value != NULL) return bp_node_fail(&node, BP_PART_VALUE, err, "%s", text);
    return bp_node_fail(object, BP_PART_VALUE, err, "%s: %s", member, text);
}

/* A triangle of particles of a file, the number of which is among those of points. */
static BpStatus refuse_particle(const BpNode *root, const BpScene *scene, const BpShapeFile *file,
                                const BpFault *fault, BpError *err) {
    char name[BP_SPHERE_NAME_SIZE];
    const BpNode particles = bp_node_member(root, "particles");
    size_t place = 0;
    while (place + 1 < json_array_size(particles.value)) {
        const BpNode entry = bp_node_element(&particles, place), named = bp_node_member(&entry, "file");
        if (strcmp(json_string_value(named.value), file->file) == 0) break;
        place++;
    }
    const BpNode entry = bp_node_element(&particles, place), member = bp_node_member(&entry, fault->member);
    return bp_node_fail(member.value != NULL ? &member : &entry, BP_PART_VALUE, err,
                        "%s: %s; or \"shapes\": false, which draws these particles as spheres",
                        bp_triangle_name(scene, fault->index, name), fault->text);
}

/* A triangle of a mesh, which comes from a file or stands in no document. */
static BpStatus refuse_mesh(const BpNode *root, const BpScene *scene, const BpFault *fault, BpError *err) {
    char name[BP_SPHERE_NAME_SIZE];
    size_t mesh = 0;
    while (mesh + 1 < scene->mesh_file_count && scene->mesh_files[mesh + 1].first <= fault->index) mesh++;
    if (scene->mesh_files[mesh].in_memory) return bp_scene_validate(scene, err);
    if (scene->mesh_files[mesh].of_particles)
        return refuse_particle(root, scene, &scene->mesh_files[mesh], fault, err);
    const BpNode meshes = bp_node_member(root, "meshes"), entry = bp_node_element(&meshes, mesh),
                 member = bp_node_member(&entry, fault->member);
    return bp_node_fail(member.value != NULL ? &member : &entry, BP_PART_VALUE, err, "%s: %s",
                        bp_triangle_name(scene, fault->index, name), fault->text);
}

BpStatus bp_refuse_faults(const BpNode *root, const BpScene *scene, BpError *err) {
    BpFault fault;
    BP_TRY(bp_scene_find_fault(scene, &fault, err));
    const BpNode camera = bp_node_member(root, "camera");
    const BpNode background = bp_node_member(root, "background");
    const BpNode backdrop = bp_node_member(root, "backdrop");
    const BpNode textures = bp_node_member(root, "textures");
    const BpNode materials = bp_node_member(root, "materials");
    const BpNode spheres = bp_node_member(root, "spheres");
    const BpNode clouds = bp_node_member(root, "clouds");
    const size_t listed = json_array_size(spheres.value); /* the rest came from clouds */
    switch (fault.subject) {
    case BP_FAULT_NONE:
        return BP_OK;
    case BP_FAULT_CAMERA: {
        const char *member = fault.member;
        if (json_object_get(camera.value, member) ==
            NULL) { /* a default; what was written stands beside it */
            if (strcmp(member, "lookat") == 0) member = "lookfrom";
            if (strcmp(member, "aperture") == 0) member = "defocus_angle";
        }
        return fail_member(&camera, member, fault.text, err);
    }
    case BP_FAULT_BACKDROP:
        if (json_is_array(backdrop.value))
            return bp_node_fail(&backdrop, BP_PART_VALUE, err, "%s", fault.text);
        return fail_member(&backdrop, fault.member, fault.text, err);
    case BP_FAULT_BACKGROUND:
        if (json_is_array(background.value))
            return bp_node_fail(&background, BP_PART_VALUE, err, "%s", fault.text);
        return fail_member(&background, fault.member, fault.text, err);
    case BP_FAULT_DISC: {
        const BpNode discs = bp_node_member(&background, "discs");
        const BpNode disc = bp_node_element(&discs, fault.index);
        return fail_member(&disc, fault.member, fault.text, err);
    }
    case BP_FAULT_TEXTURE: {
        const BpNode texture = bp_node_member(&textures, scene->textures[fault.index].name);
        return fail_member(&texture, fault.member, fault.text, err);
    }
    case BP_FAULT_MEDIUM: {
        const BpNode media = bp_node_member(root, "media");
        const BpNode medium = bp_node_member(&media, scene->media[fault.index].name);
        return fail_member(&medium, fault.member, fault.text, err);
    }
    case BP_FAULT_MATERIAL: {
        const BpNode material = bp_node_member(&materials, scene->materials[fault.index].name);
        return fail_member(&material, fault.member, fault.text, err);
    }
    case BP_FAULT_SPHERE: {
        if (fault.index >= listed) break;
        const BpNode sphere = bp_node_element(&spheres, fault.index);
        return fail_member(&sphere, fault.member, fault.text, err);
    }
    case BP_FAULT_TRIANGLE: {
        const BpNode triangles = bp_node_member(root, "triangles"), quads = bp_node_member(root, "quads"),
                     boxes = bp_node_member(root, "boxes");
        const size_t written = json_array_size(triangles.value),
                     of_quads = BP_QUAD_TRIANGLES * scene->quad_count;
        const size_t i = fault.index;
        if (i >= bp_scene_listed_triangles(scene)) return refuse_mesh(root, scene, &fault, err);
        const BpNode shape = i < written ? bp_node_element(&triangles, i)
                             : i < written + of_quads
                                 ? bp_node_element(&quads, (i - written) / BP_QUAD_TRIANGLES)
                                 : bp_node_element(&boxes, (i - written - of_quads) / BP_BOX_TRIANGLES);
        const BpNode member = bp_node_member(&shape, fault.member);
        return bp_node_fail(member.value != NULL ? &member : &shape, BP_PART_VALUE, err, "%s", fault.text);
    }
    case BP_FAULT_CAPSULE: {
        if (fault.index >= scene->listed_capsules) break;
        const BpNode capsules = bp_node_member(root, "capsules"),
                     capsule = bp_node_element(&capsules, fault.index),
                     member = bp_node_member(&capsule, fault.member);
        return bp_node_fail(member.value != NULL ? &member : &capsule, BP_PART_VALUE, err, "%s", fault.text);
    }
    case BP_FAULT_COINCIDENT: {
        /* The place of the error: the later of the two spheres that stands in the document itself, or else
         * the cloud that the later one comes from. */
        const size_t written = fault.index < listed ? fault.index : fault.other;
        char a[BP_SPHERE_NAME_SIZE], b[BP_SPHERE_NAME_SIZE];
        size_t cloud = scene->point_file_count;
        while (cloud > 0 && scene->point_files[cloud - 1].first > fault.index) --cloud;
        const BpNode sphere = bp_node_element(&spheres, written);
        if (written >= listed && scene->point_files[cloud - 1].in_memory) break; /* stands in no document */
        const BpNode particles = bp_node_member(root, "particles");
        const size_t place = cloud - (cloud > 0), cloud_count = json_array_size(clouds.value);
        const BpNode entry = place < cloud_count ? bp_node_element(&clouds, place)
                                                 : bp_node_element(&particles, place - cloud_count);
        return bp_node_fail(written < listed ? &sphere : &entry, BP_PART_VALUE, err, "%s and %s: %s",
                            bp_sphere_name(scene, fault.other, a), bp_sphere_name(scene, fault.index, b),
                            fault.text);
    }
    case BP_FAULT_ALBEDO:
        break;
    }
    return bp_scene_validate(scene, err);
}
