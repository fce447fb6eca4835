"""Reads the PFM pictures that `ballpark render` writes."""

import array
import sys


def read_pfm(path):
    """Width, height and the numbers, r g b a pixel, bottom row first."""
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n", f"{path}: not a colour PFM"
        width, height = map(int, file.readline().split())
        assert float(file.readline()) < 0, f"{path}: not little endian"
        numbers = array.array("f", file.read())
    if sys.byteorder == "big":
        numbers.byteswap()
    assert len(numbers) == width * height * 3, f"{path}: {len(numbers)} numbers"
    return width, height, numbers
