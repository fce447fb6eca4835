"""What a point sees of a lamp, in closed form, and the same by quadrature.

In:    half angles, cosines, the fuzz of metal; all in doubles.   Out: shares of the light that a lobe collects.
Knows: the definitions of the lobes.   Does not know: scenes, the program, how it samples.

A lamp is a ball of radius r at distance D: it covers the cone of half angle sigma = asin(r / D) around a direction
that stands at an angle omega to the lobe's axis.
"""
import math

PI = math.pi


def irradiance(sigma, omega):
    """What a matte point above a horizon receives from the lamp, over pi times its radiance: 1 is a lamp that fills the
    sky. J. M. Snyder, "Area Light Sources for Real-Time Graphics", Microsoft Research MSR-TR-96-11, 1996."""
    share = math.sin(sigma) ** 2
    if omega <= PI / 2 - sigma:
        return share * math.cos(omega)
    if omega >= PI / 2 + sigma:
        return 0.0
    g = math.asin(math.cos(sigma) / math.sin(omega))
    rest = math.sqrt(max(0.0, share - math.cos(g) ** 2))
    disk = -2 * math.sin(omega) * math.cos(sigma) * math.cos(g) + PI / 2 - g + math.sin(g) * math.cos(g)
    cone = math.cos(omega) * (math.cos(g) * rest + share * math.asin(min(1.0, math.cos(g) / math.sin(sigma))))
    return share * math.cos(omega) + (disk - cone) / PI if omega <= PI / 2 else (disk + cone) / PI


def cosine_cubed(sigma, omega):
    """The same for the lobe 2 cos^3 / pi, for a lamp wholly above the horizon: from the expansion of cos^3 in Legendre
    polynomials, each of which keeps its shape when it is averaged over a cone."""
    y, c = math.cos(sigma), math.cos(omega)
    third = 0.5 * (5 * c ** 3 - 3 * c)
    return 4 * (0.3 * c * (1 - y * y) + 0.05 * third * (1 - y * y) * (5 * y * y - 1))


def hemisphere(sigma):
    """The same for a uniform lobe, for a lamp wholly above the horizon."""
    return 1 - math.cos(sigma)


def fuzz_density(fuzz, ball, cosine):
    """Density over solid angle of the direction R + f S at an angle of the given cosine to R; S is on the unit sphere, or
    in the unit ball."""
    inside = fuzz * fuzz - (1 - cosine * cosine)
    if inside <= 0 or cosine <= 0:
        return 0.0
    h = math.sqrt(inside)
    if ball:
        return h * (3 * cosine * cosine + inside) / (2 * PI * fuzz ** 3)
    return (cosine * cosine + inside) / (2 * PI * fuzz * h)


def fuzz_absorbed(fuzz, ball, up):
    """The share of fuzzy reflections that point below the surface; `up`: cosine of R to the normal."""
    if up >= fuzz:
        return 0.0
    if ball:
        return (fuzz - up) ** 2 * (2 * fuzz + up) / (4 * fuzz ** 3)
    return (fuzz - up) / (2 * fuzz)


# ---- quadrature ------------------------------------------------------------------------------------------------

def nodes(count):
    """Gauss and Legendre's points and weights on (0, 1)."""
    found = []
    for i in range(count):
        x = math.cos(PI * (i + 0.75) / (count + 0.5))
        for _ in range(50):
            p, previous = 1.0, 0.0
            for k in range(1, count + 1):
                p, previous = ((2 * k - 1) * x * p - (k - 1) * previous) / k, p
            slope = count * (x * p - previous) / (x * x - 1)
            step = p / slope
            x -= step
            if abs(step) < 1e-15:
                break
        found.append((0.5 * (1 - x), 1 / ((1 - x * x) * slope * slope)))
    return found


def integrate(function, low, high, points):
    return (high - low) * sum(w * function(low + (high - low) * x) for x, w in points)


def over_cone(density, sigma, rings=400, sectors=400):
    """The integral of density(theta, phi) over the directions at an angle theta < sigma to an axis. Midpoints: a density
    may jump or bend, as it does at a horizon."""
    total = 0.0
    for i in range(rings):
        # even in cos(theta), so that each ring has the same solid angle
        theta = 2 * math.asin(math.sqrt((i + 0.5) / rings) * math.sin(sigma / 2))
        total += sum(density(theta, 2 * PI * (j + 0.5) / sectors) for j in range(sectors))
    return total * 4 * PI * math.sin(sigma / 2) ** 2 / (rings * sectors)


def cosine_to(theta, phi, omega):
    """The cosine to an axis at an angle omega from the cone's."""
    return math.cos(theta) * math.cos(omega) + math.sin(theta) * math.sin(omega) * math.cos(phi)


def lobe_share(density, sigma, omega, rings=400, sectors=400):
    """The share of a lobe around one axis that falls into the cone; density(cosine to that axis)."""
    return over_cone(lambda theta, phi: density(cosine_to(theta, phi, omega)), sigma, rings, sectors)


def fuzz_share(fuzz, ball, sigma, omega, points=nodes(200)):
    """The share of a fuzz lobe that falls into the cone, wherever the surface is not in the way. In rings around R: at
    each angle gamma the part of the circle inside the cone is known, and sin(gamma) = f sin(t) takes away the pole
    at the lobe's rim."""
    def ring(t):
        sine = fuzz * math.sin(t)
        gamma = math.asin(min(1.0, sine))
        if omega == 0:
            inside = 1.0 if gamma < sigma else 0.0
        elif gamma + omega <= sigma:
            inside = 1.0
        elif abs(gamma - omega) >= sigma:
            inside = 0.0
        else:
            inside = math.acos(max(-1.0, min(1.0, (math.cos(sigma) - math.cos(gamma) * math.cos(omega)) /
                                              (sine * math.sin(omega))))) / PI
        cosine = math.cos(gamma)
        h = fuzz * math.cos(t)
        # density * 2 pi sin(gamma) * d gamma / dt, with d gamma / dt = h / cosine
        if ball:
            mass = h * (3 * cosine * cosine + h * h) / fuzz ** 3 * sine * h / cosine
        else:
            mass = (cosine * cosine + h * h) / fuzz * sine / cosine
        return mass * inside

    # Where the circle begins to enter the cone, and where it is wholly inside or outside, the integrand bends.
    edges = [0.0, PI / 2]
    for gamma in (abs(sigma - omega), sigma + omega):
        if math.sin(gamma) < fuzz and gamma < PI / 2:
            edges.append(math.asin(math.sin(gamma) / fuzz))
    edges.sort()
    return sum(integrate(ring, low, high, points) for low, high in zip(edges, edges[1:]) if high > low)
