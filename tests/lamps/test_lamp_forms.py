"""The closed forms that the lamps' cases stand on (forms.py), each against quadrature or draws of its definition."""
import math
import random
import sys
import unittest

import forms

PI = math.pi
POINTS = forms.nodes(64)


class Forms(unittest.TestCase):
    def test_quadrature_itself(self):
        self.assertAlmostEqual(forms.integrate(math.exp, 0, 1, POINTS), math.e - 1, delta=1e-14)
        self.assertAlmostEqual(forms.over_cone(lambda theta, phi: 1, 0.7, 5, 5), 2 * PI * (1 - math.cos(0.7)), delta=1e-13)
        for sigma in (0.1, 1.0, 1.5):
            mean = forms.over_cone(lambda theta, phi: math.cos(theta), sigma, 100, 1) / (2 * PI * (1 - math.cos(sigma)))
            self.assertAlmostEqual(mean, (1 + math.cos(sigma)) / 2, delta=1e-5)

    def test_irradiance(self):
        """Clear of the horizon, cut by it from above and from below, filling the sky, and out of sight."""
        for sigma in (0.05, 0.4, 1.0, 1.5):
            for omega in (0.0, 0.3, 1.2, PI / 2 - 0.02, PI / 2, PI / 2 + 0.02, 1.9, 2.4, 3.0):
                share = forms.lobe_share(lambda c: max(c, 0) / PI, sigma, omega, 300, 300)
                self.assertAlmostEqual(forms.irradiance(sigma, omega), share, delta=1e-6 + 4e-5 * share,
                                       msg=f"sigma {sigma}, omega {omega}")
        self.assertAlmostEqual(forms.irradiance(PI / 2 - 1e-9, 0), 1, delta=1e-12)
        self.assertEqual(forms.irradiance(0.3, PI / 2 + 0.31), 0)

    def test_irradiance_is_continuous(self):
        for sigma in (1e-3, 0.2, 1.2):
            for edge in (PI / 2 - sigma, PI / 2, PI / 2 + sigma):
                low, high = (forms.irradiance(sigma, edge + side) for side in (-1e-10, 1e-10))
                self.assertAlmostEqual(low, high, delta=1e-9)

    def test_other_lobes(self):
        for sigma, omega in ((0.05, 0.3), (0.5, 0), (0.5, 0.9), (0.2, 1.3), (1.2, 0.3)):
            cubed = forms.lobe_share(lambda c: 2 * c ** 3 / PI, sigma, omega, 300, 300)
            self.assertAlmostEqual(forms.cosine_cubed(sigma, omega), cubed, delta=2e-5 * cubed + 1e-9)
            even = forms.lobe_share(lambda c: 1 / (2 * PI), sigma, omega, 50, 50)
            self.assertAlmostEqual(forms.hemisphere(sigma), even, delta=1e-12)

    def test_fuzz_densities(self):
        """They hold the whole lobe; at fuzz 1 they are the matte lobes; shares of them agree with plain quadrature."""
        for fuzz in (0.02, 0.3, 0.9, 1.0):
            for ball in (False, True):
                whole = forms.fuzz_share(fuzz, ball, PI / 2, 0)
                self.assertAlmostEqual(whole, 1, delta=1e-9, msg=f"fuzz {fuzz}, ball {ball}")
        for cosine in (0.1, 0.5, 0.99):
            self.assertAlmostEqual(forms.fuzz_density(1, False, cosine), cosine / PI, delta=1e-15)
            self.assertAlmostEqual(forms.fuzz_density(1, True, cosine), 2 * cosine ** 3 / PI, delta=1e-15)
        for sigma, omega in ((0.1, 0.05), (0.2, 0.3), (0.4, 0.5)):
            plain = forms.lobe_share(lambda c: forms.fuzz_density(0.5, True, c), sigma, omega, 300, 300)
            self.assertAlmostEqual(forms.fuzz_share(0.5, True, sigma, omega), plain, delta=1e-4 * plain)
        self.assertAlmostEqual(forms.fuzz_share(1, False, 0.3, 0.6), forms.irradiance(0.3, 0.6), delta=1e-6)
        self.assertAlmostEqual(forms.fuzz_share(1, True, 0.3, 0.6), forms.cosine_cubed(0.3, 0.6), delta=1e-6)

    def test_draws(self):
        """Draws of R + f S, by the definition alone: how many fall into a cone, and below the surface."""
        draw = random.Random(5)
        count = 40000
        for fuzz, ball, up in ((0.5, False, 0.2), (0.5, True, 0.2), (1, False, 0.1), (1, True, 0.1), (0.3, False, 0.4)):
            normal = (math.sqrt(1 - up * up), 0, up)  # R is (0, 0, 1)
            sigma, omega = 0.25, 0.2
            axis = (0, math.sin(omega), math.cos(omega))
            within = below = 0
            for _ in range(count):
                while True:
                    s = [draw.uniform(-1, 1) for _ in range(3)]
                    length = math.sqrt(sum(x * x for x in s))
                    if 0 < length <= 1:
                        break
                if not ball:
                    s = [x / length for x in s]
                v = [fuzz * s[0], fuzz * s[1], 1 + fuzz * s[2]]
                length = math.sqrt(sum(x * x for x in v))
                within += sum(a * b for a, b in zip(v, axis)) > math.cos(sigma) * length
                below += sum(a * b for a, b in zip(v, normal)) <= 0
            for found, expected in ((within, forms.fuzz_share(fuzz, ball, sigma, omega)),
                                    (below, forms.fuzz_absorbed(fuzz, ball, up))):
                error = math.sqrt(max(expected * (1 - expected), 1e-9) / count)
                self.assertLess(abs(found / count - expected), 4.5 * error, f"fuzz {fuzz}, ball {ball}")


if __name__ == "__main__":
    sys.exit(0 if unittest.main(exit=False).result.wasSuccessful() else 1)
