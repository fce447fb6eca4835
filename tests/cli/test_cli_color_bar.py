"""The colour bar of a transparent picture: its letters can be read wherever the picture is laid.

In:    pictures of particles with a bar.   Out: their pixels over a white and a black page.   Knows: where the bar stands.
"""
from cli import ProgramTest, main
from png import read_png


class ColorBar(ProgramTest):
    def picture(self, width, *options):
        self.write("a.csv", "x,y,z,heat\n" + "".join(f"{i},{i % 3},0,{i}\n" for i in range(11)))
        self.succeed("render", "a.csv", "-q", "--spp", 1, "--width", width, "-o", "a.png", "--set",
                     'particles[0].color={"column":"heat","bar":true}', *options)
        return read_png(self.read("a.png"))

    def over(self, picture, page):
        """The grey of each pixel, by row, when the picture lies on a page."""
        width, height, _, channels, rows, _ = picture
        self.assertEqual(channels, 4)
        grey = lambda row, x: sum(w * (row[4 * x + c] * row[4 * x + 3] + page * (255 - row[4 * x + 3])) / 255
                                  for c, w in enumerate((0.2126, 0.7152, 0.0722)))
        return [[grey(rows[y], x) for x in range(width)] for y in range(height)]

    def test_transparent(self):
        """Every stroke is dark, and next to white, on white paper and on a black screen alike."""
        for width, scale in ((300, 1), (900, 2)):
            picture = self.picture(width, "--set", "backdrop=none")
            height, rows = picture[1], picture[4]
            ink = [(x, y) for y in range(height) for x in range(3 * width // 4, width)
                   if tuple(rows[y][4 * x:4 * x + 4]) == (40, 40, 40, 255)]
            # The labels: right of the frame, whose right side is the longest column of ink.
            columns = {x: sum(1 for u, _ in ink if u == x) for x, _ in ink}
            frame = max(x for x, count in columns.items() if count >= height // 2)
            letters = [(x, y) for x, y in ink if x > frame]
            self.assertGreater(len(letters), 60 * scale * scale)
            for page in (255, 0):
                grey = self.over(picture, page)
                for x, y in letters:
                    self.assertLess(grey[y][x], 45)
                    around = [grey[v][u] for v in range(y - 2 * scale, y + 2 * scale + 1)
                              for u in range(x - 2 * scale, min(x + 2 * scale + 1, width))]
                    self.assertGreater(max(around), 250, (page, x, y))

    def test_opaque(self):
        """Without alpha there is no rim: ink alone, light on a dark picture and dark on a light one."""
        for backdrop, ink in (("[0,0,0]", (224, 224, 224)), ("[1,1,1]", (40, 40, 40))):
            width, height, _, channels, rows, _ = self.picture(300, "--set", f"backdrop={backdrop}")
            self.assertEqual(channels, 3)
            page = 255 if backdrop == "[1,1,1]" else 0
            right = {tuple(rows[y][3 * x:3 * x + 3]) for y in range(height) for x in range(width - 10, width)}
            self.assertEqual(right - {ink}, {(page,) * 3})


if __name__ == "__main__":
    main()
