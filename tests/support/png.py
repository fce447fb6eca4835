"""Reads the PNG files that the program writes: RGB or RGBA of 8 or 16 bits, not interlaced. Standard library only."""

import struct
import zlib


def read_png(data):
    """(width, height, bits, channels, rows of samples) of a PNG that is not interlaced, and its chunks by name."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, []
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        chunks.append((name.decode(), data[at + 8:at + 8 + size]))
        at += 12 + size
    width, height, bits, kind = struct.unpack_from(">IIBB", dict(chunks)["IHDR"])
    channels = {2: 3, 6: 4}[kind]
    size = channels * bits // 8
    raw = zlib.decompress(b"".join(body for name, body in chunks if name == "IDAT"))
    rows, before = [], bytes(width * size)
    for y in range(height):
        kind, line = raw[y * (width * size + 1)], bytearray(raw[y * (width * size + 1) + 1:(y + 1) * (width * size + 1)])
        for i, byte in enumerate(line):
            left, up, corner = (line[i - size] if i >= size else 0), before[i], (before[i - size] if i >= size else 0)
            guess = left + up - corner
            paeth = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            line[i] = (byte + [0, left, up, (left + up) // 2, paeth][kind]) & 0xff
        rows.append(line)
        before = line
    if bits == 16:
        rows = [struct.unpack(f">{len(row) // 2}H", row) for row in rows]
    return width, height, bits, channels, rows, chunks
