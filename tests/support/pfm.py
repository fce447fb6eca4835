"""Reads the PFM pictures that `ballpark render` writes."""

import array
import sys


def read_pfm(data):
    """Width, height and the numbers of the bytes of a file: r g b a pixel, bottom row first."""
    kind, size, scale, rest = data.split(b"\n", 3)
    assert kind == b"PF" and float(scale) == -1.0, f"not a colour PFM, little endian: {kind} {scale}"
    width, height = map(int, size.split())
    numbers = array.array("f", rest)
    if sys.byteorder == "big":
        numbers.byteswap()
    assert len(numbers) == width * height * 3, f"{len(numbers)} numbers"
    return width, height, numbers
