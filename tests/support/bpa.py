"""Film files (.bpa), read and written by the layout of docs/FILES.md and without the program's code."""

import json
import struct
import zlib

BLOCK = 65536


def _from_planes(planes, width, count):
    numbers = bytearray(width * count)
    for done in range(0, count, BLOCK):
        block = min(BLOCK, count - done)
        part = planes[width * done:width * (done + block)]
        for byte in range(width):
            numbers[width * done + byte:width * (done + block):width] = part[byte * block:(byte + 1) * block]
    return bytes(numbers)


def _to_planes(numbers, width, count):
    return b"".join(numbers[width * done + byte:width * min(done + BLOCK, count):width]
                    for done in range(0, count, BLOCK) for byte in range(width))


def _arrays(header):
    """Name, bytes of a number and how many, in the order of the file."""
    pixels = header["width"] * header["height"]
    cells = pixels * header["replicates"]
    yield "sums", 8, 3 * cells
    if header.get("fine_sums"):
        yield "fine_sums", 8, 3 * cells
    yield "counts", 4, cells
    if header.get("aovs"):
        yield "depth", 4, pixels
        yield "normal", 4, 3 * pixels
        yield "albedo", 4, 3 * pixels
    if header.get("pixel_segments"):
        yield "pixel_segments", 8, pixels
    if header.get("alpha"):
        yield "met", 8, pixels
    if header.get("unseen"):
        yield "unseen", 4, 2 * pixels
        yield "unseen_tint", 4, 3
    if "plan" in header:
        yield "decisions", 1, header["plan"]["decision_bytes"]


def read(data):
    """The header, and the numbers of each array as little-endian bytes."""
    head, body = data.split(b"\n", 1)
    header = json.loads(head)
    assert zlib.crc32(data[:-4]) == struct.unpack("<I", data[-4:])[0], "a wrong checksum"
    unpacked, at, arrays = zlib.decompress(body[:-4]), 0, {}
    for name, width, count in _arrays(header):
        arrays[name] = _from_planes(unpacked[at:at + width * count], width, count)
        at += width * count
    assert at == len(unpacked), "a wrong length"
    return header, arrays


def write(header, arrays):
    """The bytes of a film; each array has so few numbers that they are one block."""
    body = b""
    for name, width, count in _arrays(header):
        assert count <= BLOCK and len(arrays[name]) == width * count, name
        body += b"".join(arrays[name][byte::width] for byte in range(width))
    file = json.dumps(header).encode() + b"\n" + zlib.compress(body)
    return file + struct.pack("<I", zlib.crc32(file))


def sums_alone(data):
    """The same film without depth, normal, albedo, alpha, unseen light and what a render needs to go on: none of them has to be there."""
    header, arrays = read(data)
    for name in ("plan", "job"):
        header.pop(name, None)
    return write(dict(header, aovs=False, pixel_segments=False, alpha=False, unseen=False), arrays)
