"""Which agreement scenes have kernels of their own where all effects are in: those whose lamps are sampled."""

import json
import os
import subprocess
import tempfile


def with_lamps(program, source, names):
    """Those of the scenes in tests/agree/scenes for which the program sends rays to lamps. Without a driver, `explain` does not look
    for light that is found by chance, for which it would compile a kernel a scene."""
    paths = [os.path.join(source, "tests/agree/scenes", name + ".json") for name in names]
    with tempfile.TemporaryDirectory() as no_drivers:
        said = subprocess.run([program, "explain", *paths, "--json", "-"], check=True, stdout=subprocess.PIPE,
                              env={**os.environ, "OCL_ICD_VENDORS": no_drivers}).stdout
    found = {os.path.basename(one["scene"])[:-len(".json")] for one in json.loads(said)["scenes"]
             if any(effect["name"] == "light_sampling" and effect["simulated"] for effect in one["effects"])}
    assert found and found < set(names), f"either all scenes have lamps or none: {found}"
    return found
