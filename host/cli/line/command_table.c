/* command_table.c: see command_table.h. */
#include "command_table.h"

#include "base/message_text.h"
#include "option_list.h"

#include <stdint.h>
#include <string.h>

const BpCommand bp_commands[] = {
    {
        .name = "render",
        .operands = "SCENE...",
        .operands_min = 1,
        .operands_max = SIZE_MAX,
        .summary = "render scenes to pictures",
        .description =
            "Renders each SCENE, a JSON document (see scenes/README.md; \"-\" is standard input, for "
            "every command that takes a scene), or a file of particles (.xyz, .pdb, .pqr, .cif, .gro, "
            "POSCAR, .dump, .lammpstrj, .data, .gsd, .csv, .ply, and .gz of each; see docs/PARTICLES.md) or "
            "a "
            "mesh (.ply with faces, .obj, .stl, .off, .gltf, .glb). The picture is named after the scene and "
            "written to "
            "the current folder, unless --output names "
            "another file or folder. The ending "
            "selects the format: .png, .ppm, .pfm, .exr (with layers for noise, samples, depth, "
            "normal and albedo), or .bpa, which keeps the sums of the samples for `ballpark "
            "merge`. All scenes are read before the first is rendered; a kernel that several of "
            "them share is built once.\n"
            "\n"
            "The first line reports noise relative to mean brightness (NRMSE). Halving the noise "
            "takes four times as long. With --error or --time, rendering stops at that noise or "
            "time instead of at the scene's number of samples; with several of --error, --time "
            "and --spp, it stops at whichever comes first. --adaptive gives noisy pixels more "
            "samples and the others fewer; --spp is then the mean.\n"
            "\n"
            "Ctrl-C stops the render and writes the picture so far. --checkpoint saves the sums to "
            "a .bpa file while rendering, and --resume continues from it, even after a kill, to the same "
            "picture bit for bit. --share I/N renders one of N parts for `ballpark merge`. "
            "Processes that mpirun or srun starts together share the work: each renders a part of "
            "the picture, or one of several pictures (see docs/CLUSTERS.md). On one device, the same "
            "scene, seed and number of samples give the same picture bit for bit.",
        .examples = "  ballpark render cover.json                          to cover.png\n"
                    "  ballpark render cover.json --width 300 --spp 20     a quick look\n"
                    "  ballpark render cover.json --error 1%               until noise is 1 %\n"
                    "  ballpark render cover.json --error 1% --adaptive    faster on most scenes\n"
                    "  ballpark render cover.json --time 2m -o two.exr     for two minutes\n"
                    "  ballpark render cover.json --set camera.vfov=30     another field of view\n"
                    "  ballpark render scenes/*.json -o pictures/          many scenes at once\n"
                    "  ballpark render cover.json --checkpoint 60 -o a.exr saves its sums to a.bpa\n"
                    "  ballpark render cover.json --resume a.bpa -o a.exr  continues from there\n"
                    "  ballpark render cover.json --share 1/8 -o 1.bpa     one of eight parts\n"
                    "  mpirun -n 64 ballpark render cover.json --error 1%  on many machines\n"
                    "  ballpark render cover.json -o - | display           into another program\n"
                    "  ballpark render protein.pdb                         a molecule, framed and "
                    "lit\n"
                    "  ballpark render run.gsd --frames ::10 -o run.png    run-0000.png, run-0010.png, ...\n"
                    "  ballpark render protein.pdb --turntable 36          one every ten degrees\n"
                    "  ballpark generate cover | ballpark render - -o cover.png\n",
        .bit = BP_RENDER,
        .is_shared = true,
    },
    {
        .name = "view",
        .operands = "SCENE",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "look at a scene in a window, and move the camera",
        .description =
            "Opens a window, if this program was built with SDL 2, and renders SCENE in it until "
            "the noise is below --error; the title shows the progress. While the camera moves, the "
            "picture is coarser or noisier, so that it keeps up.\n"
            "\n"
            "Dragging with the left button orbits around the point that the camera looks at, "
            "dragging with the right button pans, the wheel zooms, and a click focuses on what is under "
            "the pointer. [ and ] change the aperture, - and + the exposure; 0 resets the exposure, and "
            "r the camera. s saves the picture in the current folder as SCENE-view-1.png, with the first "
            "free number, and prints the command that renders it from the same camera. q or Escape "
            "quits.",
        .examples = "  ballpark view scenes/cover.json --width 640\n"
                    "  ballpark view protein.pdb --error 0.5%\n",
        .bit = BP_VIEW,
    },
    {
        .name = "check",
        .operands = "[SCENE]",
        .operands_max = 1,
        .summary = "compare a device's picture with a reference",
        .description =
            "Renders the scene on the device, and again with a reference tracer in plain C that shares no "
            "code with the kernel, using equally many samples but other random numbers, and "
            "compares the two statistically. It reports whether they agree, the confidence interval of "
            "their brightness ratio, and the smallest error that it would have detected. Default: 64 pixels "
            "wide, 1024 "
            "samples per pixel. A correct kernel fails one check in 10,000.\n\n"
            "Nothing passes without evidence: if no difference is found, but the samples are too few to show "
            "that brightness is equal within --margin, the verdict is inconclusive.\n\n"
            "--suite checks the agreement scenes that come with the program instead; a correct "
            "kernel fails one suite in 1,000. --device all checks every device. Devices are listed in a "
            "separate process, and each is checked in one of its own, so a driver that crashes or hangs "
            "is reported by name and does not stop the others. With --timeout, each device is judged by "
            "what it has rendered by then.\n\n"
            "--bits compares small pictures with recorded ones, bit for bit, in every form of the kernel. A "
            "device that differs may still be correct: --suite finds out.\n\n"
            "Exit code: 0 agree, 3 disagree (or different bits), 4 inconclusive, 5 no such device, "
            "6 a device or its driver failed; if several apply, the first of 3, 6, 5, 4.",
        .examples = "  ballpark check cover.json\n"
                    "  ballpark check cover.json --device all --json report.json\n"
                    "  ballpark check cover.json --spp 16384 --map map.png    more sensitive\n"
                    "  ballpark check --suite --device all --timeout 300 --junit new.xml\n"
                    "  ballpark check --suite --against old.json       after a driver update\n"
                    "  ballpark check --bits                           are the bits as recorded?\n",
        .bit = BP_CHECK,
    },
    {
        .name = "explain",
        .operands = "SCENE...",
        .operands_min = 1,
        .operands_max = SIZE_MAX,
        .summary = "show which effects a scene uses, why, and what each costs",
        .description =
            "For each SCENE, lists the effects that the kernel can simulate: which are compiled into its "
            "kernel, which are left out, and why. With --measure, compares the speed of the scene's "
            "kernel with that of kernels that simulate one more effect, and of one that simulates all of "
            "them. They take "
            "turns tracing the same samples; the table shows the ratio of their times and the range between "
            "the quartiles.\n"
            "\n"
            "With --pixel, follows one path of that pixel, step by step; --first-sample selects the sample. "
            "For the first matte point, it lists the ways by which light of lamps arrives through a ball of "
            "glass or off a mirror, and the light of each.",
        .examples = "  ballpark explain scenes/cover.json\n"
                    "  ballpark explain scenes/*.json --json effects.json\n"
                    "  ballpark explain scenes/v4-13-metal.json --measure\n"
                    "  ballpark explain scenes/cover.json --pixel 600,300\n",
        .bit = BP_EXPLAIN,
    },
    {
        .name = "cost",
        .operands = "SCENE",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "show what accuracy costs in time",
        .description =
            "Renders SCENE (default: 240 pixels wide) in every configuration that trades time for accuracy: "
            "more samples, the other sampler, adaptive sampling, less depth, double precision, fast math, "
            "plain numerics, the other Fresnel formula, and some combinations. Each is compared with a "
            "reference rendered in double precision with exact Fresnel and depth 1000 (on a device without "
            "double precision, by the reference tracer). The table shows what each configuration costs and "
            "what it changes. The last lines recommend a configuration for errors of 5 %, 1 % and 0.2 %, "
            "with the time at the scene's full size. -o writes all of it, with plots and pictures, as one "
            "self-contained HTML page.\n\n"
            "Results are less precise with a small --time. "
            "--depth, --sampler, --precision, --math and --numerics set the configuration that the others "
            "are compared with. Ctrl-C stops early and prints the results so far.",
        .examples = "  ballpark cost cover.json\n"
                    "  ballpark cost cover.json -o cost.html --time 5m      more precise, as a page\n"
                    "  ballpark cost cover.json --csv - --width 300\n",
        .bit = BP_COST,
    },
    {
        .name = "merge",
        .operands = "FILE.bpa...",
        .operands_min = 1,
        .operands_max = SIZE_MAX,
        .summary = "combine renders of different samples into one",
        .description = "Adds up .bpa files of the same scene, seed and settings whose sample numbers do not "
                       "overlap, and writes a picture or another .bpa file. The result is the same, bit for "
                       "bit, as that of one render of all the samples, so a long render can be split among "
                       "identical machines, or continued later.",
        .examples = "  ballpark render cover.json --spp 500 -o a.bpa\n"
                    "  ballpark render cover.json --spp 500 --first-sample 500 -o b.bpa\n"
                    "  ballpark merge a.bpa b.bpa -o cover.png\n",
        .bit = BP_MERGE,
    },
    {
        .name = "bench",
        .operands = "[SCENE...]",
        .operands_max = SIZE_MAX,
        .summary = "measure throughput",
        .description =
            "Measures how fast scenes load, build and render: samples and ray segments per second, "
            "nanoseconds per segment, bytes per sphere. A SCENE is a file or one of the fixed scenes: cover, "
            "diffuse (the same spheres, all matte), glass (all glass), field-1e4, field-1e6 or any other "
            "number (random spheres in a cube). The default is these five. ball-81920 is a mesh; so are 20, "
            "80, 320 and so on. The scenes take turns, round "
            "after round; the table shows medians. --time is the tracing time per scene, over all rounds. "
            "With -o, the fixed scenes are written to that folder and nothing is measured.",
        .examples = "  ballpark bench\n"
                    "  ballpark bench cover field-1e7 --kernel sample --json figures.json\n"
                    "  ballpark bench -o scenes        write the fixed scenes, for other programs\n",
        .bit = BP_BENCH,
    },
    {
        .name = "devices",
        .operands = "",
        .summary = "list the OpenCL devices",
        .description =
            "Lists every device of every OpenCL platform and marks the default: a GPU if "
            "there is one, otherwise a CPU. A driver that crashes or hangs when it lists its devices is "
            "named and left out. For a GPU it shows which --kernel was the fastest when the GPU was first "
            "used, and has been used there since.",
        .examples = "  ballpark devices\n"
                    "  ballpark devices --json -       the same as JSON\n",
        .bit = BP_DEVICES,
    },
    {
        .name = "generate",
        .operands = "cover|field",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "write a scene: the book's cover, or a field of spheres",
        .description =
            "cover: the cover of the book as a scene file; the same seed gives the same spheres "
            "on every machine. field: spheres with random positions, sizes and colours as a PLY "
            "file, for the \"clouds\" of a scene. Both go to standard output if that is a pipe or a "
            "file.",
        .examples = "  ballpark generate cover                                     to cover.json\n"
                    "  ballpark generate cover | ballpark render - -o cover.png\n"
                    "  ballpark generate cover --grid 50 --seed 7 -o wide.json     10,000 spheres\n"
                    "  ballpark generate field --count 10000000 -o field.ply\n",
        .bit = BP_GENERATE,
    },
    {
        .name = "scene",
        .operands = "FILE",
        .operands_min = 1,
        .operands_max = 1,
        .summary = "print the scene that a file becomes, to edit and cite",
        .description =
            "Prints, as a JSON document, the scene that `ballpark render FILE` would "
            "render, to standard output or with -o to a file. For a file of particles (XYZ, PDB, PQR, "
            "mmCIF, CIF of crystals, POSCAR, GRO, LAMMPS dump and data, GSD, CSV, PLY; each also packed by "
            "gzip) or of a mesh (PLY with faces, OBJ, STL, OFF, glTF), the document contains all choices: "
            "camera, light, style or "
            "materials. "
            "Particles and meshes stay in their file, which the document names. docs/PARTICLES.md and "
            "scenes/README.md describe its members.",
        .examples = "  ballpark scene protein.pdb -o protein.json\n"
                    "  ballpark scene run.gsd --frame -1 | ballpark render - -o last.png\n",
        .bit = BP_SCENE,
    },
    {
        .name = "help",
        .operands = "[COMMAND]",
        .operands_max = 1,
        .summary = "explain a command",
        .description = "Prints help about the program, or about one command with its options and examples.",
        .examples = "  ballpark help render\n",
        .bit = BP_HELP,
    },
};
const size_t bp_command_count = sizeof bp_commands / sizeof bp_commands[0];

BpStatus bp_command_find(const char *name, const BpCommand **command, BpError *err) {
    const char *names[sizeof bp_commands / sizeof bp_commands[0]];
    for (size_t c = 0; c < bp_command_count; ++c) {
        if (strcmp(name, bp_commands[c].name) == 0) {
            *command = &bp_commands[c];
            return BP_OK;
        }
        names[c] = bp_commands[c].name;
    }
    const char *nearest = bp_nearest_name(name, names, bp_command_count);
    char printable[80];
    bp_printable(name, printable, sizeof printable);
    if (nearest != NULL)
        return bp_fail(err, BP_ERR_USAGE, "unknown command \"%s\"; did you mean %s?", printable, nearest);
    if (strcmp(name, "version") == 0)
        return bp_fail(err, BP_ERR_USAGE, "unknown command \"version\"; did you mean `ballpark --version`?");
    return bp_fail(err, BP_ERR_USAGE, "unknown command \"%s\"; see `ballpark --help`", printable);
}
