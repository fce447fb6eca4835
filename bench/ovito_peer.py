#!/usr/bin/env python3
"""OVITO's Tachyon as a peer: renders a GSD file of bench/particle_data.py.

    ovito_peer.py COUNT.gsd OUT.png|OUT.ppm SAMPLES SHADOW_RAYS
    ovito_peer.py --why            exit code 0 if OVITO's module renders here; else 77, and the reason

In:    COUNT.gsd with COUNT.json beside it, whose camera it uses, and whose colours it gives to the types. SAMPLES are rays
       of a pixel; from where each of them arrives, SHADOW_RAYS go on.
Out:   the picture, by ambient occlusion alone: a white sky, matte particles, and no other lamp.

It needs the module of bench/ovito_setup, whose Python runs this; nothing else in ballpark needs it.
"""
import json
import math
import os
import sys
import tempfile


class Unable(Exception):
    pass


def load():
    try:
        import ovito.io
        import ovito.vis
    except ImportError as error:
        raise Unable(f"OVITO's module cannot be used: {str(error).splitlines()[0]}") from error
    return ovito


def render(path, output, samples, shadow_rays):
    ovito = load()
    with open(os.path.splitext(path)[0] + ".json") as file:
        document = json.load(file)
    camera = document["camera"]
    style = document["particles"][0]
    pipeline = ovito.io.import_file(path)
    data = pipeline.source.data
    data.cell_.vis.enabled = False
    kinds = data.particles_.particle_types_
    for kind_of in kinds.types:
        changed = kinds.type_by_id_(kind_of.id)
        changed.radius = style["radius"]
        changed.color = style["color"]["types"][kind_of.name]
    pipeline.add_to_scene()
    at, look = camera["lookfrom"], camera["lookat"]
    view = ovito.vis.Viewport(type=ovito.vis.Viewport.Type.Perspective, camera_pos=at, fov=math.radians(camera["vfov"]),
                              camera_dir=[b - a for a, b in zip(at, look)], camera_up=camera["vup"])
    renderer = ovito.vis.TachyonRenderer(direct_light=False, shadows=False, ambient_occlusion=True, ambient_occlusion_brightness=1.0,
                                         ambient_occlusion_samples=shadow_rays, antialiasing=samples > 1, antialiasing_samples=samples)
    try:
        view.render_image(filename=output, size=tuple(camera["aspect_ratio"]), background=tuple(document["background"]),
                          renderer=renderer)
    except RuntimeError as error:
        raise Unable(f"OVITO does not render here: {str(error).splitlines()[0]}") from error


def why():
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    import particle_data
    with tempfile.TemporaryDirectory() as folder:
        stem = particle_data.write(10, folder)
        render(stem + ".gsd", stem + ".png", 1, 1)


def main(words):
    try:
        if words == ["--why"]:
            why()
        elif len(words) == 4:
            render(*words[:2], int(words[2]), int(words[3]))
        else:
            sys.exit(__doc__)
    except Unable as reason:
        print(f"skipped: {reason}", file=sys.stderr)
        return 77
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
