"""Line plots as SVG, without any library: what docs/BENCHMARKS.md needs and no more."""
import math
from html import escape

WIDTH, HEIGHT = 720, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 180, 44, 56
# Told apart by every kind of sight, with the marks: on white paper, and on dark.
COLOURS = [("#0b6e99", "#58b6e0"), ("#d9730d", "#f59b4c"), ("#6b8e23", "#a3cc4e"), ("#8e44ad", "#c38be0"), ("#c0392b", "#ef7d72")]
PAPER = {"paper": ("#ffffff", "#1b1d21"), "ink": ("#1f2328", "#e6e6e6"), "grid": ("#dddddd", "#3a3d42")}
MARKS = ["circle", "square", "triangle", "diamond", "cross"]


KNOWN = ["ballpark, packet", "ballpark, sample", "Embree", "the book's tree"]  # have the same colour in every plot


def ticks(low, high):
    """1, 2 and 5 times powers of ten between low and high; powers alone when they are many."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    steps = (1,) if len(decades) > 4 else (1, 2, 5)
    return [step * 10 ** d for d in decades for step in steps if low * .999 <= step * 10 ** d <= high * 1.001]


def even_ticks(high):
    """0 and up in steps of 1, 2 or 5 times a power of ten, four to ten of them."""
    power = 10 ** math.floor(math.log10(high / 4))
    step = max(step for step in (1, 2, 5) if step * power <= high / 4) * power
    return [i * step for i in range(int(high / step) + 1)]


def label(value):
    if value >= 1e6:
        return f"{value / 1e6:g} M"
    if value >= 1e4:
        return f"{value / 1e3:g} k"
    return f"{value:g}"


def style():
    """Classes for both kinds of paper. Viewers that know no dark mode take the first."""
    def rules(which):
        papers = " ".join(f".{name}{{fill:{pair[which]};stroke:none}}" for name, pair in PAPER.items())
        lines = " ".join(f".l{i}{{stroke:{pair[which]}}} .f{i}{{fill:{pair[which]}}}" for i, pair in enumerate(COLOURS))
        return f"{papers} .grid{{stroke:{PAPER['grid'][which]}}} {lines}"
    return f"<style>{rules(0)} @media (prefers-color-scheme: dark){{{rules(1)}}}</style>"


def mark(kind, x, y, colour):
    if kind == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" class="f{colour}"/>'
    shapes = {"square": "-3.5,-3.5 3.5,-3.5 3.5,3.5 -3.5,3.5", "triangle": "0,-4.5 4.5,3.5 -4.5,3.5",
              "diamond": "0,-5 5,0 0,5 -5,0", "cross": "-5,-1 -1,-1 -1,-5 1,-5 1,-1 5,-1 5,1 1,1 1,5 -1,5 -1,1 -5,1"}
    points = " ".join(f"{x + float(a.split(',')[0]):.1f},{y + float(a.split(',')[1]):.1f}" for a in shapes[kind].split())
    return f'<polygon points="{points}" class="f{colour}"/>'


def plot(path, lines, x_label, y_label, title, x_ticks=None, joined=None):
    """Light on dark paper where the reader's screen is. `title`: what is to be seen, as a sentence.

    `lines`: name -> [(x, y), ...], all above 0. Where y spans less than a factor of 5, its axis is linear, from 0. `x_ticks`: where the
    grid's lines stand; every point has one if that is None. `joined`: the names of lines, where others are points alone."""
    points = [p for line in lines.values() for p in line]
    x_low, x_high = min(p[0] for p in points), max(p[0] for p in points)
    y_low, y_high = min(p[1] for p in points) / 1.15, max(p[1] for p in points) * 1.15
    linear = y_high < 5 * y_low

    def place_x(x):
        return LEFT + (WIDTH - LEFT - RIGHT) * (math.log(x / x_low) / math.log(x_high / x_low) if x_high > x_low else .5)

    def place_y(y):
        if linear:
            return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * y / y_high
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * math.log(y / y_low) / math.log(y_high / y_low)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
           f'<title>{escape(title)}</title>', style(), f'<rect width="{WIDTH}" height="{HEIGHT}" class="paper"/>',
           f'<g class="ink"><text x="{LEFT}" y="24" font-size="15">{escape(title)}</text>']
    for y in even_ticks(y_high) if linear else ticks(y_low, y_high):
        at = place_y(y)
        out.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{at:.1f}" y2="{at:.1f}" class="grid"/>')
        out.append(f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{label(y)}</text>')
    for x in sorted({p[0] for p in points}) if x_ticks is None else [x for x in x_ticks if x_low <= x <= x_high]:
        at = place_x(x)
        out.append(f'<line x1="{at:.1f}" x2="{at:.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" class="grid" opacity="0.5"/>')
        out.append(f'<text x="{at:.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{label(x)}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 14}" text-anchor="middle">{escape(x_label)}</text>')
    out.append(f'<text transform="translate(18 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">'
               f'{escape(y_label)}</text>')
    out.append("</g>")
    ends = []
    for number, (name, line) in enumerate(lines.items()):
        number = KNOWN.index(name) if name in KNOWN else number
        colour, kind = number % len(COLOURS), MARKS[number % len(MARKS)]
        spots = [(place_x(x), place_y(y)) for x, y in line]
        if joined is None or name in joined:
            out.append(f'<polyline fill="none" class="l{colour}" stroke-width="2" points="'
                       + " ".join(f"{x:.1f},{y:.1f}" for x, y in spots) + '"/>')
        out += [mark(kind, x, y, colour) for x, y in spots]
        ends.append([spots[-1][1], name, colour, spots[-1][0]])
    # names at the lines' ends, pushed apart
    ends.sort()
    for above, below in zip(ends, ends[1:]):
        below[0] = max(below[0], above[0] + 16)
    for y, name, colour, _ in ends:
        out.append(f'<text x="{WIDTH - RIGHT + 12}" y="{y + 4:.1f}" class="f{colour}">{escape(name)}</text>')
    out.append("</svg>")
    with open(path, "w") as file:
        file.write("\n".join(out) + "\n")
