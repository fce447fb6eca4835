"""Writes JPEG files, by ITU-T T.81 and JFIF 1.02, as coarse as whole numbers are and no coarser.

In:    a size and the bytes of each texel.   Out: the bytes of a file.
Knows: the formats' documents.   Does not know: libjpeg, other programs.

Every step of quantisation is 1, so a decoder comes within two of each byte where colours are not halved. Codes of Huffman's tables all have
one length, since files here are small.
"""
import math
import struct

ZIGZAG = sorted(((u, v) for u in range(8) for v in range(8)), key=lambda p: (sum(p), p[0] if sum(p) % 2 == 0 else p[1]))
DC_SYMBOLS = list(range(12))
AC_SYMBOLS = [0x00, 0xF0] + [run << 4 | size for run in range(16) for size in range(1, 11)]
COSINES = [[math.cos((2 * x + 1) * u * math.pi / 16) * (math.sqrt(0.125) if u == 0 else 0.5) for x in range(8)] for u in range(8)]


def segment(marker, content):
    return struct.pack(">BBH", 0xFF, marker, len(content) + 2) + content


class Bits:
    def __init__(self):
        self.bits = []

    def put(self, value, count):
        self.bits += [value >> i & 1 for i in reversed(range(count))]

    def value(self, number):
        """A number of T.81's signed form, behind its size."""
        size = abs(number).bit_length()
        self.put(number if number > 0 else number + (1 << size) - 1, size)

    def done(self):
        bits = self.bits + [1] * (-len(self.bits) % 8)
        whole = bytes(int("".join(map(str, bits[i:i + 8])), 2) for i in range(0, len(bits), 8))
        return whole.replace(b"\xff", b"\xff\0")


def dct(block):
    """Whole coefficients, in the order of the file, of 8 by 8 numbers around 0, rows first."""
    half = [[sum(COSINES[u][x] * row[x] for x in range(8)) for u in range(8)] for row in block]
    return [round(sum(COSINES[v][y] * half[y][u] for y in range(8))) for u, v in ZIGZAG]


def put_dc(bits, number, before):
    size = abs(number - before).bit_length()
    bits.put(DC_SYMBOLS.index(size), 4)
    bits.value(number - before)


def put_ac(bits, coefficients):
    run = 0
    for number in coefficients[1:]:
        if number == 0:
            run += 1
            continue
        for _ in range(run // 16):
            bits.put(AC_SYMBOLS.index(0xF0), 8)
        bits.put(AC_SYMBOLS.index(run % 16 << 4 | abs(number).bit_length()), 8)
        bits.value(number)
        run = 0
    if run > 0:
        bits.put(AC_SYMBOLS.index(0), 8)


def channels_of(width, height, texel, gray):
    """Planes of Y, and of Cb and Cr, around 0."""
    if gray:
        return [[[texel(x, y)[0] - 128 for x in range(width)] for y in range(height)]]
    planes = [[], [], []]
    for y in range(height):
        colors = [texel(x, y) for x in range(width)]
        planes[0].append([0.299 * r + 0.587 * g + 0.114 * b - 128 for r, g, b in colors])
        planes[1].append([-0.168735892 * r - 0.331264108 * g + 0.5 * b for r, g, b in colors])
        planes[2].append([0.5 * r - 0.418687589 * g - 0.081312411 * b for r, g, b in colors])
    return planes


def halved(plane):
    """Means of two by two; the last row and column stand for what lies beyond."""
    height, width = len(plane), len(plane[0])
    at = lambda x, y: plane[min(y, height - 1)][min(x, width - 1)]
    return [[sum(at(2 * x + i, 2 * y + j) for i in (0, 1) for j in (0, 1)) / 4 for x in range((width + 1) // 2)]
            for y in range((height + 1) // 2)]


def blocks_of(plane, across, down):
    """By row and column, with the last row and column repeated beyond."""
    height, width = len(plane), len(plane[0])
    return [[dct([[plane[min(8 * j + y, height - 1)][min(8 * i + x, width - 1)] for x in range(8)] for y in range(8)])
             for i in range(across)] for j in range(down)]


def jpeg(width, height, texel, gray=False, halve=False, progressive=False, markers=(), channels=None):
    """A file. `halve`: colours have half the resolution. `markers`: (number, content) of segments behind the first; `channels`: how many
    the header claims, where that is wrong on purpose."""
    planes = channels_of(width, height, texel, gray)
    step = 2 if halve else 1
    if halve:
        planes[1:] = [halved(plane) for plane in planes[1:]]
    factors = [step] + [1] * (len(planes) - 1)
    across, down = -(-width // (8 * step)), -(-height // (8 * step))
    blocks = [blocks_of(plane, across * f, down * f) for plane, f in zip(planes, factors)]
    frame = struct.pack(">BHHB", 8, height, width, channels or len(planes))
    frame += b"".join(bytes([k + 1, f << 4 | f, 0]) for k, f in enumerate((factors * 4)[:channels] if channels else factors))
    out = b"\xff\xd8" + segment(0xE0, b"JFIF\0\1\2\0\0\1\0\1\0\0") + b"".join(segment(n, c) for n, c in markers)
    out += segment(0xDB, b"\0" + bytes([1] * 64)) + segment(0xC2 if progressive else 0xC0, frame)
    out += segment(0xC4, b"\0" + bytes([0, 0, 0, len(DC_SYMBOLS)] + [0] * 12) + bytes(DC_SYMBOLS))
    out += segment(0xC4, b"\x10" + bytes([0] * 7 + [len(AC_SYMBOLS)] + [0] * 8) + bytes(AC_SYMBOLS))

    def scan(numbers, first, last, content):
        head = bytes([len(numbers)]) + b"".join(bytes([n + 1, 0]) for n in numbers) + bytes([first, last, 0])
        return segment(0xDA, head) + content.done()
    bits, before = Bits(), [0] * len(planes)
    for j in range(down):
        for i in range(across):
            for k, f in enumerate(factors):
                for y in range(f):
                    for x in range(f):
                        block = blocks[k][j * f + y][i * f + x]
                        put_dc(bits, block[0], before[k])
                        before[k] = block[0]
                        if not progressive:
                            put_ac(bits, block)
    out += scan(range(len(planes)), 0, 0 if progressive else 63, bits)
    for k, plane in enumerate(planes if progressive else []):
        bits = Bits()
        for j in range(-(-len(plane) // 8)):
            for i in range(-(-len(plane[0]) // 8)):
                put_ac(bits, blocks[k][j][i])
        out += scan([k], 1, 63, bits)
    return out + b"\xff\xd9"
