"""Reads the EXR files that the program writes: scan lines, ZIP compressed, 32-bit channels. Standard library only;
that other programs can read them too is the business of tests/image/test_image_formats.c.

The layout is that of "OpenEXR File Layout" (openexr.com): a header of attributes, a table of chunks, chunks of 16
rows; in a chunk, row by row, each channel's values, channels in the order of their names."""

import struct
import zlib

ROWS = 16  # of a chunk, with ZIP compression


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def attributes(data):
    """The header's attributes as bytes by name, and where the header ends."""
    found, at = {}, 8
    while data[at] != 0:
        name, at = text(data, at)
        _, at = text(data, at)
        size, = struct.unpack_from("<i", data, at)
        found[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def unpacked(packed, size):
    """Undoes ZIP: deflate, differences of bytes, lower and upper halves of the bytes apart."""
    if len(packed) == size:
        return packed
    coded = bytearray(zlib.decompress(packed))
    assert len(coded) == size
    for i in range(1, size):
        coded[i] = (coded[i - 1] + coded[i] - 128) & 0xff
    half = (size + 1) // 2
    whole = bytearray(size)
    whole[0::2], whole[1::2] = coded[:half], coded[half:]
    return bytes(whole)


def read(data):
    """(width, height, {channel: list of values, row by row from the top})"""
    assert struct.unpack_from("<ii", data) == (20000630, 2), "not an EXR of scan lines"
    header, at = attributes(data)
    assert header["compression"] == b"\3", header["compression"]
    x0, y0, x1, y1 = struct.unpack("<iiii", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    kinds, list_at, listing = [], 0, header["channels"]
    while listing[list_at] != 0:
        name, list_at = text(listing, list_at)
        kinds.append((name, {0: "I", 2: "f"}[struct.unpack_from("<i", listing, list_at)[0]]))
        list_at += 16
    channels = {name: [] for name, _ in kinds}
    chunks = (height + ROWS - 1) // ROWS
    for offset in struct.unpack_from(f"<{chunks}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(ROWS, height - (y - y0))
        raw = unpacked(data[offset + 8:offset + 8 + size], rows * width * 4 * len(kinds))
        place = 0
        for _ in range(rows):
            for name, kind in kinds:
                channels[name].extend(struct.unpack_from(f"<{width}{kind}", raw, place))
                place += 4 * width
    return width, height, channels
